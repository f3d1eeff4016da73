//! Joint types that have an ERP and a CFM of their own, copied from the world when the joint is created.

use super::{Ball, DBall, DHinge, Fixed, JointData, JointMut, JointRef, Param, Transmission};
use crate::error::finite_number;
use crate::{Error, Softness};

/// Joint types whose own softness can be set: the ball, fixed, double ball, double hinge and transmission joints.
///
/// Of a fixed joint it softens the position only, and of a double hinge the CFM softens the distance only; the other rows
/// use the world's, as in ODE.
pub trait OwnSoftness: JointData {}

impl OwnSoftness for Ball {}
impl OwnSoftness for Fixed {}
impl OwnSoftness for DBall {}
impl OwnSoftness for DHinge {}
impl OwnSoftness for Transmission {}

impl<J: OwnSoftness> JointRef<'_, J> {
    /// The joint's own ERP and CFM.
    pub fn softness(&self) -> Softness {
        let model = self.world.joints.at(self.index).kind.model();
        Softness { erp: model.param(Param::Erp as i32), cfm: model.param(Param::Cfm as i32) }
    }
}

impl<J: OwnSoftness> JointMut<'_, J> {
    /// Sets the joint's own ERP and CFM, e.g. [`Softness::from_spring`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is not finite.
    pub fn set_softness(&mut self, softness: Softness) -> Result<&mut Self, Error> {
        finite_number("joint ERP", softness.erp)?;
        finite_number("joint CFM", softness.cfm)?;
        let model = self.world.joints.at_mut(self.index).kind.model_mut();
        model.set_param(Param::Erp as i32, softness.erp);
        model.set_param(Param::Cfm as i32, softness.cfm);
        Ok(self)
    }
}
