//! Soft constraints: what a spring and damper becomes in one substep.
//!
//! A constraint C = 0 with Jacobian J and effective mass m = 1/(J M⁻¹ Jᵀ) is replaced by a spring and damper that act along
//! C and are integrated implicitly with the substep h. An impulse step towards its solution is
//!
//! ```text
//! Δλ = −m s (J v + b C) − t λ
//! ```
//!
//! with the bias rate b (1/s), the mass scale s and the impulse scale t. For an oscillator of angular frequency ω and damping
//! ratio ζ, whose stiffness is that of the effective mass (E. Catto, "Soft Constraints", GDC 2011, and "Solver2D", 2024):
//!
//! ```text
//! b = ω / (2ζ + h ω)      q = h ω (2ζ + h ω)      s = q / (1 + q)      t = 1 / (1 + q)
//! ```
//!
//! For given constants, as ERP and CFM give them, γ = CFM/h per impulse: s = K/(K + γ), t = γ/(K + γ), with K = 1/m.

use crate::Softness;

/// A spring and damper, whatever they hold: its undamped frequency and its damping ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Hertz.
    pub frequency: f64,
    /// 1 for critical damping.
    pub damping_ratio: f64,
}

/// Largest h ω.
const MAX_PHASE: f64 = 1.2;

/// The coefficients b, s and t of one substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coefficients {
    pub bias_rate: f32,
    pub mass_scale: f32,
    pub impulse_scale: f32,
}

impl Spring {
    /// The coefficients at substeps of `h` seconds, with h ω at most 1.2.
    ///
    /// What a sweep does to slow modes of a pile, it does only in a small part κ, and what it put into the impulses acts
    /// again a substep later. With m the mass of the mode and c = b C, per substep,
    ///
    /// ```text
    /// Δλ = −t λ − 2 κ m v − κ m c      m Δv = λ      Δc = h b v
    /// ```
    ///
    /// is stable (Routh, Hurwitz) if t + 2κ > h b / 2, so for all κ if t > h b / 2. With x = h ω and a = 2ζ + x that is
    /// a (2 − x²) > x: beyond x = √2 no damping ratio helps, and tall piles sway with growing swing. What damps that swing
    /// is t, so a small ζ settles a pile sooner than a large one.
    pub(crate) fn coefficients(self, h: f64) -> Coefficients {
        let omega = (2.0 * core::f64::consts::PI * self.frequency).min(MAX_PHASE / h);
        let a = 2.0 * self.damping_ratio + h * omega;
        let q = h * omega * a;
        Coefficients {
            bias_rate: (omega / a) as f32,
            mass_scale: (q / (1.0 + q)) as f32,
            impulse_scale: (1.0 / (1.0 + q)) as f32,
        }
    }
}

impl Softness {
    /// The ERP and CFM at `n` substeps of the spring and damper that these are at the whole step.
    ///
    /// With kp = ERP/(h CFM) and kd = (1 − ERP)/CFM kept, and h/n in place of h (see [`Softness::from_spring`]):
    /// ERP' = ERP / (ERP + n (1 − ERP)), CFM' = CFM / (ERP/n + 1 − ERP). An ERP beyond 0 … 1 counts as the nearer end.
    pub(crate) fn at_substep(self, n: f64) -> Self {
        let erp = self.erp.clamp(0.0, 1.0);
        Self { erp: erp / (erp + n * (1.0 - erp)), cfm: self.cfm.max(0.0) / (erp / n + (1.0 - erp)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn substeps_keep_the_spring() {
        let (kp, kd, h) = (5000.0, 30.0, 0.01);
        let whole = Softness::from_spring(kp, kd, h).unwrap();
        let part = whole.at_substep(4.0);
        let expected = Softness::from_spring(kp, kd, h / 4.0).unwrap();
        assert!((part.erp - expected.erp).abs() < 1e-14 && (part.cfm / expected.cfm - 1.0).abs() < 1e-13);
        let hard = Softness { erp: 0.2, cfm: 0.0 }.at_substep(4.0);
        assert!(
            hard.cfm == 0.0
                && ((1.0 - hard.erp) * (1.0 - hard.erp) * (1.0 - hard.erp) * (1.0 - hard.erp) - 0.8).abs()
                    < 0.02
        );
    }

    #[test]
    fn a_soft_constraint_settles_like_its_spring() {
        // A mass of 1 kg under a force of 1 N: the spring gives way by 1/ω².
        let (spring, h) = (Spring { frequency: 2.0, damping_ratio: 0.3 }, 1e-3);
        let c = spring.coefficients(h);
        let (mut x, mut v) = (0.0f64, 0.0f64);
        for _ in 0..20_000 {
            v += h;
            let mut lambda = 0.0f64;
            for _ in 0..60 {
                let delta = -f64::from(c.mass_scale) * (v + f64::from(c.bias_rate) * x)
                    - f64::from(c.impulse_scale) * lambda;
                lambda += delta;
                v += delta;
            }
            x += h * v;
        }
        let omega = 2.0 * core::f64::consts::PI * 2.0;
        assert!((x * omega * omega - 1.0).abs() < 1e-3, "{}", x * omega * omega);
    }
}
