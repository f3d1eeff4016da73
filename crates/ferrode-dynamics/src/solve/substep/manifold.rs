//! Contact manifolds: what `Substep` gets from collision detection.

use crate::{BodyKey, Error, Surface};
use ferrode_math::simd::Record;
use ferrode_math::{ContactPoint, Vec3};

/// Most points of a manifold.
pub const MANIFOLD_POINTS: usize = 4;

/// A point of a [`ContactManifold`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ManifoldPoint {
    /// From the first body's centre of mass to the point, in metres along the world's axes.
    pub arm1: [f32; 3],
    /// From the second body's centre of mass; without a second body it doesn't count.
    pub arm2: [f32; 3],
    /// Distance of the surfaces, in metres: negative where they overlap. Points apart keep a body from crossing the gap
    /// within the step.
    pub separation: f32,
    /// Normal impulse of the last substep, from which the next step begins: carry it over from the manifold of the step
    /// before for points that are the same, and leave 0 for new ones. After a step, the impulse that held then.
    pub impulse: f32,
}

/// Up to four contact points of two bodies that share a normal, and what they pushed with.
///
/// The caller keeps manifolds from step to step for their impulses; they hold no other state. See
/// [`World::step_with_manifolds`](crate::World::step_with_manifolds).
#[derive(Clone, Copy, Debug)]
pub struct ContactManifold {
    /// arm1, separation, arm2, impulse.
    pub(super) points: [Record; MANIFOLD_POINTS],
    /// Normal, twisting impulse, friction impulse (a vector of the world).
    pub(super) head: Record,
    /// First tangent or zero, rolling impulse (a vector of the world).
    pub(super) tail: Record,
    /// Slots of the bodies, and what of their serials tells them from others that had the slot.
    pub(super) bodies: [(u32, u32); 2],
    pub(super) surface: u32,
    pub(super) count: u8,
}

/// The surface of a manifold that nothing comes of.
const IGNORED: u32 = u32::MAX;

/// The slot of no body: the static world.
pub(super) const STATIC: u32 = u32::MAX;

impl ContactManifold {
    /// A manifold without points between two bodies, or a body and the static world. `surface` is the place of its
    /// surface in the list that is handed to the step.
    pub fn new(first: Option<BodyKey>, second: Option<BodyKey>, surface: u32) -> Self {
        let body = |key: Option<BodyKey>| key.map_or((STATIC, 0), |key| (key.0.index, key.0.serial as u32));
        Self {
            points: [Record::ZERO; MANIFOLD_POINTS],
            head: Record::ZERO,
            tail: Record::ZERO,
            bodies: [body(first), body(second)],
            surface,
            count: 0,
        }
    }

    /// The manifold of one contact at a world point, without a past.
    pub(super) fn of_contact(
        keys: [Option<BodyKey>; 2],
        centres: [Vec3; 2],
        point: &ContactPoint,
        surface: u32,
    ) -> Self {
        let mut manifold = Self::new(keys[0], keys[1], surface);
        manifold.set_normal(point.normal);
        manifold.push(ManifoldPoint {
            arm1: to_f32(point.position - centres[0]),
            arm2: to_f32(point.position - centres[1]),
            separation: -point.depth as f32,
            impulse: 0.0,
        });
        manifold
    }

    /// Unit normal, into the first body.
    pub fn normal(&self) -> Vec3 {
        let n = &self.head.0;
        Vec3::new(f64::from(n[0]), f64::from(n[1]), f64::from(n[2]))
    }

    /// Sets the normal: a unit vector into the first body, along the world's axes.
    pub fn set_normal(&mut self, normal: Vec3) {
        self.head.0[..3].copy_from_slice(&to_f32(normal));
    }

    /// Sets the first friction direction: a unit vector across the normal; zero, as at first, for any.
    pub fn set_tangent(&mut self, tangent: Vec3) {
        self.tail.0[..3].copy_from_slice(&to_f32(tangent));
    }

    /// As [`Self::set_normal`], in single precision.
    pub fn set_normal_f32(&mut self, normal: [f32; 3]) {
        self.head.0[..3].copy_from_slice(&normal);
    }

    /// A manifold that nothing comes of, whatever points it has.
    pub fn ignored() -> Self {
        Self { surface: IGNORED, ..Self::new(None, None, 0) }
    }

    /// Whether it is one that nothing comes of.
    pub fn is_ignored(&self) -> bool {
        self.surface == IGNORED
    }

    /// The surface's place in the list that is handed to the step.
    pub fn surface(&self) -> u32 {
        self.surface
    }

    /// Sets the surface's place in the list that is handed to the step.
    pub fn set_surface(&mut self, surface: u32) {
        self.surface = surface;
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        usize::from(self.count)
    }

    /// Whether it has no points.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The points.
    pub fn points(&self) -> impl ExactSizeIterator<Item = ManifoldPoint> + '_ {
        self.points[..self.len()].iter().map(|r| {
            let [a, b, c, separation, d, e, f, impulse] = r.0;
            ManifoldPoint { arm1: [a, b, c], arm2: [d, e, f], separation, impulse }
        })
    }

    /// Drops all points, keeping the friction's impulses.
    pub fn clear(&mut self) {
        self.points = [Record::ZERO; MANIFOLD_POINTS];
        self.count = 0;
    }

    /// Adds a point; returns `false` and leaves it out if there are four.
    pub fn push(&mut self, point: ManifoldPoint) -> bool {
        let Some(record) = self.points.get_mut(usize::from(self.count)) else { return false };
        let ([a, b, c], [d, e, f]) = (point.arm1, point.arm2);
        *record = Record([a, b, c, point.separation, d, e, f, point.impulse]);
        self.count += 1;
        true
    }

    /// Takes over points and all impulses.
    pub fn carry_over(&mut self, before: &Self) {
        (self.points, self.count) = (before.points, before.count);
        (self.head, self.tail) = (before.head, before.tail);
    }

    /// Gives impulses of points that `before` had, and that have no successor of the same impulse here, to the nearest
    /// points that have none yet. What a face bears it goes on bearing, whatever its corners are called.
    pub fn adopt(&mut self, before: &Self) {
        let count = self.len();
        let turned = (0..3).map(|k| self.head.0[k] * before.head.0[k]).sum::<f32>() < 0.9;
        if turned || self.points[..count].iter().all(|r| r.0[7] > 0.0) {
            return;
        }
        for old in before.points[..before.len()].iter().filter(|r| r.0[7] > 0.0) {
            if self.points[..count].iter().any(|r| r.0[7] == old.0[7]) {
                continue;
            }
            let distance = |r: &Record| {
                let [a, b, c] = [r.0[0] - old.0[0], r.0[1] - old.0[1], r.0[2] - old.0[2]];
                a * a + b * b + c * c
            };
            let mut nearest: Option<(f32, usize)> = None;
            for (i, r) in self.points[..count].iter().enumerate().filter(|(_, r)| r.0[7] == 0.0) {
                let d = distance(r);
                if nearest.is_none_or(|n| d < n.0) {
                    nearest = Some((d, i));
                }
            }
            if let Some((_, i)) = nearest {
                self.points[i].0[7] = old.0[7];
            }
        }
    }

    /// Takes over the impulses of friction from the manifold of the step before.
    pub fn carry_friction(&mut self, before: &Self) {
        self.head.0[3..].copy_from_slice(&before.head.0[3..]);
        self.tail.0[4..].copy_from_slice(&before.tail.0[4..]);
    }

    /// Forgets all impulses, as when bodies were moved by hand.
    pub fn forget(&mut self) {
        self.head.0[3..].fill(0.0);
        self.tail.0[4..].fill(0.0);
        for point in &mut self.points {
            point.0[7] = 0.0;
        }
    }

    /// Whether the surfaces meet, or pushed in the step before.
    pub(super) fn touches(&self) -> bool {
        self.points[..self.len()].iter().any(|r| r.0[3] <= 0.0 || r.0[7] > 0.0)
    }

    /// Sum of the normal impulses, N s per substep.
    pub fn normal_impulse(&self) -> f64 {
        self.points[..self.len()].iter().map(|r| f64::from(r.0[7])).sum()
    }

    /// Impulse of the friction on the first body in the last substep, along the world's axes, N s.
    pub fn friction_impulse(&self) -> Vec3 {
        let f = &self.head.0;
        Vec3::new(f64::from(f[4]), f64::from(f[5]), f64::from(f[6]))
    }
}

pub(super) fn to_f32(v: Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// The error of a manifold that names a surface that there is none of.
pub(super) fn check_surface(manifold: &ContactManifold, surfaces: &[Surface]) -> Result<(), Error> {
    if (manifold.surface as usize) < surfaces.len() || manifold.count == 0 || manifold.is_ignored() {
        return Ok(());
    }
    Err(Error::OutOfRange {
        what: "surface of a manifold",
        value: f64::from(manifold.surface),
        expected: "the place of a surface in the list that was handed in",
    })
}
