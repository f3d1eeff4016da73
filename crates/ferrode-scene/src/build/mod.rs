//! Makes a [`ferrode::World`] of a [`Scene`], in which everything is found by its name in the file.
//!
//! - A link that can move is a body. The body's frame is that of the link's inertial: its origin is the centre of
//!   mass. [`NamedWorld::link_pose`] gives the link's own frame.
//! - A link of a static model is no body: its collisions are fixed in the world.
//! - Joints are attached child first, so that positions and velocities have the file's sign: those of the child
//!   relative to the parent. They are 0 where the file puts the links.
//! - Springs, damping and friction of an axis are constraint rows, so that stiff ones are stable at any step size;
//!   see [`passive`](self) below.
//!
//! ```
//! use ferrode_scene::{BuildOptions, LoadOptions, build, load_str};
//!
//! let text = r#"
//! <sdf version="1.7">
//!   <world name="w">
//!     <model name="pendulum">
//!       <link name="rod"><pose>0 0 -1 0 0 0</pose></link>
//!       <joint name="pivot" type="revolute">
//!         <pose>0 0 1 0 0 0</pose>
//!         <parent>world</parent><child>rod</child>
//!         <axis><xyz>0 1 0</xyz><dynamics><damping>0.1</damping></dynamics></axis>
//!       </joint>
//!     </model>
//!   </world>
//! </sdf>"#;
//! let loaded = load_str("pendulum.sdf", text, &LoadOptions::default())?;
//! let mut world = build(&loaded.scene, &BuildOptions::default())?;
//! world.add_effort(world.joint("pivot").expect("as in the file").id(), 0, 3.0)?;
//! world.step()?;
//! let pivot = world.joint("pivot").expect("as in the file");
//! assert!(pivot.velocity(0).unwrap() > 0.0);
//! assert_eq!(pivot.unit(0), Some("rad"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Springs, damping and friction of an axis
//! A damper of `c` N·m·s/rad is a motor that aims at rest, with unlimited force but softened by CFM = 1/c: the row then
//! says λ = −c v at the *end* of the step, an implicit damper that takes energy at any step size. A spring joins in as
//! ERP and CFM of the same row. Coulomb friction is a motor that aims at rest with its force limited to the friction.
//! Angular axes get these rows from an angular motor beside the joint, so that the joint's own motor stays free for
//! whoever drives it; a prismatic axis needs its own motor for them.
//!
//! # Screws, gearboxes and joints that mimic others
//! Their axes are coupled by forces before each step, which act on all bodies concerned, so that a leader feels its
//! follower. The coupling is as exact as the forces are foreseeable: a step late for those that the step's own
//! constraints bring.

mod adopt;
mod bodies;
mod check;
mod connect;
mod coupling;
mod named;
mod passive;
mod planar;
mod shapes;
mod solids;

use ferrode::{
    DirectSettings, Error as EngineError, FrictionLaw, Pose, Quat, Softness, Stepper, Vec3, World,
};

use crate::description::{FrictionModel, JointId, LinkId, OdeSolver, Scene};
use crate::error::{Notes, Result, SceneError, Warning, WarningKind};
use crate::source::Origin;

pub use connect::AxisMotor;
pub use named::{NamedJoint, NamedLink};

/// How to build a world.
#[derive(Clone, Debug, Default)]
pub struct BuildOptions {
    /// The step size in seconds, in place of the file's. Soft contacts, stops, springs and dampers depend on it.
    pub step: Option<f64>,
    /// The stepper, in place of the file's.
    pub stepper: Option<Stepper>,
    /// A warning is an error.
    pub strict: bool,
}

/// A world in which everything is found by its name in the file.
#[derive(Clone, Debug)]
pub struct NamedWorld {
    /// The world. It may be changed freely, but what it holds for the scene must stay in it, and
    /// [`NamedWorld::step`] is to step it: springs, couplings and turns are kept up there.
    pub world: World,
    /// The description it was built from.
    pub scene: Scene,
    /// What could not be built as the file says.
    pub warnings: Vec<Warning>,
    step_size: f64,
    links: Vec<bodies::BuiltLink>,
    joints: Vec<Option<connect::BuiltJoint>>,
    passive: Vec<passive::Passive>,
    couplings: Vec<coupling::Coupling>,
}

/// The softness of a world that the file leaves hard: ODE's default CFM in double precision. Without any, redundant
/// constraints have no unique forces.
const LEAST_CFM: f64 = 1e-10;

/// Builds a world.
///
/// # Errors
/// A [`SceneError`] that names the element whose numbers the engine refuses, or that names by its place what is not in
/// the scene; or a step size that is not positive. With [`BuildOptions::strict`], also
/// whatever would be a warning.
pub fn build(scene: &Scene, options: &BuildOptions) -> Result<NamedWorld> {
    let mut notes = Notes::default();
    check::check(scene)?;
    let step_size = options.step.unwrap_or(scene.physics.max_step_size);
    if !(step_size > 0.0 && step_size.is_finite()) {
        let file = scene.models.first().map_or("", |model| model.origin.source().name());
        return Err(SceneError::in_file(file, format!("the step size must be positive, found {step_size}")));
    }
    let mut world = World::new();
    set_up(&mut world, scene, options, &mut notes).map_err(|error| refused_settings(scene, &error))?;
    let links = bodies::add_links(&mut world, scene, step_size, &mut notes)?;
    let joints = connect::add_joints(&mut world, scene, &links, step_size, &mut notes)?;
    shapes::exclude_pairs(&mut world, scene, &links)?;
    let mut built = NamedWorld {
        world,
        scene: scene.clone(),
        warnings: Vec::new(),
        step_size,
        links,
        joints,
        passive: Vec::new(),
        couplings: Vec::new(),
    };
    passive::add(&mut built, &mut notes)?;
    coupling::add(&mut built, &mut notes);
    built.warnings = notes.into_warnings();
    if options.strict
        && let Some(first) = built.warnings.first()
    {
        return Err(SceneError::from_warning(first.clone(), built.warnings.len() - 1));
    }
    Ok(built)
}

fn set_up(
    world: &mut World,
    scene: &Scene,
    options: &BuildOptions,
    notes: &mut Notes,
) -> std::result::Result<(), EngineError> {
    let (physics, ode) = (&scene.physics, &scene.physics.ode);
    world.set_gravity(scene.gravity)?;
    world.set_erp(ode.erp)?;
    world.set_cfm(ode.cfm.max(LEAST_CFM))?;
    world.set_contact_max_correcting_velocity(ode.contact_max_correcting_vel)?;
    world.set_contact_surface_layer(ode.contact_surface_layer)?;
    let mut quick = *world.quick();
    (quick.iterations, quick.over_relaxation) = (ode.iterations, ode.sor);
    world.set_quick(quick)?;
    world.set_max_contacts(u16::try_from(physics.max_contacts).unwrap_or(u16::MAX));
    world.stepper = options.stepper.unwrap_or(match ode.solver {
        OdeSolver::World => Stepper::Direct,
        OdeSolver::Quick => Stepper::Quick,
    });
    let model = match ode.friction_model {
        FrictionModel::Pyramid => return Ok(()),
        FrictionModel::Box => "box",
        FrictionModel::Cone => {
            let cone = DirectSettings { friction: FrictionLaw::Cone, ..*world.direct() };
            world.set_direct(cone);
            if world.stepper == Stepper::Direct {
                return Ok(());
            }
            "cone"
        }
    };
    let file = scene.models.first().map_or("", |model| model.origin.source().name());
    let message =
        format!("the {model} model of friction is not supported by this stepper: the pyramid model holds");
    notes.push(Warning::in_file(WarningKind::NotSupported, file, message));
    Ok(())
}

fn refused_settings(scene: &Scene, error: &EngineError) -> SceneError {
    let file = scene.models.first().map_or("", |model| model.origin.source().name());
    SceneError::in_file(file, format!("the engine refuses the physics settings: {error}"))
}

/// An error of the engine, at the element that led to it.
fn refused(origin: &Origin, what: &str, error: impl std::fmt::Display) -> SceneError {
    SceneError::new(origin.clone(), format!("the engine refuses {what}: {error}"))
}

/// A spring and damper as ERP and CFM; `None` if both are zero.
fn softness(stiffness: f64, damping: f64, step: f64) -> Option<Softness> {
    Softness::from_spring(stiffness, damping, step).ok()
}

/// The angle about `axis` of a rotation, within half a turn: twice that of the part of the quaternion along it.
fn twist_angle(rotation: Quat, axis: Vec3) -> f64 {
    let pi = std::f64::consts::PI;
    let angle = 2.0 * ferrode::math::real::atan2(rotation.imaginary().dot(axis), rotation.w);
    if angle > pi {
        angle - 2.0 * pi
    } else if angle < -pi {
        angle + 2.0 * pi
    } else {
        angle
    }
}

impl NamedWorld {
    /// The step size in seconds that the world was built for.
    pub fn step_size(&self) -> f64 {
        self.step_size
    }

    /// One step of [`NamedWorld::step_size`] seconds: springs and couplings are brought up to date, and the world is
    /// stepped.
    ///
    /// # Errors
    /// As [`ferrode::World::step`].
    pub fn step(&mut self) -> std::result::Result<ferrode::Step, EngineError> {
        self.update_passive()?;
        let step = self.world.step(self.step_size)?;
        self.follow_turns();
        Ok(step)
    }

    /// The body of a link; `None` for one of a static model.
    pub fn link_body(&self, link: LinkId) -> Option<ferrode::BodyKey> {
        self.links.get(link.0)?.body
    }

    /// The geoms of a link, in the order of its collisions; those that could not be built are missing.
    pub fn link_geoms(&self, link: LinkId) -> &[ferrode::GeomKey] {
        self.links.get(link.0).map_or(&[], |link| &link.geoms)
    }

    /// The frame of a link in the world, now. That of a link the scene does not have is the world's.
    pub fn link_pose(&self, link: LinkId) -> Pose {
        let Some(described) = self.scene.links.get(link.0) else { return Pose::IDENTITY };
        match self.link_body(link).and_then(|body| self.world.body(body).ok()) {
            Some(body) => body.pose() * described.inertial.pose.inverse(),
            None => described.pose,
        }
    }

    /// The velocity of a link's origin in m/s and its angular velocity in rad/s, in the world.
    pub fn link_velocity(&self, link: LinkId) -> (Vec3, Vec3) {
        match self.link_body(link).and_then(|body| self.world.body(body).ok()) {
            Some(body) => (body.point_velocity(self.link_pose(link).position), body.angular_velocity()),
            None => (Vec3::ZERO, Vec3::ZERO),
        }
    }

    /// Fixes a link where it is now.
    ///
    /// # Errors
    /// As [`ferrode::World::add_fixed`]. A static link is fixed already.
    pub fn weld(&mut self, link: LinkId) -> std::result::Result<(), EngineError> {
        if let Some(body) = self.link_body(link) {
            self.world.add_fixed(Some(body), None)?;
        }
        Ok(())
    }

    /// The link of this name: scoped (`robot::base`), or bare (`base`) if only one link has it.
    pub fn link(&self, name: &str) -> Option<NamedLink<'_>> {
        let index = crate::description::find_index(&self.scene.links, name, |link| &link.name)?;
        Some(NamedLink::new(self, LinkId(index)))
    }

    /// The joint of this name: scoped (`robot::elbow`), or bare (`elbow`) if only one joint has it.
    pub fn joint(&self, name: &str) -> Option<NamedJoint<'_>> {
        let index = crate::description::find_index(&self.scene.joints, name, |joint| &joint.name)?;
        Some(NamedJoint::new(self, JointId(index)))
    }
}
