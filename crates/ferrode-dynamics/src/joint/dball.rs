//! Double ball: keeps a point of one body at a distance from a point of the other, like a rod with a ball at each end.

use super::anchor::Anchors;
use super::{JointError, JointModel, JointMut, JointRef};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number};
use crate::rows::{JointRows, Row, RowCount};
use ferrode_math::Vec3;

/// Two anchors and the distance that they keep: what the double ball and the double hinge have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rod {
    pub anchors: Anchors,
    /// Distance wanted, in metres.
    pub length: f64,
}

/// Below this distance in metres the anchors coincide, and the rod's direction is that of their relative velocity.
const COINCIDENT: f64 = 1e-12;

impl Rod {
    /// From the second body's anchor to the first's.
    pub fn span(&self, ends: &Ends<'_>) -> Vec3 {
        self.anchors.world1(ends) - self.anchors.world2(ends)
    }

    /// Takes the present distance of the anchors for the wanted one.
    pub fn measure(&mut self, ends: &Ends<'_>) {
        self.length = self.span(ends).length();
    }

    /// Sets the anchor of the caller's first (0) or second (1) side from a world point, and measures the distance.
    pub fn set_anchor(&mut self, ends: &Ends<'_>, side: usize, p: Vec3) {
        if (side == 0) != ends.reverse {
            self.anchors.first = ends.a().to_local_point(p);
        } else {
            self.anchors.second = ends.b().to_local_point(p);
        }
        self.measure(ends);
    }

    /// How much the anchors are too far apart, in metres; negative if they are too close.
    pub fn stretch(&self, ends: &Ends<'_>) -> f64 {
        self.span(ends).length() - self.length
    }

    /// The one row that keeps the distance: it is bilateral, and has slot 0.
    pub fn write_row(&self, ends: &Ends<'_>, ctx: &StepContext, erp: f64, cfm: f64, row: &mut Row) {
        let (a, b) = (ends.a(), ends.b());
        let r1 = a.rotation * self.anchors.first;
        let r2 = b.rotation * self.anchors.second;
        let span = self.span(ends);
        let distance = span.length();
        let direction = if distance < COINCIDENT {
            let v1 = a.linear_velocity + a.angular_velocity.cross(r1);
            let v2 = b.linear_velocity + b.angular_velocity.cross(r2);
            let v = v1 - v2;
            if v.length() < COINCIDENT { Vec3::X } else { v }
        } else {
            span
        };
        let u = direction.normalized_or(Vec3::X);
        row.linear1 = u;
        row.angular1 = r1.cross(u);
        if ends.two() {
            row.linear2 = -u;
            row.angular2 = -r2.cross(u);
        }
        row.correct(ctx.fps * erp, self.length - distance);
        row.cfm = cfm;
    }
}

/// A distance that can be kept, or the error that names it.
pub(crate) fn distance(value: f64) -> Result<f64, Error> {
    let what = "distance of the anchors";
    finite_number(what, value)?;
    if value >= 0.0 {
        Ok(value)
    } else {
        Err(Error::OutOfRange { what, value, expected: "zero or a positive number" })
    }
}

/// The double ball's data: two anchors, their distance, and its own ERP and CFM.
#[derive(Clone, Debug)]
pub struct DBall {
    rod: Rod,
    erp: f64,
    cfm: f64,
}

impl DBall {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self { rod: Rod::default(), erp, cfm }
    }
}

impl JointModel for DBall {
    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        RowCount::new(1, 1)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        if let [row, ..] = out.rows {
            self.rod.write_row(ends, ctx, self.erp, self.cfm, row);
        }
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        self.rod.measure(ends);
    }

    fn set_param(&mut self, n: i32, value: f64) {
        super::param::set_own_softness(n, value, &mut self.erp, &mut self.cfm);
    }

    fn param(&self, n: i32) -> f64 {
        super::param::own_softness(n, self.erp, self.cfm)
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        JointError { position: self.rod.stretch(ends).abs(), angle: 0.0 }
    }
}

impl JointRef<'_, DBall> {
    /// The first body's anchor, in world coordinates.
    pub fn anchor1(&self) -> Vec3 {
        self.data.rod.anchors.in_callers_order(&self.ends())[0]
    }

    /// The second body's anchor, in world coordinates.
    pub fn anchor2(&self) -> Vec3 {
        self.data.rod.anchors.in_callers_order(&self.ends())[1]
    }

    /// The distance that the joint keeps, in metres.
    pub fn distance(&self) -> f64 {
        self.data.rod.length
    }
}

impl JointMut<'_, DBall> {
    /// Sets the first body's anchor, in world coordinates, and takes the present distance of the anchors as the one to
    /// keep. Without that body the point stays fixed in the world.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor1(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("double ball anchor 1", anchor)?;
        let (ball, ends) = self.parts();
        ball.rod.set_anchor(&ends, 0, anchor);
        Ok(())
    }

    /// As [`Self::set_anchor1`], for the second body.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor2(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("double ball anchor 2", anchor)?;
        let (ball, ends) = self.parts();
        ball.rod.set_anchor(&ends, 1, anchor);
        Ok(())
    }

    /// Sets the distance to keep, in metres. Call it last: attaching and setting anchors measure it anew.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is finite and not negative.
    pub fn set_distance(&mut self, length: f64) -> Result<(), Error> {
        self.parts().0.rod.length = distance(length)?;
        Ok(())
    }
}
