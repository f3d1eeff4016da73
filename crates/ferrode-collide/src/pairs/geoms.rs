//! What the cache knows of a geom.

use crate::manifold::Vec3f;
use crate::space::f32_box::Box32;
use crate::{Frame, Shape};
use ferrode_math::{Aabb, Vec3};

/// Who moves a geom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Nobody, or the caller by hand: contacts do not. Two such geoms make no pair.
    Fixed,
    /// It may be moved by contacts, but rests.
    Asleep,
    /// It may be moved by contacts.
    Awake,
}

/// What became of geoms since the last update.
#[derive(Clone, Debug, Default)]
pub(super) struct News {
    /// Moved or added.
    pub moved: Vec<u32>,
    /// Awake again, or moved by hand.
    pub woken: Vec<u32>,
}

/// A geom of the cache that a task tells news of: see [`PairCache::tell`](super::PairCache::tell).
#[derive(Debug)]
pub struct Told<'a> {
    pub(super) id: u32,
    pub(super) geom: Option<&'a mut GeomState>,
    pub(super) next: u32,
    pub(super) news: &'a mut News,
}

impl Told<'_> {
    /// As [`PairCache::move_geom`](super::PairCache::move_geom).
    #[inline]
    pub fn move_geom(&mut self, frame: &Frame) {
        if let Some(geom) = &mut self.geom {
            geom.follow(self.id, frame, self.next, self.news);
        }
    }

    /// As [`PairCache::set_ahead`](super::PairCache::set_ahead).
    #[inline]
    pub fn set_ahead(&mut self, ahead: f32, way: Vec3f) {
        if let Some(geom) = &mut self.geom {
            geom.look_ahead(self.id, (ahead, way), self.next, self.news);
        }
    }

    /// As [`PairCache::set_awake`](super::PairCache::set_awake).
    pub fn set_awake(&mut self, awake: bool) {
        if let Some(geom) = &mut self.geom {
            geom.rouse(self.id, awake, self.news);
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct GeomState {
    pub shape: Shape,
    pub frame: Frame,
    /// Metres that any point of it can have moved, ever.
    pub odometer: f64,
    /// No look at the box until [`spent`](Self::spent) is beyond this.
    pub leaf_limit: f64,
    /// Distance of the furthest point from the frame's origin.
    pub reach: f64,
    /// The update before which it moved last.
    pub moved: u32,
    /// The update in which its leaf changed last.
    pub leaf_changed: u32,
    pub ahead: f32,
    /// In the coming step.
    pub way: Vec3f,
    pub motion: Motion,
    pub bounded: bool,
}

impl GeomState {
    pub fn new(shape: Shape, frame: &Frame, motion: Motion) -> Self {
        let own = shape.aabb_in(&Frame::IDENTITY);
        let bounded = own.is_finite() && !matches!(shape, Shape::Plane(_));
        let reach = if bounded { own.max.max(-own.min).length() } else { f64::INFINITY };
        Self {
            shape,
            frame: *frame,
            odometer: 0.0,
            leaf_limit: f64::NEG_INFINITY,
            reach,
            moved: 0,
            leaf_changed: 0,
            ahead: 0.0,
            way: Vec3f::ZERO,
            motion,
            bounded,
        }
    }

    #[inline]
    pub fn awake(&self) -> bool {
        self.motion == Motion::Awake
    }

    /// The odometer, and what it looks ahead: what grows by either may come nearer than was known.
    #[inline]
    pub fn spent(&self) -> f64 {
        self.odometer + f64::from(self.ahead)
    }

    /// How far a pair looks ahead beyond the margin: as far as both do, but no further than they come nearer.
    #[inline(always)]
    pub fn ahead_of_both(&self, other: &Self) -> f64 {
        let ahead = self.ahead + other.ahead;
        if ahead == 0.0 {
            return 0.0;
        }
        let nearer = (self.way - other.way).length();
        f64::from(if nearer < ahead { nearer } else { ahead })
    }

    /// Goes to another place; false if that is none, or the same.
    #[inline]
    pub fn go(&mut self, frame: &Frame) -> bool {
        let shift = (frame.position - self.frame.position).length_squared();
        let mut turn = 0.0;
        for (r, s) in frame.rotation.rows.iter().zip(&self.frame.rotation.rows) {
            for (x, y) in r.iter().zip(s) {
                turn += (x - y) * (x - y);
            }
        }
        // The chord of the angle is the norm of the matrices' difference over √2.
        let by = shift.sqrt() + if turn > 0.0 { (0.5 * turn).sqrt() * self.reach } else { 0.0 };
        if by.is_nan() || by == 0.0 || !(shift + turn).is_finite() {
            return false;
        }
        self.frame = *frame;
        if by.is_finite() {
            self.odometer += by;
        }
        true
    }

    /// Goes to another place before update `next`.
    #[inline]
    pub fn follow(&mut self, id: u32, frame: &Frame, next: u32, news: &mut News) {
        if self.go(frame) && self.moved != next {
            self.moved = next;
            news.moved.push(id);
            if !self.awake() {
                // Moved by hand: what rests on it must be looked at.
                news.woken.push(id);
            }
        }
    }

    /// Looks so far ahead from update `next` on.
    #[inline]
    pub fn look_ahead(&mut self, id: u32, (ahead, way): (f32, Vec3f), next: u32, news: &mut News) {
        if ahead.is_finite() && ahead >= 0.0 && way.length_squared().is_finite() {
            (self.ahead, self.way) = (ahead, way);
            if self.spent() > self.leaf_limit && self.moved != next {
                self.moved = next;
                news.moved.push(id);
            }
        }
    }

    /// Wakes or falls asleep.
    pub fn rouse(&mut self, id: u32, awake: bool, news: &mut News) {
        if self.motion != Motion::Fixed && self.awake() != awake {
            self.motion = if awake { Motion::Awake } else { Motion::Asleep };
            if awake {
                news.woken.push(id);
            }
        }
    }

    /// The box around it, larger by what pairs look ahead.
    pub fn around(&self, margin: f64) -> Aabb {
        self.shape.aabb_in(&self.frame).expanded(0.5 * margin + f64::from(self.ahead))
    }

    /// A leaf for the box, and how far the geom may move until it can leave it.
    pub fn leaf(&self, around: &Aabb, fat: f64, old: Option<Box32>) -> (Box32, f64) {
        if self.motion == Motion::Fixed {
            return (Box32::around(around), 0.0);
        }
        let e = around.extent();
        let room = fat * e.x.max(e.y).max(e.z);
        let mut leaf = around.expanded(room);
        if let Some(old) = old {
            // What left its leaf goes on that way; what jumped does not.
            let center = Vec3::new(old.center2(0).into(), old.center2(1).into(), old.center2(2).into()) * 0.5;
            let ahead = around.center() - center;
            if ahead.abs_max() < e.abs_max() {
                leaf.min += ahead.min(Vec3::ZERO);
                leaf.max += ahead.max(Vec3::ZERO);
            }
        }
        (Box32::around(&leaf), room)
    }

    /// Whether an unbounded geom comes near a box.
    pub fn meets(&self, leaf: &Box32) -> bool {
        match &self.shape {
            Shape::Plane(plane) => {
                let (b, n) = (leaf.aabb(), plane.normal());
                let lowest = Vec3::new(
                    if n.x > 0.0 { b.min.x } else { b.max.x },
                    if n.y > 0.0 { b.min.y } else { b.max.y },
                    if n.z > 0.0 { b.min.z } else { b.max.z },
                );
                plane.depth(lowest) >= -f64::from(self.ahead)
            }
            shape => shape.aabb_in(&self.frame).overlaps(&leaf.aabb()),
        }
    }

    /// Whether it is the first geom of a pair with `other`: the smaller one; its anchors are in single precision.
    pub fn before(&self, other: &Self) -> bool {
        let surface = |s: &Shape| u8::from(matches!(s, Shape::TriMesh(_) | Shape::Heightfield(_)));
        (surface(&self.shape), self.reach) < (surface(&other.shape), other.reach)
    }
}
