//! Contacts that are known again in the next step.
//!
//! A solver that starts from the forces of the step before needs to know which contact is which. Contacts come without
//! names, and a corner that slides or a polygon that is clipped elsewhere changes their order. So contacts of one pair
//! are grouped by normal into manifolds of at most four points, enough to carry any face, and the points take over the
//! numbers of those that were nearest to them, on both bodies, a step before.

use crate::{Frame, GeomContact};
use ferrode_math::Vec3;

/// Most points of a manifold.
pub const MANIFOLD_POINTS: usize = 4;
/// Cosine of the angle up to which two normals are one: about eight degrees.
const ONE_NORMAL: f64 = 0.99;

/// A contact of a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ManifoldPoint {
    /// World position, in metres.
    pub position: Vec3,
    /// Penetration depth in metres.
    pub depth: f64,
    /// The position in the first body's coordinates.
    pub local_a: Vec3,
    /// The position in the second body's coordinates.
    pub local_b: Vec3,
    /// The same number as long as this is the same contact; unique within the manifold and its successors.
    pub id: u32,
}

/// Up to four contacts with one normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manifold {
    /// Unit, into the first body: that of the deepest contact.
    pub normal: Vec3,
    /// The normal in the first body's coordinates.
    pub local_normal: Vec3,
    /// Parts of the geoms at the deepest contact, as in [`GeomContact`].
    pub sides: (i32, i32),
    points: [ManifoldPoint; MANIFOLD_POINTS],
    count: usize,
    next_id: u32,
}

impl Manifold {
    /// The contacts.
    pub fn points(&self) -> &[ManifoldPoint] {
        &self.points[..self.count]
    }

    fn new(contacts: &[GeomContact], a: &Frame, b: &Frame) -> Option<Self> {
        let (chosen, count) = choose(contacts);
        let first = contacts.get(chosen[0])?;
        let mut points = [ManifoldPoint::default(); MANIFOLD_POINTS];
        for (k, (point, &i)) in points.iter_mut().zip(&chosen[..count]).enumerate() {
            let c = &contacts[i].point;
            *point = ManifoldPoint {
                position: c.position,
                depth: c.depth,
                local_a: a.point_to_local(c.position),
                local_b: b.point_to_local(c.position),
                id: k as u32,
            };
        }
        Some(Self {
            normal: first.point.normal,
            local_normal: a.vector_to_local(first.point.normal),
            sides: (first.side1, first.side2),
            points,
            count,
            next_id: count as u32,
        })
    }

    /// Takes over the numbers of `old`'s points that are within `reach` metres of the new ones on either body: a point
    /// fixed to one of them moves over the other. The nearest pairs first; each number goes to one point.
    pub fn inherit(&mut self, old: &Self, reach: f64) {
        let mut pairs = [(0.0, 0, 0); MANIFOLD_POINTS * MANIFOLD_POINTS];
        let mut count = 0;
        for (i, p) in self.points().iter().enumerate() {
            for (j, q) in old.points().iter().enumerate() {
                let square =
                    (p.local_a - q.local_a).length_squared().min((p.local_b - q.local_b).length_squared());
                if square <= reach * reach {
                    pairs[count] = (square, i, j);
                    count += 1;
                }
            }
        }
        pairs[..count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut ids = [None; MANIFOLD_POINTS];
        let mut taken = [false; MANIFOLD_POINTS];
        for &(_, i, j) in &pairs[..count] {
            if ids[i].is_none() && !taken[j] {
                ids[i] = Some(old.points[j].id);
                taken[j] = true;
            }
        }
        self.next_id = old.next_id;
        for (point, id) in self.points[..self.count].iter_mut().zip(ids) {
            point.id = id.unwrap_or_else(|| {
                self.next_id = self.next_id.wrapping_add(1);
                self.next_id.wrapping_sub(1)
            });
        }
    }
}

/// Groups the contacts of one pair of geoms by normal and puts their manifolds into `out`, in place of what it held; the
/// deepest first. `contacts` is reordered.
///
/// `old` are the manifolds of the same pair a step before: each new one inherits from the unused one with the nearest
/// normal, if that is within about 25 degrees, points within `reach` metres of each other being the same.
pub fn manifolds(
    contacts: &mut [GeomContact],
    a: &Frame,
    b: &Frame,
    old: &[Manifold],
    reach: f64,
    out: &mut Vec<Manifold>,
) {
    out.clear();
    let mut rest = contacts;
    while !rest.is_empty() {
        let deepest =
            (0..rest.len()).fold(0, |k, i| if rest[i].point.depth > rest[k].point.depth { i } else { k });
        let normal = rest[deepest].point.normal;
        let mut count = 0;
        for i in 0..rest.len() {
            if i == deepest || rest[i].point.normal.dot(normal) > ONE_NORMAL {
                rest.swap(i, count);
                count += 1;
            }
        }
        let (group, others) = rest.split_at_mut(count);
        out.extend(Manifold::new(group, a, b));
        rest = others;
    }
    let mut used = 0u64;
    for m in out.iter_mut() {
        let mut best = (0.9, None);
        for (j, o) in old.iter().enumerate().take(64) {
            let cosine = o.local_normal.dot(m.local_normal);
            if cosine > best.0 && used & (1 << j) == 0 {
                best = (cosine, Some(j));
            }
        }
        if let Some(j) = best.1 {
            used |= 1 << j;
            m.inherit(&old[j], reach);
        }
    }
}

/// The deepest contact, the one furthest from it, and the two that widen the polygon most, on either side.
fn choose(contacts: &[GeomContact]) -> ([usize; MANIFOLD_POINTS], usize) {
    let mut chosen = [0; MANIFOLD_POINTS];
    if contacts.len() <= MANIFOLD_POINTS {
        for (i, slot) in chosen.iter_mut().enumerate() {
            *slot = i;
        }
        // The deepest first.
        let deepest = best_of(contacts, |c| c.point.depth).0;
        chosen.swap(0, deepest);
        return (chosen, contacts.len());
    }
    let at = |i: usize| contacts[i].point.position;
    let first = best_of(contacts, |c| c.point.depth).0;
    let normal = contacts[first].point.normal;
    let second = best_of(contacts, |c| (c.point.position - at(first)).length_squared()).0;
    let area = |c: &GeomContact| (at(second) - at(first)).cross(c.point.position - at(first)).dot(normal);
    let (left, widest) = best_of(contacts, area);
    let (right, narrowest) = best_of(contacts, |c| -area(c));
    chosen[0] = first;
    chosen[1] = second;
    let mut count = 2;
    for (i, size) in [(left, widest), (right, narrowest)] {
        if size > 0.0 && !chosen[..count].contains(&i) {
            chosen[count] = i;
            count += 1;
        }
    }
    (chosen, count)
}

fn best_of(contacts: &[GeomContact], measure: impl Fn(&GeomContact) -> f64) -> (usize, f64) {
    let mut best = (0, f64::NEG_INFINITY);
    for (i, c) in contacts.iter().enumerate() {
        let m = measure(c);
        if m > best.1 {
            best = (i, m);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CollideOptions, Cuboid, Plane, Shape, narrow};
    use ferrode_math::{Pose, Quat};

    fn contacts(a: (&Shape, &Frame), b: (&Shape, &Frame)) -> Vec<GeomContact> {
        let mut list = Vec::new();
        narrow::collide_frames(a, b, CollideOptions::default(), &mut list);
        list
    }

    #[test]
    fn a_sliding_turning_box_keeps_its_numbers() {
        let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).unwrap());
        let slab = Shape::from(Cuboid::new(Vec3::new(10.0, 10.0, 1.0)).unwrap());
        let ground = Frame::IDENTITY;
        let mut old: Vec<Manifold> = Vec::new();
        let mut new = Vec::new();
        let mut corners: Vec<(u32, Vec3)> = Vec::new();
        for step in 0..200 {
            let t = f64::from(step) * 0.01;
            let turn =
                Quat::from_axis_angle(Vec3::Z, 0.8 * t) * Quat::from_axis_angle(Vec3::X, 1e-4 * (9.0 * t));
            let frame = Frame::from(&Pose::new(Vec3::new(t, 0.3 * t, 0.995), turn));
            let mut list = contacts((&cube, &frame), (&slab, &ground));
            manifolds(&mut list, &frame, &ground, &old, 0.05, &mut new);
            assert_eq!(new.len(), 1);
            assert_eq!(new[0].points().len(), 4);
            for p in new[0].points() {
                // Each number stays at its corner of the box.
                match corners.iter().find(|c| c.0 == p.id) {
                    Some(c) => assert!((c.1 - p.local_a).length() < 0.02, "step {step}: {c:?} {p:?}"),
                    None => corners.push((p.id, p.local_a)),
                }
            }
            core::mem::swap(&mut old, &mut new);
        }
        assert_eq!(corners.len(), 4);
    }

    #[test]
    fn many_contacts_become_four_that_hold() {
        let corner = |x: f64, y: f64, depth: f64| GeomContact::new(Vec3::new(x, y, 0.0), Vec3::Z, depth);
        let mut list = vec![
            corner(0.1, 0.0, 0.01),
            corner(1.0, 1.0, 0.01),
            corner(-1.0, 1.0, 0.01),
            corner(0.0, 1.0, 0.01),
            corner(-1.0, -1.0, 0.02),
            corner(1.0, -1.0, 0.01),
        ];
        let mut out = Vec::new();
        manifolds(&mut list, &Frame::IDENTITY, &Frame::IDENTITY, &[], 0.1, &mut out);
        assert_eq!(out.len(), 1);
        let points = out[0].points();
        assert_eq!(points.len(), 4);
        assert_eq!(points[0].depth, 0.02);
        assert!(points.iter().all(|p| p.position.x.abs() == 1.0 && p.position.y.abs() == 1.0));
    }

    #[test]
    fn walls_and_floor_are_apart() {
        let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).unwrap());
        let frame = Frame::from(&Pose::from_position(Vec3::new(0.49, 0.0, 0.49)));
        let mut list =
            contacts((&cube, &frame), (&Plane::new(Vec3::Z, 0.0).unwrap().into(), &Frame::IDENTITY));
        list.extend(contacts((&cube, &frame), (&Plane::new(Vec3::X, 0.0).unwrap().into(), &Frame::IDENTITY)));
        let mut out = Vec::new();
        manifolds(&mut list, &frame, &Frame::IDENTITY, &[], 0.1, &mut out);
        assert_eq!(out.len(), 2);
        assert!(out.iter().all(|m| m.points().len() == 4));
    }
}
