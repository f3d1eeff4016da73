//! Demos of the gallery, live: the scene's own control before and after each step, and what it draws beside its bodies.

use crate::args;
use crate::overlay::Overlays;
use crate::painter::Painter;
use crate::view_point::ViewPoint;
use ferrode::World;
use ferrode_demos::{Demo, Director, Failure, Mark};
use ferrode_math::Vec3;
use ferrode_render::{Color, Ground, Layer, Paint, Scene};
use ferrode_scene::NamedWorld;

/// What drives a demo's world. A clone, with a clone of the world, goes on to the same bits.
#[derive(Clone, Debug)]
pub struct Direction {
    demo: &'static Demo,
    director: Director,
    /// At the demo's end: what was measured, or what does not hold.
    verdict: Option<Result<String, Failure>>,
}

/// A demo at its start: its world, with names for its bodies, and what drives it.
///
/// # Errors
/// The engine refuses the scene.
pub fn start(demo: &'static Demo) -> Result<(NamedWorld, Direction), String> {
    let play = demo.start().map_err(|failure| format!("demo {}: {failure}", demo.name))?;
    let (world, director) = play.into_parts();
    let named = NamedWorld::of_world(world, director.step_size(), demo.name);
    Ok((named, Direction { demo, director, verdict: None }))
}

/// Where a demo wants to be looked at from.
pub fn view_point(demo: &Demo) -> ViewPoint {
    ViewPoint::LookAt { eye: demo.camera.eye, target: demo.camera.target }
}

/// What a demo shows of what bodies hide.
pub fn overlays(demo: &Demo) -> Overlays {
    let mut overlays = Overlays::default();
    for name in demo.show {
        args::switch_on(&mut overlays, name);
    }
    overlays
}

impl Direction {
    /// The demo.
    pub fn demo(&self) -> &'static Demo {
        self.demo
    }

    /// One step of the world, driven and measured.
    ///
    /// # Errors
    /// Whatever the engine refuses.
    pub fn step(&mut self, named: &mut NamedWorld) -> Result<ferrode::Step, Failure> {
        self.director.before(&mut named.world)?;
        let step = named.step()?;
        self.director.after(&mut named.world)?;
        let end = (self.demo.seconds / self.director.step_size()).round() as u64;
        if named.world.step_count() == end {
            self.verdict = Some(self.director.verdict(&named.world));
        }
        Ok(step)
    }

    /// At the demo's end and after: what was measured, or what does not hold.
    pub fn verdict(&self) -> Option<&Result<String, Failure>> {
        self.verdict.as_ref()
    }

    /// Adds what the demo draws beside the world's shapes; before those are painted, as it may have a ground of its own.
    pub fn draw(&self, world: &World, painter: &mut Painter, scene: &mut Scene) {
        let color = |tint: ferrode_demos::Tint| Color::rgb(tint.0, tint.1, tint.2);
        let drawing = self.director.drawing(world);
        if let Some(height) = drawing.floor {
            painter.floor = None;
            scene.ground(Ground { point: Vec3::new(0.0, 0.0, height), ..Ground::default() });
        }
        for mark in drawing.marks {
            match mark {
                Mark::Solid { shape, pose, tint } => {
                    painter.shape(None, &shape, &pose, Paint::from(color(tint)), scene);
                }
                Mark::Line { from, to, width, tint } => {
                    scene.line(from, to, width, color(tint), Layer::World);
                }
                Mark::Arrow { from, to, radius, tint } => {
                    scene.arrow(from, to, radius, Paint::from(color(tint)), Layer::World);
                }
            }
        }
    }

    /// Tells in the panel what there is to see, what is measured, and at the end what was.
    pub fn show(&self, ui: &mut egui::Ui) {
        egui::CollapsingHeader::new(self.demo.name).default_open(true).show(ui, |ui| {
            ui.label(self.demo.about);
            ui.weak(self.demo.property);
            match &self.verdict {
                None => ui.weak(format!("measured at {} s", self.demo.seconds)),
                Some(Ok(found)) => ui.label(format!("holds: {found}")),
                Some(Err(failure)) => {
                    ui.colored_label(egui::Color32::from_rgb(180, 40, 30), failure.to_string())
                }
            };
        });
    }
}
