//! A solid and a hollow cylinder race down a slope. The solid one wins: its mass is nearer to the axis.

use super::prelude::*;
use ferrode_math::real;

const SLOPE: f64 = 12.0;
const RADIUS: f64 = 0.3;
const SECONDS: f64 = 2.0;

pub(super) const DEMO: Demo = Demo {
    name: "cylinders",
    subject: Subject::Contacts,
    about: "a solid and a hollow cylinder race down a slope",
    property: "they roll with 2/3 and 1/2 of g sin θ, within 1 %",
    seconds: SECONDS,
    picture_at: 1.6,
    show: &[],
    camera: Camera::new([3.4, -4.6, 1.8], [1.3, 0.0, -0.25]),
    build,
};

#[derive(Clone)]
struct Race {
    solid: BodyKey,
    hollow: BodyKey,
}

fn build() -> Result<Play, Failure> {
    let mut world = air(Stepper::Direct)?;
    let lean = turn(Vec3::Y, SLOPE);
    let slope = Pose { position: lean.rotate(at(3.0, 0.0, -0.1)), rotation: lean };
    add_wall(&mut world, at(9.0, 4.0, 0.2), slope)?;
    let along_y = turn(Vec3::X, 90.0);
    let mut add = |y: f64, mass: Mass| -> Result<BodyKey, Failure> {
        let builder = BodyBuilder::new()
            .at(at(0.0, y, 0.0) + lean.rotate(at(0.0, 0.0, RADIUS)))
            .rotated(along_y)
            .with_mass(mass)
            .with_shape(Cylinder::new(RADIUS, 0.8)?, 0.0);
        Ok(world.add_body(builder)?)
    };
    let solid = Mass::cylinder_total(5.0, ferrode::dynamics::Axis::Z, RADIUS, 0.8)?;
    // A thin tube: all of its mass at the radius.
    let (axial, across) = (5.0 * RADIUS * RADIUS, 5.0 * (RADIUS * RADIUS / 2.0 + 0.64 / 12.0));
    let hollow = Mass::parameters(5.0, Vec3::ZERO, [across, across, axial], [0.0; 3])?;
    let race = Race { solid: add(-0.8, solid)?, hollow: add(0.8, hollow)? };
    Stage::new(world, 0.002, race)
        .draw(|race, world, drawing| {
            let line = turn(Vec3::Y, SLOPE);
            let at_line = |y: f64| line.rotate(at(0.0, y, 0.003));
            drawing.rod(at_line(-1.9), at_line(1.9), 0.012, Tint::MARK);
            // The hollow one, as it is: dark inside.
            if let Ok(hollow) = world.body(race.hollow) {
                drawing.solid(Cylinder::new(0.88 * RADIUS, 0.802), hollow.pose(), Tint(40, 42, 48));
            }
        })
        .check(|race, world| {
            let gone = 0.5 * G * real::sin(SLOPE.to_radians()) * SECONDS * SECONDS;
            let mut findings = Findings::new();
            for (name, key, part) in [("solid (m)", race.solid, 2.0 / 3.0), ("hollow (m)", race.hollow, 0.5)]
            {
                let lean = turn(Vec3::Y, SLOPE);
                let along = lean.inverse_rotate(place(world, key)?).x - lean.inverse_rotate(Vec3::ZERO).x;
                findings = findings.near(name, along, part * gone, 0.01);
            }
            Ok(findings)
        })
}
