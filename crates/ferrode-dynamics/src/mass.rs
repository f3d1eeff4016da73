//! Mass properties of a rigid body.

use crate::Error;
use ferrode_math::{Mat3, Vec3};

/// Mass, centre of mass and inertia tensor (ODE manual, `dMass`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Total mass, in kilograms.
    pub mass: f64,
    /// Centre of mass in the body's frame, in metres.
    pub centre: Vec3,
    /// Inertia tensor about the **origin** of the body's frame, along its axes, in kg m².
    pub inertia: Mat3,
}

impl Default for Mass {
    /// A new body's: 1 kg, unit inertia.
    fn default() -> Self {
        Self { mass: 1.0, centre: Vec3::ZERO, inertia: Mat3::IDENTITY }
    }
}

impl Mass {
    /// Whether this can be a body's mass about its centre of mass.
    ///
    /// # Errors
    /// [`Error::MassNotPositive`], [`Error::InertiaNotPositiveDefinite`].
    pub fn check(&self) -> Result<(), Error> {
        if self.mass.is_nan() || self.mass <= 0.0 || self.mass.is_infinite() {
            return Err(Error::MassNotPositive(self.mass));
        }
        crate::error::finite("centre of mass", self.centre)?;
        if !self.inertia.is_finite() || !self.inertia.is_positive_definite() {
            return Err(Error::InertiaNotPositiveDefinite { about: "the body's origin" });
        }
        let c = Mat3::cross(self.centre);
        if !(self.inertia + c * c * self.mass).is_positive_definite() {
            return Err(Error::InertiaNotPositiveDefinite { about: "the centre of mass" });
        }
        Ok(())
    }
}
