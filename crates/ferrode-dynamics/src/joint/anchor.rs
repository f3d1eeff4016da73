//! Anchors that joints share: a point set in world coordinates, kept in the coordinates of both bodies.

use crate::carried::Carried;
use crate::ends::{Ends, StepContext};
use crate::rows::Row;
use ferrode_math::Vec3;

/// The same material point as each side sees it. The difference of the two in the world is the position error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Anchors {
    /// In the first body's coordinates.
    pub first: Vec3,
    /// In the second body's coordinates, or world coordinates without one.
    pub second: Vec3,
}

impl Anchors {
    /// Puts both sides at a world point.
    pub fn at(ends: &Ends<'_>, p: Vec3) -> Self {
        Self { first: ends.a().to_local_point(p), second: ends.b().to_local_point(p) }
    }

    /// As [`Anchors::at`] with the first body displaced by `offset`, which it is not.
    pub fn at_displaced(ends: &Ends<'_>, p: Vec3, offset: Vec3) -> Self {
        let mut displaced = *ends.a();
        displaced.position += offset;
        Self { first: displaced.to_local_point(p), second: ends.b().to_local_point(p) }
    }

    /// The first body's point in the world.
    pub fn world1(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().to_world_point(self.first)
    }

    /// The second body's point in the world.
    pub fn world2(&self, ends: &Ends<'_>) -> Vec3 {
        ends.b().to_world_point(self.second)
    }

    /// The caller's first and second side: exchanged in reverse.
    pub fn in_callers_order(&self, ends: &Ends<'_>) -> [Vec3; 2] {
        let (a, b) = (self.world1(ends), self.world2(ends));
        if ends.reverse { [b, a] } else { [a, b] }
    }

    /// What holds the two points together.
    pub fn carried(&self, ends: &Ends<'_>, cfm: f64) -> Carried {
        Carried::anchors(ends, [ends.a().rotation * self.first, ends.b().rotation * self.second], cfm)
    }

    /// How far the two points are apart.
    pub fn distance(&self, ends: &Ends<'_>) -> f64 {
        (self.world1(ends) - self.world2(ends)).length()
    }

    /// Three rows that hold the two points together, along x, y and z, with slots 0 … 2: the ball joint's.
    ///
    /// `erp` is the error reduction of these rows.
    #[inline]
    pub fn write_rows(&self, ends: &Ends<'_>, ctx: &StepContext, erp: f64, rows: &mut [Row]) {
        self.write_rows_along([Vec3::X, Vec3::Y, Vec3::Z], [ctx.fps * erp; 3], ends, rows);
    }

    /// As [`Anchors::write_rows`], along the given unit directions, each with its own factor from error to velocity.
    #[inline(always)]
    pub fn write_rows_along<const N: usize>(
        &self,
        directions: [Vec3; N],
        k: [f64; N],
        ends: &Ends<'_>,
        rows: &mut [Row],
    ) {
        let r1 = ends.a().rotation * self.first;
        let r2 = ends.b().rotation * self.second;
        let error = (ends.b().position + r2) - (ends.a().position + r1);
        for (slot, ((row, u), k)) in rows.iter_mut().zip(directions).zip(k).enumerate() {
            row.linear1 = u;
            row.angular1 = r1.cross(u);
            if ends.two() {
                row.linear2 = -u;
                row.angular2 = -r2.cross(u);
            }
            row.correct(k, u.dot(error));
            row.slot = slot as u8;
        }
    }
}
