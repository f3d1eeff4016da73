//! What a joint sees of the bodies at its ends.

use ferrode_math::{Mat3, Quat, Vec3};

/// Pose and velocity of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Centre of mass in the world.
    pub position: Vec3,
    /// Rotation from body to world.
    pub rotation: Mat3,
    /// The same rotation as a unit quaternion.
    pub quaternion: Quat,
    /// World frame.
    pub linear_velocity: Vec3,
    /// World frame.
    pub angular_velocity: Vec3,
}

impl Frame {
    /// The static world: at the origin, unrotated, at rest.
    pub const WORLD: Self = Self {
        position: Vec3::ZERO,
        rotation: Mat3::IDENTITY,
        quaternion: Quat::IDENTITY,
        linear_velocity: Vec3::ZERO,
        angular_velocity: Vec3::ZERO,
    };

    /// A world point in body coordinates.
    pub fn to_local_point(self, p: Vec3) -> Vec3 {
        self.rotation.transpose_mul(p - self.position)
    }

    /// A body point in world coordinates.
    pub fn to_world_point(self, p: Vec3) -> Vec3 {
        self.position + self.rotation * p
    }
}

/// The two ends of a joint, in the joint's own order: the first is a body whenever the joint is attached.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ends<'a> {
    /// The first body; `None` in limbo.
    pub first: Option<&'a Frame>,
    /// The second body; `None` stands for the static world.
    pub second: Option<&'a Frame>,
    /// Whether the joint was attached as (world, body): the caller's second body is the joint's first.
    pub reverse: bool,
}

impl<'a> Ends<'a> {
    /// The first body, or the static world in limbo.
    pub fn a(&self) -> &'a Frame {
        self.first.unwrap_or(&Frame::WORLD)
    }

    /// The second body, or the static world.
    pub fn b(&self) -> &'a Frame {
        self.second.unwrap_or(&Frame::WORLD)
    }

    /// Whether both ends are bodies.
    pub fn two(&self) -> bool {
        self.second.is_some()
    }

    /// −1 for a reversed joint, else 1.
    pub fn sign(&self) -> f64 {
        if self.reverse { -1.0 } else { 1.0 }
    }

    /// Relative rotation conj(q₁) q₂.
    pub fn relative_rotation(&self) -> Quat {
        self.a().quaternion.conjugate() * self.b().quaternion
    }
}

/// What a joint may know of the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepContext {
    /// Step size h, in seconds.
    pub h: f64,
    /// 1/h.
    pub fps: f64,
    /// The world's ERP.
    pub erp: f64,
    /// The world's CFM.
    pub cfm: f64,
    /// Cap on the push-out velocity of contacts.
    pub contact_max_correcting_velocity: f64,
    /// Depth that contacts may keep.
    pub contact_surface_layer: f64,
}

impl StepContext {
    /// fps · ERP: the factor from a position error to a velocity.
    pub fn k(&self) -> f64 {
        self.fps * self.erp
    }
}
