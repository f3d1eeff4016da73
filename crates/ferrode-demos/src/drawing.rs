//! What a scene shows beside its bodies: ropes, springs, stands, the paths that bodies took. None of it is simulated.

use crate::kit::{from_z_to, sin_cos};
use core::f64::consts::TAU;
use ferrode::{Capsule, Cuboid, DBall, DHinge, JointType, Pose, Shape, Vec3, World};

/// A colour: red, green, blue from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tint(pub u8, pub u8, pub u8);

impl Tint {
    /// Stands and frames.
    pub const FRAME: Self = Self(120, 124, 132);
    /// Ropes, threads, chains.
    pub const ROPE: Self = Self(70, 66, 62);
    /// Springs.
    pub const SPRING: Self = Self(58, 62, 72);
    /// Paths that bodies took.
    pub const PATH: Self = Self(214, 68, 60);
    /// What is expected.
    pub const MARK: Self = Self(52, 120, 200);
    /// The cloth of a table.
    pub const FELT: Self = Self(64, 122, 92);
}

/// Something that is drawn.
#[derive(Clone, Debug)]
pub enum Mark {
    /// A shape at a pose.
    Solid {
        /// The shape.
        shape: Shape,
        /// Where it is, in the world.
        pose: Pose,
        /// Its colour.
        tint: Tint,
    },
    /// A line.
    Line {
        /// Where it begins, in the world.
        from: Vec3,
        /// Where it ends.
        to: Vec3,
        /// How wide it is, pixels.
        width: f32,
        /// Its colour.
        tint: Tint,
    },
    /// An arrow.
    Arrow {
        /// Where it begins, in the world.
        from: Vec3,
        /// Where its tip is.
        to: Vec3,
        /// The radius of its shaft, m.
        radius: f64,
        /// Its colour.
        tint: Tint,
    },
}

/// All that a scene shows beside its bodies, now.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// What is drawn.
    pub marks: Vec<Mark>,
    /// Height of a ground to draw, for shadows to fall on, where the world has none; m.
    pub floor: Option<f64>,
}

impl Drawing {
    /// A shape; one that cannot be made (too thin, say) is left out.
    pub(crate) fn solid(
        &mut self,
        shape: Result<impl Into<Shape>, ferrode::collide::ShapeError>,
        pose: Pose,
        tint: Tint,
    ) {
        if let Ok(shape) = shape {
            self.marks.push(Mark::Solid { shape: shape.into(), pose, tint });
        }
    }

    /// A box along the world's axes.
    pub(crate) fn block(&mut self, sides: Vec3, center: Vec3, tint: Tint) {
        self.solid(Cuboid::new(sides), Pose::from_position(center), tint);
    }

    /// A stand on the ground z = 0 that holds an axle along y at a point.
    pub(crate) fn gallows(&mut self, axle: Vec3) {
        let back = axle + Vec3::new(0.0, 0.4, 0.0);
        self.rod(axle - Vec3::Y * 0.05, back, 0.03, Tint::FRAME);
        self.rod(back, Vec3::new(back.x, back.y, 0.0), 0.05, Tint::FRAME);
    }

    /// A rod with round ends.
    pub(crate) fn rod(&mut self, from: Vec3, to: Vec3, radius: f64, tint: Tint) {
        let along = to - from;
        let pose = Pose { position: (from + to) * 0.5, rotation: from_z_to(along) };
        self.solid(Capsule::new(radius, along.length()), pose, tint);
    }

    /// A line of some pixels' width.
    pub(crate) fn line(&mut self, from: Vec3, to: Vec3, tint: Tint) {
        self.marks.push(Mark::Line { from, to, width: 2.0, tint });
    }

    /// An arrow.
    pub(crate) fn arrow(&mut self, from: Vec3, to: Vec3, radius: f64, tint: Tint) {
        self.marks.push(Mark::Arrow { from, to, radius, tint });
    }

    /// A path through points.
    pub(crate) fn path(&mut self, trail: &Trail) {
        for pair in trail.points.windows(2) {
            self.line(pair[0], pair[1], Tint::PATH);
        }
    }

    /// A coil spring of a radius and a number of turns.
    pub(crate) fn spring(&mut self, from: Vec3, to: Vec3, radius: f64, turns: u32) {
        let along = to - from;
        let (length, turn) = (along.length(), from_z_to(along));
        const PARTS: u32 = 14;
        let count = turns * PARTS;
        let point = |i: u32| {
            let t = f64::from(i) / f64::from(count);
            let (sin, cos) = sin_cos(TAU * f64::from(turns) * t);
            // It begins and ends on its axis.
            let out = radius * (8.0 * t.min(1.0 - t)).min(1.0);
            from + turn.rotate(Vec3::new(out * cos, out * sin, length * t))
        };
        for i in 0..count {
            self.rod(point(i), point(i + 1), 0.12 * radius, Tint::SPRING);
        }
    }

    /// A rod for each joint that stands for one: double balls and double hinges.
    pub(crate) fn rods(&mut self, world: &World, radius: f64) {
        for joint in world.joints() {
            let ends = match world.joint_type(joint) {
                Ok(JointType::DBall) => world.joint::<DBall>(joint).map(|j| [j.anchor1(), j.anchor2()]),
                Ok(JointType::DHinge) => world.joint::<DHinge>(joint).map(|j| [j.anchor1(), j.anchor2()]),
                _ => continue,
            };
            if let Ok([from, to]) = ends {
                self.rod(from, to, radius, Tint::ROPE);
            }
        }
    }
}

/// The way that a point took: its last places.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trail {
    points: Vec<Vec3>,
    /// Steps since the last point was kept.
    steps: u32,
}

/// As many places are kept.
const KEPT: usize = 600;

impl Trail {
    /// Looks where the point is after a step, and keeps each `every`-th place.
    pub fn follow(&mut self, point: Vec3, every: u32) {
        if self.steps.is_multiple_of(every) {
            if self.points.len() == KEPT {
                self.points.remove(0);
            }
            self.points.push(point);
        }
        self.steps = self.steps.wrapping_add(1);
    }
}
