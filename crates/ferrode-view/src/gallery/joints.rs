//! The book's pictures of joints: two bodies each, with anchors and axes as the engine gives them.

use super::labels::{Label, Side};
use crate::joint_marks::joint_marks;
use crate::overlay::{Overlays, Scale};
use ferrode::prelude::*;
use ferrode::{
    AMotor, AMotorMode, AxisFrame, DBall, DHinge, Error, Hinge, LMotor, PR, PU, Piston, Plane2D, Slider,
    Transmission, TransmissionMode,
};
use ferrode_math::real;
use ferrode_render::{Camera, Color, Layer, Paint, Scene};

/// A joint's picture.
pub struct JointPicture {
    /// The page it belongs to, `book/joints/NAME.md`.
    pub name: &'static str,
    /// What its anchors and its axes are called.
    words: [&'static [&'static str]; 2],
    /// Adds the joint to its two bodies.
    join: fn(&mut World, [BodyKey; 2]) -> Result<JointKey, Error>,
    /// Adds the bodies.
    bodies: fn(&mut World) -> Result<[BodyKey; 2], Error>,
}

/// The scene of a joint's picture, ready to be drawn.
pub struct Set {
    /// The world.
    pub world: World,
    /// The bodies that the joint holds together.
    pub bodies: [BodyKey; 2],
    /// Words beside it.
    pub labels: Vec<Label>,
    /// What is shown of the engine.
    pub overlays: Overlays,
}

/// Colours of the first and the second body, as on the book's other drawings.
pub const COLORS: [Color; 2] = [Color::rgb(240, 176, 104), Color::rgb(140, 184, 230)];

/// How long axes are.
pub const SCALE: Scale = Scale { length: 0.42, per_newton: 0.0007 };

const HEIGHT: f64 = 0.55;
const ORIGIN: Vec3 = Vec3::new(0.0, 0.0, HEIGHT);
const SLAB: Vec3 = Vec3::new(0.76, 0.4, 0.16);

fn add(world: &mut World, x: f64, shape: Shape) -> Result<BodyKey, Error> {
    world.add_body(BodyBuilder::new().at(Vec3::new(x, 0.0, HEIGHT)).with_shape(shape, 500.0))
}

/// Two slabs, the joint between them.
fn slabs(world: &mut World) -> Result<[BodyKey; 2], Error> {
    let slab: Shape = Cuboid::new(SLAB)?.into();
    Ok([add(world, -0.44, slab.clone())?, add(world, 0.44, slab)?])
}

/// A chassis over a wheel.
fn wheel(world: &mut World) -> Result<[BodyKey; 2], Error> {
    let chassis = add(world, 0.0, Cuboid::new(Vec3::new(1.1, 0.36, 0.16))?.into())?;
    world.body_mut(chassis)?.set_position(Vec3::new(0.0, 0.0, 0.92))?;
    let wheel = add(world, 0.0, Cylinder::new(0.36, 0.16)?.into())?;
    let body = world.body_mut(wheel)?;
    body.set_position(Vec3::new(0.0, 0.0, 0.37))?;
    body.set_quaternion(Quat::from_axis_angle(Vec3::X, 0.5 * core::f64::consts::PI))?;
    Ok([chassis, wheel])
}

/// Two wheels side by side.
fn wheels(world: &mut World) -> Result<[BodyKey; 2], Error> {
    let up = Quat::from_axis_angle(Vec3::X, 0.5 * core::f64::consts::PI);
    let mut wheel = |x: f64, radius: f64| -> Result<BodyKey, Error> {
        let key = add(world, x, Cylinder::new(radius, 0.14)?.into())?;
        world.body_mut(key)?.set_quaternion(up)?;
        world.add_hinge(Some(key), None, Vec3::new(x, 0.0, HEIGHT), Vec3::Y)?;
        Ok(key)
    };
    Ok([wheel(-0.42, 0.28)?, wheel(0.36, 0.46)?])
}

/// A ball that has just come to lie on a slab.
fn ball_on_slab(world: &mut World) -> Result<[BodyKey; 2], Error> {
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let ball = add(world, 0.0, Sphere::new(0.3)?.into())?;
    // It slides, so that friction slants the force.
    world.body_mut(ball)?.set_position(Vec3::new(0.0, 0.0, HEIGHT - 0.002))?;
    world.body_mut(ball)?.set_linear_velocity(Vec3::new(-2.0, 0.0, 0.0))?;
    let slab = add(world, 0.0, Cuboid::new(Vec3::new(1.2, 0.7, 0.16))?.into())?;
    world.body_mut(slab)?.set_position(Vec3::new(0.0, 0.0, 0.17))?;
    world.body_mut(slab)?.set_kinematic();
    Ok([ball, slab])
}

/// Turns the first body about the joint's place.
fn swing(world: &mut World, body: BodyKey, axis: Vec3, angle: f64) -> Result<(), Error> {
    let turn = Quat::from_axis_angle(axis, angle);
    let body = world.body_mut(body)?;
    let (place, rotation) = (body.position(), body.quaternion());
    body.set_position(ORIGIN + turn.rotate(place - ORIGIN))?;
    body.set_quaternion(turn * rotation)?;
    Ok(())
}

fn shift(world: &mut World, body: BodyKey, by: Vec3) -> Result<(), Error> {
    let body = world.body_mut(body)?;
    let place = body.position() + by;
    body.set_position(place)?;
    Ok(())
}

/// The joint pictures, in the book's order.
pub const ALL: &[JointPicture] = &[
    JointPicture {
        name: "ball",
        words: [&["anchor"], &[]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.add_ball(Some(one), Some(two), ORIGIN)?;
            swing(world, one, Vec3::new(0.5, 0.6, 0.4).normalized_or(Vec3::X), 0.5)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "hinge",
        words: [&["anchor"], &["axis"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.add_hinge(Some(one), Some(two), ORIGIN, Vec3::Z)?;
            world.joint_mut::<Hinge>(key)?.set_limits(-0.9, 0.9)?;
            swing(world, one, Vec3::Z, 0.5)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "slider",
        words: [&[], &["axis"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.add_slider(Some(one), Some(two), Vec3::X)?;
            world.joint_mut::<Slider>(key)?.set_limits(-0.3, 0.0)?;
            shift(world, one, Vec3::X * -0.2)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "universal",
        words: [&["anchor"], &["axis 1", "axis 2"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.add_universal(Some(one), Some(two), ORIGIN, Vec3::Y, Vec3::Z)?;
            swing(world, one, Vec3::Y, 0.35)?;
            swing(world, two, Vec3::Z, 0.3)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "hinge2",
        words: [&["anchor"], &["axis 1", "axis 2"]],
        bodies: wheel,
        join: |world, [one, two]| world.add_hinge2(one, two, Vec3::new(0.0, 0.0, 0.37), Vec3::Z, Vec3::Y),
    },
    JointPicture {
        name: "pr",
        words: [&["anchor"], &["axis 1 (P)", "axis 2 (R)"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.create_joint::<PR>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<PR>(key)?;
            joint.set_anchor(ORIGIN)?;
            joint.set_axis1(Vec3::X)?;
            joint.set_axis2(Vec3::Z)?;
            shift(world, one, Vec3::X * -0.15)?;
            swing(world, one, Vec3::Z, 0.35)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "pu",
        words: [&["anchor"], &["axis 1", "axis 2", "axis P"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.create_joint::<PU>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<PU>(key)?;
            joint.set_anchor(ORIGIN)?;
            joint.set_axis1(Vec3::Y)?;
            joint.set_axis2(Vec3::Z)?;
            joint.set_axis_p(Vec3::X)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "piston",
        words: [&["anchor"], &["axis"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.create_joint::<Piston>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<Piston>(key)?;
            joint.set_anchor(ORIGIN)?;
            joint.set_axis(Vec3::X)?;
            swing(world, one, Vec3::X, 0.6)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "fixed",
        words: [&["held"], &[]],
        bodies: slabs,
        join: |world, [one, two]| {
            shift(world, one, Vec3::X * 0.06)?;
            shift(world, two, Vec3::X * -0.06)?;
            world.add_fixed(Some(one), Some(two))
        },
    },
    JointPicture {
        name: "amotor",
        words: [&[], &["axis 0", "axis 1", "axis 2"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.create_joint::<AMotor>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<AMotor>(key)?;
            joint.set_mode(AMotorMode::Euler);
            joint.set_axis(0, AxisFrame::First, Vec3::X)?;
            joint.set_axis(2, AxisFrame::Second, Vec3::Z)?;
            swing(world, one, Vec3::Z, 0.3)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "lmotor",
        words: [&[], &["axis 0", "axis 1", "axis 2"]],
        bodies: slabs,
        join: |world, [one, two]| {
            let key = world.create_joint::<LMotor>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<LMotor>(key)?;
            joint.set_axis_count(3);
            for (i, axis) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
                joint.set_axis(i, AxisFrame::Second, axis)?;
            }
            Ok(key)
        },
    },
    JointPicture {
        name: "plane2d",
        words: [&[], &["x", "y"]],
        bodies: |world| {
            let body = add(world, 0.0, Cuboid::new(SLAB)?.into())?;
            let sheet = add(world, 0.0, Cuboid::new(Vec3::new(1.5, 0.9, 0.01))?.into())?;
            shift(world, body, Vec3::Z * -HEIGHT)?;
            shift(world, sheet, Vec3::Z * (-0.01 - 0.5 * SLAB.z - HEIGHT))?;
            Ok([body, sheet])
        },
        join: |world, [one, _]| {
            let key = world.create_joint::<Plane2D>(None)?;
            world.attach(key, Some(one), None)?;
            swing(world, one, Vec3::Z, 0.4)?;
            Ok(key)
        },
    },
    JointPicture {
        name: "contact",
        words: [&["normal"], &["force"]],
        bodies: ball_on_slab,
        join: |world, [one, two]| {
            world.step(0.01)?;
            // The contact joints of a step are gone after it: a fixed one has the same two bodies.
            world.add_fixed(Some(one), Some(two))
        },
    },
    JointPicture {
        name: "dball",
        words: [&["anchor 1", "anchor 2"], &[]],
        bodies: slabs,
        join: |world, [one, two]| {
            shift(world, one, Vec3::new(-0.12, 0.0, 0.15))?;
            shift(world, two, Vec3::new(0.12, 0.0, -0.1))?;
            let key = world.create_joint::<DBall>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<DBall>(key)?;
            joint.set_anchor1(ORIGIN + Vec3::new(-0.18, 0.0, 0.15))?;
            joint.set_anchor2(ORIGIN + Vec3::new(0.18, 0.0, -0.1))?;
            Ok(key)
        },
    },
    JointPicture {
        name: "dhinge",
        words: [&["anchor 1", "anchor 2"], &["axis", "axis"]],
        bodies: slabs,
        join: |world, [one, two]| {
            shift(world, one, Vec3::new(-0.12, 0.0, 0.15))?;
            shift(world, two, Vec3::new(0.12, 0.0, -0.1))?;
            let key = world.create_joint::<DHinge>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<DHinge>(key)?;
            joint.set_axis(Vec3::Y)?;
            joint.set_anchor1(ORIGIN + Vec3::new(-0.18, 0.0, 0.15))?;
            joint.set_anchor2(ORIGIN + Vec3::new(0.18, 0.0, -0.1))?;
            Ok(key)
        },
    },
    JointPicture {
        name: "transmission",
        words: [&["anchor 1", "anchor 2"], &["axis 1", "axis 2"]],
        bodies: wheels,
        join: |world, [one, two]| {
            let key = world.create_joint::<Transmission>(None)?;
            world.attach(key, Some(one), Some(two))?;
            let mut joint = world.joint_mut::<Transmission>(key)?;
            joint.set_mode(TransmissionMode::ParallelAxes);
            joint.set_ratio(0.46 / 0.28)?;
            joint.set_axis(Vec3::Y)?;
            joint.set_anchor1(Vec3::new(-0.42, 0.0, HEIGHT))?;
            joint.set_anchor2(Vec3::new(0.36, 0.0, HEIGHT))?;
            Ok(key)
        },
    },
];

impl JointPicture {
    /// Where it is looked at from: all from the same side, the plane z = 0 lower than the others.
    pub fn camera(&self) -> Camera {
        let low = if self.name == "plane2d" { HEIGHT } else { 0.0 };
        Camera::look_at(Vec3::new(0.95, -1.85, 1.36 - low), Vec3::new(0.0, 0.0, 0.5 - low))
    }

    /// Builds the scene.
    ///
    /// # Errors
    /// The engine refuses a number.
    pub fn set(&self) -> Result<Set, Error> {
        let mut world = World::new();
        let bodies = (self.bodies)(&mut world)?;
        let joint = (self.join)(&mut world, bodies)?;
        world.sync_geoms();
        let mut labels = Vec::new();
        for (key, text) in bodies.into_iter().zip(["1", "2"]) {
            let body = world.body(key)?;
            let at = body.position()
                + match (self.name, text) {
                    ("plane2d" | "contact", "2") => Vec3::new(0.45, -0.25, 0.08),
                    ("plane2d", _) => body.vector_to_world(Vec3::new(-0.25, 0.0, 0.08)),
                    ("contact", _) => Vec3::new(-0.12, -0.2, 0.1),
                    ("hinge2", "1") => Vec3::new(-0.4, 0.0, 0.08),
                    ("hinge2", _) => Vec3::new(-0.2, -0.08, 0.1),
                    ("transmission", _) => Vec3::new(-0.1, -0.08, 0.12),
                    // On the top, towards the outer end: the joint is in the middle.
                    _ => {
                        let out = 0.3 * body.position().x.signum();
                        body.vector_to_world(Vec3::new(out, 0.0, 0.08))
                    }
                };
            labels.push(Label { at, text: text.to_owned(), side: Side::On });
        }
        let mut overlays = Overlays { joints: true, ..Overlays::default() };
        let [anchors, axes] = self.words;
        let mut beside = |at: Vec3, text: &str, side: Side| {
            labels.push(Label { at, text: text.to_owned(), side });
        };
        match self.name {
            "contact" => {
                overlays = Overlays { contacts: true, forces: true, ..Overlays::default() };
                if let Some(contact) = world.contacts().first() {
                    let point = contact.point;
                    let left = Vec3::new(-0.19, 0.0, 0.03);
                    beside(point.position + point.normal * SCALE.length + left, anchors[0], Side::On);
                    beside(point.position + contact.force * SCALE.per_newton, axes[0], Side::Below);
                }
            }
            "plane2d" => {
                for (axis, word) in [Vec3::X, Vec3::Y].into_iter().zip(axes) {
                    beside(world.body(bodies[0])?.position() + axis * PLANE_ARROW, word, Side::Above);
                }
            }
            _ => {
                let marks = joint_marks(world.dynamics(), joint).unwrap_or_default();
                for (at, word) in marks.anchors.iter().zip(anchors) {
                    beside(*at, word, Side::Below);
                }
                for (axis, word) in marks.axes.iter().zip(axes) {
                    beside(axis.at + axis.along * SCALE.length, word, Side::Above);
                }
            }
        }
        Ok(Set { world, bodies, labels, overlays })
    }

    /// Adds what the engine's overlays do not have: the axes of a plane, the rods that double joints are.
    pub fn draw_more(&self, set: &Set, scene: &mut Scene) {
        let paint = Paint::from(Color::rgb(40, 170, 120)).glowing();
        if let ("plane2d", Ok(body)) = (self.name, set.world.body(set.bodies[0])) {
            for axis in [Vec3::X, Vec3::Y] {
                let to = body.position() + axis * PLANE_ARROW;
                scene.arrow(body.position(), to, 0.0125, paint, Layer::Over);
            }
            let turn = |i: u32| {
                let angle = 1.2 + 0.06 * f64::from(i);
                body.position() + Vec3::new(real::cos(angle), real::sin(angle), 0.0) * 0.3
            };
            for i in 0..24 {
                scene.line(turn(i), turn(i + 1), 2.5, Color::rgb(40, 170, 120), Layer::Over);
            }
        }
        for joint in set.world.joints() {
            let ends = set.world.joint::<DBall>(joint).map(|j| [j.anchor1(), j.anchor2()]);
            let ends = ends.or_else(|_| set.world.joint::<DHinge>(joint).map(|j| [j.anchor1(), j.anchor2()]));
            if let Ok([from, to]) = ends {
                scene.line(from, to, 3.0, Color::rgb(70, 66, 62), Layer::Over);
            }
        }
    }
}

/// Length of the plane's arrows, m.
const PLANE_ARROW: f64 = 0.6;
