//! From a file to a world that is ready to be shown.

use ferrode::{Material, Plane, Pose, Stepper, Vec3, World};
use ferrode_scene::{BuildOptions, LoadOptions, NamedWorld, Scene, SceneError, Warning, build, load};
use std::path::PathBuf;

/// The file, and what to do to its world.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Setup {
    /// SDF or URDF.
    pub file: PathBuf,
    /// Warnings are errors.
    pub strict: bool,
    /// Folders that hold models.
    pub model_path: Vec<PathBuf>,
    /// Adds the plane z = 0, and lifts onto it what would start below.
    pub ground: bool,
    /// Links to fix to the world.
    pub fix: Vec<String>,
    /// Step size in place of the file's, s.
    pub dt: Option<f64>,
    /// In place of the file's stepper.
    pub stepper: Option<Stepper>,
}

/// Height of the lowest point of all geoms on bodies; infinite if there are none.
fn lowest_point(world: &World) -> f64 {
    let on_bodies = world.geoms().filter(|info| info.body.is_some());
    let boxes = on_bodies.filter_map(|info| world.geom(info.key).ok()).map(|geom| geom.aabb());
    boxes.map(|aabb| aabb.min.z).fold(f64::INFINITY, f64::min)
}

impl Setup {
    /// Reads the file and builds its world; gives what the file says that is not understood, too.
    ///
    /// # Errors
    /// What the loader says, with file, line and element, or which link to fix there is not.
    pub fn load(&self) -> Result<(NamedWorld, Vec<Warning>), String> {
        let options = LoadOptions {
            model_paths: self.model_path.clone(),
            strict: self.strict,
            ..LoadOptions::default()
        };
        let mut loaded = load(&self.file, &options).map_err(told)?;
        let mut named = self.build(&loaded.scene, None)?;
        let lift = -lowest_point(&named.world).min(0.0);
        if self.ground && lift > 0.0 {
            loaded.scene.translate_moving(Vec3::new(0.0, 0.0, lift));
            named = self.build(&loaded.scene, None)?;
        }
        let warnings = loaded.warnings.into_iter().chain(named.warnings.iter().cloned()).collect();
        Ok((named, warnings))
    }

    /// Builds the world of a scene that is as high as it should be, perhaps with another step size.
    ///
    /// # Errors
    /// What the builder says, or which link to fix there is not.
    pub fn build(&self, scene: &Scene, dt: Option<f64>) -> Result<NamedWorld, String> {
        let options = BuildOptions { step: dt.or(self.dt), stepper: self.stepper, strict: self.strict };
        let mut named = build(scene, &options).map_err(told)?;
        if self.ground {
            add_ground(&mut named.world).map_err(|error| error.to_string())?;
        }
        for name in &self.fix {
            let link = named.link(name).ok_or_else(|| format!("--fix {name}: there is no such link"))?.id();
            named.weld(link).map_err(|error| error.to_string())?;
        }
        Ok(named)
    }
}

fn told(error: SceneError) -> String {
    error.to_string()
}

/// The plane z = 0, as rough as SDF's surfaces are by default.
fn add_ground(world: &mut World) -> Result<(), ferrode::Error> {
    let plane = world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    world.set_material(plane, Material::with_friction(1.0))
}
