//! What a scene needs of an engine, and this project's own behind it.

use ferrode_dynamics::{
    Ball, BodyKey, Contact, GroupKey, Hinge, JointKey, Mass, Param, StepReport, Stepper, Surface, World,
};
use ferrode_math::random::OdeRandom;
use ferrode_math::{ContactPoint, Quat, Vec3};

/// How forces are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The exact solver: `dWorldStep`.
    Direct,
    /// The iterative one, 20 iterations: `dWorldQuickStep`.
    Quick,
}

/// A coefficient of friction.
#[derive(Clone, Copy, Debug)]
pub struct Mu(pub f64);

/// A contact to be made: the point, and the bodies by their numbers.
#[derive(Clone, Copy, Debug)]
pub struct ContactLine {
    /// The body that the normal points into.
    pub first: usize,
    /// The other one, or `None` for the ground.
    pub second: Option<usize>,
    /// Where.
    pub point: ContactPoint,
}

/// An engine as the scenes see it.
pub trait Engine {
    /// Its name in the results.
    const NAME: &'static str;

    /// An empty world with this gravity, the random generator at seed 0.
    fn new(gravity: Vec3) -> Self;
    /// Sets the constraint force mixing of joints and contacts.
    #[allow(dead_code, reason = "not every program sets it")]
    fn set_cfm(&mut self, cfm: f64);
    /// Adds a box; its number.
    fn add_box(&mut self, mass: f64, sides: Vec3, position: Vec3, rotation: Quat) -> usize;
    /// Adds a ball joint.
    fn add_ball(&mut self, first: Option<usize>, second: Option<usize>, anchor: Vec3);
    /// Adds a hinge, maybe with a brake of this torque.
    fn add_hinge(
        &mut self,
        first: Option<usize>,
        second: Option<usize>,
        anchor: Vec3,
        axis: Vec3,
        brake: Option<f64>,
    );
    /// Makes the contacts, steps, and takes the contacts away.
    fn step(&mut self, method: Method, h: f64, contacts: &[ContactLine], mu: Mu);
    /// Positions and rotations of the bodies.
    fn poses(&self) -> Vec<(Vec3, Quat)>;
    /// Linear velocities of the bodies.
    fn speeds(&self) -> Vec<Vec3>;
    /// Largest gap between the two anchors of a joint, in metres.
    fn joint_error(&self) -> f64;
}

/// This project's world.
pub struct Ferrode {
    world: World,
    contacts: GroupKey,
    bodies: Vec<BodyKey>,
    joints: Vec<JointKey>,
    /// Rows in the last step.
    pub rows: usize,
    /// What the last step told of itself.
    #[allow(dead_code, reason = "not every program prints it")]
    pub report: StepReport,
}

const VALID: &str = "the scenes use valid numbers and living keys only";

impl Ferrode {
    fn body(&self, body: Option<usize>) -> Option<BodyKey> {
        body.map(|i| self.bodies[i])
    }
}

#[allow(dead_code, reason = "not every program prints it")]
impl Ferrode {
    /// Lets steps use so many threads.
    pub fn set_threads(&mut self, threads: usize) {
        self.world.set_threads(threads);
    }

    /// Largest angle between the axes of a joint, in radians.
    pub fn axis_error(&self) -> f64 {
        let error = |joint: &JointKey| self.world.joint_error(*joint).expect(VALID).angle;
        self.joints.iter().map(error).fold(0.0, f64::max)
    }
}

impl Engine for Ferrode {
    const NAME: &'static str = "ferrode";

    fn new(gravity: Vec3) -> Self {
        let mut world = World::new();
        world.set_gravity(gravity).expect(VALID);
        world.set_random(OdeRandom::new(0));
        let contacts = world.create_group();
        Self {
            world,
            contacts,
            bodies: Vec::new(),
            joints: Vec::new(),
            rows: 0,
            report: StepReport::default(),
        }
    }

    fn set_cfm(&mut self, cfm: f64) {
        self.world.set_cfm(cfm).expect(VALID);
    }

    fn add_box(&mut self, mass: f64, sides: Vec3, position: Vec3, rotation: Quat) -> usize {
        let key = self.world.create_body();
        let body = self.world.body_mut(key).expect(VALID);
        body.set_mass(&Mass::cuboid_total(mass, sides).expect(VALID)).expect(VALID);
        body.set_position(position).expect(VALID);
        body.set_quaternion(rotation).expect(VALID);
        self.bodies.push(key);
        self.bodies.len() - 1
    }

    fn add_ball(&mut self, first: Option<usize>, second: Option<usize>, anchor: Vec3) {
        let joint = self.world.create_joint::<Ball>(None).expect(VALID);
        self.world.attach(joint, self.body(first), self.body(second)).expect(VALID);
        self.world.joint_mut::<Ball>(joint).expect(VALID).set_anchor(anchor).expect(VALID);
        self.joints.push(joint);
    }

    fn add_hinge(
        &mut self,
        first: Option<usize>,
        second: Option<usize>,
        anchor: Vec3,
        axis: Vec3,
        brake: Option<f64>,
    ) {
        let joint = self.world.create_joint::<Hinge>(None).expect(VALID);
        self.world.attach(joint, self.body(first), self.body(second)).expect(VALID);
        let mut hinge = self.world.joint_mut::<Hinge>(joint).expect(VALID);
        hinge.set_anchor(anchor).expect(VALID);
        hinge.set_axis(axis).expect(VALID);
        if let Some(torque) = brake {
            self.world.set_joint_param(joint, Param::Vel, 1, 0.0).expect(VALID);
            self.world.set_joint_param(joint, Param::FMax, 1, torque).expect(VALID);
        }
        self.joints.push(joint);
    }

    fn step(&mut self, method: Method, h: f64, contacts: &[ContactLine], Mu(mu): Mu) {
        let surface = Surface::with_friction(mu);
        for line in contacts {
            let contact = Contact::at(line.point, surface);
            let joint = self.world.create_contact(Some(self.contacts), &contact).expect(VALID);
            let (first, second) = (self.body(Some(line.first)), self.body(line.second));
            self.world.attach(joint, first, second).expect(VALID);
        }
        let stepper = match method {
            Method::Direct => Stepper::Direct,
            Method::Quick => Stepper::Quick,
        };
        let report = self.world.step(stepper, h).expect(VALID);
        self.rows = report.rows;
        self.report = report;
        self.world.empty_group(self.contacts).expect(VALID);
    }

    fn poses(&self) -> Vec<(Vec3, Quat)> {
        let pose = |key: &BodyKey| {
            let body = self.world.body(*key).expect(VALID);
            (body.position(), body.quaternion())
        };
        self.bodies.iter().map(pose).collect()
    }

    fn speeds(&self) -> Vec<Vec3> {
        self.bodies.iter().map(|key| self.world.body(*key).expect(VALID).linear_velocity()).collect()
    }

    fn joint_error(&self) -> f64 {
        let error = |joint: &JointKey| self.world.joint_error(*joint).expect(VALID).position;
        self.joints.iter().map(error).fold(0.0, f64::max)
    }
}
