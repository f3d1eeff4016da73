//! Joints of random scenes, each type with everything that can be set on it.

use super::{Dice, Line, Scene};
use ferrode_dynamics::JointType;
use ferrode_math::Vec3;

const JOINTS: [JointType; 16] = [
    JointType::Ball,
    JointType::Hinge,
    JointType::Slider,
    JointType::Universal,
    JointType::Hinge2,
    JointType::Fixed,
    JointType::Null,
    JointType::AMotor,
    JointType::LMotor,
    JointType::Plane2D,
    JointType::PR,
    JointType::PU,
    JointType::Piston,
    JointType::DBall,
    JointType::DHinge,
    JointType::Transmission,
];

/// A type that can be attached to these bodies.
pub(super) fn choose(dice: &mut Dice, bodies: [Option<usize>; 2]) -> JointType {
    loop {
        let kind = JOINTS[dice.below(JOINTS.len())];
        if bodies.iter().all(Option::is_some) || !kind.needs_two_bodies() {
            return kind;
        }
    }
}

impl Scene {
    pub(super) fn add_joint(
        &mut self,
        dice: &mut Dice,
        j: usize,
        kind: JointType,
        bodies: [Option<usize>; 2],
        positions: &[Vec3],
    ) {
        let two = bodies.iter().all(Option::is_some);
        self.types.push(kind);
        let place = |body: Option<usize>| body.map_or(-1.0, |i| i as f64);
        self.set("joint", j, &[f64::from(kind.number())]);
        self.set("attach", j, &[place(bodies[0]), place(bodies[1])]);
        self.set("feedback", j, &[]);
        let centre = |body: Option<usize>| body.map_or(Vec3::ZERO, |i| positions[i]);
        let between = if two {
            (centre(bodies[0]) + centre(bodies[1])) * 0.5
        } else {
            centre(bodies[0].or(bodies[1])) + dice.vector(0.4)
        };
        let anchor = (between + dice.vector(0.2)).to_array();
        let [e0, e1, e2] = dice.frame().map(Vec3::to_array);
        // (parameter groups, whether each is linear), by type.
        let mut groups: &[bool] = &[];
        match kind {
            JointType::Ball => {
                self.set("BallAnchor", j, &anchor);
                if dice.chance(0.2) {
                    self.set("BallAnchor2", j, &dice.vector(0.5).to_array());
                }
            }
            JointType::Hinge => {
                self.set("HingeAnchor", j, &anchor);
                self.set("HingeAxis", j, &e0);
                groups = &[false];
            }
            JointType::Slider => {
                self.set("SliderAxis", j, &e0);
                groups = &[true];
            }
            JointType::Universal => {
                self.set("UniversalAnchor", j, &anchor);
                self.set("UniversalAxis1", j, &e0);
                self.set("UniversalAxis2", j, &e1);
                groups = &[false, false];
            }
            JointType::Hinge2 => {
                self.set("Hinge2Anchor", j, &anchor);
                self.set("Hinge2Axes", j, &[e0[0], e0[1], e0[2], e1[0], e1[1], e1[2]]);
                groups = &[false, false];
            }
            JointType::Fixed => self.set("Fixed", j, &[]),
            JointType::PR => {
                self.set("PRAnchor", j, &anchor);
                self.set("PRAxis1", j, &e0);
                self.set("PRAxis2", j, &e1);
                groups = &[true, false];
            }
            JointType::PU => {
                self.set("PUAnchor", j, &anchor);
                self.set("PUAxis1", j, &e0);
                self.set("PUAxis2", j, &e1);
                self.set("PUAxis3", j, &e2);
                groups = &[false, false, true];
            }
            JointType::Piston => {
                self.set("PistonAnchor", j, &anchor);
                self.set("PistonAxis", j, &e0);
                groups = &[true, false];
            }
            JointType::AMotor => groups = self.add_angular_motor(dice, j, bodies, [e0, e1, e2]),
            JointType::LMotor => {
                let axes = 1 + dice.below(3);
                self.set("LMotorNumAxes", j, &[axes as f64]);
                for (i, e) in [e0, e1, e2].iter().enumerate().take(axes) {
                    let rel = dice.below(3) as f64;
                    self.set("LMotorAxis", j, &[i as f64, rel, e[0], e[1], e[2]]);
                }
                groups = &[true, true, true][..axes];
            }
            JointType::Plane2D => groups = &[true, true, false],
            JointType::DBall => {
                self.set("DBallAnchor1", j, &anchor);
                self.set("DBallAnchor2", j, &dice.vector(1.0).to_array());
                if dice.chance(0.3) {
                    self.set("DBallDistance", j, &[dice.range(0.1, 2.0)]);
                }
            }
            JointType::DHinge => {
                self.set("DHingeAxis", j, &e0);
                self.set("DHingeAnchor1", j, &anchor);
                self.set("DHingeAnchor2", j, &dice.vector(1.0).to_array());
            }
            JointType::Transmission => self.add_transmission(dice, j, bodies, positions, [e0, e1]),
            _ => {}
        }
        if dice.chance(0.25) {
            self.set_off(dice, j, kind, bodies, [&anchor, &e0, &e1]);
        }
        let own =
            [JointType::Ball, JointType::Fixed, JointType::DBall, JointType::DHinge, JointType::Transmission];
        if own.contains(&kind) && dice.chance(0.3) {
            self.set("param", j, &[13.0, dice.range(0.1, 0.9)]);
            self.set("param", j, &[8.0, [1e-9, 1e-6, 1e-3][dice.below(3)]]);
        }
        if kind == JointType::Hinge2 && dice.chance(0.6) {
            self.set("param", j, &[11.0, dice.range(0.1, 0.9)]);
            self.set("param", j, &[12.0, [1e-9, 1e-5, 1e-2][dice.below(3)]]);
        }
        for (group, linear) in groups.iter().enumerate() {
            self.add_limit_motor(dice, j, group, *linear);
        }
        if dice.chance(0.05) {
            self.set("joint_enabled", j, &[0.0]);
        }
        self.add_joint_forces(dice, j, kind, bodies);
    }

    /// Sets what the joint counts as its present position or angle.
    fn set_off(
        &mut self,
        dice: &mut Dice,
        j: usize,
        kind: JointType,
        bodies: [Option<usize>; 2],
        [anchor, e0, e1]: [&[f64; 3]; 3],
    ) {
        let d = dice.vector(0.3).to_array();
        let (first, rest): (_, &[f64]) = match kind {
            JointType::Hinge if dice.chance(0.5) => (anchor, &d),
            JointType::Hinge | JointType::Slider => (e0, &d),
            // In reverse ODE asks for a frame from two equal axes here.
            JointType::Universal if bodies[0].is_none() => return,
            JointType::Universal if dice.chance(0.5) => (e0, &d[..2]),
            JointType::Universal => (e1, &d[..2]),
            JointType::PU | JointType::Piston => (anchor, &d),
            _ => return,
        };
        let op = match kind {
            JointType::Hinge if first == anchor => "HingeAnchorDelta",
            JointType::Hinge => "HingeAxisOffset",
            JointType::Slider => "SliderAxisDelta",
            JointType::Universal if first == e0 => "UniversalAxis1Offset",
            JointType::Universal => "UniversalAxis2Offset",
            JointType::PU => "PUAnchorOffset",
            _ => "PistonAnchorOffset",
        };
        self.set(op, j, &[&first[..], rest].concat());
    }

    fn add_angular_motor(
        &mut self,
        dice: &mut Dice,
        j: usize,
        bodies: [Option<usize>; 2],
        [e0, e1, e2]: [[f64; 3]; 3],
    ) -> &'static [bool] {
        const ANGULAR: [bool; 3] = [false; 3];
        if dice.chance(0.4) && bodies[0].is_some() {
            // Euler angles: the first axis in body 1, the third in body 2.
            self.set("AMotorMode", j, &[1.0]);
            self.set("AMotorAxis", j, &[0.0, 1.0, e0[0], e0[1], e0[2]]);
            self.set("AMotorAxis", j, &[2.0, 2.0, e1[0], e1[1], e1[2]]);
            return &ANGULAR;
        }
        let axes = 1 + dice.below(3);
        self.set("AMotorNumAxes", j, &[axes as f64]);
        for (i, e) in [e0, e1, e2].iter().enumerate().take(axes) {
            let rel = dice.below(3) as f64;
            self.set("AMotorAxis", j, &[i as f64, rel, e[0], e[1], e[2]]);
            self.set("AMotorAngle", j, &[i as f64, dice.range(-0.5, 0.5)]);
        }
        &ANGULAR[..axes]
    }

    /// Gears and bevel gears. A chain drive's first contact point is decided by the sign of a rounding error in ODE.
    fn add_transmission(
        &mut self,
        dice: &mut Dice,
        j: usize,
        bodies: [Option<usize>; 2],
        positions: &[Vec3],
        [e0, e1]: [[f64; 3]; 2],
    ) {
        let [p, q] = bodies.map(|b| b.map_or(Vec3::ZERO, |i| positions[i]));
        if dice.chance(0.6) {
            let d = (q - p).normalized_or(Vec3::X);
            let axis = d.cross(Vec3::from_array(e0)).normalized_or(Vec3::Z);
            self.set("TransmissionMode", j, &[0.0]);
            self.set("TransmissionAxis", j, &axis.to_array());
            self.set("TransmissionRatio", j, &[dice.range(0.5, 2.0)]);
            self.set("TransmissionAnchor1", j, &p.to_array());
            self.set("TransmissionAnchor2", j, &q.to_array());
        } else {
            // Not quite perpendicular: ODE turns one axis round if their product is negative, be it by rounding.
            let a = Vec3::from_array(e0);
            let tilt = if dice.chance(0.5) { 0.1 } else { -0.1 };
            let b = (Vec3::from_array(e1) + a * tilt).normalized_or(Vec3::Z);
            let apex = (p + q) * 0.5;
            self.set("TransmissionMode", j, &[1.0]);
            self.set("TransmissionAxis1", j, &e0);
            self.set("TransmissionAxis2", j, &b.to_array());
            self.set("TransmissionAnchor1", j, &(apex + a * dice.range(0.3, 1.0)).to_array());
            self.set("TransmissionAnchor2", j, &(apex + b * dice.range(0.3, 1.0)).to_array());
        }
        if dice.chance(0.3) {
            self.set("TransmissionBacklash", j, &[dice.range(0.001, 0.02)]);
        }
    }

    fn add_limit_motor(&mut self, dice: &mut Dice, j: usize, group: usize, linear: bool) {
        let base = 256.0 * group as f64;
        let param = |scene: &mut Self, n: f64, value: f64| scene.set("param", j, &[base + n, value]);
        let reach = if linear { 0.3 } else { 0.5 };
        let (low, high) = (dice.range(-reach, 0.1), dice.range(-0.1, reach));
        match dice.below(5) {
            0 => {
                param(self, 0.0, low);
                param(self, 1.0, high);
            }
            1 => param(self, 0.0, low),
            2 => param(self, 1.0, high),
            3 if dice.chance(0.3) => {
                param(self, 0.0, low);
                param(self, 1.0, low);
            }
            _ => {}
        }
        if dice.chance(0.5) {
            param(self, 5.0, dice.range(0.1, 20.0));
            if dice.chance(0.8) {
                param(self, 2.0, dice.range(-3.0, 3.0));
            }
        }
        if dice.chance(0.3) {
            param(self, 6.0, dice.range(0.0, 1.0));
        }
        if dice.chance(0.3) {
            param(self, 7.0, dice.range(0.0, 1.0));
        }
        if dice.chance(0.3) {
            param(self, 8.0, [1e-9, 1e-4, 1e-2][dice.below(3)]);
        }
        if dice.chance(0.3) {
            param(self, 9.0, dice.range(0.1, 0.9));
            param(self, 10.0, [1e-9, 1e-5, 1e-2][dice.below(3)]);
        }
    }

    fn add_joint_forces(&mut self, dice: &mut Dice, j: usize, kind: JointType, bodies: [Option<usize>; 2]) {
        if !dice.chance(0.3) {
            return;
        }
        let f = dice.vector(2.0).to_array();
        let (op, count) = match kind {
            JointType::Hinge => ("AddHingeTorque", 1),
            JointType::Slider => ("AddSliderForce", 1),
            JointType::Universal => ("AddUniversalTorques", 2),
            JointType::Hinge2 => ("AddHinge2Torques", 2),
            JointType::PR => ("AddPRTorque", 1),
            JointType::Piston => ("AddPistonForce", 1),
            // ODE reads an absent second body here.
            JointType::AMotor if bodies.iter().all(Option::is_some) => ("AddAMotorTorques", 3),
            _ => return,
        };
        self.each_step.push(Line::new(op, j, &f[..count]));
    }
}
