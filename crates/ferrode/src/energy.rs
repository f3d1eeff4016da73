//! Energy of a world, to see whether a simulation is to be believed.

use crate::World;
use ferrode_dynamics::Body;

/// Mechanical energy in joules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion: translation and rotation of all dynamic bodies.
    pub kinetic: f64,
    /// Of height in the world's gravity, zero at the origin.
    pub potential: f64,
}

impl Energy {
    /// Kinetic and potential energy together.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }
}

impl World {
    /// The energy of all dynamic bodies. Springs (soft contacts and joints) are not counted.
    pub fn energy(&self) -> Energy {
        let g = self.gravity();
        let mut energy = Energy::default();
        for (_, body) in self.bodies().filter(|(_, body)| !body.is_kinematic()) {
            energy.kinetic += body.kinetic_energy();
            energy.potential += potential(body, g);
        }
        energy
    }
}

fn potential(body: &Body, g: ferrode_math::Vec3) -> f64 {
    if body.gravity_mode() { -body.mass().mass * g.dot(body.position()) } else { 0.0 }
}
