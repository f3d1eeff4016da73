//! From the cache's contacts to the solver's manifolds, and back.

use super::Pipeline;
use super::geoms::Known;
use crate::{GeomInfo, World};
use ferrode_collide::manifold::{Vec3f, is_concave};
use ferrode_collide::narrow::distance_frames;
use ferrode_collide::pairs::{Contact, PairCache};
use ferrode_collide::{Frame, Shape};
use ferrode_dynamics::{ContactManifold, ManifoldPoint};
use ferrode_math::Vec3;
use ferrode_math::stage::{Crew, chunks};

/// The tag of a contact whose manifold has been set up; new ones have 0.
const SET_UP: u32 = 1;
/// Contacts of one task, a multiple of 64.
const PLACES: usize = 256;

/// Calls `visit` with the number of each of the first `count` bits that is set.
#[inline(always)]
fn for_awake(words: &[u64], count: usize, mut visit: impl FnMut(usize)) {
    for (w, word) in words.iter().take(count.div_ceil(64)).enumerate() {
        let mut bits = *word;
        while bits != 0 {
            visit(64 * w + bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}

impl World {
    /// Broad and narrow phase.
    pub(super) fn update_pairs(&mut self, crew: &Crew, pipeline: &mut Pipeline) {
        let Pipeline { pairs, known, .. } = pipeline;
        let (colliders, infos, known) = (&self.colliders, &self.geom_infos, &*known);
        pairs.update_with(crew, &|a, b| {
            let of = |slot: u32| {
                let info = infos.get(slot as usize)?.as_ref()?;
                let known = known.get(slot as usize)?.as_ref()?;
                Some((known.body, colliders.geom(info.key)?))
            };
            let (Some((body_a, a)), Some((body_b, b))) = (of(a), of(b)) else { return false };
            let meet = a.category_bits() & b.collide_bits() != 0 || b.category_bits() & a.collide_bits() != 0;
            meet && (body_a.is_none() || body_a != body_b)
        });
    }

    /// Gives the solver what touches.
    pub(super) fn fill_manifolds(&mut self, h: f64, crew: &Crew, pipeline: &mut Pipeline) {
        let rules = (self.rules_version, self.dynamics.topology_version());
        let anew = pipeline.seen_rules != rules;
        pipeline.seen_rules = rules;
        let Pipeline { pairs, known, manifolds, surfaces, filled, .. } = pipeline;
        if anew {
            surfaces.clear();
        }
        let (contacts, awake) = pairs.places();
        if contacts.len() > manifolds.capacity() {
            // Each time, old and new are held side by side: not too often. What is not used yet is not there yet.
            manifolds.reserve_exact(contacts.len() + contacts.len() / 2 - manifolds.len());
        }
        manifolds.resize(contacts.len(), ContactManifold::new(None, None, 0));
        filled.resize_with(contacts.len().div_ceil(PLACES), Filled::default);
        let ahead = h + h / f64::from(self.dynamics.substep().substeps);
        let filling = Filling { world: self, pairs, known, ahead };
        crew.each((chunks(manifolds, PLACES), chunks(filled, 1)), |task, (manifolds, filled)| {
            let filled = &mut filled[0];
            filled.start();
            let first = task * PLACES;
            if anew {
                let used = (0..manifolds.len()).filter(|i| !contacts[first + i].is_vacant());
                filled.new.extend(used.map(|i| (first + i) as u32));
                return;
            }
            for_awake(&awake[first / 64..], manifolds.len(), |i| {
                let contact = &contacts[first + i];
                if contact.tag == SET_UP {
                    filling.fill(contact, &mut manifolds[i], filled);
                } else {
                    filled.new.push((first + i) as u32);
                }
            });
        });
        for filled in filled.iter_mut() {
            for place in core::mem::take(&mut filled.new) {
                let place = place as usize;
                let (contact, manifold) = (&contacts[place], &mut manifolds[place]);
                let surface = self.surface_of(contact, surfaces);
                let body = |slot: u32| known.get(slot as usize)?.as_ref()?.body;
                let mut made = match surface {
                    Some(surface) => ContactManifold::new(body(contact.a), body(contact.b), surface),
                    // They pass through each other.
                    None => ContactManifold::ignored(),
                };
                if contact.tag == SET_UP {
                    made.carry_over(manifold);
                }
                *manifold = made;
                if awake[place >> 6] >> (place & 63) & 1 != 0 {
                    filling.fill(contact, manifold, filled);
                }
            }
        }
        let deepest = filled.iter().fold(0.0f32, |d, f| if f.deepest > d { f.deepest } else { d });
        let points = filled.iter().map(|f| f.points).sum();
        (pipeline.points, pipeline.max_depth) = (points, f64::from(deepest));
    }

    /// The place of a contact's surface; `None` if the two geoms pass through each other.
    fn surface_of(&self, contact: &Contact, table: &mut super::SurfaceTable) -> Option<u32> {
        let info = |slot: u32| self.geom_infos.get(slot as usize)?.as_ref();
        let (a, b) = (info(contact.a)?, info(contact.b)?);
        if self.are_joined(a, b).unwrap_or(false) {
            return None;
        }
        Some(table.place(&self.pair_surface(a, b)?))
    }
}

/// What a task found that filled manifolds.
#[derive(Clone, Debug, Default)]
pub(super) struct Filled {
    /// Places of contacts that have no manifold yet.
    new: Vec<u32>,
    points: usize,
    deepest: f32,
}

impl Filled {
    fn start(&mut self) {
        self.new.clear();
        (self.points, self.deepest) = (0, 0.0);
    }
}

/// What manifolds are filled from.
#[derive(Clone, Copy)]
struct Filling<'a> {
    world: &'a World,
    pairs: &'a PairCache,
    known: &'a [Option<Known>],
    /// How far ahead contacts act: the step, and the substep that its last sweep provides for.
    ahead: f64,
}

impl Filling<'_> {
    fn fill(&self, contact: &Contact, manifold: &mut ContactManifold, filled: &mut Filled) {
        if manifold.is_ignored() {
            return;
        }
        let of = |slot: u32| {
            let known = self.known.get(slot as usize)?.as_ref()?;
            Some((known, self.pairs.frame(slot)?, slot))
        };
        let (Some(a), Some(b)) = (of(contact.a), of(contact.b)) else { return };
        if grazes(contact, self.pairs, a.1, b.1) || self.passes_by(contact, (a.0, a.1), (b.0, b.1)) {
            manifold.clear();
            return;
        }
        fill(manifold, contact, (a.0, a.1), (b.0, b.1));
        if a.0.directed || b.0.directed {
            let normal = manifold.normal();
            let direction = [a.2, b.2]
                .into_iter()
                .zip([a.1, b.1])
                .find_map(|(slot, frame)| direction(&self.world.geom_infos, slot, frame, normal));
            manifold.set_tangent(direction.unwrap_or(Vec3::ZERO));
        }
        for p in contact.manifold.points().iter().filter(|p| p.depth >= 0.0) {
            filled.points += 1;
            filled.deepest = if p.depth > filled.deepest { p.depth } else { filled.deepest };
        }
    }
}

impl Filling<'_> {
    /// Whether a convex body that is still apart from what it seems to run into passes over it. The plane across the least distance
    /// would stop a ball that rolls from tile to tile at the edge of the next one, long before it touches that, and a box that slides over
    /// tiles askew at the side of the next one.
    #[inline]
    fn passes_by(&self, contact: &Contact, a: (&Known, &Frame), b: (&Known, &Frame)) -> bool {
        let m = &contact.manifold;
        let nearest = m.points().iter().fold(f32::NEG_INFINITY, |d, p| if p.depth > d { p.depth } else { d });
        if nearest >= 0.0 {
            return false;
        }
        let (Some(sa), Some(sb)) = (self.pairs.shape(contact.a), self.pairs.shape(contact.b)) else {
            return false;
        };
        let round = |s: &Shape| matches!(s, Shape::Sphere(_) | Shape::Capsule(_));
        let fixed = a.0.body.is_none() || b.0.body.is_none();
        if is_concave(sa, sb) || !(fixed || round(sa) || round(sb)) {
            return false;
        }
        let velocity = |known: &Known| {
            let body = known.body.and_then(|key| self.world.dynamics.body(key).ok());
            body.map_or(Vec3::ZERO, |b| b.linear_velocity())
        };
        let way = (velocity(a.0) - velocity(b.0)) * self.ahead;
        let n = Vec3::new(m.normal.x.into(), m.normal.y.into(), m.normal.z.into());
        if n.dot(way) > f64::from(nearest) {
            return false;
        }
        let thickness = f64::from(if a.0.body.is_some() { a.0.thickness } else { b.0.thickness });
        // Looked at four times on the way, it overlaps whatever is in the way at one of them, unless it is faster than this.
        if way.length() > 4.0 * thickness {
            return false;
        }
        let least = -GRAZING.min(GRAZING_PART * thickness);
        [1.0, 0.5, 0.25, 0.75].into_iter().all(|t| {
            let moved = Frame { position: a.1.position + way * t, rotation: a.1.rotation };
            distance_frames((sa, &moved), (sb, b.1)).is_some_and(|d| d.distance >= least)
        })
    }
}

/// The first friction direction of a geom, in the world and across the normal.
fn direction(infos: &[Option<GeomInfo>], slot: u32, frame: &Frame, normal: Vec3) -> Option<Vec3> {
    let direction = infos.get(slot as usize)?.as_ref()?.material.friction_direction?;
    let world = frame.rotation * direction;
    (world - normal * normal.dot(world)).normalized()
}

/// Overlap side by side, in metres, below which boxes pass each other: a box that slides over tiles lies in them by a hair,
/// and would run against the side of the next.
const GRAZING: f64 = 2e-3;
/// The same as a part of half the thickness, for what only seems to be in the way.
const GRAZING_PART: f64 = 1e-2;

/// Whether two boxes that would meet face to face overlap across the normal by no more than a hair.
#[inline]
fn grazes(contact: &Contact, pairs: &PairCache, a: &Frame, b: &Frame) -> bool {
    let (Some(Shape::Cuboid(box_a)), Some(Shape::Cuboid(box_b))) =
        (pairs.shape(contact.a), pairs.shape(contact.b))
    else {
        return false;
    };
    let n = contact.manifold.normal;
    let n = Vec3::new(n.x.into(), n.y.into(), n.z.into());
    let along = |frame: &Frame| frame.rotation.transpose_mul(n).abs();
    let (na, nb) = (along(a), along(b));
    if na.abs_max() < 0.999 || nb.abs_max() < 0.999 {
        return false;
    }
    let (sides_a, sides_b) = (box_a.sides(), box_b.sides());
    let between = b.position - a.position;
    (0..3).filter(|k| na[*k] < 0.5).any(|k| {
        let rows = &a.rotation.rows;
        let axis = Vec3::new(rows[0][k], rows[1][k], rows[2][k]);
        let reach = sides_a[k] + b.rotation.transpose_mul(axis).abs().dot(sides_b);
        0.5 * reach - axis.dot(between).abs() < GRAZING
    })
}

/// Arms, separations and impulses from the cache's manifold.
#[inline]
fn fill(to: &mut ContactManifold, from: &Contact, a: (&Known, &Frame), b: (&Known, &Frame)) {
    let before = *to;
    to.clear();
    let m = &from.manifold;
    to.set_normal_f32(m.normal.to_array());
    let (ra, rb) = (rotation(a.1), rotation(b.1));
    let origin = if m.origin_b == Vec3::ZERO {
        b.0.arm
    } else {
        let o = b.1.rotation * m.origin_b;
        [b.0.arm[0] + o.x as f32, b.0.arm[1] + o.y as f32, b.0.arm[2] + o.z as f32]
    };
    for p in m.points() {
        to.push(ManifoldPoint {
            arm1: place(&ra, p.anchor_a, a.0.arm),
            arm2: if b.0.body.is_some() { place(&rb, p.anchor_b, origin) } else { [0.0; 3] },
            separation: -p.depth,
            impulse: p.impulse[0],
        });
    }
    to.adopt(&before);
}

#[inline(always)]
fn rotation(frame: &Frame) -> [[f32; 3]; 3] {
    frame.rotation.rows.map(|row| row.map(|x| x as f32))
}

#[inline(always)]
fn place(r: &[[f32; 3]; 3], v: Vec3f, origin: [f32; 3]) -> [f32; 3] {
    core::array::from_fn(|i| origin[i] + (r[i][0] * v.x + r[i][1] * v.y + r[i][2] * v.z))
}

impl Pipeline {
    /// Puts the solver's impulses into the cache, which hands them on to the same points a step later.
    pub(super) fn keep_impulses(&mut self, crew: &Crew) {
        let Self { pairs, manifolds, .. } = self;
        let (contacts, awake) = pairs.contact_places();
        crew.each(chunks(contacts, PLACES), |task, contacts| {
            let first = task * PLACES;
            for_awake(&awake[first / 64..], contacts.len(), |i| {
                let contact = &mut contacts[i];
                contact.tag = SET_UP;
                let points = contact.manifold.points_mut().iter_mut();
                for (point, solved) in points.zip(manifolds[first + i].points()) {
                    point.impulse[0] = solved.impulse;
                }
            });
        });
    }
}
