//! Random poses of two geoms that touch, are near each other, or are apart.

use crate::shapes::{Class, SIDE, SIZES, height};
use ferrode_collide::{CollideOptions, Frame, Heightfield, Ray, Shape, narrow};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3};

/// How two geoms are to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// They have contacts, none deeper than 0.15 m.
    Touching,
    /// Their boxes overlap, they do not.
    Near,
    /// Their boxes are apart.
    Separated,
}

impl State {
    /// All.
    pub const ALL: [Self; 3] = [Self::Touching, Self::Near, Self::Separated];
}

/// Two geoms at poses.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Which of the sizes.
    pub sizes: [usize; 2],
    /// Where.
    pub poses: [Pose; 2],
}

/// Repeatable random numbers.
pub struct Numbers(OdeRandom);

impl Numbers {
    /// From a seed.
    pub fn new(seed: u32) -> Self {
        Self(OdeRandom::new(seed))
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.0.next_u32()) / 4294967296.0
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::new(self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(-1.0, 1.0));
            if let Some(n) = v.normalized().filter(|_| v.length() <= 1.0) {
                return n;
            }
        }
    }

    fn turn(&mut self) -> Quat {
        Quat::from_axis_angle(self.direction(), self.within(0.0, 6.3))
    }

    /// Standing, lying or anyhow.
    fn pose(&mut self, position: Vec3, upright: bool) -> Pose {
        let turn = if upright {
            let lying = if self.within(0.0, 1.0) < 0.3 { Vec3::X * 0.5 } else { Vec3::ZERO };
            let tilt = Quat::from_axis_angle(Vec3::X, core::f64::consts::PI * lying.x);
            Quat::from_axis_angle(Vec3::Z, self.within(0.0, 6.3)) * tilt
        } else {
            self.turn()
        };
        Pose::new(position, turn)
    }
}

/// `count` samples of a state. Half of all are upright, as bodies are that stand on each other.
pub fn samples(
    classes: [Class; 2],
    shapes: [&[Shape]; 2],
    state: State,
    count: usize,
    n: &mut Numbers,
) -> Vec<Sample> {
    let mut list = Vec::new();
    for _ in 0..1_000_000 {
        if list.len() == count {
            break;
        }
        let sample = candidate(classes, state, list.len() % 2 == 0, n);
        if is(shapes, classes, &sample, state) {
            list.push(sample);
        }
    }
    list
}

fn candidate(classes: [Class; 2], state: State, upright: bool, n: &mut Numbers) -> Sample {
    let mut size = || (n.within(0.0, SIZES as f64) as usize).min(SIZES - 1);
    let sizes = [size(), size()];
    let apart = state == State::Separated;
    if classes[1].is_ground() {
        let (x, y) = (n.within(-0.4, 0.4) * SIDE, n.within(-0.4, 0.4) * SIDE);
        let above = if apart { n.within(3.0, 5.0) } else { n.within(-0.2, 1.2) };
        let at = Vec3::new(x, y, height(x, y) + above);
        let turn = if classes[1] == Class::Heightfield { Heightfield::z_up() } else { Quat::IDENTITY };
        let ground = Pose::new(Vec3::ZERO, turn);
        let body = match classes[0] {
            Class::Ray => {
                let down = Vec3::new(n.within(-1.0, 1.0), n.within(-1.0, 1.0), n.within(-1.0, 0.3));
                Ray::pose(at, down).unwrap_or(ground)
            }
            _ => n.pose(at, upright),
        };
        return Sample { sizes, poses: [body, ground] };
    }
    let place = Vec3::new(n.within(-1.0, 1.0), n.within(-1.0, 1.0), n.within(-1.0, 1.0));
    let second = n.pose(place, upright);
    if classes[0] == Class::Ray {
        let from = second.position + n.direction() * n.within(0.0, if apart { 4.0 } else { 1.8 });
        let to = second.position + n.direction() * n.within(0.0, 0.9);
        let pose = Ray::pose(from, to - from).unwrap_or(second);
        return Sample { sizes, poses: [pose, second] };
    }
    let distance = if apart { n.within(0.5, 3.0) } else { n.within(0.1, 1.8) };
    let direction = if upright && n.within(0.0, 1.0) < 0.5 {
        Vec3::new(n.within(-0.3, 0.3), n.within(-0.3, 0.3), if n.within(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 })
    } else {
        n.direction()
    };
    let first = n.pose(second.position + direction * distance, upright);
    Sample { sizes, poses: [first, second] }
}

fn is(shapes: [&[Shape]; 2], classes: [Class; 2], sample: &Sample, state: State) -> bool {
    let [a, b] = [0, 1].map(|k| &shapes[k][sample.sizes[k]]);
    let [fa, fb] = sample.poses.map(|p| Frame::from(&p));
    let boxes = a.aabb_in(&fa).overlaps(&b.aabb_in(&fb));
    let mut list = Vec::new();
    narrow::collide_frames((a, &fa), (b, &fb), CollideOptions::default(), &mut list);
    match state {
        State::Touching => {
            let deepest = list.iter().map(|c| c.point.depth).fold(0.0, f64::max);
            !list.is_empty() && (classes[0] == Class::Ray || deepest < 0.15)
        }
        State::Near => list.is_empty() && boxes,
        State::Separated => list.is_empty() && (!boxes || classes[1] == Class::Plane),
    }
}
