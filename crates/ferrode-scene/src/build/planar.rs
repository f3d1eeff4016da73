//! The planar joint of URDF: its link keeps its height over a plane and its upright stance, and slides and turns in it.
//!
//! ```text
//!        n, the axis of the file            The engine has no such joint. A linear motor along n holds the height,
//!        |   ___                            an angular motor about t1 and t2 the stance; each aims, with unlimited
//!        |  /__/|  slides and turns         force, at the velocity that takes the world's ERP of its error away.
//!   t2 \ | |__|/   in the plane
//!       \|_______ t1
//! ```
//!
//! The linear motor measures the velocities of the centres, so the plane must stand still: it is fixed in the world or a
//! static link.

use ferrode::dynamics::AxisFrame;
use ferrode::{AMotor, BodyKey, Error, JointKey, LMotor, Quat, Vec3, World};

/// What holds a body in a plane.
#[derive(Clone, Debug)]
pub(super) struct Planar {
    body: BodyKey,
    height_motor: JointKey,
    stance_motor: JointKey,
    normal: Vec3,
    tangents: [Vec3; 2],
    height: f64,
    stance: Quat,
}

/// Sets the motors up. The third axis of the angular one is left for whoever turns the link in the plane.
pub(super) fn connect(world: &mut World, body: BodyKey, normal: Vec3) -> Result<Planar, Error> {
    let (t1, t2) = ferrode::math::plane_space(normal);
    let height_motor = world.create_joint::<LMotor>(None)?;
    world.attach(height_motor, Some(body), None)?;
    let mut motor = world.joint_mut::<LMotor>(height_motor)?;
    motor.set_axis_count(1);
    motor.set_axis(0, AxisFrame::World, normal)?;
    let stance_motor = world.create_joint::<AMotor>(None)?;
    world.attach(stance_motor, Some(body), None)?;
    let mut motor = world.joint_mut::<AMotor>(stance_motor)?;
    motor.set_axis_count(3);
    for (index, axis) in [t1, t2, normal].into_iter().enumerate() {
        motor.set_axis(index, AxisFrame::World, axis)?;
    }
    let start = world.body(body)?;
    let (height, stance) = (normal.dot(start.position()), start.quaternion());
    let planar = Planar { body, height_motor, stance_motor, normal, tangents: [t1, t2], height, stance };
    planar.update(world, 1.0)?;
    Ok(planar)
}

impl Planar {
    /// The angular motor; its third axis turns the link in the plane.
    pub(super) fn key(&self) -> JointKey {
        self.stance_motor
    }

    /// Out of the plane.
    pub(super) fn normal(&self) -> Vec3 {
        self.normal
    }

    /// How far the link has turned since the start, as a rotation vector's direction and half angle.
    fn turned(&self, world: &World) -> Quat {
        let now = world.body(self.body).map_or(self.stance, |body| body.quaternion());
        now * self.stance.conjugate()
    }

    /// The angle in the plane, within half a turn.
    pub(super) fn angle(&self, world: &World) -> f64 {
        super::twist_angle(self.turned(world), self.normal)
    }

    /// Aims the motors at the plane.
    pub(super) fn update(&self, world: &mut World, step: f64) -> Result<(), Error> {
        let rate = world.erp() / step;
        let off = world.body(self.body)?.position().dot(self.normal) - self.height;
        // What is left of the rotation without the turn in the plane is a tilt about an axis in it.
        let turn = Quat::from_axis_angle(self.normal, self.angle(world));
        let tilt = self.turned(world) * turn.conjugate();
        let tilt = tilt.imaginary() * if tilt.w < 0.0 { -2.0 } else { 2.0 };
        let mut motor = world.joint_mut::<LMotor>(self.height_motor)?;
        motor.set_motor_of(1, -rate * off, f64::INFINITY)?;
        let mut motor = world.joint_mut::<AMotor>(self.stance_motor)?;
        for (index, tangent) in self.tangents.iter().enumerate() {
            motor.set_motor_of(index + 1, -rate * tilt.dot(*tangent), f64::INFINITY)?;
        }
        Ok(())
    }
}
