//! `ferrode-view gallery`: all pictures of the documentation, by one command.
//!
//! It writes `gallery.md` with `img/gallery/NAME.png` for each demo, and `book/img/joint-NAME.png` for the pages of joints. The
//! same driver draws the same pictures, byte for byte: worlds have the same bits on every machine, and so has what is
//! drawn of them.

pub mod joints;
mod labels;
mod page;
mod small_png;

use crate::demo;
use crate::failure::Failure;
use crate::lettering::Lettering;
use crate::overlay::{self, Scale};
use crate::painter::Painter;
use crate::render_command::staged;
use ferrode_demos::{ALL, Demo};
use ferrode_math::Vec3;
use ferrode_render::{Camera, Canvas, Ground, Picture, Quality, Scene};
use joints::JointPicture;
use std::path::Path;

pub use page::page;

/// Width and height of the gallery's pictures.
pub const SIZE: [u32; 2] = [480, 300];

/// Draws all pictures of the documentation that lies in a folder, and writes the gallery's page.
///
/// # Errors
/// There is no driver, the engine refuses a scene, or a file cannot be written.
pub fn draw_all(docs: &Path) -> Result<(), Failure> {
    write_all(docs).map_err(Failure::output)
}

fn write_all(docs: &Path) -> Result<(), String> {
    let folder = docs.join("img/gallery");
    make_folder(&folder)?;
    let mut studio = Studio::open(SIZE)?;
    for demo in ALL {
        let picture = studio.demo(demo)?;
        save(&folder.join(format!("{}.png", demo.name)), &small_png::encode(&picture)?)?;
    }
    let folder = docs.join("book/img");
    make_folder(&folder)?;
    for joint in joints::ALL {
        let picture = studio.joint(joint)?;
        save(&folder.join(format!("joint-{}.png", joint.name)), &small_png::encode(&picture)?)?;
    }
    save(&docs.join("gallery.md"), page().as_bytes())
}

fn make_folder(path: &Path) -> Result<(), String> {
    std::fs::create_dir_all(path).map_err(|error| format!("cannot make {}: {error}", path.display()))
}

fn save(path: &Path, bytes: &[u8]) -> Result<(), String> {
    std::fs::write(path, bytes).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    eprintln!("{} ({} kB)", path.display(), bytes.len().div_ceil(1000));
    Ok(())
}

/// Where pictures of one size are taken.
#[derive(Debug)]
pub struct Studio {
    canvas: Canvas,
    scene: Scene,
    letters: Option<Lettering>,
}

impl Studio {
    /// Opens a driver.
    ///
    /// # Errors
    /// As [`Canvas::new`].
    pub fn open(size: [u32; 2]) -> Result<Self, String> {
        let canvas = Canvas::new(size[0], size[1], Quality::fine()).map_err(|error| error.to_string())?;
        Ok(Self { canvas, scene: Scene::new(), letters: None })
    }

    /// A demo at its picture's moment, by its own camera.
    ///
    /// # Errors
    /// The engine refuses the scene, or the driver fails.
    pub fn demo(&mut self, demo: &'static Demo) -> Result<Picture, String> {
        let told = |error: &dyn std::fmt::Display| format!("demo {}: {error}", demo.name);
        let (mut named, mut direction) = demo::start(demo)?;
        let overlays = demo::overlays(demo);
        if overlays.joint_forces {
            overlay::record_joint_forces(&mut named.world).map_err(|error| told(&error))?;
        }
        let (mut painter, _) = staged(&named);
        let scale = Scale::of(&named.world);
        for _ in 0..(demo.picture_at / named.step_size()).round() as u64 {
            direction.step(&mut named).map_err(|error| told(&error))?;
        }
        // Some steppers move bodies alone.
        named.world.sync_geoms();
        let camera = Camera::look_at(demo.camera.eye, demo.camera.target);
        self.scene.clear(camera.target);
        direction.draw(&named.world, &mut painter, &mut self.scene);
        painter.paint(&named.world, &mut self.scene);
        overlay::draw(&named.world, &overlays, &scale, &mut self.scene);
        self.canvas.draw(&self.scene, &camera).map_err(|error| told(&error))
    }

    /// A joint's picture for the book: its bodies, and what the engine says of its anchors and axes.
    ///
    /// # Errors
    /// The engine refuses the scene, or the driver fails.
    pub fn joint(&mut self, joint: &JointPicture) -> Result<Picture, String> {
        let told = |error: &dyn std::fmt::Display| format!("joint {}: {error}", joint.name);
        let set = joint.set().map_err(|error| told(&error))?;
        let camera = joint.camera();
        let mut painter = Painter::default();
        for (body, color) in set.bodies.into_iter().zip(joints::COLORS) {
            painter.set_color(body, color);
        }
        self.scene.clear(camera.target);
        let ground = Ground { point: Vec3::new(0.0, 0.0, GROUND), ..Ground::default() };
        self.scene.ground(ground);
        painter.paint(&set.world, &mut self.scene);
        overlay::draw(&set.world, &set.overlays, &joints::SCALE, &mut self.scene);
        joint.draw_more(&set, &mut self.scene);
        let (scene, size) = (&self.scene, self.canvas.size());
        let letters = self.letters.get_or_insert_with(|| Lettering::new(self.canvas.gpu(), Canvas::format()));
        let picture = self.canvas.draw_with(scene, &camera, |gpu, encoder, into| {
            let words = |ui: &mut egui::Ui| labels::paint(ui.painter(), &set.labels, &camera, size);
            letters.draw(gpu, encoder, into, size, words);
        });
        picture.map_err(|error| told(&error))
    }
}

/// The ground under joints, m.
const GROUND: f64 = -0.12;
