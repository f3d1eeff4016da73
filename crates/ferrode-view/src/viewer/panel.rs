//! The panel beside the picture.

use super::Viewer;
use super::input::KEYS;
use super::quantity::{JointValue, LinkValue, Quantity};
use crate::lettering;
use crate::overlay::Overlays;
use crate::painter::Coloring;
use ferrode::Stepper;

const STEPPERS: [(Stepper, &str); 3] =
    [(Stepper::Direct, "direct"), (Stepper::Quick, "quick"), (Stepper::Substep, "substep")];

/// How wide the panel is at first, in points.
pub(super) const WIDTH: f64 = 290.0;

impl Viewer {
    /// Shows the user interface.
    pub fn interface(&mut self, ui: &mut egui::Ui) {
        if self.overlays.names {
            let overlays = Overlays { time: false, ..self.overlays };
            let camera = self.camera();
            let labels =
                lettering::labels(&self.playback.named, &overlays, self.playback.time(), &camera, self.size);
            lettering::paint(ui.ctx(), &labels);
        }
        if self.panel {
            let shown =
                egui::Panel::right("panel").resizable(true).default_size(WIDTH as f32).show(ui, |ui| {
                    egui::ScrollArea::vertical().show(ui, |ui| self.sections(ui));
                });
            let area = shown.response.rect;
            self.panel_area = Some(area);
            self.covered = f64::from(area.width() * ui.ctx().pixels_per_point());
        }
        egui::Area::new(egui::Id::unique("status")).fixed_pos([10.0, 8.0]).interactable(false).show(
            ui.ctx(),
            |ui| {
                let state = if self.playback.paused { "paused" } else { "running" };
                let text = format!("{:.3} s  {state}  ×{}", self.playback.time(), self.playback.speed);
                let dark = egui::Color32::from_rgb(40, 46, 56);
                ui.label(egui::RichText::new(text).size(17.0).strong().color(dark));
                if !self.message.is_empty() {
                    ui.label(egui::RichText::new(&self.message).color(egui::Color32::from_rgb(150, 40, 30)));
                }
            },
        );
    }

    fn sections(&mut self, ui: &mut egui::Ui) {
        ui.add_space(4.0);
        self.time_controls(ui);
        if let Some(direction) = &self.playback.direction {
            direction.show(ui);
        }
        ui.separator();
        self.overlay_controls(ui);
        ui.separator();
        egui::CollapsingHeader::new("body").default_open(true).show(ui, |ui| self.body_section(ui));
        egui::CollapsingHeader::new("plots").default_open(true).show(ui, |ui| self.plots(ui));
        egui::CollapsingHeader::new("keys").show(ui, |ui| {
            egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
                for (key, what) in KEYS {
                    ui.strong(*key);
                    ui.label(*what);
                    ui.end_row();
                }
            });
        });
    }

    fn time_controls(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            if ui.button(if self.playback.paused { "play" } else { "pause" }).clicked() {
                self.playback.paused = !self.playback.paused;
            }
            if ui.button("step").clicked() {
                self.single_step();
            }
            if ui.button("back").clicked() {
                self.back();
            }
            if ui.button("reset").clicked() {
                self.reset();
            }
        });
        let [from, to] = self.playback.range();
        let mut time = self.playback.time();
        if to > from && ui.add(egui::Slider::new(&mut time, from..=to).text("time [s]")).changed() {
            self.seek(time);
        }
        ui.add(
            egui::Slider::new(&mut self.playback.speed, 1.0 / 64.0..=16.0).logarithmic(true).text("speed"),
        );
        if self.playback.is_recording() {
            return;
        }
        ui.horizontal(|ui| {
            ui.label("stepper");
            for (stepper, name) in STEPPERS {
                if ui.selectable_label(self.playback.stepper() == stepper, name).clicked() {
                    self.playback.set_stepper(stepper);
                }
            }
        });
        let now = self.playback.named.step_size() * 1e3;
        ui.horizontal(|ui| {
            ui.label(format!("step {now:.3} ms"));
            for (factor, name) in [(0.5, "÷ 2"), (2.0, "× 2")] {
                if ui.button(name).clicked() {
                    self.set_step_size(now * 1e-3 * factor);
                }
            }
        });
        let facts = &self.playback.facts;
        let ratio = self.playback.named.step_size() / facts.wall.max(1e-9);
        ui.small(format!(
            "{:.0} frames/s · step {:.2} ms, {ratio:.0}× time · {} bodies · {} contacts · {} rows",
            self.frame_rate,
            facts.wall * 1e3,
            self.playback.named.world.body_count(),
            facts.contacts,
            facts.rows
        ));
    }

    fn overlay_controls(&mut self, ui: &mut egui::Ui) {
        let overlays = &mut self.overlays;
        let flags = [
            ("contacts", &mut overlays.contacts),
            ("contact forces", &mut overlays.forces),
            ("joints", &mut overlays.joints),
            ("joint forces", &mut overlays.joint_forces),
            ("centres of mass", &mut overlays.centres),
            ("inertia", &mut overlays.inertia),
            ("boxes", &mut overlays.boxes),
            ("tree", &mut overlays.tree),
            ("names", &mut overlays.names),
        ];
        egui::Grid::new("overlays").num_columns(2).show(ui, |ui| {
            for (n, (name, flag)) in flags.into_iter().enumerate() {
                ui.checkbox(flag, name);
                if n % 2 == 1 {
                    ui.end_row();
                }
            }
        });
        ui.horizontal(|ui| {
            ui.label("colours");
            for (coloring, name) in
                [(Coloring::Bodies, "bodies"), (Coloring::Sleep, "sleep"), (Coloring::Islands, "islands")]
            {
                ui.selectable_value(&mut self.painter.coloring, coloring, name);
            }
        });
    }

    fn body_section(&mut self, ui: &mut egui::Ui) {
        let Some(body) = self.selected else {
            ui.weak("click on a body");
            return;
        };
        egui::Grid::new("body").num_columns(2).show(ui, |ui| {
            for (name, value) in self.describe(body) {
                ui.weak(name);
                ui.label(value);
                ui.end_row();
            }
        });
        let mut offers: Vec<(String, Vec<(&str, Quantity)>)> = Vec::new();
        if let Some(link) = self.link_of(body) {
            let values = LinkValue::all().map(|(value, name)| (name, Quantity::Link(link, value)));
            offers.push(("plot".to_owned(), values.collect()));
        }
        for (id, joint) in self.joints_of(body) {
            let values = JointValue::all().map(|(value, name)| (name, Quantity::Joint(id, value)));
            let there = values.filter(|(_, quantity)| quantity.value(&self.playback).is_finite());
            offers.push((joint, there.collect()));
        }
        for (of, values) in offers {
            ui.horizontal_wrapped(|ui| {
                ui.weak(of);
                for (name, quantity) in values {
                    if ui.small_button(name).clicked() {
                        self.plot(quantity);
                    }
                }
            });
        }
    }
}
