//! Runs a script with this crate.

use super::{Line, Record};
use ferrode_dynamics::*;
use ferrode_math::random::OdeRandom;
use ferrode_math::{ContactPoint, Mat3, Quat, Vec3};

pub struct Engine {
    pub world: World,
    pub bodies: Vec<BodyKey>,
    pub joints: Vec<JointKey>,
    contacts: GroupKey,
}

impl Default for Engine {
    fn default() -> Self {
        let mut world = World::new();
        let contacts = world.create_group();
        Self { world, bodies: Vec::new(), joints: Vec::new(), contacts }
    }
}

fn vector(n: &[f64]) -> Vec3 {
    Vec3::new(n[0], n[1], n[2])
}

fn frame(rel: f64) -> AxisFrame {
    [AxisFrame::World, AxisFrame::First, AxisFrame::Second][rel as usize]
}

fn flag(x: f64) -> bool {
    x != 0.0
}

fn auto_disable(n: &[f64]) -> AutoDisable {
    AutoDisable {
        enabled: flag(n[0]),
        linear_threshold: n[1],
        angular_threshold: n[2],
        steps: n[3] as i32,
        time: n[4],
        average_samples: n[5] as u32,
    }
}

fn damping(n: &[f64]) -> Damping {
    Damping { linear_scale: n[0], angular_scale: n[1], linear_threshold: n[2], angular_threshold: n[3] }
}

fn contact(n: &[f64]) -> Contact {
    let surface = Surface {
        mode: SurfaceMode(n[0] as u32),
        mu: n[1],
        mu2: n[2],
        rho: n[3],
        rho2: n[4],
        rho_n: n[5],
        bounce: n[6],
        bounce_velocity: n[7],
        soft_erp: n[8],
        soft_cfm: n[9],
        motion1: n[10],
        motion2: n[11],
        motion_n: n[12],
        slip1: n[13],
        slip2: n[14],
        ..Surface::default()
    };
    let point = ContactPoint { position: vector(&n[15..]), normal: vector(&n[18..]), depth: n[21] };
    Contact { surface, point, fdir1: vector(&n[22..]) }
}

impl Engine {
    pub fn run(&mut self, lines: &[Line]) -> Result<Vec<Record>, Error> {
        let mut records = Vec::new();
        for line in lines {
            self.execute(line, &mut records)?;
        }
        Ok(records)
    }

    fn body_or_world(&self, index: f64) -> Option<BodyKey> {
        (index >= 0.0).then(|| self.bodies[index as usize])
    }

    pub fn execute(&mut self, line: &Line, records: &mut Vec<Record>) -> Result<(), Error> {
        let (i, n) = (line.index, &line.numbers[..]);
        if self.execute_on_world(line, records)? || self.execute_on_body(line)? {
            return Ok(());
        }
        let Some(joint) = self.joints.get(i).copied() else { panic!("unknown line \"{line}\"") };
        match line.op {
            "attach" => {
                let (first, second) = (self.body_or_world(n[0]), self.body_or_world(n[1]));
                self.world.attach(joint, first, second)
            }
            "feedback" => self.world.set_joint_feedback(joint, true),
            "joint_enabled" => self.world.set_joint_enabled(joint, flag(n[0])),
            "param" => {
                let number = n[0] as usize;
                let name = Param::ALL[number & 0xff];
                self.world.set_joint_param(joint, name, 1 + (number >> 8), n[1])
            }
            _ => self.execute_on_joint(joint, line),
        }
    }

    fn execute_on_world(&mut self, line: &Line, records: &mut Vec<Record>) -> Result<bool, Error> {
        let (n, world) = (&line.numbers[..], &mut self.world);
        match line.op {
            "gravity" => world.set_gravity(vector(n))?,
            "erp" => world.set_erp(n[0])?,
            "cfm" => world.set_cfm(n[0])?,
            "iterations" => {
                world.set_quick(QuickSettings { iterations: n[0] as u32, ..*world.quick() })?;
            }
            "over_relaxation" => {
                world.set_quick(QuickSettings { over_relaxation: n[0], ..*world.quick() })?;
            }
            "max_correcting_velocity" => world.set_contact_max_correcting_velocity(n[0])?,
            "surface_layer" => world.set_contact_surface_layer(n[0])?,
            "world_damping" => world.set_damping(damping(n))?,
            "world_max_angular_speed" => world.set_max_angular_speed(n[0])?,
            "world_auto_disable" => world.set_auto_disable(auto_disable(n))?,
            "seed" => world.set_random(OdeRandom::new(n[0] as u32)),
            "body" => self.bodies.push(world.create_body()),
            "joint" => {
                let mut types = JointType::ALL.iter();
                let of_number = types.find(|t| f64::from(t.number()) == n[0]);
                self.joints.push(world.create_joint_of_type(*of_number.expect("a joint's number"), None)?);
            }
            "contact" => {
                let joint = world.create_contact(Some(self.contacts), &contact(&n[2..]))?;
                let (first, second) = (self.body_or_world(n[0]), self.body_or_world(n[1]));
                self.world.attach(joint, first, second)?;
            }
            "step" => {
                let stepper = if n[0] == 0.0 { Stepper::Direct } else { Stepper::Quick };
                let report = world.step(stepper, n[1])?;
                assert!(report.quarantined.is_empty(), "a body was quarantined");
                world.empty_group(self.contacts)?;
            }
            "print" => self.print(records),
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn execute_on_body(&mut self, line: &Line) -> Result<bool, Error> {
        let Some(body) = self.bodies.get(line.index).copied() else { return Ok(false) };
        let (n, b) = (&line.numbers[..], self.world.body_mut(body)?);
        match line.op {
            "mass" => {
                b.set_mass(&Mass::parameters(n[0], Vec3::ZERO, [n[1], n[2], n[3]], [n[4], n[5], n[6]])?)?
            }
            "position" => b.set_position(vector(n))?,
            "quaternion" => b.set_quaternion(Quat::from_parts(n[0], vector(&n[1..])))?,
            "linear_velocity" => b.set_linear_velocity(vector(n))?,
            "angular_velocity" => b.set_angular_velocity(vector(n))?,
            "kinematic" => b.set_kinematic(),
            "gravity_mode" => b.set_gravity_mode(flag(n[0])),
            "gyroscopic_mode" => b.set_gyroscopic_mode(flag(n[0])),
            "finite_rotation" => {
                b.set_finite_rotation_mode(flag(n[0]));
                b.set_finite_rotation_axis(vector(&n[1..]))?;
            }
            "damping" => b.set_damping(damping(n))?,
            "max_angular_speed" => b.set_max_angular_speed(n[0])?,
            "auto_disable" => {
                // ODE's flag setter has effects of its own.
                self.world.set_body_auto_disable_flag(body, flag(n[0]))?;
                self.world.body_mut(body)?.set_auto_disable(auto_disable(n))?;
            }
            "body_enabled" if flag(n[0]) => b.enable(),
            "body_enabled" => b.disable(),
            "force" => {
                b.add_force(vector(n))?;
                b.add_torque(vector(&n[3..]))?;
            }
            "relative_force_at" => b.add_relative_force_at_relative_position(vector(n), vector(&n[3..]))?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn execute_on_joint(&mut self, joint: JointKey, line: &Line) -> Result<(), Error> {
        let (n, world) = (&line.numbers[..], &mut self.world);
        let v = |at: usize| vector(&n[at..]);
        match line.op {
            "BallAnchor" => world.joint_mut::<Ball>(joint)?.set_anchor(v(0)),
            "BallAnchor2" => world.joint_mut::<Ball>(joint)?.set_anchor2(v(0)),
            "HingeAnchor" => world.joint_mut::<Hinge>(joint)?.set_anchor(v(0)),
            "HingeAxis" => world.joint_mut::<Hinge>(joint)?.set_axis(v(0)),
            "AddHingeTorque" => world.joint_mut::<Hinge>(joint)?.add_torque(n[0]),
            "HingeAnchorDelta" => world.joint_mut::<Hinge>(joint)?.set_anchor_delta(v(0), v(3)),
            "HingeAxisOffset" => world.joint_mut::<Hinge>(joint)?.set_axis_offset(v(0), n[3]),
            "SliderAxisDelta" => world.joint_mut::<Slider>(joint)?.set_axis_delta(v(0), v(3)),
            "UniversalAxis1Offset" => world.joint_mut::<Universal>(joint)?.set_axis1_offset(v(0), n[3], n[4]),
            "UniversalAxis2Offset" => world.joint_mut::<Universal>(joint)?.set_axis2_offset(v(0), n[3], n[4]),
            "PUAnchorOffset" => world.joint_mut::<PU>(joint)?.set_anchor_offset(v(0), v(3)),
            "PistonAnchorOffset" => world.joint_mut::<Piston>(joint)?.set_anchor_offset(v(0), v(3)),
            "PistonAxisDelta" => world.joint_mut::<Piston>(joint)?.set_axis_delta(v(0), v(3)),
            "SliderAxis" => world.joint_mut::<Slider>(joint)?.set_axis(v(0)),
            "AddSliderForce" => world.joint_mut::<Slider>(joint)?.add_force(n[0]),
            "UniversalAnchor" => world.joint_mut::<Universal>(joint)?.set_anchor(v(0)),
            "UniversalAxis1" => world.joint_mut::<Universal>(joint)?.set_axis1(v(0)),
            "UniversalAxis2" => world.joint_mut::<Universal>(joint)?.set_axis2(v(0)),
            "AddUniversalTorques" => world.joint_mut::<Universal>(joint)?.add_torques(n[0], n[1]),
            "Hinge2Anchor" => world.joint_mut::<Hinge2>(joint)?.set_anchor(v(0)),
            "Hinge2Axes" => world.joint_mut::<Hinge2>(joint)?.set_axes(Some(v(0)), Some(v(3))),
            "AddHinge2Torques" => world.joint_mut::<Hinge2>(joint)?.add_torques(n[0], n[1]),
            "Fixed" => {
                world.joint_mut::<Fixed>(joint)?.set_fixed();
                Ok(())
            }
            "PRAnchor" => world.joint_mut::<PR>(joint)?.set_anchor(v(0)),
            "PRAxis1" => world.joint_mut::<PR>(joint)?.set_axis1(v(0)),
            "PRAxis2" => world.joint_mut::<PR>(joint)?.set_axis2(v(0)),
            "AddPRTorque" => world.joint_mut::<PR>(joint)?.add_torque(n[0]),
            "PUAnchor" => world.joint_mut::<PU>(joint)?.set_anchor(v(0)),
            "PUAxis1" => world.joint_mut::<PU>(joint)?.set_axis1(v(0)),
            "PUAxis2" => world.joint_mut::<PU>(joint)?.set_axis2(v(0)),
            "PUAxis3" => world.joint_mut::<PU>(joint)?.set_axis_p(v(0)),
            "PistonAnchor" => world.joint_mut::<Piston>(joint)?.set_anchor(v(0)),
            "PistonAxis" => world.joint_mut::<Piston>(joint)?.set_axis(v(0)),
            "AddPistonForce" => world.joint_mut::<Piston>(joint)?.add_force(n[0]),
            "AMotorMode" => {
                let mode = if flag(n[0]) { AMotorMode::Euler } else { AMotorMode::User };
                world.joint_mut::<AMotor>(joint)?.set_mode(mode);
                Ok(())
            }
            "AMotorNumAxes" => {
                world.joint_mut::<AMotor>(joint)?.set_axis_count(n[0] as usize);
                Ok(())
            }
            "AMotorAxis" => world.joint_mut::<AMotor>(joint)?.set_axis(n[0] as usize, frame(n[1]), v(2)),
            "AMotorAngle" => world.joint_mut::<AMotor>(joint)?.set_angle(n[0] as usize, n[1]),
            "AddAMotorTorques" => world.joint_mut::<AMotor>(joint)?.add_torques(n[0], n[1], n[2]),
            "LMotorNumAxes" => {
                world.joint_mut::<LMotor>(joint)?.set_axis_count(n[0] as usize);
                Ok(())
            }
            "LMotorAxis" => world.joint_mut::<LMotor>(joint)?.set_axis(n[0] as usize, frame(n[1]), v(2)),
            "DBallAnchor1" => world.joint_mut::<DBall>(joint)?.set_anchor1(v(0)),
            "DBallAnchor2" => world.joint_mut::<DBall>(joint)?.set_anchor2(v(0)),
            "DBallDistance" => world.joint_mut::<DBall>(joint)?.set_distance(n[0]),
            "DHingeAnchor1" => world.joint_mut::<DHinge>(joint)?.set_anchor1(v(0)),
            "DHingeAnchor2" => world.joint_mut::<DHinge>(joint)?.set_anchor2(v(0)),
            "DHingeAxis" => world.joint_mut::<DHinge>(joint)?.set_axis(v(0)),
            "TransmissionMode" => {
                let mode = [
                    TransmissionMode::ParallelAxes,
                    TransmissionMode::IntersectingAxes,
                    TransmissionMode::ChainDrive,
                ];
                world.joint_mut::<Transmission>(joint)?.set_mode(mode[n[0] as usize]);
                Ok(())
            }
            "TransmissionAxis" => world.joint_mut::<Transmission>(joint)?.set_axis(v(0)),
            "TransmissionAxis1" => world.joint_mut::<Transmission>(joint)?.set_axis1(v(0)),
            "TransmissionAxis2" => world.joint_mut::<Transmission>(joint)?.set_axis2(v(0)),
            "TransmissionAnchor1" => world.joint_mut::<Transmission>(joint)?.set_anchor1(v(0)),
            "TransmissionAnchor2" => world.joint_mut::<Transmission>(joint)?.set_anchor2(v(0)),
            "TransmissionRatio" => world.joint_mut::<Transmission>(joint)?.set_ratio(n[0]),
            "TransmissionBacklash" => world.joint_mut::<Transmission>(joint)?.set_backlash(n[0]),
            _ => panic!("unknown line \"{line}\""),
        }
    }

    /// Positions, angles and rates that a joint measures; `None` for the types that measure nothing.
    fn measures(&self, joint: JointKey) -> Result<Option<Vec<f64>>, Error> {
        let world = &self.world;
        Ok(Some(match world.joint_type(joint)? {
            JointType::Hinge => {
                let j = world.joint::<Hinge>(joint)?;
                vec![j.angle(), j.angle_rate()]
            }
            JointType::Slider => {
                let j = world.joint::<Slider>(joint)?;
                vec![j.position()?, j.position_rate()?]
            }
            JointType::Universal => {
                let j = world.joint::<Universal>(joint)?;
                vec![j.angle1(), j.angle2(), j.angle1_rate(), j.angle2_rate()]
            }
            JointType::Hinge2 => {
                let j = world.joint::<Hinge2>(joint)?;
                vec![j.angle1(), j.angle2(), j.angle1_rate(), j.angle2_rate()]
            }
            JointType::PR => {
                let j = world.joint::<PR>(joint)?;
                vec![j.position()?, j.position_rate()?, j.angle(), j.angle_rate()]
            }
            JointType::PU => {
                let j = world.joint::<PU>(joint)?;
                let angles = [j.angle1(), j.angle2(), j.angle1_rate(), j.angle2_rate()];
                [&[j.position()?, j.position_rate()][..], &angles].concat()
            }
            JointType::Piston => {
                let j = world.joint::<Piston>(joint)?;
                vec![j.position(), j.position_rate(), j.angle(), j.angle_rate()]
            }
            JointType::AMotor => {
                let j = world.joint::<AMotor>(joint)?;
                (0..j.axis_count()).flat_map(|k| [j.angle(k), j.angle_rate(k)]).collect()
            }
            JointType::Transmission => {
                let j = world.joint::<Transmission>(joint)?;
                vec![j.angle1(), j.angle2()]
            }
            _ => return Ok(None),
        }))
    }

    fn print(&self, records: &mut Vec<Record>) {
        let mut record = |what: &str, index: usize, numbers: Vec<f64>| {
            records.push(Record { what: what.into(), index, numbers });
        };
        for (i, body) in self.bodies.iter().enumerate() {
            let b = self.world.body(*body).expect("bodies live as long as the script");
            let (p, q, v, w) = (b.position(), b.quaternion(), b.linear_velocity(), b.angular_velocity());
            let mut numbers = vec![f64::from(u8::from(b.is_enabled())), p.x, p.y, p.z, q.w];
            let q = q.imaginary();
            numbers.extend([q, v, w].into_iter().flat_map(Vec3::to_array));
            record("body", i, numbers);
        }
        for (i, joint) in self.joints.iter().enumerate() {
            if let Some(numbers) = self.measures(*joint).expect("joints live as long as the script") {
                record("measure", i, numbers);
            }
            if let Some(f) = self.world.joint_feedback(*joint).expect("joints live as long as the script") {
                let vectors = [f.force1, f.torque1, f.force2, f.torque2];
                record("feedback", i, vectors.into_iter().flat_map(Vec3::to_array).collect());
            }
        }
        record("seed", 0, vec![f64::from(self.world.random().seed())]);
    }
}

/// A mass as the oracle prints one.
pub fn mass_record(m: &Mass) -> Record {
    let Mat3 { rows } = m.inertia;
    let mut numbers = vec![m.mass, m.centre.x, m.centre.y, m.centre.z];
    numbers.extend(rows.into_iter().flatten());
    Record { what: "mass".into(), index: 0, numbers }
}
