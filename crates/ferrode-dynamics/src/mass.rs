//! Mass properties of a rigid body: what moments a solid has, and how they change with the frame
//! (ODE manual, "Mass functions").

mod shapes;
mod trimesh;

pub use shapes::Axis;
pub use trimesh::MeshError;

use crate::Error;
use crate::error::finite;
use core::ops::{Add, AddAssign};
use ferrode_math::{Mat3, Vec3};

/// Mass, centre of mass and inertia tensor (ODE manual, `dMass`).
///
/// ```
/// use ferrode_dynamics::{Axis, Mass};
/// use ferrode_math::Vec3;
/// # fn main() -> Result<(), ferrode_dynamics::Error> {
/// // A dumbbell: two balls of 1 kg on a bar of 0.5 kg.
/// let ball = Mass::sphere_total(1.0, 0.1)?;
/// let bar = Mass::cylinder_total(0.5, Axis::X, 0.02, 0.8)?;
/// let dumbbell = bar + ball.translate(Vec3::new(0.5, 0.0, 0.0))? + ball.translate(Vec3::new(-0.5, 0.0, 0.0))?;
/// assert_eq!(dumbbell.mass, 2.5);
/// assert_eq!(dumbbell.centre, Vec3::ZERO);
/// # Ok(()) }
/// ```
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
    /// Nothing at all: the start of a sum. No body can have it.
    pub const ZERO: Self = Self { mass: 0.0, centre: Vec3::ZERO, inertia: Mat3::ZERO };

    /// From numbers: the mass, the centre, and the inertia tensor about the frame's origin as its diagonal
    /// `[Ixx, Iyy, Izz]` and the rest `[Ixy, Ixz, Iyz]` (ODE's `dMassSetParameters`; the products of inertia enter the
    /// matrix as they are, so they are the negative integrals −∫xy dm).
    ///
    /// # Errors
    /// Those of [`Mass::check`].
    pub fn parameters(
        mass: f64,
        centre: Vec3,
        diagonal: [f64; 3],
        products: [f64; 3],
    ) -> Result<Self, Error> {
        let [xx, yy, zz] = diagonal;
        let [xy, xz, yz] = products;
        let made =
            Self { mass, centre, inertia: Mat3::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) };
        made.check()?;
        Ok(made)
    }

    /// Whether this can be a body's mass about its centre of mass.
    ///
    /// # Errors
    /// [`Error::MassNotPositive`], [`Error::NotFinite`], [`Error::InertiaNotPositiveDefinite`].
    pub fn check(&self) -> Result<(), Error> {
        if self.mass.is_nan() || self.mass <= 0.0 || self.mass.is_infinite() {
            return Err(Error::MassNotPositive(self.mass));
        }
        finite("centre of mass", self.centre)?;
        if !self.inertia.is_finite() || !self.inertia.is_positive_definite() {
            return Err(Error::InertiaNotPositiveDefinite { about: "the body's origin" });
        }
        if !self.about_centre().is_positive_definite() {
            return Err(Error::InertiaNotPositiveDefinite { about: "the centre of mass" });
        }
        Ok(())
    }

    /// The inertia tensor about the centre of mass, along the frame's axes.
    pub fn about_centre(&self) -> Mat3 {
        let c = Mat3::cross(self.centre);
        self.inertia + c * c * self.mass
    }

    /// The same solid with its density scaled to the total mass `mass` (ODE's `dMassAdjust`).
    ///
    /// # Errors
    /// [`Error::MassNotPositive`] if `mass`, or the mass that there is to scale, is not a positive number.
    pub fn adjust(&self, mass: f64) -> Result<Self, Error> {
        for m in [mass, self.mass] {
            if m.is_nan() || m <= 0.0 || m.is_infinite() {
                return Err(Error::MassNotPositive(m));
            }
        }
        Ok(Self { mass, centre: self.centre, inertia: self.inertia * (mass / self.mass) })
    }

    /// The solid displaced by `by` within its frame (ODE's `dMassTranslate`): the parallel-axis theorem.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn translate(&self, by: Vec3) -> Result<Self, Error> {
        finite("displacement of a mass", by)?;
        let (from, to) = (Mat3::cross(self.centre), Mat3::cross(self.centre + by));
        let inertia = self.inertia + (from * from - to * to) * self.mass;
        Ok(Self { mass: self.mass, centre: self.centre + by, inertia: upper(inertia) })
    }

    /// The solid turned by `rotation` about the frame's origin (ODE's `dMassRotate`).
    ///
    /// # Errors
    /// [`Error::NotARotation`] unless `rotation` is orthogonal with determinant 1, to 1e-6.
    pub fn rotate(&self, rotation: Mat3) -> Result<Self, Error> {
        let defect = rotation * rotation.transpose() - Mat3::IDENTITY;
        let orthogonal = defect.rows.iter().flatten().all(|x| x.abs() < 1e-6);
        if !orthogonal || rotation.determinant().is_nan() || rotation.determinant() <= 0.0 {
            return Err(Error::NotARotation { what: "rotation of a mass" });
        }
        let inertia = rotation * self.inertia * rotation.transpose();
        Ok(Self { mass: self.mass, centre: rotation * self.centre, inertia: upper(inertia) })
    }
}

/// The symmetric matrix with `m`'s upper triangle: rounding must not make an inertia tensor lopsided.
fn upper(m: Mat3) -> Mat3 {
    let r = m.rows;
    Mat3::from_rows([[r[0][0], r[0][1], r[0][2]], [r[0][1], r[1][1], r[1][2]], [r[0][2], r[1][2], r[2][2]]])
}

impl Add for Mass {
    type Output = Self;

    /// Both solids in one frame (ODE's `dMassAdd`). Two of no mass have their centre at the origin.
    fn add(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let moment = self.centre * self.mass + other.centre * other.mass;
        let centre = if mass == 0.0 { Vec3::ZERO } else { moment * (1.0 / mass) };
        Self { mass, centre, inertia: self.inertia + other.inertia }
    }
}

impl AddAssign for Mass {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
