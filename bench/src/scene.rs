//! The scenes, written once for every engine.

use crate::engine::{ContactLine, Engine, Method, Mu};
use ferrode_collide::{CollideOptions, Cuboid, Plane, Shape, narrow};
use ferrode_math::{Pose, Quat, Vec3};

/// A scene: which one, how it is stepped, and for how long.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// Its name in the results.
    pub name: &'static str,
    /// What it is.
    pub kind: Kind,
    /// The stepper.
    pub method: Method,
    /// Number of steps that are timed.
    pub steps: usize,
}

/// What a scene is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Boxes in 20 rows of 20, 19, … 1, each on two below.
    Pyramid,
    /// Robots of 30 bodies: a torso on the ground, and limbs of hinges with brakes.
    Robots,
    /// Links hanging from a ball joint, started level.
    Chain,
    /// A wall of 20 boxes, with gaps, that settles.
    Wall,
}

/// All scenes.
pub const SCENES: [Scene; 6] = [
    Scene { name: "pyramid of 210 boxes", kind: Kind::Pyramid, method: Method::Quick, steps: 100 },
    Scene { name: "64 robots of 30 hinges", kind: Kind::Robots, method: Method::Quick, steps: 50 },
    Scene { name: "chain of 200 links", kind: Kind::Chain, method: Method::Quick, steps: 50 },
    Scene { name: "64 robots of 30 hinges", kind: Kind::Robots, method: Method::Direct, steps: 20 },
    Scene { name: "chain of 200 links", kind: Kind::Chain, method: Method::Direct, steps: 20 },
    Scene { name: "loose wall of 20 boxes", kind: Kind::Wall, method: Method::Direct, steps: 60 },
];

impl Scene {
    /// Step size in seconds.
    pub const H: f64 = 0.01;
    /// Friction of all contacts.
    pub const MU: Mu = Mu(0.5);
    const BOX: Vec3 = Vec3::new(1.0, 0.5, 0.5);

    /// The scene in an engine.
    pub fn build<E: Engine>(&self) -> E {
        let mut engine = E::new(Vec3::new(0.0, 0.0, -9.81));
        match self.kind {
            Kind::Pyramid => boxes(&mut engine, 20, |row| 20 - row, Vec3::new(0.05, 0.0, 0.002)),
            Kind::Wall => boxes(&mut engine, 4, |_| 5, Vec3::new(0.02, 0.0, 0.02)),
            Kind::Robots => robots(&mut engine, 64),
            Kind::Chain => chain(&mut engine, 200),
        }
        engine
    }

    /// Whether boxes touch in it.
    pub fn has_contacts(&self) -> bool {
        matches!(self.kind, Kind::Pyramid | Kind::Wall)
    }

    /// The contacts of boxes at these poses with each other and with the ground.
    pub fn contacts(&self, poses: &[(Vec3, Quat)]) -> Vec<ContactLine> {
        if !self.has_contacts() {
            return Vec::new();
        }
        let cuboid = Shape::from(Cuboid::new(Self::BOX).expect("sides are positive"));
        let ground = Shape::from(Plane::new(Vec3::Z, 0.0).expect("a unit normal"));
        let poses: Vec<Pose> = poses.iter().map(|(p, q)| Pose::new(*p, *q)).collect();
        let reach = Self::BOX.length();
        let (mut lines, mut found) = (Vec::new(), Vec::new());
        for (i, a) in poses.iter().enumerate() {
            narrow::collide((&cuboid, a), (&ground, &Pose::IDENTITY), CollideOptions::default(), &mut found);
            lines.extend(found.drain(..).map(|c| ContactLine { first: i, second: None, point: c.point }));
            for (j, b) in poses.iter().enumerate().skip(i + 1) {
                if (a.position - b.position).length() < reach {
                    narrow::collide((&cuboid, a), (&cuboid, b), CollideOptions::default(), &mut found);
                    let line = |c: ferrode_collide::GeomContact| ContactLine {
                        first: i,
                        second: Some(j),
                        point: c.point,
                    };
                    lines.extend(found.drain(..).map(line));
                }
            }
        }
        lines
    }
}

/// Rows of boxes, each shifted by half a box against the one below, with gaps.
fn boxes(engine: &mut impl Engine, rows: usize, count: impl Fn(usize) -> usize, gap: Vec3) {
    let pitch = Scene::BOX + gap;
    for row in 0..rows {
        let n = count(row);
        // In a pyramid a row stands symmetrically on the one below; in a wall every second row is shifted.
        let start = if n == count(rows - 1 - row) { 0.5 * (row % 2) as f64 } else { -0.5 * n as f64 };
        for i in 0..n {
            let x = (start + i as f64) * pitch.x;
            let z = 0.5 * Scene::BOX.z + row as f64 * pitch.z;
            engine.add_box(1.0, Scene::BOX, Vec3::new(x, 0.0, z), Quat::IDENTITY);
        }
    }
}

/// Each robot: a torso hinged to the world, and five limbs of six bodies less one, 30 hinges in all.
fn robots(engine: &mut impl Engine, count: usize) {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    for robot in 0..count {
        let base = Vec3::new((robot % 8) as f64 * 5.0, (robot / 8) as f64 * 5.0, 3.0);
        let torso = engine.add_box(5.0, Vec3::new(0.4, 0.3, 0.6), base, Quat::IDENTITY);
        engine.add_hinge(Some(torso), None, base, Vec3::Z, Some(5.0));
        for k in 0..29 {
            let (limb, joint) = (k % 5, k / 5);
            let direction = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z][limb];
            let length = 0.25;
            let parent = if joint == 0 { torso } else { torso + k + 1 - 5 };
            let anchor = base + direction * (0.4 + joint as f64 * length);
            let centre = anchor + direction * (0.5 * length);
            let sides = Vec3::splat(0.08) + direction.abs() * (length - 0.08);
            let body = engine.add_box(0.5 + 0.1 * joint as f64, sides, centre, Quat::IDENTITY);
            let axis = axes[(limb / 2 + joint + 1) % 3];
            engine.add_hinge(Some(body), Some(parent), anchor, axis, Some(1.0 + joint as f64));
        }
    }
}

fn chain(engine: &mut impl Engine, links: usize) {
    let length = 0.2;
    let mut last = None;
    for i in 0..links {
        let at = Vec3::new((i as f64 + 0.5) * length, 0.0, 0.0);
        let link = engine.add_box(0.2, Vec3::new(length, 0.05, 0.05), at, Quat::IDENTITY);
        engine.add_ball(Some(link), last, Vec3::new(i as f64 * length, 0.0, 0.0));
        last = Some(link);
    }
}
