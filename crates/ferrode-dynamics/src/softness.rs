//! Springs and dampers as ERP and CFM.

use crate::Error;

/// Error reduction and constraint force mixing of a soft constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softness {
    /// Part of the position error that one step corrects.
    pub erp: f64,
    /// Velocity given way per unit of force.
    pub cfm: f64,
}

impl Softness {
    /// The softness that acts like a spring of stiffness `kp` (N/m) with a damper `kd` (N s/m), integrated implicitly
    /// with steps of `h` seconds: ERP = h kp / (h kp + kd), CFM = 1 / (h kp + kd) (ODE manual, "How to use ERP and
    /// CFM").
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a step that is not positive, negative or non-finite constants, or both zero.
    pub fn from_spring(kp: f64, kd: f64, h: f64) -> Result<Self, Error> {
        step_size(h)?;
        for (what, value) in [("spring constant kp", kp), ("damping constant kd", kd)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange { what, value, expected: "a finite number of at least 0" });
            }
        }
        let sum = h * kp + kd;
        if sum == 0.0 {
            return Err(Error::OutOfRange { what: "h kp + kd", value: 0.0, expected: "positive" });
        }
        Ok(Self { erp: h * kp / sum, cfm: 1.0 / sum })
    }

    /// The spring and damper constants (kp, kd) of this softness at steps of `h` seconds.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a step that is not positive or a CFM that is not positive (a hard constraint has no
    /// finite spring).
    pub fn to_spring(self, h: f64) -> Result<(f64, f64), Error> {
        step_size(h)?;
        if self.cfm.is_nan() || self.cfm <= 0.0 {
            return Err(Error::OutOfRange { what: "cfm", value: self.cfm, expected: "positive" });
        }
        Ok((self.erp / (h * self.cfm), (1.0 - self.erp) / self.cfm))
    }
}

/// The step size if it is positive and finite.
pub(crate) fn step_size(h: f64) -> Result<f64, Error> {
    if h > 0.0 && h.is_finite() && (1.0 / h).is_finite() {
        Ok(h)
    } else {
        Err(Error::OutOfRange { what: "step size", value: h, expected: "a positive number of seconds" })
    }
}

#[cfg(test)]
mod tests {
    use super::Softness;

    #[test]
    fn spring_constants_come_back() {
        let s = Softness::from_spring(400.0, 7.0, 0.01).unwrap();
        let (kp, kd) = s.to_spring(0.01).unwrap();
        assert!((kp - 400.0).abs() < 1e-10 && (kd - 7.0).abs() < 1e-12);
        assert!(Softness::from_spring(-1.0, 0.0, 0.01).is_err());
        assert!(Softness::from_spring(0.0, 0.0, 0.01).is_err());
        assert!(Softness::from_spring(1.0, 0.0, 0.0).is_err());
    }
}
