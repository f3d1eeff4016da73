//! From the cache's contacts to the solver's manifolds, and back.

use super::Pipeline;
use super::geoms::Known;
use crate::{GeomInfo, World};
use ferrode_collide::manifold::Vec3f;
use ferrode_collide::pairs::{Contact, PairCache};
use ferrode_collide::{Frame, Shape};
use ferrode_dynamics::{ContactManifold, ManifoldPoint};
use ferrode_math::Vec3;

/// The tag of a contact whose manifold has been set up; new ones have 0.
const SET_UP: u32 = 1;

impl World {
    /// Broad and narrow phase.
    pub(super) fn update_pairs(&mut self, pipeline: &mut Pipeline) {
        let Pipeline { pairs, known, .. } = pipeline;
        let (colliders, infos, known) = (&self.colliders, &self.geom_infos, &*known);
        pairs.update(&|a, b| {
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
    pub(super) fn fill_manifolds(&mut self, pipeline: &mut Pipeline) {
        let rules = (self.rules_version, self.dynamics.topology_version());
        let anew = pipeline.seen_rules != rules;
        pipeline.seen_rules = rules;
        let places = pipeline.pairs.contact_places().0.len();
        let Pipeline { pairs, known, manifolds, surfaces, .. } = pipeline;
        if anew {
            surfaces.clear();
        }
        manifolds.resize(places, ContactManifold::new(None, None, 0));
        for (place, manifold) in manifolds.iter_mut().enumerate() {
            match pairs.contact(place as u32) {
                None => manifold.clear(),
                Some(contact) if anew || contact.tag != SET_UP => {
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
                }
                Some(_) => {}
            }
        }
        let (mut deepest, mut points) = (0.0f32, 0);
        for (place, contact) in pairs.contacts() {
            let manifold = &mut manifolds[place as usize];
            if manifold.is_ignored() {
                continue;
            }
            let of = |slot: u32| {
                let known = known.get(slot as usize)?.as_ref()?;
                Some((known, pairs.frame(slot)?, slot))
            };
            let (Some(a), Some(b)) = (of(contact.a), of(contact.b)) else { continue };
            if grazes(contact, pairs, a.1, b.1) {
                manifold.clear();
                continue;
            }
            fill(manifold, contact, (a.0, a.1), (b.0, b.1));
            if a.0.directed || b.0.directed {
                let normal = manifold.normal();
                let direction = [a.2, b.2]
                    .into_iter()
                    .zip([a.1, b.1])
                    .find_map(|(slot, frame)| direction(&self.geom_infos, slot, frame, normal));
                manifold.set_tangent(direction.unwrap_or(Vec3::ZERO));
            }
            for p in contact.manifold.points().iter().filter(|p| p.depth >= 0.0) {
                points += 1;
                deepest = if p.depth > deepest { p.depth } else { deepest };
            }
        }
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

/// The first friction direction of a geom, in the world and across the normal.
fn direction(infos: &[Option<GeomInfo>], slot: u32, frame: &Frame, normal: Vec3) -> Option<Vec3> {
    let direction = infos.get(slot as usize)?.as_ref()?.material.friction_direction?;
    let world = frame.rotation * direction;
    (world - normal * normal.dot(world)).normalized()
}

/// Overlap side by side, in metres, below which boxes pass each other: a box that slides over tiles lies in them by a hair,
/// and would run against the side of the next.
const GRAZING: f64 = 2e-3;

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
    pub(super) fn keep_impulses(&mut self) {
        let (contacts, awake) = self.pairs.contact_places();
        for (w, word) in awake.iter().enumerate() {
            let mut bits = *word;
            while bits != 0 {
                let place = 64 * w + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let contact = &mut contacts[place];
                contact.tag = SET_UP;
                for (point, impulse) in
                    contact.manifold.points_mut().iter_mut().zip(self.manifolds[place].points())
                {
                    point.impulse[0] = impulse.impulse;
                }
            }
        }
    }
}
