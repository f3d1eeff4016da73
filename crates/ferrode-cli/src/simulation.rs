//! A file's world, set up as the command line asks, and stepped.

use crate::args::{FileArgs, SetupArgs};
use crate::exit::Failure;
use crate::hold::Hold;
use ferrode::{GeomKey, JointKey, Material, Plane, Pose, Step, Vec3, World};
use ferrode_scene::description::{JointId, LinkId};
use ferrode_scene::{BuildOptions, LoadOptions, NamedWorld, Scene, Warning, WarningKind, build, load};

/// A file's world, set up and ready to step.
#[derive(Clone, Debug)]
pub struct Simulation {
    named: NamedWorld,
    hold: Option<Hold>,
    /// What the file says that is not understood, not supported, or looks like a mistake.
    pub warnings: Vec<Warning>,
}

/// Height of the lowest point of all geoms on bodies; infinite if there are none.
fn lowest_point(world: &World) -> f64 {
    let on_bodies = world.geoms().filter(|info| info.body.is_some());
    let boxes = on_bodies.filter_map(|info| world.geom(info.key).ok()).map(|geom| geom.aabb());
    boxes.map(|aabb| aabb.min.z).fold(f64::INFINITY, f64::min)
}

/// How the command line wants files to be read.
pub fn load_options(args: &FileArgs) -> LoadOptions {
    LoadOptions { model_paths: args.model_path.clone(), strict: args.strict, ..LoadOptions::default() }
}

impl Simulation {
    /// Reads a file and builds its world.
    ///
    /// # Errors
    /// The file is wrong, cannot be simulated, or lacks a link that is to be fixed.
    pub fn new(file: &FileArgs, setup: &SetupArgs) -> Result<Self, Failure> {
        let mut loaded = load(&file.file, &load_options(file)).map_err(Failure::told)?;
        let options = BuildOptions { step: setup.dt, strict: file.strict, ..BuildOptions::default() };
        loaded.scene.translate_moving(Vec3::new(0.0, 0.0, setup.height.unwrap_or(0.0)));
        let mut named = build(&loaded.scene, &options).map_err(Failure::told)?;
        if setup.ground && setup.height.is_none() {
            let lift = -lowest_point(&named.world).min(0.0);
            if lift > 0.0 {
                loaded.scene.translate_moving(Vec3::new(0.0, 0.0, lift));
                named = build(&loaded.scene, &options).map_err(Failure::told)?;
            }
        }
        let warnings = loaded.warnings.into_iter().chain(named.warnings.iter().cloned()).collect();
        let mut simulation = Self { named, hold: None, warnings };
        if setup.ground {
            simulation.add_ground().map_err(Failure::file)?;
        }
        for name in &setup.fix {
            let link = simulation.find_link(name)?;
            simulation.named.weld(link).map_err(Failure::file)?;
        }
        if let Some(gains) = setup.hold {
            simulation.hold = Some(Hold::new(&mut simulation, gains)?);
        }
        Ok(simulation)
    }

    /// The plane z = 0, as rough as SDF's surfaces are by default.
    fn add_ground(&mut self) -> Result<(), ferrode::Error> {
        let plane = self.named.world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
        self.named.world.set_material(plane, Material::with_friction(1.0))
    }

    fn find_link(&self, name: &str) -> Result<LinkId, Failure> {
        if let Some(link) = self.named.link(name) {
            return Ok(link.id());
        }
        let links = &self.scene().links;
        let names: Vec<&str> = links.iter().map(|link| link.name.as_str()).take(12).collect();
        let more = if links.len() > names.len() { ", …" } else { "" };
        Err(Failure::usage(format!(
            "--fix {name}: no link has this name, or several have; there are: {}{more}",
            names.join(", ")
        )))
    }

    /// Makes one step.
    ///
    /// # Errors
    /// The engine refuses the step, or a motor's number.
    pub fn step(&mut self) -> Result<Step, Failure> {
        if let Some(hold) = self.hold.take() {
            let aimed = hold.aim(self);
            self.hold = Some(hold);
            aimed?;
        }
        self.named.step().map_err(Failure::file)
    }

    /// The step size, s.
    pub fn step_size(&self) -> f64 {
        self.named.step_size()
    }

    /// What the file says.
    pub fn scene(&self) -> &Scene {
        &self.named.scene
    }

    /// The engine's world.
    pub fn world(&self) -> &World {
        &self.named.world
    }

    /// The engine's world, to change.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.named.world
    }

    /// Whether a link can move.
    pub fn moves(&self, link: LinkId) -> bool {
        self.named.link_body(link).is_some()
    }

    /// The body of a link, unless it cannot move.
    #[cfg(feature = "rerun")]
    pub fn link_body(&self, link: LinkId) -> Option<ferrode::prelude::BodyKey> {
        self.named.link_body(link)
    }

    /// The link frame in the world.
    pub fn link_pose(&self, link: LinkId) -> Pose {
        self.named.link_pose(link)
    }

    /// Linear velocity of a link's origin and angular velocity, in the world.
    pub fn link_velocity(&self, link: LinkId) -> (Vec3, Vec3) {
        self.named.link_velocity(link)
    }

    /// The position of a joint's axis (0 or 1), in rad or m; `None` if it has no such axis.
    pub fn joint_position(&self, joint: JointId, axis: usize) -> Option<f64> {
        self.named.joint_position(joint, axis)
    }

    /// The velocity of a joint's axis.
    pub fn joint_velocity(&self, joint: JointId, axis: usize) -> Option<f64> {
        self.named.joint_velocity(joint, axis)
    }

    /// How many of the warnings are more than counts of ignored parts.
    pub fn warning_count(&self) -> usize {
        self.warnings.iter().filter(|warning| warning.kind() != WarningKind::Ignored).count()
    }

    /// Joints of the file that the engine has.
    pub fn joint_count(&self) -> usize {
        let joints = 0..self.scene().joints.len();
        joints.filter(|index| self.named.joint_key(JointId(*index)).is_some()).count()
    }

    /// How far a joint's links are from where it wants them: metres and radians.
    pub fn joint_error(&self, joint: JointId) -> Option<(f64, f64)> {
        let error = self.named.world.joint_error(self.named.joint_key(joint)?).ok()?;
        Some((error.position, error.angle))
    }

    /// The names of the links that own the two geoms of the deepest contact of the last step.
    pub fn deepest_contact(&self) -> Option<[String; 2]> {
        let contacts = self.named.world.contacts();
        let deepest = contacts.iter().max_by(|a, b| a.point.depth.total_cmp(&b.point.depth))?;
        Some([deepest.first.geom, deepest.second.geom].map(|geom| self.owner_of(geom)))
    }

    fn owner_of(&self, geom: GeomKey) -> String {
        let links = &self.scene().links;
        let owner = (0..links.len()).find(|index| self.named.link_geoms(LinkId(*index)).contains(&geom));
        owner.map_or_else(|| "the ground".to_owned(), |index| links[index].name.clone())
    }

    /// The unit of an axis' position: `rad` or `m`.
    pub fn joint_unit(&self, joint: JointId, axis: usize) -> &'static str {
        let name = &self.scene().joints[joint.0].name;
        self.named.joint(name).and_then(|joint| joint.unit(axis)).unwrap_or("rad")
    }

    /// The motor of a joint's axis, to be driven from outside from now on: the engine's joint, the number of its group of
    /// parameters, and the engine's velocity per velocity of the axis, 1 or −1.
    pub fn take_motor(&mut self, joint: JointId, axis: usize) -> Option<(JointKey, usize, f64)> {
        let motor = self.named.axis_motor(joint, axis)?;
        self.named.release_axis(joint, axis);
        Some((motor.joint, motor.group, motor.sign))
    }

    /// The names of the links whose bodies were taken out because they were not finite.
    pub fn quarantined(&self) -> Vec<String> {
        let links = self.scene().links.iter().enumerate();
        let out = links.filter(|(index, _)| {
            let body = self.named.link_body(LinkId(*index));
            body.and_then(|key| self.named.world.body(key).ok()).is_some_and(ferrode::Body::is_quarantined)
        });
        out.map(|(_, link)| link.name.clone()).collect()
    }
}
