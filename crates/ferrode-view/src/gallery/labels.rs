//! Words over a picture.

use egui::{Align2, Color32, FontId, pos2, vec2};
use ferrode_math::Vec3;
use ferrode_render::Camera;

/// A word beside a point of the world.
#[derive(Clone, Debug)]
pub struct Label {
    /// The point.
    pub at: Vec3,
    /// The word.
    pub text: String,
    /// Where it stands.
    pub side: Side,
}

/// Where a word stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// On the point.
    On,
    /// Above it, on the right.
    Above,
    /// Below it, on the right.
    Below,
}

/// Height of letters, pixels.
const HEIGHT: f32 = 16.0;

/// Paints labels over a picture of a size.
pub fn paint(painter: &egui::Painter, labels: &[Label], camera: &Camera, size: [u32; 2]) {
    for label in labels {
        let Some(([x, y], _)) = camera.project(label.at, size) else { continue };
        let point = pos2(x as f32, y as f32);
        let (place, align) = match label.side {
            Side::On => (point, Align2::CENTER_CENTER),
            Side::Above => (point + vec2(7.0, -3.0), Align2::LEFT_BOTTOM),
            Side::Below => (point + vec2(7.0, 4.0), Align2::LEFT_TOP),
        };
        let write = |dx: f32, dy: f32, color: Color32| {
            let font = FontId::proportional(HEIGHT);
            painter.text(place + vec2(dx, dy), align, &label.text, font, color);
        };
        // A pale rim, for words over dark things.
        for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
            write(dx, dy, Color32::from_white_alpha(200));
        }
        write(0.0, 0.0, Color32::from_rgb(24, 26, 30));
    }
}
