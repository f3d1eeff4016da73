//! Holds joints where they start, like a spring and a damper, through their motors.
//!
//! A PD law evaluated at the start of a step, τ = KP (q₀ − q) − KD q̇, blows up once KD·h exceeds about the inertia
//! that the joint moves: a robot's wrist at usual gains. So the law is taken at the end of the step,
//!
//! ```text
//! τ = KP (q₀ − q − h q̇′) − KD q̇′    ⇔    q̇′ + CFM τ = v,    CFM = 1/(h KP + KD),    v = KP (q₀ − q)/(h KP + KD)
//! ```
//!
//! which is the row of a velocity motor with v as its wanted velocity and softness CFM: the same numbers as those of
//! a soft stop (ODE manual, "How to use ERP and CFM"), with v = ERP/h · (q₀ − q). The solver finds τ together with all
//! other forces, so that any gains are stable. Unlike a soft stop, the motor has a largest force, which is the
//! effort that the file allows, and leaves the joint its own stops.

use crate::exit::Failure;
use crate::simulation::Simulation;
use ferrode::{JointKey, Param, Softness};
use ferrode_scene::description::JointId;

/// The motors that hold, and where.
#[derive(Clone, Debug)]
pub struct Hold {
    axes: Vec<HeldAxis>,
    /// ERP/h: wanted velocity per position error, 1/s.
    rate: f64,
}

#[derive(Clone, Debug)]
struct HeldAxis {
    joint: JointId,
    axis: usize,
    key: JointKey,
    group: usize,
    /// The engine's velocity per velocity of the file's axis: 1 or −1.
    sign: f64,
    start: f64,
}

impl Hold {
    /// Takes over the motors of all joints that have any, to hold them where they are now with gains `kp` and `kd`.
    ///
    /// # Errors
    /// There is no joint to hold, or the engine refuses a number.
    pub fn new(simulation: &mut Simulation, [kp, kd]: [f64; 2]) -> Result<Self, Failure> {
        let h = simulation.step_size();
        let softness = Softness::from_spring(kp, kd, h).map_err(Failure::usage)?;
        let mut axes = Vec::new();
        for index in 0..simulation.scene().joints.len() {
            let joint = JointId(index);
            for axis in 0..2 {
                let Some(start) = simulation.joint_position(joint, axis) else { continue };
                let Some((key, group, sign)) = simulation.take_motor(joint, axis) else { continue };
                let described = &simulation.scene().joints[index];
                let limits = if axis == 0 { &described.axis } else { &described.axis2 };
                let effort = limits.as_ref().and_then(|axis| axis.limits.effort).unwrap_or(f64::INFINITY);
                let world = simulation.world_mut();
                for (param, value) in [(Param::FMax, effort), (Param::Cfm, softness.cfm), (Param::Vel, 0.0)] {
                    world.set_joint_param(key, param, group, value).map_err(Failure::file)?;
                }
                axes.push(HeldAxis { joint, axis, key, group, sign, start });
            }
        }
        if axes.is_empty() {
            return Err(Failure::usage("--hold: there is no joint with a motor to hold"));
        }
        Ok(Self { axes, rate: softness.erp / h })
    }

    /// Aims the motors anew; before each step.
    ///
    /// # Errors
    /// The engine refuses a number.
    pub fn aim(&self, simulation: &mut Simulation) -> Result<(), Failure> {
        for held in &self.axes {
            let Some(position) = simulation.joint_position(held.joint, held.axis) else { continue };
            let velocity = held.sign * self.rate * (held.start - position);
            // A quarantined body may have left its joint with a position that is no number; it is not stepped any more.
            if velocity.is_finite() {
                simulation
                    .world_mut()
                    .set_joint_param(held.key, Param::Vel, held.group, velocity)
                    .map_err(Failure::file)?;
            }
        }
        Ok(())
    }
}
