//! The viewer without its window: what hands do, what time does, what is to be drawn.

mod describe;
mod grab;
pub mod input;
mod orbit;
mod panel;
pub mod playback;
mod plots;
pub mod quantity;
pub mod script;
pub mod series;
pub mod source;
mod spawn;
#[cfg(test)]
mod tests;

use crate::overlay::{self, Overlays, Scale};
use crate::painter::{Coloring, Painter, bounds};
use crate::render_command::staged;
use crate::view_point::ViewPoint;
use ferrode::{BodyKey, World};
use ferrode_math::{Aabb, Pose, Vec3};
use ferrode_render::{Camera, Color, Layer, Paint, Scene};
use ferrode_scene::description::LinkId;
use grab::Grab;
use input::{Button, Input, Key};
use orbit::Orbit;
use playback::Playback;
use series::Series;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Duration;

/// What the viewer asks of its window.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// Save a picture of the window.
    Shot(PathBuf),
    /// Save a picture of the plots.
    Plots(PathBuf),
    /// Close.
    Quit,
}

/// A world, a camera, and the user's hands on both.
#[derive(Debug)]
pub struct Viewer {
    /// The world in time.
    pub playback: Playback,
    /// Recorded values.
    pub series: Series,
    /// How worlds are drawn.
    pub painter: Painter,
    /// What is shown of the engine.
    pub overlays: Overlays,
    /// The panel is shown.
    pub panel: bool,
    /// What went wrong or was done last, in a line.
    pub message: String,
    scale: Scale,
    orbit: Orbit,
    around: Aabb,
    size: [u32; 2],
    pointer: [f64; 2],
    pressed: Option<Press>,
    held: BTreeSet<Key>,
    grab: Option<Grab>,
    selected: Option<BodyKey>,
    shown: Vec<plots::Plot>,
    wishes: Vec<Wish>,
    shots: usize,
    frame_rate: f64,
    panel_area: Option<egui::Rect>,
    /// Columns that the panel covers if it is shown.
    covered: f64,
}

/// A button that is down.
#[derive(Clone, Copy, Debug)]
struct Press {
    button: Button,
    at: [f64; 2],
    moved: bool,
}

/// Pixels that a hand trembles by.
const TREMBLE: f64 = 3.0;
const FAR: f64 = 1e4;

impl Viewer {
    /// A viewer for a window of a size.
    pub fn new(playback: Playback, size: [u32; 2], view: &ViewPoint, overlays: Overlays) -> Self {
        let (painter, around) = staged(&playback.named);
        let covered = panel::WIDTH.min(0.5 * f64::from(size[0]));
        let camera = view.camera(&around, (f64::from(size[0]) - covered) / f64::from(size[1].max(1)));
        let scale = Scale::of(&playback.named.world);
        let mut viewer = Self {
            playback,
            series: Series::default(),
            painter,
            overlays,
            panel: true,
            message: String::new(),
            scale,
            orbit: Orbit::from_camera(&camera),
            around,
            size,
            pointer: [0.0; 2],
            pressed: None,
            held: BTreeSet::new(),
            grab: None,
            selected: None,
            shown: plots::Plot::usual(),
            wishes: Vec::new(),
            shots: 0,
            frame_rate: 0.0,
            panel_area: None,
            covered,
        };
        viewer.prepare();
        viewer
    }

    /// Lets joints record their forces: for their overlay, plots, and the panel.
    fn prepare(&mut self) {
        if let Err(error) = overlay::record_joint_forces(&mut self.playback.named.world) {
            self.message = error.to_string();
        }
    }

    /// The camera. What it turns about is in the middle of what the panel leaves free.
    pub fn camera(&self) -> Camera {
        self.orbit.camera_beside(self.covered(), f64::from(self.size[1]))
    }

    /// Columns that the panel covers now, never more than half of them.
    fn covered(&self) -> f64 {
        if self.panel { self.covered.min(0.5 * f64::from(self.size[0])) } else { 0.0 }
    }

    /// Goes so far back that what the whole picture would show is seen beside the panel.
    pub fn make_room(&mut self) {
        let width = f64::from(self.size[0]);
        self.orbit.back_off(width / (width - self.covered()));
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Whether the mouse is over the panel; `scale` is the pixels of a point of the interface.
    pub fn pointer_is_on_panel(&self, scale: f32) -> bool {
        let point = egui::pos2(self.pointer[0] as f32 / scale, self.pointer[1] as f32 / scale);
        self.panel && self.panel_area.is_some_and(|area| area.contains(point))
    }

    /// Columns of pixels that the panel covers on the right; `scale` is the pixels of a point of the interface.
    pub fn panel_columns(&self, scale: f32) -> u32 {
        match self.panel_area {
            Some(area) if self.panel => (area.width() * scale).max(0.0) as u32,
            _ => 0,
        }
    }

    /// The window has another size.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.size = size;
    }

    /// The body that was clicked on.
    pub fn selected(&self) -> Option<BodyKey> {
        self.selected
    }

    /// The body that is held.
    pub fn held_body(&self) -> Option<BodyKey> {
        self.grab.map(|grab| grab.body)
    }

    /// What the window is asked for since the last question.
    pub fn take_wishes(&mut self) -> Vec<Wish> {
        std::mem::take(&mut self.wishes)
    }

    fn tell(&mut self, result: Result<(), impl std::fmt::Display>) {
        if let Err(error) = result {
            self.message = error.to_string();
        }
    }

    /// Takes what a hand did.
    pub fn input(&mut self, input: Input) {
        match input {
            Input::Key(key, true) => {
                if self.held.insert(key) || key.repeats() {
                    self.key(key);
                }
            }
            Input::Key(key, false) => {
                self.held.remove(&key);
            }
            Input::Move(to) => self.pointer_moved(to),
            Input::Button(button, true) => self.button_down(button),
            Input::Button(button, false) => self.button_up(button),
            Input::Wheel(notches) => self.orbit.zoom(notches),
        }
    }

    /// Lets go of all keys and buttons: the window lost the user.
    pub fn release_all(&mut self) {
        self.held.clear();
        self.pressed = None;
        self.grab = None;
    }

    fn key(&mut self, key: Key) {
        let overlays = &mut self.overlays;
        let toggle = |flag: &mut bool| *flag = !*flag;
        match key {
            Key::Space => self.playback.paused = !self.playback.paused,
            Key::Right | Key::Char('.') => self.single_step(),
            Key::Left | Key::Char(',') => self.back(),
            Key::Char('r') => self.reset(),
            Key::Char('[') => self.playback.speed = (self.playback.speed * 0.5).max(1.0 / 64.0),
            Key::Char(']') => self.playback.speed = (self.playback.speed * 2.0).min(16.0),
            Key::Char('f') => self.see_everything(),
            Key::Char('c') => self.look_at_selected(),
            Key::Char('b') => self.drop_body(spawn::Kind::Cube),
            Key::Char('n') => self.drop_body(spawn::Kind::Ball),
            Key::Char('m') => self.drop_body(spawn::Kind::Capsule),
            Key::Char('v') => self.drop_body(spawn::Kind::Cylinder),
            Key::Char('x') => self.shoot(),
            Key::Char('1') => toggle(&mut overlays.contacts),
            Key::Char('2') => toggle(&mut overlays.forces),
            Key::Char('3') => toggle(&mut overlays.joints),
            Key::Char('4') => toggle(&mut overlays.joint_forces),
            Key::Char('5') => toggle(&mut overlays.centres),
            Key::Char('6') => toggle(&mut overlays.inertia),
            Key::Char('7') => toggle(&mut overlays.boxes),
            Key::Char('8') => toggle(&mut overlays.tree),
            Key::Char('0') => toggle(&mut overlays.names),
            Key::Char('9') => {
                self.painter.coloring = match self.painter.coloring {
                    Coloring::Bodies => Coloring::Sleep,
                    Coloring::Sleep => Coloring::Islands,
                    Coloring::Islands => Coloring::Bodies,
                };
            }
            Key::Char('p') => {
                let path = PathBuf::from(format!("ferrode-{:03}.png", self.shots));
                self.shots += 1;
                self.message = format!("saved {}", path.display());
                self.wishes.push(Wish::Shot(path));
            }
            Key::Tab => self.panel = !self.panel,
            Key::Escape => self.wishes.push(Wish::Quit),
            Key::Char(_) | Key::Up | Key::Down => {}
        }
    }

    fn single_step(&mut self) {
        self.playback.paused = true;
        let grab = self.grab;
        let stepped = self.playback.single_step(&mut |world, h| pull(grab, world, h));
        self.tell(stepped);
        self.series.record(&self.playback);
    }

    /// Winds back to the state kept before this one.
    pub fn back(&mut self) {
        let done = self.playback.back().map(|_| ());
        self.tell(done);
        self.forget();
    }

    /// Pauses, and goes to a time as nearly as states were kept.
    pub fn seek(&mut self, time: f64) {
        self.playback.paused = true;
        let done = self.playback.seek(time);
        self.tell(done);
        self.forget();
    }

    /// Begins anew.
    pub fn reset(&mut self) {
        let done = self.playback.reset();
        self.tell(done);
        self.series.clear();
        self.forget();
    }

    /// Forgets bodies that are gone, and lets new joints record their forces.
    fn forget(&mut self) {
        let world = &self.playback.named.world;
        self.grab = self.grab.filter(|grab| world.contains_body(grab.body));
        self.selected = self.selected.filter(|body| world.contains_body(*body));
        self.painter.selected = self.selected;
        self.prepare();
    }

    /// Changes the step size.
    pub fn set_step_size(&mut self, h: f64) {
        let link = self.selected.and_then(|body| self.link_of(body));
        let done = self.playback.set_step_size(h);
        self.tell(done);
        let (coloring, floor) = (self.painter.coloring, self.painter.floor);
        self.painter = staged(&self.playback.named).0;
        (self.painter.coloring, self.painter.floor) = (coloring, floor);
        self.selected = link.and_then(|link| self.playback.named.link_body(link));
        self.forget();
    }

    fn look_at_selected(&mut self) {
        let body = self.selected.and_then(|body| self.playback.named.world.body(body).ok());
        if let Some(position) = body.map(ferrode::Body::position) {
            self.orbit.look_at(position);
        }
    }

    fn see_everything(&mut self) {
        self.around = bounds(&self.playback.named.world).unwrap_or(self.around);
        let aspect = (f64::from(self.size[0]) - self.covered()) / f64::from(self.size[1].max(1));
        self.orbit.frame(&self.around, aspect);
    }

    /// A size for bodies that are added: a good part of what is there.
    fn new_size(&self) -> f64 {
        (self.scale.length / 0.35 * 0.6).clamp(0.02, 5.0)
    }

    fn drop_body(&mut self, kind: spawn::Kind) {
        let (size, at) = (self.new_size(), self.orbit.target());
        if !self.playback.is_recording() {
            self.playback.depart();
            let done = spawn::drop_body(&mut self.playback.named.world, kind, size, at).map(|_| ());
            self.tell(done);
        }
    }

    fn shoot(&mut self) {
        let (size, camera) = (self.new_size(), self.camera());
        let along = camera.ray(self.pointer, self.size);
        if !self.playback.is_recording() {
            self.playback.depart();
            let done = spawn::shoot(&mut self.playback.named.world, size, &camera, along).map(|_| ());
            self.tell(done);
        }
    }

    /// The body under the mouse, and where.
    fn under_pointer(&mut self) -> Option<(BodyKey, Vec3)> {
        let camera = self.camera();
        let along = camera.ray(self.pointer, self.size);
        let world = &mut self.playback.named.world;
        let hit = world.ray_cast(camera.eye, along, FAR, |_| true).ok()??;
        Some((world.geom_info(hit.geom).ok()?.body?, hit.position))
    }

    fn button_down(&mut self, button: Button) {
        if self.pressed.is_some() {
            return;
        }
        self.pressed = Some(Press { button, at: self.pointer, moved: false });
        if button == Button::Left
            && !self.playback.is_recording()
            && let Some((body, point)) = self.under_pointer()
        {
            self.grab = Grab::new(&self.playback.named.world, body, point, &self.camera());
        }
    }

    fn pointer_moved(&mut self, to: [f64; 2]) {
        let [dx, dy] = [to[0] - self.pointer[0], to[1] - self.pointer[1]];
        self.pointer = to;
        let Some(press) = &mut self.pressed else { return };
        press.moved |= (to[0] - press.at[0]).abs().max((to[1] - press.at[1]).abs()) > TREMBLE;
        let press = *press;
        if !press.moved {
            return;
        }
        let camera = self.camera();
        let along = camera.ray(to, self.size);
        match (press.button, &mut self.grab) {
            (Button::Left, Some(grab)) => grab.follow(&camera, along),
            (Button::Left | Button::Right, _) => self.orbit.turn(dx, dy),
            (Button::Middle, _) => self.orbit.pan(dx, dy, f64::from(self.size[1])),
        }
    }

    fn button_up(&mut self, button: Button) {
        let Some(press) = self.pressed.filter(|press| press.button == button) else { return };
        self.pressed = None;
        self.grab = None;
        if button == Button::Left && !press.moved {
            self.selected = self.under_pointer().map(|(body, _)| body);
            self.painter.selected = self.selected;
        }
    }

    /// The link of a body; `None` for bodies that the user added.
    pub fn link_of(&self, body: BodyKey) -> Option<LinkId> {
        let named = &self.playback.named;
        (0..named.scene.links.len()).map(LinkId).find(|link| named.link_body(*link) == Some(body))
    }

    /// Counts a frame that took so many seconds of wall time.
    pub fn count_frame(&mut self, seconds: f64) {
        if seconds > 0.0 {
            let now = 1.0 / seconds;
            self.frame_rate += (now - self.frame_rate) * if self.frame_rate == 0.0 { 1.0 } else { 0.05 };
        }
    }

    /// Lets time pass, of which steps may take as much as `most`.
    pub fn advance(&mut self, seconds: f64, most: Duration) {
        let axis = |plus: char, minus: char| {
            let down = |c: char| f64::from(u8::from(self.held.contains(&Key::Char(c))));
            down(plus) - down(minus)
        };
        let flight = [axis('d', 'a'), axis('e', 'q'), axis('w', 's')];
        if flight != [0.0; 3] {
            self.orbit.fly(flight, seconds);
        }
        let before = self.playback.time();
        let grab = self.grab;
        let done = self.playback.advance(seconds, most, |world, h| pull(grab, world, h));
        self.tell(done);
        if self.playback.time() != before {
            self.series.record(&self.playback);
        }
    }

    /// Fills a scene with what is to be drawn.
    pub fn fill(&mut self, scene: &mut Scene) {
        let camera = self.camera();
        scene.clear(camera.target);
        let world = &self.playback.named.world;
        if let Some(direction) = &self.playback.direction {
            direction.draw(world, &mut self.painter, scene);
        }
        self.painter.paint(world, scene);
        overlay::draw(world, &self.overlays, &self.scale, scene);
        if let Some(grab) = &self.grab
            && let Some(point) = grab.point(world)
        {
            let paint = Paint::from(Color::YELLOW).glowing();
            scene.line(point, grab.target, 2.5, Color::YELLOW, Layer::Over);
            let radius = 0.008 * camera.distance();
            scene.sphere_in(&Pose::from_position(point), radius, paint, Layer::Over);
            scene.sphere_in(&Pose::from_position(grab.target), radius, paint, Layer::Over);
        }
    }

    /// Bodies that move: faster than 1 cm/s, or 0.05 rad/s.
    pub fn moving(&self) -> usize {
        let bodies = self.playback.named.world.bodies();
        let moves = |body: &ferrode::Body| {
            body.linear_velocity().length() > 0.01 || body.angular_velocity().length() > 0.05
        };
        bodies.filter(|(_, body)| body.is_enabled() && moves(body)).count()
    }

    /// Whether the picture changes by itself.
    pub fn is_alive(&self) -> bool {
        !self.playback.paused || !self.held.is_empty() || self.pressed.is_some()
    }

    /// Time, pause and where all links are (position, quaternion), and bodies that were added by hand, as JSON.
    pub fn state(&self) -> serde_json::Value {
        let named = &self.playback.named;
        let moving =
            named.scene.links.iter().enumerate().filter(|(n, _)| named.link_body(LinkId(*n)).is_some());
        let links = moving.map(|(n, link)| {
            let (p, q) = (named.link_pose(LinkId(n)).position, named.link_pose(LinkId(n)).rotation);
            (link.name.clone(), serde_json::json!([p.x, p.y, p.z, q.w, q.x, q.y, q.z]))
        });
        let links: serde_json::Map<String, serde_json::Value> = links.collect();
        let known: BTreeSet<BodyKey> =
            (0..named.scene.links.len()).filter_map(|n| named.link_body(LinkId(n))).collect();
        let added = named.world.bodies().filter(|(key, _)| !known.contains(key));
        let added: Vec<[f64; 3]> = added.map(|(_, body)| body.position().to_array()).collect();
        let selected =
            self.selected.and_then(|body| self.link_of(body)).map(|id| &named.scene.links[id.0].name);
        serde_json::json!({
            "time": self.playback.time(),
            "steps": named.world.step_count(),
            "paused": self.playback.paused,
            "frames_per_second": self.frame_rate,
            "bodies": named.world.body_count(),
            "selected": selected,
            "links": links,
            "added": added,
        })
    }
}

fn pull(grab: Option<Grab>, world: &mut World, h: f64) {
    if let Some(grab) = grab {
        // A body that is gone is held no more: the viewer forgets it itself.
        let _ = grab.pull(world, h);
    }
}
