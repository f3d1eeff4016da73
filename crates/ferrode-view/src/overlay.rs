//! What the engine knows and bodies hide: contacts, joints, masses, boxes.

use crate::joint_marks::{AxisMark, RangeMark, joint_marks};
use ferrode::{Body, Mass, World};
use ferrode_math::{Pose, Quat, Vec3, plane_space, real};
use ferrode_render::{Color, Layer, Paint, Scene};

/// Which overlays are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overlays {
    /// Contact points and their normals.
    pub contacts: bool,
    /// Forces of contacts.
    pub forces: bool,
    /// Joints' anchors, axes and limits.
    pub joints: bool,
    /// Forces of joints, of those that record them ([`record_joint_forces`]).
    pub joint_forces: bool,
    /// Centres of mass, with the axes of the body.
    pub centres: bool,
    /// The box of even density that has the body's mass and moments of inertia.
    pub inertia: bool,
    /// The boxes around geoms, along the world's axes.
    pub boxes: bool,
    /// The boxes of the tree that finds pairs.
    pub tree: bool,
    /// Names of bodies (and of joints, if these are shown), as text.
    pub names: bool,
    /// The time, as text; windows show it in any case.
    pub time: bool,
}

/// How long arrows are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Length of normals and axes, m.
    pub length: f64,
    /// Metres of arrow a newton.
    pub per_newton: f64,
}

impl Scale {
    /// Lengths that suit a world: axes are about as long as bodies are wide, and the weight of the heaviest body an arrow of
    /// twice that.
    pub fn of(world: &World) -> Self {
        let mut sizes: Vec<f64> = world
            .geoms()
            .filter(|info| info.body.is_some())
            .filter_map(|info| world.geom(info.key).ok())
            .map(|geom| geom.aabb().extent().length())
            .filter(|size| size.is_finite())
            .collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let length = 0.35 * sizes.get(sizes.len() / 2).copied().unwrap_or(1.0).max(1e-3);
        let heaviest = world.bodies().map(|(_, body)| body.mass().mass).fold(0.0, f64::max);
        let weight = (heaviest * world.gravity().length()).max(heaviest).max(1e-9);
        Self { length, per_newton: 2.0 * length / weight }
    }
}

/// An arrow of an overlay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    /// Where it starts, in the world.
    pub from: Vec3,
    /// Where its tip is.
    pub to: Vec3,
    /// What it stands for.
    pub kind: ArrowKind,
}

/// What an arrow stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrowKind {
    /// The normal of a contact, into the first body.
    Normal,
    /// The force of a contact on the first body.
    ContactForce,
    /// An axis of a joint.
    Axis,
    /// The force of a joint on its first body.
    JointForce,
}

const POINT: Color = Color::rgb(230, 60, 60);
const NORMAL: Color = Color::rgb(60, 120, 230);
const FORCE: Color = Color::rgb(240, 140, 30);
const ANCHOR: Color = Color::rgb(250, 210, 70);
const AXIS: Color = Color::rgb(40, 170, 120);
const STOP: Color = Color::rgb(200, 80, 180);
const BOX: Color = Color::rgb(90, 100, 120);
const TREE: Color = Color::rgb(190, 120, 40);

/// Lets all joints record their forces from now on.
///
/// # Errors
/// As [`ferrode::dynamics::World::set_joint_feedback`].
pub fn record_joint_forces(world: &mut World) -> Result<(), ferrode::Error> {
    let joints: Vec<_> = world.joints().collect();
    for joint in joints {
        world.set_joint_feedback(joint, true)?;
    }
    Ok(())
}

/// The arrows that are drawn for a world.
pub fn arrows(world: &World, overlays: &Overlays, scale: &Scale) -> Vec<Arrow> {
    let mut list = Vec::new();
    for contact in world.contacts() {
        let from = contact.point.position;
        if overlays.contacts {
            list.push(Arrow {
                from,
                to: from + contact.point.normal * scale.length,
                kind: ArrowKind::Normal,
            });
        }
        if overlays.forces {
            let to = from + contact.force * scale.per_newton;
            list.push(Arrow { from, to, kind: ArrowKind::ContactForce });
        }
    }
    if !(overlays.joints || overlays.joint_forces) {
        return list;
    }
    for joint in world.joints() {
        let Some(marks) = joint_marks(world.dynamics(), joint) else { continue };
        if overlays.joints {
            let half = |axis: &AxisMark| axis.along * scale.length;
            let axes = marks.axes.iter();
            list.extend(axes.map(|a| Arrow {
                from: a.at - half(a),
                to: a.at + half(a),
                kind: ArrowKind::Axis,
            }));
        }
        if overlays.joint_forces
            && let (Ok(Some(feedback)), Some(from)) = (world.joint_feedback(joint), marks.anchors.first())
        {
            let to = *from + feedback.force1 * scale.per_newton;
            list.push(Arrow { from: *from, to, kind: ArrowKind::JointForce });
        }
    }
    list
}

/// Adds overlays to a scene.
pub fn draw(world: &World, overlays: &Overlays, scale: &Scale, scene: &mut Scene) {
    let thin = 0.02 * scale.length;
    for arrow in arrows(world, overlays, scale) {
        let (radius, color) = match arrow.kind {
            ArrowKind::Normal => (thin, NORMAL),
            ArrowKind::ContactForce | ArrowKind::JointForce => (1.5 * thin, FORCE),
            ArrowKind::Axis => (1.5 * thin, AXIS),
        };
        scene.arrow(arrow.from, arrow.to, radius, Paint::from(color).glowing(), Layer::Over);
    }
    let dot = |scene: &mut Scene, at: Vec3, radius: f64, color: Color| {
        scene.sphere_in(&Pose::from_position(at), radius, Paint::from(color).glowing(), Layer::Over);
    };
    if overlays.contacts {
        for contact in world.contacts() {
            dot(scene, contact.point.position, 2.5 * thin, POINT);
        }
    }
    if overlays.joints {
        for marks in world.joints().filter_map(|joint| joint_marks(world.dynamics(), joint)) {
            for anchor in &marks.anchors {
                dot(scene, *anchor, 3.0 * thin, ANCHOR);
            }
            for range in &marks.ranges {
                draw_range(range, scale.length, scene);
            }
        }
    }
    for (_, body) in world.bodies() {
        if overlays.centres {
            draw_centre(&body.pose(), scale.length, thin, scene);
        }
        if overlays.inertia
            && let Some((turn, sides)) = inertia_box(body.mass())
        {
            let pose = Pose::new(body.position(), body.quaternion() * turn);
            scene.wire_box(&pose, sides, 1.5, STOP, Layer::Over);
        }
    }
    if overlays.boxes {
        for aabb in world.geoms().filter_map(|info| world.geom(info.key).ok()).map(|geom| geom.aabb()) {
            if aabb.is_finite() && aabb.extent().abs_max() < 1e5 {
                scene.wire_box(&Pose::from_position(aabb.center()), aabb.extent(), 1.0, BOX, Layer::World);
            }
        }
    }
    if overlays.tree {
        for aabb in world.colliders().tree_boxes(world.space()) {
            scene.wire_box(&Pose::from_position(aabb.center()), aabb.extent(), 1.0, TREE, Layer::World);
        }
    }
}

fn draw_centre(pose: &Pose, length: f64, thin: f64, scene: &mut Scene) {
    for (axis, color) in [(Vec3::X, Color::RED), (Vec3::Y, Color::GREEN), (Vec3::Z, Color::BLUE)] {
        let to = pose.position + pose.transform_vector(axis) * (0.6 * length);
        scene.arrow(pose.position, to, thin, Paint::from(color).glowing(), Layer::Over);
    }
    let ball = Paint::from(Color::BLACK).glowing();
    scene.sphere_in(&Pose::from_position(pose.position), 2.0 * thin, ball, Layer::Over);
}

/// The lines of a range: for an axis that turns its stops, the arc between them and a hand where it is, for one that slides a
/// rail with its stops, along which the first body's centre goes. The last line is the hand, or where the centre is.
pub fn range_lines(range: &RangeMark, length: f64) -> Vec<[Vec3; 2]> {
    const PARTS: usize = 24;
    let radius = 0.6 * length;
    let limit = &range.limit;
    let stops: Vec<f64> = range.stops().collect();
    let mut lines = Vec::new();
    if limit.turns {
        lines.extend(stops.iter().map(|stop| [range.at, range.place(*stop, radius)]));
        if let [low, high] = *stops {
            let angle = |i: usize| low + (high - low) * i as f64 / PARTS as f64;
            lines.extend(
                (0..PARTS).map(|i| [range.place(angle(i), radius), range.place(angle(i + 1), radius)]),
            );
        }
        lines.push([range.at, range.place(limit.position, radius)]);
        return lines;
    }
    let (across, _) = plane_space(limit.axis);
    let mark = |position: f64, size: f64| {
        let at = range.place(position, 0.0);
        [at - across * size, at + across * size]
    };
    if let [low, high] = *stops {
        lines.push([range.place(low, 0.0), range.place(high, 0.0)]);
    }
    lines.extend(stops.iter().map(|stop| mark(*stop, 0.3 * length)));
    lines.push(mark(limit.position, 0.15 * length));
    lines
}

fn draw_range(range: &RangeMark, length: f64, scene: &mut Scene) {
    let lines = range_lines(range, length);
    for (n, [from, to]) in lines.iter().enumerate() {
        let (width, color) = if n + 1 == lines.len() { (2.5, ANCHOR) } else { (2.0, STOP) };
        scene.line(*from, *to, width, color, Layer::Over);
    }
}

/// The box of even density with a mass' moments: its axes' rotation in the body, and its sides; `None` for moments that no
/// solid has.
///
/// A box of sides a, b, c has the moments m (b² + c²)/12 and so on, so a² = 6 (I₂ + I₃ − I₁)/m.
pub fn inertia_box(mass: &Mass) -> Option<(Quat, Vec3)> {
    let (moments, axes) = principal(mass)?;
    let side = |i: usize| {
        let square = 6.0 * (moments[(i + 1) % 3] + moments[(i + 2) % 3] - moments[i]) / mass.mass;
        (square >= 0.0 && square.is_finite()).then(|| square.sqrt())
    };
    Some((axes, Vec3::new(side(0)?, side(1)?, side(2)?)))
}

/// Principal moments and the rotation to their axes, by Jacobi's rotations (Numerische Mathematik 9, 1, 1966).
fn principal(mass: &Mass) -> Option<([f64; 3], Quat)> {
    let mut a = mass.inertia.rows;
    let mut q = Quat::IDENTITY;
    for _ in 0..24 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if a[i][j].abs() <= 1e-14 * (a[i][i].abs() + a[j][j].abs()) {
                continue;
            }
            let angle = 0.5 * real::atan2(2.0 * a[i][j], a[i][i] - a[j][j]);
            // About the third axis, from i to j.
            let mut axis = [0.0; 3];
            axis[3 - i - j] = if (j + 3 - i) % 3 == 1 { 1.0 } else { -1.0 };
            q = q * Quat::from_axis_angle(Vec3::from_array(axis), angle);
            let r = q.to_matrix();
            let turned = r.transpose() * (mass.inertia * r);
            a = turned.rows;
        }
    }
    let moments = [a[0][0], a[1][1], a[2][2]];
    moments.iter().all(|m| m.is_finite()).then_some((moments, q))
}

/// Kinetic and potential energy of one body in a world's gravity, J.
pub fn energy_of(world: &World, body: &Body) -> [f64; 2] {
    let height = if body.gravity_mode() { -world.gravity().dot(body.position()) } else { 0.0 };
    [body.kinetic_energy(), body.mass().mass * height]
}

#[cfg(test)]
mod tests {
    use super::inertia_box;
    use ferrode::{Mass, Quat, Vec3};

    #[test]
    fn a_box_is_its_own_inertia_box() {
        let sides = Vec3::new(0.3, 0.5, 1.1);
        let turn = Quat::from_axis_angle(Vec3::new(0.3, -0.5, 0.8).normalized().unwrap(), 1.3);
        let mass = Mass::cuboid(700.0, sides).unwrap().rotate(turn.to_matrix()).unwrap();
        let (axes, found) = inertia_box(&mass).unwrap();
        // The same box, perhaps with its axes in another order: its corners are the same set.
        let mut lengths = found.to_array();
        lengths.sort_by(f64::total_cmp);
        for (got, want) in lengths.iter().zip([0.3, 0.5, 1.1]) {
            assert!((got - want).abs() < 1e-9, "{lengths:?}");
        }
        let longest = (0..3).max_by(|a, b| found.to_array()[*a].total_cmp(&found.to_array()[*b])).unwrap();
        let mut axis = [0.0; 3];
        axis[longest] = 1.0;
        assert!(axes.rotate(Vec3::from_array(axis)).dot(turn.rotate(Vec3::Z)).abs() > 1.0 - 1e-9);
    }
}
