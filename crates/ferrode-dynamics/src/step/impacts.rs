//! Impacts in turn, pair of bodies after pair, before a step of `Direct`, if its settings ask for it.
//!
//! The step's own solution has all contacts bounce at once: a ball that hits a row of touching ones meets them as one body. In turn, the
//! pair that approaches fastest collides first, as if alone, then what approaches fastest now, until nothing does: the last ball of
//! the row leaves. Both are limits of stiff elastic bodies; which one is nearer depends on the bodies (B. Smith, D. M. Kaufman,
//! E. Vouga, R. Tamstorf, E. Grinspun, "Reflections on simultaneous impact", SIGGRAPH 2012).

use super::few_rows::FewRows;
use super::{Island, SolverBody};
use crate::World;
use crate::arena::NIL;
use crate::joint::{JointKind, SurfaceMode};
use ferrode_math::Vec3;
use std::collections::BinaryHeap;

/// So many impacts per pair of bodies and step on average; what approaches still is left to the step's own solution.
const MOST_IMPACTS: usize = 100;
/// Approaches below this part of the fastest one are rounding.
const ROUNDING: f64 = 1e-12;
/// Part of its diagonal that is added to each row, so that the corners of a face share an impulse.
const SHARED: f64 = 1e-10;

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    points: Vec<Point>,
    pairs: Vec<Pair>,
    /// The pairs of each body: `starts[b]..starts[b + 1]` in `at_body`.
    starts: Vec<u32>,
    at_body: Vec<u32>,
    queue: BinaryHeap<(u64, core::cmp::Reverse<u32>)>,
    problem: FewRows,
}

/// A contact's normal row.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// Places of the bodies, or `NIL`.
    bodies: [u32; 2],
    /// Into the first body.
    normal: Vec3,
    /// r × n of each body.
    angular: [Vec3; 2],
    /// Restitution, and the approach above which it acts; none if the surface does not bounce.
    bounce: Option<(f64, f64)>,
}

/// The points that two bodies share.
#[derive(Clone, Copy, Debug)]
struct Pair {
    bodies: [u32; 2],
    first: u32,
    end: u32,
    /// What the last entry in the queue says.
    approach: f64,
}

impl Point {
    /// How fast the surfaces depart from each other.
    fn departure(&self, bodies: &[SolverBody]) -> f64 {
        let of = |side: usize| {
            bodies.get(self.bodies[side] as usize).map_or(0.0, |body| {
                let linear = self.normal.dot(body.frame.linear_velocity);
                let linear = if side == 0 { linear } else { -linear };
                linear + self.angular[side].dot(body.frame.angular_velocity)
            })
        };
        of(0) + of(1)
    }

    /// How fast the surfaces approach, if so fast that they bounce.
    fn impact(&self, bodies: &[SolverBody]) -> f64 {
        let approach = -self.departure(bodies);
        match self.bounce {
            Some((_, least)) if approach > least => approach,
            _ => 0.0,
        }
    }
}

impl World {
    /// Lets the contacts of an island collide in turn: changes the velocities of `island.bodies`.
    pub(super) fn collide_in_turn(&self, island: &mut Island, work: &mut Workspace) {
        work.points.clear();
        for span in &island.spans {
            let joint = self.joints.at(span.joint);
            let JointKind::Contact(contact) = &joint.kind else { continue };
            let surface = &contact.surface;
            // A surface that moves along its normal drives bodies rather than being hit; the step sees to it.
            if surface.mode.has(SurfaceMode::MOTION_N) {
                continue;
            }
            let normal = contact.point.normal * if joint.reverse { -1.0 } else { 1.0 };
            let turning = |place: u32| {
                let body = island.bodies.get(place as usize);
                body.map_or(Vec3::ZERO, |b| (contact.point.position - b.frame.position).cross(normal))
            };
            let [a, b] = span.bodies.map(turning);
            let bounces = surface.mode.has(SurfaceMode::BOUNCE) && surface.bounce_velocity >= 0.0;
            work.points.push(Point {
                bodies: span.bodies,
                normal,
                angular: [a, -b],
                bounce: bounces.then_some((surface.bounce, surface.bounce_velocity)),
            });
        }
        if work.points.iter().all(|p| p.impact(&island.bodies) == 0.0) {
            return;
        }
        work.group(island.bodies.len());
        work.run(&mut island.bodies);
    }
}

impl Workspace {
    /// Lists pairs, and which ones each body takes part in.
    fn group(&mut self, bodies: usize) {
        let key = |p: &Point| (p.bodies[0].min(p.bodies[1]), p.bodies[0].max(p.bodies[1]));
        self.points.sort_by_key(key);
        self.pairs.clear();
        for (i, point) in self.points.iter().enumerate() {
            let (low, high) = key(point);
            match self.pairs.last_mut() {
                Some(pair) if pair.bodies == [low, high] => pair.end = i as u32 + 1,
                _ => self.pairs.push(Pair {
                    bodies: [low, high],
                    first: i as u32,
                    end: i as u32 + 1,
                    approach: 0.0,
                }),
            }
        }
        self.starts.clear();
        self.starts.resize(bodies + 2, 0);
        let ends = || self.pairs.iter().enumerate().flat_map(|(i, p)| p.bodies.map(|b| (i, b)));
        for (_, body) in ends().filter(|(_, b)| *b != NIL) {
            self.starts[body as usize + 2] += 1;
        }
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.at_body.clear();
        self.at_body.resize(self.starts.last().map_or(0, |n| *n as usize), 0);
        for (pair, body) in ends().filter(|(_, b)| *b != NIL) {
            let next = &mut self.starts[body as usize + 1];
            self.at_body[*next as usize] = pair as u32;
            *next += 1;
        }
    }

    /// Collides pair after pair.
    fn run(&mut self, bodies: &mut [SolverBody]) {
        self.queue.clear();
        for pair in 0..self.pairs.len() {
            self.look_at(pair, bodies);
        }
        let fastest = self.pairs.iter().map(|p| p.approach).fold(0.0, f64::max);
        let mut left = MOST_IMPACTS * self.pairs.len();
        while let Some((approach, core::cmp::Reverse(pair))) = self.queue.pop() {
            let pair = pair as usize;
            // An entry from before one of the bodies changed.
            if self.pairs[pair].approach.to_bits() != approach {
                continue;
            }
            if f64::from_bits(approach) <= ROUNDING * fastest || left == 0 {
                break;
            }
            left -= 1;
            if !self.collide(pair, bodies) {
                continue;
            }
            for body in self.pairs[pair].bodies {
                if body == NIL {
                    continue;
                }
                for i in self.starts[body as usize]..self.starts[body as usize + 1] {
                    self.look_at(self.at_body[i as usize] as usize, bodies);
                }
            }
        }
    }

    /// Puts a pair into the queue if it collides.
    fn look_at(&mut self, pair: usize, bodies: &[SolverBody]) {
        let Pair { first, end, .. } = self.pairs[pair];
        let points = &self.points[first as usize..end as usize];
        let approach = points.iter().map(|p| p.impact(bodies)).fold(0.0, f64::max);
        if approach > 0.0 && approach.is_finite() {
            // Positive numbers are in the order of their bits.
            self.queue.push((approach.to_bits(), core::cmp::Reverse(pair as u32)));
        }
        self.pairs[pair].approach = approach;
    }

    /// Gives two bodies the impulses at their points after which none approaches, and those that did depart with their restitution.
    fn collide(&mut self, pair: usize, bodies: &mut [SolverBody]) -> bool {
        let Pair { first, end, .. } = self.pairs[pair];
        let points = &self.points[first as usize..end as usize];
        let n = points.len();
        let inverse = |place: u32| {
            bodies
                .get(place as usize)
                .map_or((0.0, ferrode_math::Mat3::ZERO), |b| (b.inv_mass, b.inv_inertia))
        };
        // All points in the order of the first one's bodies.
        let pair_bodies = points[0].bodies;
        let ends = pair_bodies.map(inverse);
        let seen = |p: &Point| {
            let swapped = p.bodies != pair_bodies;
            let normal = if swapped { -p.normal } else { p.normal };
            let [a, b] = p.angular;
            (normal, if swapped { [b, a] } else { [a, b] })
        };
        self.problem.begin(n);
        for (i, p) in points.iter().enumerate() {
            let (normal, angular) = seen(p);
            for (j, q) in points.iter().enumerate().take(i + 1) {
                let (other, turning) = seen(q);
                let linear = normal.dot(other) * (ends[0].0 + ends[1].0);
                *self.problem.entry(i, j) =
                    linear + angular[0].dot(ends[0].1 * turning[0]) + angular[1].dot(ends[1].1 * turning[1]);
            }
            *self.problem.entry(i, i) *= 1.0 + SHARED;
            let departure = p.departure(bodies);
            let wanted = match p.bounce {
                Some((bounce, least)) if -departure > least => -bounce * departure,
                _ => 0.0,
            };
            self.problem.push(wanted - departure, (0.0, f64::INFINITY), -1);
        }
        // Neither body can move.
        if !(0..n).all(|i| *self.problem.entry(i, i) > 0.0) {
            return false;
        }
        if self.problem.solve() != Some(true) {
            return false;
        }
        for (p, impulse) in points.iter().zip(&self.problem.x) {
            for (side, place) in p.bodies.into_iter().enumerate() {
                if let Some(body) = bodies.get_mut(place as usize) {
                    let along = if side == 0 { p.normal } else { -p.normal };
                    body.frame.linear_velocity += along * (impulse * body.inv_mass);
                    body.frame.angular_velocity += body.inv_inertia * (p.angular[side] * *impulse);
                }
            }
        }
        true
    }
}
