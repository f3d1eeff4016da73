//! Rigid bodies.

use crate::arena::{NIL, key_type};
use crate::ends::Frame;
use crate::error::{finite, finite_number, not_nan, unit};
use crate::joint::Link;
use crate::sleep::Idleness;
use crate::{AutoDisable, Damping, Error, Mass};
use core::fmt;
use ferrode_math::{Mat3, Pose, Quat, Vec3, rotation};
use std::sync::Arc;

key_type!(
    /// Names a body of a world. A stale key, or a key of another world, finds nothing.
    BodyKey,
    "body"
);

/// Called when a step has moved the body, before damping and before the force accumulators are cleared: the body shows
/// its exact velocities, and changes that the callback makes to it hold.
pub type MovedCallback = Arc<dyn Fn(BodyKey, &mut Body) + Send + Sync>;

/// How a step turns angular velocity into rotation (ODE manual, `dBodySetFiniteRotationMode`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum FiniteRotation {
    /// Infinitesimal: cheap, and inaccurate at high speed. The default.
    #[default]
    Off,
    /// Finite: exact for a constant angular velocity.
    Full,
    /// Finite about a world axis, infinitesimal across it: for wheels.
    Axis {
        /// Unit vector in the world frame.
        axis: Vec3,
        /// ODE turns the part across the axis at half its rate; `true` turns it at its full rate.
        full_rate: bool,
    },
}

/// A rigid body. Its frame's origin is the centre of mass.
///
/// Reach it by [`World::body`](crate::World::body) and [`World::body_mut`](crate::World::body_mut). No setter wakes a
/// sleeping body; [`Body::enable`] does.
#[derive(Clone)]
pub struct Body {
    // State.
    pub(crate) frame: Frame,
    pub(crate) force: Vec3,
    pub(crate) torque: Vec3,
    // Mass.
    pub(crate) mass: Mass,
    pub(crate) inv_mass: f64,
    /// Inverse inertia in the body frame; zero for kinematic bodies.
    pub(crate) inv_inertia: Mat3,
    // How it is stepped.
    pub(crate) enabled: bool,
    pub(crate) quarantined: bool,
    pub(crate) gravity_mode: bool,
    pub(crate) gyroscopic_mode: bool,
    pub(crate) finite_rotation_mode: bool,
    pub(crate) finite_rotation_axis: Vec3,
    pub(crate) finite_rotation_full_rate: bool,
    pub(crate) max_angular_speed: f64,
    pub(crate) damping: Damping,
    pub(crate) auto_disable: AutoDisable,
    pub(crate) idleness: Idleness,
    /// How long `Substep` has seen the body rest, in seconds.
    pub(crate) rest_time: f64,
    /// The bodies that fell asleep together have the same number; 0 for those awake.
    pub(crate) sleep_group: u64,
    pub(crate) moved: Option<MovedCallback>,
    pub(crate) user_data: u64,
    /// Counts changes of the pose, so that others can tell whether they have seen the latest.
    pub(crate) pose_version: u64,
    // Lists.
    pub(crate) first_joint: Link,
    pub(crate) joint_count: usize,
    pub(crate) next: u32,
    pub(crate) prev: u32,
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Body")
            .field("position", &self.frame.position)
            .field("quaternion", &self.frame.quaternion)
            .field("linear_velocity", &self.frame.linear_velocity)
            .field("angular_velocity", &self.frame.angular_velocity)
            .field("mass", &self.mass.mass)
            .field("enabled", &self.enabled)
            .field("kinematic", &self.is_kinematic())
            .finish_non_exhaustive()
    }
}

impl Body {
    pub(crate) fn new(auto_disable: AutoDisable, damping: Damping, max_angular_speed: f64) -> Self {
        Self {
            frame: Frame::WORLD,
            force: Vec3::ZERO,
            torque: Vec3::ZERO,
            mass: Mass::default(),
            inv_mass: 1.0,
            inv_inertia: Mat3::IDENTITY,
            enabled: true,
            quarantined: false,
            gravity_mode: true,
            gyroscopic_mode: true,
            finite_rotation_mode: false,
            finite_rotation_axis: Vec3::ZERO,
            finite_rotation_full_rate: false,
            max_angular_speed,
            damping,
            auto_disable,
            idleness: Idleness::new(&auto_disable),
            rest_time: 0.0,
            sleep_group: 0,
            moved: None,
            user_data: 0,
            pose_version: 0,
            first_joint: NIL,
            joint_count: 0,
            next: NIL,
            prev: NIL,
        }
    }

    // ---- pose and velocity ----

    /// Centre of mass, in world coordinates.
    pub fn position(&self) -> Vec3 {
        self.frame.position
    }

    /// Rotation from body to world, as a unit quaternion.
    pub fn quaternion(&self) -> Quat {
        self.frame.quaternion
    }

    /// Rotation from body to world, as a matrix.
    pub fn rotation(&self) -> Mat3 {
        self.frame.rotation
    }

    /// Position and rotation.
    pub fn pose(&self) -> Pose {
        Pose::new(self.frame.position, self.frame.quaternion)
    }

    /// Velocity of the centre of mass, world frame, m/s.
    pub fn linear_velocity(&self) -> Vec3 {
        self.frame.linear_velocity
    }

    /// Angular velocity, world frame, rad/s.
    pub fn angular_velocity(&self) -> Vec3 {
        self.frame.angular_velocity
    }

    /// A number that changes whenever the pose does.
    pub fn pose_version(&self) -> u64 {
        self.pose_version
    }

    /// Moves the centre of mass to a world point.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_position(&mut self, position: Vec3) -> Result<(), Error> {
        self.frame.position = finite("position", position)?;
        self.pose_changed();
        Ok(())
    }

    /// Sets the rotation by a quaternion, which is normalised.
    ///
    /// # Errors
    /// [`Error::NotARotation`] if it is zero or not finite.
    pub fn set_quaternion(&mut self, q: Quat) -> Result<(), Error> {
        let q = q.normalized().ok_or(Error::NotARotation { what: "the quaternion" })?;
        self.frame.quaternion = q;
        self.frame.rotation = q.to_matrix();
        self.pose_changed();
        Ok(())
    }

    /// Sets the rotation by a matrix, as ODE does: the matrix is orthogonalised by ODE's rule, the quaternion comes from
    /// the matrix as given. For a proper rotation matrix the two agree; for others only after the next step. See
    /// [`Body::set_rotation_orthogonal`].
    ///
    /// # Errors
    /// [`Error::NotARotation`] if it can't be orthogonalised.
    pub fn set_rotation(&mut self, m: &Mat3) -> Result<(), Error> {
        let bad = Error::NotARotation { what: "the rotation matrix" };
        if !m.is_finite() {
            return Err(bad);
        }
        let rotation = rotation::orthogonalize_as_ode(m).ok_or(bad.clone())?;
        self.frame.quaternion = Quat::from_matrix(m).normalized().ok_or(bad)?;
        self.frame.rotation = rotation;
        self.pose_changed();
        Ok(())
    }

    /// Sets the rotation by the proper rotation nearest to a matrix, so that quaternion and matrix always agree.
    ///
    /// # Errors
    /// [`Error::NotARotation`] if it can't be orthogonalised.
    pub fn set_rotation_orthogonal(&mut self, m: &Mat3) -> Result<(), Error> {
        let bad = Error::NotARotation { what: "the rotation matrix" };
        if !m.is_finite() {
            return Err(bad);
        }
        let m = rotation::orthogonalize(m).ok_or(bad)?;
        self.set_quaternion(Quat::from_matrix(&m))
    }

    /// Sets position and rotation.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotARotation`]; then nothing is changed.
    pub fn set_pose(&mut self, pose: Pose) -> Result<(), Error> {
        finite("position", pose.position)?;
        self.set_quaternion(pose.rotation)?;
        self.set_position(pose.position)
    }

    /// Sets the velocity of the centre of mass, world frame, m/s.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_linear_velocity(&mut self, v: Vec3) -> Result<(), Error> {
        self.frame.linear_velocity = finite("linear velocity", v)?;
        Ok(())
    }

    /// Sets the angular velocity, world frame, rad/s.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_angular_velocity(&mut self, w: Vec3) -> Result<(), Error> {
        self.frame.angular_velocity = finite("angular velocity", w)?;
        Ok(())
    }

    fn pose_changed(&mut self) {
        self.pose_version = self.pose_version.wrapping_add(1);
    }

    // ---- mass ----

    /// The mass properties.
    pub fn mass(&self) -> &Mass {
        &self.mass
    }

    /// 1/mass; 0 for kinematic bodies.
    pub fn inv_mass(&self) -> f64 {
        self.inv_mass
    }

    /// Sets mass and inertia, and makes the body dynamic.
    ///
    /// # Errors
    /// [`Error::MassNotPositive`], [`Error::InertiaNotPositiveDefinite`]; [`Error::CentreOfMassOffOrigin`], whose text
    /// says how to shift it.
    pub fn set_mass(&mut self, mass: &Mass) -> Result<(), Error> {
        mass.check()?;
        if mass.centre.abs_max() > f64::EPSILON {
            return Err(Error::CentreOfMassOffOrigin { centre: mass.centre });
        }
        let inverse = mass.inertia.inverse().filter(Mat3::is_finite);
        self.inv_inertia = inverse.ok_or(Error::InertiaNotPositiveDefinite { about: "the body's origin" })?;
        self.inv_mass = 1.0 / mass.mass;
        self.mass = *mass;
        Ok(())
    }

    /// Whether the body moves by its velocity alone, and no force changes that.
    pub fn is_kinematic(&self) -> bool {
        self.inv_mass == 0.0
    }

    /// Makes the body kinematic: it keeps the velocity it is given, whatever pushes it. Its mass is remembered.
    pub fn set_kinematic(&mut self) {
        self.inv_mass = 0.0;
        self.inv_inertia = Mat3::ZERO;
    }

    /// Makes a kinematic body dynamic again, with the mass that it had.
    pub fn set_dynamic(&mut self) {
        let mass = self.mass;
        // The stored mass was checked when it was set.
        if self.set_mass(&mass).is_err() {
            debug_assert!(false, "a body's mass is always valid");
        }
    }

    /// Inertia tensor in the world frame.
    #[inline]
    pub fn inertia_world(&self) -> Mat3 {
        self.frame.rotation * self.mass.inertia * self.frame.rotation.transpose()
    }

    /// Kinetic energy in joules; of a kinematic body, that of its stored mass.
    pub fn kinetic_energy(&self) -> f64 {
        let (v, w) = (self.frame.linear_velocity, self.frame.angular_velocity);
        0.5 * (self.mass.mass * v.length_squared() + w.dot(self.inertia_world() * w))
    }

    // ---- forces ----

    /// Force gathered for the next step, world frame, N.
    pub fn force(&self) -> Vec3 {
        self.force
    }

    /// Torque about the centre of mass gathered for the next step, world frame, N m.
    pub fn torque(&self) -> Vec3 {
        self.torque
    }

    /// Overwrites the gathered force: zero it before waking a body that was pushed in its sleep.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_force(&mut self, force: Vec3) -> Result<(), Error> {
        self.force = finite("force", force)?;
        Ok(())
    }

    /// Overwrites the gathered torque.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_torque(&mut self, torque: Vec3) -> Result<(), Error> {
        self.torque = finite("torque", torque)?;
        Ok(())
    }

    /// Adds a force at the centre of mass, world frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`], as for all functions that add forces; nothing is added then.
    pub fn add_force(&mut self, force: Vec3) -> Result<(), Error> {
        self.force += finite("force", force)?;
        Ok(())
    }

    /// Adds a torque, world frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_torque(&mut self, torque: Vec3) -> Result<(), Error> {
        self.torque += finite("torque", torque)?;
        Ok(())
    }

    /// Adds a force at the centre of mass, given in the body frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_relative_force(&mut self, force: Vec3) -> Result<(), Error> {
        self.add_force(self.frame.rotation * force)
    }

    /// Adds a torque given in the body frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_relative_torque(&mut self, torque: Vec3) -> Result<(), Error> {
        self.add_torque(self.frame.rotation * torque)
    }

    /// Adds a force (world frame) at a world point.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_force_at_position(&mut self, force: Vec3, point: Vec3) -> Result<(), Error> {
        finite("force", force)?;
        finite("point of the force", point)?;
        self.force += force;
        self.torque += (point - self.frame.position).cross(force);
        Ok(())
    }

    /// Adds a force (world frame) at a point of the body frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_force_at_relative_position(&mut self, force: Vec3, point: Vec3) -> Result<(), Error> {
        finite("force", force)?;
        finite("point of the force", point)?;
        self.force += force;
        self.torque += (self.frame.rotation * point).cross(force);
        Ok(())
    }

    /// Adds a force (body frame) at a world point.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_relative_force_at_position(&mut self, force: Vec3, point: Vec3) -> Result<(), Error> {
        self.add_force_at_position(self.frame.rotation * force, point)
    }

    /// Adds a force (body frame) at a point of the body frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn add_relative_force_at_relative_position(&mut self, force: Vec3, point: Vec3) -> Result<(), Error> {
        self.add_force_at_relative_position(self.frame.rotation * force, point)
    }

    // ---- points and vectors ----

    /// World position of a body point.
    pub fn relative_point_position(&self, point: Vec3) -> Vec3 {
        self.frame.to_world_point(point)
    }

    /// World velocity of a body point.
    pub fn relative_point_velocity(&self, point: Vec3) -> Vec3 {
        self.frame.linear_velocity + self.frame.angular_velocity.cross(self.frame.rotation * point)
    }

    /// World velocity of the body's matter at a world point.
    pub fn point_velocity(&self, point: Vec3) -> Vec3 {
        self.frame.linear_velocity + self.frame.angular_velocity.cross(point - self.frame.position)
    }

    /// Body coordinates of a world point.
    pub fn position_relative_point(&self, point: Vec3) -> Vec3 {
        self.frame.to_local_point(point)
    }

    /// A vector from body to world coordinates.
    pub fn vector_to_world(&self, v: Vec3) -> Vec3 {
        self.frame.rotation * v
    }

    /// A vector from world to body coordinates.
    pub fn vector_from_world(&self, v: Vec3) -> Vec3 {
        self.frame.rotation.transpose_mul(v)
    }

    // ---- sleeping ----

    /// Whether the body takes part in steps.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Wakes the body and starts its idle countdowns again.
    pub fn enable(&mut self) {
        self.enabled = true;
        self.idleness.restart(&self.auto_disable);
    }

    /// Takes the body out of steps, until it is enabled or a joint links it to an enabled body. Its velocity stays.
    pub fn disable(&mut self) {
        self.enabled = false;
    }

    /// When the body disables itself.
    pub fn auto_disable(&self) -> &AutoDisable {
        &self.auto_disable
    }

    /// Sets when the body disables itself. A running countdown goes on; a changed sample count starts the averages
    /// anew.
    ///
    /// ODE's flag setter also wakes the body when it clears the flag: that is
    /// [`World::set_body_auto_disable_flag`](crate::World::set_body_auto_disable_flag).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is NaN.
    pub fn set_auto_disable(&mut self, settings: AutoDisable) -> Result<(), Error> {
        let settings = settings.checked()?;
        if settings.average_samples != self.auto_disable.average_samples {
            self.idleness.forget_samples();
        }
        self.auto_disable = settings;
        Ok(())
    }

    /// Whether the body was taken out of the simulation because its state, or a force on it, was not finite. It stands
    /// at its last good pose like a part of the static world.
    pub fn is_quarantined(&self) -> bool {
        self.quarantined
    }

    /// Takes a quarantined body back in. Its force accumulators are cleared.
    pub fn release(&mut self) {
        if self.quarantined {
            self.quarantined = false;
            self.force = Vec3::ZERO;
            self.torque = Vec3::ZERO;
            self.enable();
        }
    }

    // ---- how it is stepped ----

    /// Damping.
    pub fn damping(&self) -> &Damping {
        &self.damping
    }

    /// Sets the damping.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is NaN or a scale is infinite.
    pub fn set_damping(&mut self, damping: Damping) -> Result<(), Error> {
        self.damping = damping.checked()?;
        Ok(())
    }

    /// Angular speed that the body never exceeds, rad/s; ∞ for none.
    pub fn max_angular_speed(&self) -> f64 {
        self.max_angular_speed
    }

    /// Sets the angular speed limit. It acts before the body is moved, so it can tear at joints.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is NaN.
    pub fn set_max_angular_speed(&mut self, speed: f64) -> Result<(), Error> {
        self.max_angular_speed = not_nan("maximum angular speed", speed)?;
        Ok(())
    }

    /// Whether the world's gravity acts on the body.
    pub fn gravity_mode(&self) -> bool {
        self.gravity_mode
    }

    /// Sets whether the world's gravity acts on the body.
    pub fn set_gravity_mode(&mut self, on: bool) {
        self.gravity_mode = on;
    }

    /// Whether the gyroscopic torque acts.
    pub fn gyroscopic_mode(&self) -> bool {
        self.gyroscopic_mode
    }

    /// Sets whether the gyroscopic torque acts.
    pub fn set_gyroscopic_mode(&mut self, on: bool) {
        self.gyroscopic_mode = on;
    }

    /// Whether rotation is updated by finite rotations.
    pub fn finite_rotation_mode(&self) -> bool {
        self.finite_rotation_mode
    }

    /// Switches finite rotations on or off.
    pub fn set_finite_rotation_mode(&mut self, on: bool) {
        self.finite_rotation_mode = on;
    }

    /// The axis of finite rotation, a unit vector in the world frame, or zero.
    pub fn finite_rotation_axis(&self) -> Vec3 {
        self.finite_rotation_axis
    }

    /// Sets the axis about which rotation is finite, world frame; zero makes the whole rotation finite. It counts only
    /// while the finite rotation mode is on.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_finite_rotation_axis(&mut self, axis: Vec3) -> Result<(), Error> {
        self.finite_rotation_axis =
            if axis == Vec3::ZERO { axis } else { unit("finite rotation axis", axis)? };
        Ok(())
    }

    /// How rotation is updated, as mode and axis together say.
    pub fn finite_rotation(&self) -> FiniteRotation {
        match (self.finite_rotation_mode, self.finite_rotation_axis) {
            (false, _) => FiniteRotation::Off,
            (true, Vec3::ZERO) => FiniteRotation::Full,
            (true, axis) => FiniteRotation::Axis { axis, full_rate: self.finite_rotation_full_rate },
        }
    }

    /// Makes partial finite rotation turn the part across the axis at its full rate. ODE turns it at half.
    pub fn set_finite_rotation_full_rate(&mut self, on: bool) {
        self.finite_rotation_full_rate = on;
    }

    /// Sets what is called when a step has moved the body.
    pub fn set_moved_callback(&mut self, callback: Option<MovedCallback>) {
        self.moved = callback;
    }

    /// A number of the caller's.
    pub fn user_data(&self) -> u64 {
        self.user_data
    }

    /// Sets the caller's number.
    pub fn set_user_data(&mut self, data: u64) {
        self.user_data = data;
    }

    /// Number of joints attached to the body.
    pub fn joint_count(&self) -> usize {
        self.joint_count
    }

    /// Whether there is a speed that it may not exceed in spinning.
    pub(crate) fn has_angular_speed_limit(&self) -> bool {
        self.max_angular_speed < f64::INFINITY
    }

    /// Whether state and gathered forces are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let (f, q) = (&self.frame, self.frame.quaternion);
        // 0 times a number is 0 unless the number is infinite or none: one question instead of twenty.
        let vectors = f.position * 0.0
            + f.linear_velocity * 0.0
            + f.angular_velocity * 0.0
            + self.force * 0.0
            + self.torque * 0.0;
        (vectors.x + vectors.y + vectors.z) + (0.0 * q.w + 0.0 * q.x + 0.0 * q.y + 0.0 * q.z) == 0.0
    }
}

impl Damping {
    pub(crate) fn checked(self) -> Result<Self, Error> {
        finite_number("linear damping", self.linear_scale)?;
        finite_number("angular damping", self.angular_scale)?;
        not_nan("linear damping threshold", self.linear_threshold)?;
        not_nan("angular damping threshold", self.angular_threshold)?;
        Ok(self)
    }
}

impl AutoDisable {
    pub(crate) fn checked(self) -> Result<Self, Error> {
        not_nan("auto-disable linear threshold", self.linear_threshold)?;
        not_nan("auto-disable angular threshold", self.angular_threshold)?;
        not_nan("auto-disable time", self.time)?;
        Ok(self)
    }
}
