//! What can be chosen about `Substep`.

use super::soft::Spring;
use crate::Error;
use crate::error::not_nan;
use ferrode_math::simd::Level;

/// How `Substep` steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SubstepSettings {
    /// Parts that a step is divided into; 6 by default. More make contacts, joints and high mass ratios stiffer, at proportional cost.
    pub substeps: u32,
    /// How contacts spring back, unless their surface says so itself: 68 Hz, damping ratio 0.5. The frequency is capped at
    /// 0.19 of the rate of substeps, beyond which tall piles are unstable.
    pub contact: Spring,
    /// How joints spring back, unless they have a CFM of their own: 68 Hz, damping ratio 5; capped as for contacts.
    pub joint: Spring,
    /// Whether connected sets of joints are solved together and exactly, as articulations, where nothing is said of a joint
    /// ([`World::set_joint_exact`](crate::World::set_joint_exact)). Yes by default: it costs little for chains, ragdolls, robots and
    /// what else has few loops. Sets of many loops, such as nets, are left to sweeps from joint to joint, and so are the joints' springs.
    pub exact_joints: bool,
    /// Largest speed in m/s at which contacts push bodies apart that overlap; 3 by default. The world's and the
    /// surface's limits hold as well.
    pub push_out_speed: f64,
    /// Speed in m/s below which a body counts as resting, at the part of its shape furthest out; 0.05 by default, 0 keeps
    /// everything awake. ODE's auto-disable, which judges each body alone, works beside it for bodies that have it.
    pub sleep_speed: f64,
    /// Seconds that all bodies of an island must rest before it sleeps; 0.5 by default.
    pub sleep_time: f64,
    /// The SIMD lanes to use; `None` for the fastest that the machine has. All give the same bits.
    pub lanes: Option<Level>,
}

impl Default for SubstepSettings {
    fn default() -> Self {
        Self {
            substeps: 6,
            contact: Spring { frequency: 68.0, damping_ratio: 0.5 },
            joint: Spring { frequency: 68.0, damping_ratio: 5.0 },
            exact_joints: true,
            push_out_speed: 3.0,
            sleep_speed: 0.05,
            sleep_time: 0.5,
            lanes: None,
        }
    }
}

impl SubstepSettings {
    /// The error that names the first unusable number.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check(&self) -> Result<(), Error> {
        let out_of_range = |what, value, expected| Err(Error::OutOfRange { what, value, expected });
        if !(1..=1000).contains(&self.substeps) {
            return out_of_range("substeps", f64::from(self.substeps), "a number from 1 to 1000");
        }
        for (what, spring) in [("contact frequency", self.contact), ("joint frequency", self.joint)] {
            if !(spring.frequency > 0.0 && spring.frequency.is_finite()) {
                return out_of_range(what, spring.frequency, "a positive number of hertz");
            }
            if !(spring.damping_ratio >= 0.0 && spring.damping_ratio.is_finite()) {
                return out_of_range("damping ratio", spring.damping_ratio, "a finite number of at least 0");
            }
        }
        for (what, value) in [
            ("push-out speed", self.push_out_speed),
            ("sleep speed", self.sleep_speed),
            ("sleep time", self.sleep_time),
        ] {
            if not_nan(what, value)? < 0.0 {
                return out_of_range(what, value, "at least 0");
            }
        }
        Ok(())
    }
}
