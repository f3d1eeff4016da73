//! Masses: plain records of the program's.

use crate::fault::{Fault, Outcome, USER, export, message};
use crate::real::{InMatrix, Out, Real, Real4, Real12, f, mat3, matrix3, padded, r, vec3, vector};
use core::ffi::c_int;
use ferrode_dynamics::{Axis, Error, Mass};
use ferrode_math::{Mat3, Vec3};

/// `dMass`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct MassRecord {
    mass: Real,
    centre: Real4,
    inertia: Real12,
}

impl MassRecord {
    /// A new body's.
    pub const UNIT: Self = Self {
        mass: 1.0,
        centre: [0.0; 4],
        inertia: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    };

    pub fn to_engine(self) -> Mass {
        Mass { mass: f(self.mass), centre: vector(&self.centre), inertia: mat3(&self.inertia) }
    }

    fn from_engine(mass: &Mass) -> Self {
        Self { mass: r(mass.mass), centre: padded(mass.centre), inertia: matrix3(&mass.inertia) }
    }
}

pub type MassPointer = Out<MassRecord>;

/// Writes a mass that was made elsewhere; one that no body can have is no fault.
pub fn store_checked(to: MassPointer, mass: &Mass) -> Outcome<()> {
    store(to, mass).map(|_| ())
}

/// What ODE says of a mass that can't be a body's; `None` for a good one.
fn complaint(mass: &Mass) -> Option<&'static str> {
    match mass.check() {
        Ok(()) => None,
        Err(Error::MassNotPositive(_)) => Some("mass must be > 0"),
        Err(Error::InertiaNotPositiveDefinite { about: "the centre of mass" }) => {
            Some("center of mass inconsistent with mass parameters")
        }
        Err(_) => Some("inertia must be positive definite"),
    }
}

/// Writes a mass; the complaint about it, to be told when nothing is borrowed.
fn store(to: MassPointer, mass: &Mass) -> Outcome<Option<&'static str>> {
    to.set([MassRecord::from_engine(mass)])?;
    Ok(complaint(mass))
}

/// Runs the work, then tells its complaint as `dMassCheck`'s. The result is 1 if there is none.
fn checked(name: &'static str, work: impl FnOnce() -> Outcome<Option<&'static str>>) -> c_int {
    match crate::fault::guard(name, work) {
        None => 1,
        Some(text) => {
            message(USER, text, "dMassCheck");
            0
        }
    }
}

fn axis(direction: c_int) -> Outcome<Axis> {
    match direction {
        1 => Ok(Axis::X),
        2 => Ok(Axis::Y),
        3 => Ok(Axis::Z),
        _ => Err(Fault::user("bad direction number")),
    }
}

/// The shape's mass properties. ODE also computes with a density or mass that is not positive: the inertia is linear in it.
fn scaled(unit: Result<Mass, Error>, total: f64) -> Mass {
    let unit = unit.unwrap_or(Mass { mass: f64::NAN, centre: Vec3::ZERO, inertia: Mat3::ZERO });
    Mass { mass: total, centre: unit.centre, inertia: unit.inertia * (total / unit.mass) }
}

/// By density: the shape of density 1, scaled.
fn dense(unit: Result<Mass, Error>, density: Real) -> Mass {
    let total = unit.as_ref().map_or(f64::NAN, |unit| unit.mass) * f(density);
    scaled(unit, total)
}

/// As the engine has them for good arguments; for others as ODE computes on.
fn made(by_engine: Result<Mass, Error>, otherwise: impl FnOnce() -> Mass) -> Mass {
    by_engine.unwrap_or_else(|_| otherwise())
}

fn sphere(density: Real, radius: Real) -> Mass {
    made(Mass::sphere(f(density), f(radius)), || dense(Mass::sphere(1.0, f(radius)), density))
}

fn sphere_total(total: Real, radius: Real) -> Mass {
    made(Mass::sphere_total(f(total), f(radius)), || scaled(Mass::sphere_total(1.0, f(radius)), f(total)))
}

fn cuboid(density: Real, sides: Vec3) -> Mass {
    made(Mass::cuboid(f(density), sides), || dense(Mass::cuboid(1.0, sides), density))
}

fn cuboid_total(total: Real, sides: Vec3) -> Mass {
    made(Mass::cuboid_total(f(total), sides), || scaled(Mass::cuboid_total(1.0, sides), f(total)))
}

fn capsule(density: Real, axis: Axis, radius: Real, length: Real) -> Mass {
    let by = |density| Mass::capsule(density, axis, f(radius), f(length));
    made(by(f(density)), || dense(by(1.0), density))
}

fn capsule_total(total: Real, axis: Axis, radius: Real, length: Real) -> Mass {
    let by = |total| Mass::capsule_total(total, axis, f(radius), f(length));
    made(by(f(total)), || scaled(by(1.0), f(total)))
}

fn cylinder(density: Real, axis: Axis, radius: Real, length: Real) -> Mass {
    let by = |density| Mass::cylinder(density, axis, f(radius), f(length));
    made(by(f(density)), || dense(by(1.0), density))
}

fn cylinder_total(total: Real, axis: Axis, radius: Real, length: Real) -> Mass {
    let by = |total| Mass::cylinder_total(total, axis, f(radius), f(length));
    made(by(f(total)), || scaled(by(1.0), f(total)))
}

/// Declares functions that make a mass and have it checked.
macro_rules! masses {
    ($(fn $name:ident($to:ident $(, $arg:ident: $ty:ty)*) $body:block)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C-unwind" fn $name($to: MassPointer $(, $arg: $ty)*) {
                checked(stringify!($name), || {
                    $to.check(Fault::ARGUMENT)?;
                    store($to, &$body)
                });
            }
        )+
    };
}

masses! {
    fn dMassSetParameters(
        to, mass: Real, cgx: Real, cgy: Real, cgz: Real,
        i11: Real, i22: Real, i33: Real, i12: Real, i13: Real, i23: Real
    ) {
        let inertia = [[i11, i12, i13], [i12, i22, i23], [i13, i23, i33]].map(|row| row.map(f));
        Mass { mass: f(mass), centre: vec3(cgx, cgy, cgz), inertia: Mat3::from_rows(inertia) }
    }
    fn dMassSetSphere(to, density: Real, radius: Real) { sphere(density, radius) }
    fn dMassSetSphereTotal(to, total: Real, radius: Real) { sphere_total(total, radius) }
    fn dMassSetBox(to, density: Real, lx: Real, ly: Real, lz: Real) { cuboid(density, vec3(lx, ly, lz)) }
    fn dMassSetBoxTotal(to, total: Real, lx: Real, ly: Real, lz: Real) { cuboid_total(total, vec3(lx, ly, lz)) }
    fn dMassSetCapsule(to, density: Real, direction: c_int, radius: Real, length: Real) {
        capsule(density, axis(direction)?, radius, length)
    }
    fn dMassSetCapsuleTotal(to, total: Real, direction: c_int, radius: Real, length: Real) {
        capsule_total(total, axis(direction)?, radius, length)
    }
    fn dMassSetCappedCylinder(to, density: Real, direction: c_int, radius: Real, length: Real) {
        capsule(density, axis(direction)?, radius, length)
    }
    fn dMassSetCappedCylinderTotal(to, total: Real, direction: c_int, radius: Real, length: Real) {
        capsule_total(total, axis(direction)?, radius, length)
    }
    fn dMassSetCylinder(to, density: Real, direction: c_int, radius: Real, length: Real) {
        cylinder(density, axis(direction)?, radius, length)
    }
    fn dMassSetCylinderTotal(to, total: Real, direction: c_int, radius: Real, length: Real) {
        cylinder_total(total, axis(direction)?, radius, length)
    }
    fn dMassAdjust(to, total: Real) {
        let [old] = to.get()?;
        scaled(Ok(old.to_engine()), f(total))
    }
    fn dMassTranslate(to, x: Real, y: Real, z: Real) {
        let [old] = to.get()?;
        old.to_engine().translate(vec3(x, y, z)).unwrap_or(old.to_engine())
    }
    fn dMassRotate(to, rotation: InMatrix) {
        let [old] = to.get()?;
        let (mass, turn) = (old.to_engine(), mat3(&rotation.get()?));
        mass.rotate(turn).unwrap_or_else(|_| Mass {
            mass: mass.mass,
            centre: turn * mass.centre,
            inertia: turn * mass.inertia * turn.transpose(),
        })
    }
}

export! {
    fn dMassSetZero(to: MassPointer) { to.set([MassRecord::default()])? }
    fn dMassAdd(a: MassPointer, b: crate::real::In<MassRecord>) {
        let ([first], [second]) = (a.get()?, b.get()?);
        let (first, second) = (first.to_engine(), second.to_engine());
        a.set([MassRecord::from_engine(&(first + second))])?
    }
}

/// 1 if the mass can be a body's; else a message says what is wrong with it.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dMassCheck(mass: crate::real::In<MassRecord>) -> c_int {
    checked("dMassCheck", || Ok(complaint(&mass.get()?[0].to_engine())))
}
