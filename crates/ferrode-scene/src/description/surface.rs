//! How a collision's surface rubs, bounces and gives way.
//!
//! Values that a file does not give are `None` where their absence matters, and the SDF default otherwise.

use ferrode_math::Vec3;

/// The surface of a collision.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Friction.
    pub friction: Friction,
    /// Restitution.
    pub bounce: Bounce,
    /// Softness and filtering of contacts.
    pub contact: ContactSurface,
}

/// Coulomb friction in two directions of the contact plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient along the first direction.
    pub mu: f64,
    /// Coefficient along the second direction.
    pub mu2: f64,
    /// First direction, a unit vector in the collision's frame; `None`: the engine chooses.
    pub fdir1: Option<Vec3>,
    /// Slip velocity per force along the first direction, m/(s·N).
    pub slip1: f64,
    /// Slip velocity per force along the second direction, m/(s·N).
    pub slip2: f64,
    /// Friction against spinning about the contact normal; `None`: none.
    pub torsional: Option<Torsional>,
    /// Friction against rolling: the coefficient given under `<bullet>`, where SDF keeps it; `None`: none.
    pub rolling: Option<f64>,
}

impl Default for Friction {
    fn default() -> Self {
        Self { mu: 1.0, mu2: 1.0, fdir1: None, slip1: 0.0, slip2: 0.0, torsional: None, rolling: None }
    }
}

/// Friction against spinning: a torque up to 3π/16 · `coefficient` · patch radius · normal force.
#[derive(Clone, Debug, PartialEq)]
pub struct Torsional {
    /// Coefficient, without unit.
    pub coefficient: f64,
    /// Use [`Torsional::patch_radius`]; otherwise the patch radius is √(`surface_radius` · depth).
    pub use_patch_radius: bool,
    /// Radius of the contact patch, m.
    pub patch_radius: f64,
    /// Radius of curvature of the surface, m.
    pub surface_radius: f64,
    /// Slip, rad/(s·N·m).
    pub slip: f64,
}

impl Default for Torsional {
    fn default() -> Self {
        Self { coefficient: 1.0, use_patch_radius: true, patch_radius: 0.0, surface_radius: 0.0, slip: 0.0 }
    }
}

/// Restitution.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounce {
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Impact velocity below which nothing bounces, m/s.
    pub threshold: f64,
}

impl Default for Bounce {
    fn default() -> Self {
        Self { restitution: 0.0, threshold: 100_000.0 }
    }
}

/// Softness and filtering of contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSurface {
    /// Constraint force mixing (SDF default 0).
    pub soft_cfm: Option<f64>,
    /// Error reduction (SDF default 0.2).
    pub soft_erp: Option<f64>,
    /// Stiffness, N/m (SDF default 1e12).
    pub kp: Option<f64>,
    /// Damping, N·s/m (SDF default 1).
    pub kd: Option<f64>,
    /// Largest correcting velocity, m/s (SDF default 0.01).
    pub max_vel: Option<f64>,
    /// Depth that is left uncorrected, m (SDF default 0).
    pub min_depth: Option<f64>,
    /// Contacts are found but exert no force.
    pub without_force: bool,
    /// What the collision collides with, bit by bit.
    pub collide_bitmask: u32,
    /// What the collision is, bit by bit, where it differs from [`ContactSurface::collide_bitmask`].
    pub category_bitmask: Option<u32>,
}

impl Default for ContactSurface {
    fn default() -> Self {
        Self {
            soft_cfm: None,
            soft_erp: None,
            kp: None,
            kd: None,
            max_vel: None,
            min_depth: None,
            without_force: false,
            collide_bitmask: 0xffff,
            category_bitmask: None,
        }
    }
}
