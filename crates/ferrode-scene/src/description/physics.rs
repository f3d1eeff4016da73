//! Step size and solver.

/// How to step the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Physics {
    /// The engine the file was written for: `ode`, `dart`, …
    pub engine: String,
    /// Step size, s.
    pub max_step_size: f64,
    /// How many times faster than real time to run; 0: as fast as possible.
    pub real_time_factor: f64,
    /// Most contacts between two collisions.
    pub max_contacts: u32,
    /// ODE's settings.
    pub ode: OdePhysics,
}

impl Default for Physics {
    fn default() -> Self {
        Self {
            engine: "ode".to_owned(),
            max_step_size: 0.001,
            real_time_factor: 1.0,
            max_contacts: 20,
            ode: OdePhysics::default(),
        }
    }
}

/// ODE's settings.
#[derive(Clone, Debug, PartialEq)]
pub struct OdePhysics {
    /// The solver.
    pub solver: OdeSolver,
    /// Iterations of the quick solver.
    pub iterations: u32,
    /// Over-relaxation of the quick solver.
    pub sor: f64,
    /// The friction model.
    pub friction_model: FrictionModel,
    /// Constraint force mixing of the world.
    pub cfm: f64,
    /// Error reduction of the world.
    pub erp: f64,
    /// Largest correcting velocity of a contact, m/s.
    pub contact_max_correcting_vel: f64,
    /// Depth that contacts may keep, m.
    pub contact_surface_layer: f64,
}

impl Default for OdePhysics {
    fn default() -> Self {
        Self {
            solver: OdeSolver::Quick,
            iterations: 50,
            sor: 1.3,
            friction_model: FrictionModel::Pyramid,
            cfm: 0.0,
            erp: 0.2,
            contact_max_correcting_vel: 100.0,
            contact_surface_layer: 0.001,
        }
    }
}

/// Which solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OdeSolver {
    /// The exact one (`world`).
    World,
    /// The iterative one (`quick`).
    Quick,
}

/// How friction is bounded by the normal force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionModel {
    /// Each direction by itself.
    Pyramid,
    /// A constant in each direction.
    Box,
    /// The length of the friction force.
    Cone,
}
