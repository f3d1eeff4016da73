#![forbid(unsafe_code)]
//! Reads worlds and robots from [SDFormat](http://sdformat.org/spec) 1.4 to 1.12 and
//! [URDF](http://wiki.ros.org/urdf/XML) files.
//!
//! [`load`] gives a [`Scene`]: what the file says, free of its format, with all references
//! resolved, and the warnings that came up. Whatever changes physics and is not understood is a warning with file,
//! line and element; [`LoadOptions::strict`] makes it an error.
//!
//! ```
//! use ferrode_scene::{LoadOptions, load_str};
//!
//! let text = r#"
//! <sdf version="1.12">
//!   <model name="ball">
//!     <link name="body">
//!       <inertial auto="true"><density>500</density></inertial>
//!       <collision name="shape"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
//!     </link>
//!   </model>
//! </sdf>"#;
//! let loaded = load_str("ball.sdf", text, &LoadOptions::default())?;
//! let ball = loaded.scene.link("body").expect("as in the file");
//! assert_eq!(ball.name, "ball::body");
//! assert!((ball.inertial.mass - 2.0944).abs() < 1e-4);
//!
//! let error = load_str("ball.sdf", &text.replace("0.1", "-0.1"), &LoadOptions::default()).unwrap_err();
//! assert_eq!(error.line(), Some(6));
//! assert_eq!(error.message(), "<radius> must be positive, found -0.1");
//! # Ok::<(), ferrode_scene::SceneError>(())
//! ```
//!
//! A file goes through these steps: [`source`] keeps its text and turns offsets into lines; `xml` reads elements
//! and values with their places; `sdf` and `urdf` make a `draft` of it, in which frames and links are still names;
//! `frames` finds the poses and `resolve` what the names mean; `merge` joins what fixed joints of a URDF hold together.

pub mod build;
mod context;
pub mod description;
mod draft;
pub mod error;
mod frames;
mod heightmap;
mod inertia;
mod merge;
mod mesh;
mod resolve;
mod sdf;
pub mod source;
mod urdf;
mod uri;
mod xml;

use std::path::{Path, PathBuf};

/// The book's chapter on files, so that its code is compiled and run. The packaged crate does not contain it.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/book/files.md")]
struct Book;

pub use build::{BuildOptions, NamedJoint, NamedLink, NamedWorld, build};
pub use description::Scene;
pub use error::{Result, SceneError, Warning, WarningKind};
pub use mesh::Triangles;
pub use source::{Origin, Source};

use context::Context;

/// How to load a file.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Folders that `model://` and `package://` names are looked up in, before those that the environment names.
    pub model_paths: Vec<PathBuf>,
    /// Look in the folders that the environment variables `GZ_SIM_RESOURCE_PATH`, `GAZEBO_MODEL_PATH` and
    /// `ROS_PACKAGE_PATH` name, in this order.
    pub use_environment: bool,
    /// A warning is an error, unless it only counts ignored parts.
    pub strict: bool,
    /// Merge links that fixed joints of a URDF hold together, except where the file says otherwise
    /// (`disableFixedJointLumping`, `preserveFixedJoint`).
    pub merge_fixed_joints: bool,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { model_paths: Vec::new(), use_environment: true, strict: false, merge_fixed_joints: true }
    }
}

impl LoadOptions {
    /// All folders that `model://` and `package://` names are looked up in.
    pub fn search_path(&self) -> Vec<PathBuf> {
        let mut folders = self.model_paths.clone();
        if self.use_environment {
            for variable in ["GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"] {
                if let Some(value) = std::env::var_os(variable) {
                    folders.extend(
                        std::env::split_paths(&value).filter(|folder| !folder.as_os_str().is_empty()),
                    );
                }
            }
        }
        folders
    }
}

/// A file that was read.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What it says.
    pub scene: Scene,
    /// What it says that is not understood, not supported, or looks like a mistake; the counts of ignored parts last.
    pub warnings: Vec<Warning>,
}

/// Reads an SDF or URDF file; its root element tells which.
///
/// # Errors
/// The file cannot be read, is no SDF or URDF, is not well-formed, or contradicts itself: the error names file, line,
/// column and element. With [`LoadOptions::strict`], also whatever would be a warning.
pub fn load(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Loaded> {
    let mut cx = Context::new(options);
    let scene = cx.read_file(path.as_ref(), |cx, source| read(source, cx))?;
    finish(scene, cx)
}

/// Reads SDF or URDF text, under a name to call it by in messages. Relative references in it are looked up in the
/// search path only.
///
/// # Errors
/// As for [`load`].
pub fn load_str(name: &str, text: &str, options: &LoadOptions) -> Result<Loaded> {
    let mut cx = Context::new(options);
    let scene = read(&Source::from_text(name, text), &mut cx)?;
    finish(scene, cx)
}

fn read(source: &Source, cx: &mut Context<'_>) -> Result<Scene> {
    let draft = xml::with_root(source, |root| match root.name() {
        "sdf" => sdf::read(root, cx),
        "robot" => urdf::read(root, cx),
        "mujoco" => Err(root.error("MuJoCo's format (MJCF) is not supported")),
        "gazebo" => Err(root.error("this is SDF 1.2 or older: 1.4 to 1.12 are read")),
        other => Err(root.error(format!("this is neither SDF nor URDF: its root element is <{other}>"))),
    })?;
    resolve::resolve(draft, &mut cx.notes)
}

fn finish(scene: Scene, cx: Context<'_>) -> Result<Loaded> {
    let strict = cx.options.strict;
    let warnings = cx.notes.into_warnings();
    if strict {
        let mut grave = warnings.iter().filter(|warning| warning.kind() != WarningKind::Ignored);
        if let Some(first) = grave.next() {
            return Err(SceneError::from_warning(first.clone(), grave.count()));
        }
    }
    Ok(Loaded { scene, warnings })
}

/// The README's code, compiled with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
