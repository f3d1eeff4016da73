//! How a geom's surface acts, and how two surfaces act together.

use ferrode_dynamics::{Error, Softness, Surface, SurfaceMode};
use ferrode_math::Vec3;

/// The surface of a geom. What two geoms do to each other where they touch comes from both, by [`CombineRules`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coulomb friction coefficient; ∞ sticks.
    pub friction: f64,
    /// Another coefficient across the first friction direction.
    pub friction2: Option<f64>,
    /// First friction direction in the geom's own coordinates; projected onto the tangent plane of each contact.
    pub friction_direction: Option<Vec3>,
    /// Restitution, 0 … 1.
    pub restitution: f64,
    /// Approach speed in m/s up to which nothing bounces.
    pub restitution_threshold: f64,
    /// Rolling friction about both tangents, in metres.
    pub rolling: f64,
    /// Spinning friction about the normal, in metres.
    pub spinning: f64,
    /// Slip along the first friction direction: sliding speed per newton.
    pub slip1: f64,
    /// Slip across it.
    pub slip2: f64,
    /// Softness of the contact; `None` for the world's ERP and CFM.
    pub softness: Option<Softness>,
    /// Largest speed in m/s at which contacts push apart; of two materials the smaller one counts, `None` stands for the
    /// world's.
    pub max_correcting_velocity: Option<f64>,
    /// Depth in metres that contacts are left at; of two materials the larger one counts, `None` stands for the world's.
    pub surface_layer: Option<f64>,
    /// Velocity of the surface, relative to its body, along the first and second friction direction, in m/s: a conveyor
    /// belt carries what lies on it that way.
    pub motion: [f64; 2],
}

impl Default for Material {
    /// Friction 0.5, no restitution, hard.
    fn default() -> Self {
        Self {
            friction: 0.5,
            friction2: None,
            friction_direction: None,
            restitution: 0.0,
            restitution_threshold: 0.01,
            rolling: 0.0,
            spinning: 0.0,
            slip1: 0.0,
            slip2: 0.0,
            softness: None,
            max_correcting_velocity: None,
            surface_layer: None,
            motion: [0.0; 2],
        }
    }
}

impl Material {
    /// A hard surface with the given friction coefficient.
    pub fn with_friction(friction: f64) -> Self {
        Self { friction, ..Self::default() }
    }

    /// The same with restitution.
    #[must_use]
    pub fn with_restitution(mut self, restitution: f64) -> Self {
        self.restitution = restitution;
        self
    }

    /// The error that names the first unusable number.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN, negative friction, or infinities other than of friction.
    pub fn check(&self) -> Result<(), Error> {
        let s = self.softness.unwrap_or(Softness { erp: 0.0, cfm: 0.0 });
        let at_least_zero = [
            ("friction", self.friction),
            ("second friction", self.friction2.unwrap_or(0.0)),
            ("rolling friction", self.rolling),
            ("spinning friction", self.spinning),
            ("max correcting velocity", self.max_correcting_velocity.unwrap_or(0.0)),
            ("restitution threshold", self.restitution_threshold),
        ];
        for (what, value) in at_least_zero {
            if value.is_nan() || value < 0.0 {
                return Err(Error::OutOfRange { what, value, expected: "at least 0" });
            }
        }
        let finite = [
            ("restitution", self.restitution),
            ("slip 1", self.slip1),
            ("slip 2", self.slip2),
            ("surface layer", self.surface_layer.unwrap_or(0.0)),
            ("contact erp", s.erp),
            ("contact cfm", s.cfm),
            ("surface velocity 1", self.motion[0]),
            ("surface velocity 2", self.motion[1]),
        ];
        for (what, value) in finite {
            if !value.is_finite() {
                return Err(Error::OutOfRange { what, value, expected: "finite" });
            }
        }
        match self.friction_direction {
            Some(d) if d.normalized().is_none() => {
                Err(Error::ZeroVector { what: "friction direction", value: d })
            }
            _ => Ok(()),
        }
    }
}

/// How two numbers become one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Combine {
    /// The smaller one.
    #[default]
    Min,
    /// The larger one.
    Max,
    /// The arithmetic mean.
    Average,
    /// The product.
    Multiply,
    /// The square root of the product.
    GeometricMean,
}

impl Combine {
    /// The two numbers combined. An infinite and a zero one give 0, however they are combined by product.
    pub fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Average => 0.5 * (a + b),
            Self::Multiply | Self::GeometricMean if a == 0.0 || b == 0.0 => 0.0,
            Self::Multiply => a * b,
            Self::GeometricMean => a.sqrt() * b.sqrt(),
        }
    }
}

/// How two materials become the surface of a contact.
///
/// Slips add, surface velocities subtract; softnesses act like springs in series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CombineRules {
    /// Friction coefficients; the smaller one by default, as Gazebo does.
    pub friction: Combine,
    /// Restitution; the larger one by default.
    pub restitution: Combine,
    /// Rolling and spinning friction; the larger one by default.
    pub rolling: Combine,
}

impl Default for CombineRules {
    fn default() -> Self {
        Self { friction: Combine::Min, restitution: Combine::Max, rolling: Combine::Max }
    }
}

impl CombineRules {
    /// The surface of a contact between two materials.
    pub fn surface(&self, a: &Material, b: &Material) -> Surface {
        let mu = self.friction.apply(a.friction, b.friction);
        let mut surface = Surface::with_friction(mu);
        if a.friction2.is_some() || b.friction2.is_some() {
            let second = |m: &Material| m.friction2.unwrap_or(m.friction);
            surface = surface.with_mu2(self.friction.apply(second(a), second(b)));
        }
        let restitution = self.restitution.apply(a.restitution, b.restitution);
        if restitution > 0.0 {
            surface = surface.with_bounce(restitution, a.restitution_threshold.max(b.restitution_threshold));
        }
        let rolling = self.rolling.apply(a.rolling, b.rolling);
        let spinning = self.rolling.apply(a.spinning, b.spinning);
        if rolling > 0.0 || spinning > 0.0 {
            surface = surface.with_rolling(rolling, rolling, spinning);
        }
        let slip = [a.slip1 + b.slip1, a.slip2 + b.slip2];
        // Each direction for itself: with a slip of 0 its rows would lose the world's CFM, and those of a box's four corners
        // could no longer be told apart.
        if slip[0] != 0.0 {
            surface.mode |= SurfaceMode::SLIP1;
            surface.slip1 = slip[0];
        }
        if slip[1] != 0.0 {
            surface.mode |= SurfaceMode::SLIP2;
            surface.slip2 = slip[1];
        }
        // A contact's motion is the velocity that the first body strives for relative to the second.
        let motion = [b.motion[0] - a.motion[0], b.motion[1] - a.motion[1]];
        if motion != [0.0; 2] {
            surface = surface.with_motion(motion[0], motion[1]);
        }
        let of_both = |a: Option<f64>, b: Option<f64>, choose: fn(f64, f64) -> f64| match (a, b) {
            (Some(a), Some(b)) => Some(choose(a, b)),
            (one, other) => one.or(other),
        };
        surface.max_correcting_velocity =
            of_both(a.max_correcting_velocity, b.max_correcting_velocity, f64::min);
        surface.surface_layer = of_both(a.surface_layer, b.surface_layer, f64::max);
        match (a.softness, b.softness) {
            (Some(a), Some(b)) => surface.with_softness(in_series(a, b)),
            (Some(s), None) | (None, Some(s)) => surface.with_softness(s),
            (None, None) => surface,
        }
    }
}

/// Two soft layers on top of each other, each a spring and damper of ERP and CFM at the same step size: the
/// compliances add, and the error reduction is that of the sum.
fn in_series(a: Softness, b: Softness) -> Softness {
    let cfm = a.cfm + b.cfm;
    if cfm == 0.0 {
        return Softness { erp: a.erp.max(b.erp), cfm };
    }
    // With springs alone in series, ERP / CFM = h k adds as reciprocals; with equal layers ERP stays.
    let erp = (a.erp * a.cfm + b.erp * b.cfm) / cfm;
    Softness { erp, cfm }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_combine() {
        assert_eq!(Combine::Min.apply(0.2, 0.8), 0.2);
        assert_eq!(Combine::GeometricMean.apply(0.0, f64::INFINITY), 0.0);
        assert_eq!(Combine::Multiply.apply(0.5, 0.5), 0.25);
        let rules = CombineRules::default();
        let s =
            rules.surface(&Material::with_friction(0.3), &Material::with_friction(0.9).with_restitution(0.5));
        assert_eq!((s.mu, s.bounce), (0.3, 0.5));
    }

    #[test]
    fn equal_layers_are_twice_as_soft() {
        let s = Softness { erp: 0.3, cfm: 1e-4 };
        let t = in_series(s, s);
        assert!((t.erp - 0.3).abs() < 1e-15 && (t.cfm - 2e-4).abs() < 1e-18);
    }

    #[test]
    fn unusable_numbers_are_named() {
        let bad = Material { friction: -1.0, ..Material::default() };
        assert!(bad.check().unwrap_err().to_string().contains("friction"));
        let stick = Material { friction: f64::INFINITY, ..Material::default() };
        assert!(stick.check().is_ok());
    }
}
