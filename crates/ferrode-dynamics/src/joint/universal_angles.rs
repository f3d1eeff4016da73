//! The two angles of a universal joint, which the prismatic-universal joint shares.
//!
//! A frame that has the first body's axis as x and the second's in its xy plane stands for the cross between the two
//! yokes. Each angle is the turn of a body relative to that frame, since the axes were set.

use super::axis::{angle_between, hinge_angle};
use super::{LimitMotor, LimitedAxis};
use crate::ends::{Ends, StepContext};
use crate::rows::Row;
use core::f64::consts::FRAC_PI_2;
use ferrode_math::rotation::from_two_axes;
use ferrode_math::{Quat, Vec3, plane_space};

/// Rotation whose x column is along `a` and whose y column lies in the plane of `a` and `b`. `None` if one is zero or
/// they are parallel.
pub(crate) fn frame(a: Vec3, b: Vec3) -> Option<Quat> {
    from_two_axes(a, b).map(|m| Quat::from_matrix(&m))
}

/// The axes of a universal joint, and the rotations that count as angles 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UniversalAxes {
    /// Axis 1 in the first body's coordinates, axis 2 in the second's (or the world's).
    pub local: [Vec3; 2],
    /// conj(q₁) frame(a, b) and conj(q₂) frame(b, a) at angles 0.
    pub initial: [Quat; 2],
}

impl UniversalAxes {
    pub fn new(axis1: Vec3, axis2: Vec3) -> Self {
        Self { local: [axis1, axis2], initial: [Quat::IDENTITY; 2] }
    }

    /// Axis 1 in the world.
    pub fn world1(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.local[0]
    }

    /// Axis 2 in the world; with one body it is as the caller gave it, of any length.
    pub fn world2(&self, ends: &Ends<'_>) -> Vec3 {
        ends.b().rotation * self.local[1]
    }

    /// Both axes in the world in the order of the caller's attach: exchanged in reverse.
    pub fn in_callers_order(&self, ends: &Ends<'_>) -> [Vec3; 2] {
        let (a, b) = (self.world1(ends), self.world2(ends));
        if ends.reverse { [b, a] } else { [a, b] }
    }

    /// Sets the caller's axis 1 (`index` 0) or 2 (`index` 1): a unit vector and the vector as given, in the world.
    /// The other one stays. Angles are not reset.
    pub fn set(&mut self, ends: &Ends<'_>, index: usize, unit: Vec3, raw: Vec3) {
        let both = super::axis::local_axes(ends, unit, raw);
        let index = if ends.reverse { 1 - index } else { index };
        self.local[index] = both[index];
    }

    /// What ODE does when the joint is attached: both axes are read and set again.
    pub fn reattach(&mut self, ends: &Ends<'_>) {
        for (index, axis) in self.in_callers_order(ends).into_iter().enumerate() {
            self.set(ends, index, axis.normalized_or(axis), axis);
        }
    }

    /// Makes the present angles 0. Parallel axes, which have no angles, leave the zeros as they were.
    pub fn reset_angles(&mut self, ends: &Ends<'_>) {
        let (a, b) = (self.world1(ends), self.world2(ends));
        if let (Some(ab), Some(ba)) = (frame(a, b), frame(b, a)) {
            self.initial = [ends.a().quaternion.conjugate() * ab, ends.b().quaternion.conjugate() * ba];
        }
    }

    /// Both angles in −π … π: positive when the first body turns positively relative to the second, about axis 1 and
    /// axis 2. (0, 0) while the axes are parallel.
    ///
    /// These are the angles that stops are tested against.
    pub fn angles(&self, ends: &Ends<'_>) -> [f64; 2] {
        let (a, b) = (self.world1(ends), self.world2(ends));
        let Some(ab) = frame(a, b) else { return [0.0; 2] };
        // Half a turn about the bisector of the axes takes frame(a, b) to frame(b, a).
        let Some(bisector) = (a + b).normalized() else { return [0.0; 2] };
        let ba = Quat::from_parts(0.0, bisector) * ab;
        [self.turn1(ends, ab), self.turn2(ends, ba)]
    }

    /// The first angle alone.
    pub fn angle1(&self, ends: &Ends<'_>) -> f64 {
        frame(self.world1(ends), self.world2(ends)).map_or(0.0, |ab| self.turn1(ends, ab))
    }

    /// The second angle alone. It differs from that of [`Self::angles`] if axis 2 is not of unit length, as in ODE.
    pub fn angle2(&self, ends: &Ends<'_>) -> f64 {
        frame(self.world2(ends), self.world1(ends)).map_or(0.0, |ba| self.turn2(ends, ba))
    }

    fn turn1(&self, ends: &Ends<'_>, ab: Quat) -> f64 {
        let relative = ends.a().quaternion.conjugate() * ab * self.initial[0].conjugate();
        hinge_angle(relative, self.local[0])
    }

    fn turn2(&self, ends: &Ends<'_>, ba: Quat) -> f64 {
        let relative = ends.b().quaternion.conjugate() * ba * self.initial[1].conjugate();
        -hinge_angle(relative, self.local[1])
    }

    /// The ranges of both axes: axis 1 turns the first body about the cross, axis 2 the cross about the second body.
    pub fn limited(&self, ends: &Ends<'_>, motors: [&LimitMotor; 2]) -> Vec<LimitedAxis> {
        let (a, b) = (self.world1(ends), self.world2(ends));
        let angles = self.angles(ends);
        let hand = ends.a().rotation * plane_space(self.local[0]).0;
        vec![
            LimitedAxis::turning(1, a, hand, angles[0], motors[0]),
            LimitedAxis::turning(2, b, a, angles[1], motors[1]),
        ]
    }

    /// Fills the row that keeps the axes perpendicular: about the normal of both, with the world's ERP and CFM. Parallel
    /// axes have no such normal; the row then turns about any vector across axis 1 (ODE divides by zero).
    pub fn write_perpendicular_row(&self, ends: &Ends<'_>, ctx: &StepContext, row: &mut Row, slot: u8) {
        let (a, b) = (self.world1(ends), self.world2(ends));
        let d = a.dot(b);
        let n = a.cross(b - a * d).normalized().unwrap_or_else(|| plane_space(a).0);
        row.set_angular(n, ends.two());
        row.correct(ctx.k(), -d);
        row.slot = slot;
    }

    /// How far the angle between the axes is from a right one, in radians.
    pub fn error(&self, ends: &Ends<'_>) -> f64 {
        (angle_between(self.world1(ends), self.world2(ends)) - FRAC_PI_2).abs()
    }
}
