//! Geom transforms taken off: the geom within, where it is in the world, and what contacts name.

use super::{GeomId, GeomRecord, class};
use crate::real::{Real4, Real12, mat3, matrix3, padded, vector};
use crate::record::BodyRecord;
use crate::slab::Link;
use ferrode_collide::Frame;

/// Wrappers around wrappers are followed so far: those that wrap each other have no end.
const MAX_WRAPPERS: usize = 64;

impl GeomRecord {
    pub(super) fn is_wrapper(&self) -> bool {
        self.class.get() == class::TRANSFORM
    }

    /// The geom whose shape counts, and where it is: another one for a wrapper, none for an empty wrapper.
    pub(super) fn solid(&self) -> Option<(&Self, Frame)> {
        let (mut geom, mut frame) = (self, self.frame());
        for _ in 0..MAX_WRAPPERS {
            if !geom.is_wrapper() {
                geom.refresh();
                return Some((geom, frame));
            }
            geom = geom.inner()?;
            let own = geom.frame();
            frame = Frame::new(frame.point_to_world(own.position), frame.rotation * own.rotation);
        }
        None
    }

    /// The wrapper that contacts name in place of the geom within: the outermost of those that want it.
    pub(super) fn named_wrapper(&'static self) -> Option<GeomId> {
        let around = core::iter::successors(Some(self), |geom| geom.inner());
        around
            .take(MAX_WRAPPERS)
            .take_while(|geom| geom.is_wrapper())
            .find(|geom| geom.names_itself())
            .map(GeomId::of)
    }
}

/// A geom that, until this is dropped, shows the program the place in the world and the body of the wrapper around it. The
/// program's own functions look at it meanwhile. It does nothing to a geom without a wrapper.
pub(super) struct Unwrapped<'a> {
    geom: &'a GeomRecord,
    kept: Option<Pose>,
}

/// A geom's pose as its record has it.
struct Pose {
    position: Real4,
    rotation: Real12,
    body: Link<BodyRecord>,
    has_offset: bool,
    offset_position: Real4,
    offset_rotation: Real12,
}

impl Pose {
    fn of(geom: &GeomRecord) -> Self {
        Self {
            position: geom.position.get(),
            rotation: geom.rotation.get(),
            body: geom.body.get(),
            has_offset: geom.has_offset.get(),
            offset_position: geom.offset_position.get(),
            offset_rotation: geom.offset_rotation.get(),
        }
    }

    fn give(&self, geom: &GeomRecord) {
        geom.position.set(self.position);
        geom.rotation.set(self.rotation);
        geom.body.set(self.body);
        geom.has_offset.set(self.has_offset);
        geom.offset_position.set(self.offset_position);
        geom.offset_rotation.set(self.offset_rotation);
        geom.aabb.forget();
    }
}

impl<'a> Unwrapped<'a> {
    pub(super) fn new(geom: &'a GeomRecord, wrapper: &GeomRecord, frame: &Frame) -> Self {
        if core::ptr::eq(geom, wrapper) {
            return Self { geom, kept: None };
        }
        let kept = Pose::of(geom);
        let mut there = Pose {
            position: padded(frame.position),
            rotation: matrix3(&frame.rotation),
            body: wrapper.body.get(),
            has_offset: false,
            ..Pose::of(geom)
        };
        if let Some(body) = wrapper.on_body() {
            let body = body.current();
            let body = Frame::new(vector(&body.position.get()), mat3(&body.rotation.get()));
            there.has_offset = true;
            there.offset_position = padded(body.point_to_local(frame.position));
            there.offset_rotation = matrix3(&(body.rotation.transpose() * frame.rotation));
        }
        there.give(geom);
        Self { geom, kept: Some(kept) }
    }
}

impl Drop for Unwrapped<'_> {
    fn drop(&mut self) {
        if let Some(kept) = &self.kept {
            kept.give(self.geom);
        }
    }
}
