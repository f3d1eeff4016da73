//! Solids of uniform density, by their textbook moments.

use super::Mass;
use crate::Error;
use core::f64::consts::PI;
use ferrode_math::{Mat3, Vec3};

/// The long axis of a cylinder, capsule or cone in its frame (ODE's "direction" 1, 2, 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z: how ODE's geoms stand.
    #[default]
    Z,
}

impl Axis {
    /// The unit vector.
    pub fn vector(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }

    /// The tensor of a solid of revolution about this axis.
    fn tensor(self, axial: f64, transverse: f64) -> Mat3 {
        let t = transverse;
        Mat3::from_diagonal(match self {
            Self::X => Vec3::new(axial, t, t),
            Self::Y => Vec3::new(t, axial, t),
            Self::Z => Vec3::new(t, t, axial),
        })
    }
}

/// The value if it is positive and finite, else the error that names it.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, Error> {
    if value > 0.0 && value < f64::INFINITY {
        Ok(value)
    } else {
        Err(Error::OutOfRange { what, value, expected: "a positive number" })
    }
}

/// A mass about its own centre.
fn centred(mass: f64, inertia: Mat3) -> Result<Mass, Error> {
    let made = Mass { mass, centre: Vec3::ZERO, inertia };
    // Sizes whose products under- or overflow.
    made.check()?;
    Ok(made)
}

impl Mass {
    /// A ball of `density`, kg/m³.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn sphere(density: f64, radius: f64) -> Result<Self, Error> {
        let r = positive("sphere radius", radius)?;
        Self::sphere_total(4.0 / 3.0 * PI * r * r * r * positive("density", density)?, r)
    }

    /// A ball of `mass`: I = 2/5 m r².
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn sphere_total(mass: f64, radius: f64) -> Result<Self, Error> {
        let (m, r) = (positive("mass", mass)?, positive("sphere radius", radius)?);
        let i = 0.4 * m * r * r;
        centred(m, Mat3::from_diagonal(Vec3::splat(i)))
    }

    /// A box of `density` with side lengths `sides`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn cuboid(density: f64, sides: Vec3) -> Result<Self, Error> {
        let s = box_sides(sides)?;
        Self::cuboid_total(s.x * s.y * s.z * positive("density", density)?, s)
    }

    /// A box of `mass` with side lengths `sides`: I = m/12 (b² + c²) about the side a.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn cuboid_total(mass: f64, sides: Vec3) -> Result<Self, Error> {
        let (m, s) = (positive("mass", mass)?, box_sides(sides)?);
        let (xx, yy, zz) = (s.x * s.x, s.y * s.y, s.z * s.z);
        centred(m, Mat3::from_diagonal(Vec3::new(yy + zz, xx + zz, xx + yy) * (m / 12.0)))
    }

    /// A cylinder of `density` about `axis`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn cylinder(density: f64, axis: Axis, radius: f64, length: f64) -> Result<Self, Error> {
        let (r, l) = (positive("cylinder radius", radius)?, positive("cylinder length", length)?);
        Self::cylinder_total(PI * r * r * l * positive("density", density)?, axis, r, l)
    }

    /// A cylinder of `mass` about `axis`: I = m r²/2 about it, m (r²/4 + l²/12) across.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn cylinder_total(mass: f64, axis: Axis, radius: f64, length: f64) -> Result<Self, Error> {
        let m = positive("mass", mass)?;
        let (r, l) = (positive("cylinder radius", radius)?, positive("cylinder length", length)?);
        centred(m, axis.tensor(m * r * r * 0.5, m * (0.25 * r * r + l * l / 12.0)))
    }

    /// A capsule of `density` about `axis`; `length` is that of the cylindrical part, without the caps.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn capsule(density: f64, axis: Axis, radius: f64, length: f64) -> Result<Self, Error> {
        let d = positive("density", density)?;
        let (r, l) = (positive("capsule radius", radius)?, positive("capsule length", length)?);
        let cylinder = PI * r * r * l * d;
        let caps = 4.0 / 3.0 * PI * r * r * r * d;
        // The caps: half balls, whose centres of mass lie 3/8 r beyond the cylinder's ends.
        let across =
            cylinder * (0.25 * r * r + l * l / 12.0) + caps * (0.4 * r * r + 0.375 * r * l + 0.25 * l * l);
        let along = (cylinder * 0.5 + caps * 0.4) * r * r;
        centred(cylinder + caps, axis.tensor(along, across))
    }

    /// A capsule of `mass` about `axis`; `length` is that of the cylindrical part, without the caps.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn capsule_total(mass: f64, axis: Axis, radius: f64, length: f64) -> Result<Self, Error> {
        positive("mass", mass)?;
        Self::capsule(1.0, axis, radius, length)?.adjust(mass)
    }

    /// An ellipsoid of `density` with the half axes `radii`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn ellipsoid(density: f64, radii: Vec3) -> Result<Self, Error> {
        let r = ellipsoid_radii(radii)?;
        Self::ellipsoid_total(4.0 / 3.0 * PI * r.x * r.y * r.z * positive("density", density)?, r)
    }

    /// An ellipsoid of `mass` with the half axes `radii`: I = m/5 (b² + c²) about the half axis a.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn ellipsoid_total(mass: f64, radii: Vec3) -> Result<Self, Error> {
        let (m, r) = (positive("mass", mass)?, ellipsoid_radii(radii)?);
        let (xx, yy, zz) = (r.x * r.x, r.y * r.y, r.z * r.z);
        centred(m, Mat3::from_diagonal(Vec3::new(yy + zz, xx + zz, xx + yy) * (m / 5.0)))
    }

    /// A cone of `density` about `axis`, its apex at +`length`/2 and its base, of radius `radius`, at −`length`/2. Its
    /// centre of mass lies at −`length`/4.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn cone(density: f64, axis: Axis, radius: f64, length: f64) -> Result<Self, Error> {
        let (r, l) = (positive("cone radius", radius)?, positive("cone length", length)?);
        Self::cone_total(PI / 3.0 * r * r * l * positive("density", density)?, axis, r, l)
    }

    /// As [`Mass::cone`], of `mass`: I = 3/10 m r² about the axis, 3/20 m (r² + l²/4) across it at the centre of mass.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], which names the number that is not positive; the errors of [`Mass::check`] on overflow.
    pub fn cone_total(mass: f64, axis: Axis, radius: f64, length: f64) -> Result<Self, Error> {
        let m = positive("mass", mass)?;
        let (r, l) = (positive("cone radius", radius)?, positive("cone length", length)?);
        let tensor = axis.tensor(0.3 * m * r * r, 0.15 * m * (r * r + 0.25 * l * l));
        centred(m, tensor)?.translate(axis.vector() * (-0.25 * l))
    }
}

fn box_sides(s: Vec3) -> Result<Vec3, Error> {
    Ok(Vec3::new(positive("box side x", s.x)?, positive("box side y", s.y)?, positive("box side z", s.z)?))
}

fn ellipsoid_radii(r: Vec3) -> Result<Vec3, Error> {
    Ok(Vec3::new(
        positive("ellipsoid radius x", r.x)?,
        positive("ellipsoid radius y", r.y)?,
        positive("ellipsoid radius z", r.z)?,
    ))
}
