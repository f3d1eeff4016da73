//! Geoms of the pair cache follow the bodies.

use super::Pipeline;
use crate::{GeomInfo, World};
use ferrode_collide::manifold::Vec3f;
use ferrode_collide::pairs::{Motion, Told};
use ferrode_collide::{Frame, GeomKey};
use ferrode_dynamics::{Body, BodyKey};
use ferrode_math::Pose;
use ferrode_math::stage::Crew;

/// What a task found that follows bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Followed {
    /// Geoms whose bodies became kinematic, or are no longer.
    other_kind: Vec<u32>,
}

/// What is known of a geom in the cache.
#[derive(Clone, Debug)]
pub(super) struct Known {
    key: GeomKey,
    pub body: Option<BodyKey>,
    pub offset: Option<Pose>,
    /// Of the body, when the geom last followed it.
    pose_version: u64,
    motion: Motion,
    /// From the body's centre to the geom's origin, along the world's axes.
    pub arm: [f32; 3],
    /// Distance that the geom may move in a step before it could pass through something.
    pub thickness: f32,
    /// Whether its material has a friction direction.
    pub directed: bool,
    ahead: f32,
}

impl World {
    /// Brings the cache's geoms to where the bodies are.
    pub(super) fn follow_bodies(&mut self, h: f64, crew: &Crew, pipeline: &mut Pipeline) {
        if pipeline.seen_geoms != Some(self.geom_version) {
            pipeline.seen_geoms = Some(self.geom_version);
            self.take_geoms_in(pipeline);
        }
        let all = self.call_geoms(pipeline);
        let Pipeline { pairs, known, called, followed, .. } = pipeline;
        let (margin, dynamics) = (pairs.settings().margin, &self.dynamics);
        for found in followed.iter_mut() {
            found.other_kind.clear();
        }
        let look = |slot: u32, known: &mut Option<Known>, geom: &mut Told<'_>, found: &mut Followed| {
            let Some(known) = known else { return };
            let Some(body) = known.body.and_then(|key| dynamics.body(key).ok()) else {
                return;
            };
            if body.is_kinematic() != (known.motion == Motion::Fixed) {
                found.other_kind.push(slot);
                return;
            }
            known.follow(body, h, margin, geom);
        };
        if all {
            pairs.tell(crew, known, followed, look);
        } else {
            followed.resize_with(followed.len().max(1), Followed::default);
            for slot in called.iter().copied() {
                let Some(known) = known.get_mut(slot as usize) else { continue };
                pairs.tell_of(slot, |geom| look(slot, known, geom, &mut followed[0]));
            }
        }
        for found in followed {
            for slot in found.other_kind.drain(..) {
                // It became kinematic, or dynamic again.
                let Some(Some(known)) = known.get_mut(slot as usize) else { continue };
                let Some(body) = known.body.and_then(|key| dynamics.body(key).ok()) else {
                    continue;
                };
                known.motion = motion_of(body);
                if let (Some(shape), Some(frame)) = (pairs.shape(slot).cloned(), pairs.frame(slot).copied()) {
                    pairs.insert(slot, shape, &frame, known.motion);
                }
                pairs.tell_of(slot, |geom| known.follow(body, h, margin, geom));
            }
        }
    }

    /// Lists the geoms whose bodies may have moved, woken or fallen asleep; true, without a list, for all.
    fn call_geoms(&self, pipeline: &mut Pipeline) -> bool {
        let (count, version) = self.dynamics.roll_call();
        let called = &mut pipeline.called;
        called.clear();
        if pipeline.seen_roll != Some(version) || 2 * count > self.dynamics.body_count() {
            return true;
        }
        for key in self.dynamics.roll() {
            for geom in self.geoms_of_body.get(&key).map_or(&[][..], Vec::as_slice) {
                called.extend(self.geom_slot(*geom).ok().map(|slot| slot as u32));
            }
        }
        called.sort_unstable();
        false
    }

    /// Wakes the bodies that sleep on a geom which is about to change.
    pub(crate) fn wake_touching(&mut self, slot: usize) {
        let Some(pipeline) = &self.pipeline else { return };
        let slot = slot as u32;
        for contact in (0..pipeline.manifolds.len()).filter_map(|place| pipeline.pairs.contact(place as u32))
        {
            let other = match (contact.a == slot, contact.b == slot) {
                (true, _) => contact.b,
                (_, true) => contact.a,
                _ => continue,
            };
            if let Some(Some(known)) = pipeline.known.get(other as usize)
                && let Some(key) = known.body
                && let Ok(body) = self.dynamics.body_mut(key)
                && !body.is_enabled()
            {
                body.enable();
            }
        }
    }

    /// Takes geoms into the cache that are new or were changed by hand, and those out that are no more.
    fn take_geoms_in(&mut self, pipeline: &mut Pipeline) {
        let Pipeline { pairs, known, least_thickness, .. } = pipeline;
        *least_thickness = f32::INFINITY;
        known.resize(self.geom_infos.len().max(known.len()), None);
        for (slot, known) in known.iter_mut().enumerate() {
            let info = self.geom_infos.get_mut(slot).and_then(Option::as_mut);
            let geom = info.as_ref().and_then(|info| self.colliders.geom(info.key));
            let (Some(info), Some(geom)) = (info, geom.filter(|g| g.is_enabled())) else {
                if known.take().is_some() {
                    pairs.remove(slot as u32);
                }
                continue;
            };
            if let Some(known) = known.as_ref().filter(|k| k.key == info.key)
                && !info.changed
            {
                least_thickness_of(known, least_thickness);
                continue;
            }
            info.changed = false;
            let body = info.body.and_then(|key| self.dynamics.body(key).ok());
            let motion = body.map_or(Motion::Fixed, motion_of);
            let mut made = Known::new(info, geom, motion);
            let mut frame = *geom.frame();
            if let Some(body) = body {
                let pose = body.pose() * made.offset.unwrap_or_default();
                let arm = pose.position - body.position();
                made.arm = [arm.x as f32, arm.y as f32, arm.z as f32];
                made.pose_version = body.pose_version();
                frame = Frame::from(&pose);
            }
            pairs.insert(slot as u32, geom.shape().clone(), &frame, motion);
            least_thickness_of(&made, least_thickness);
            *known = Some(made);
        }
    }
}

fn least_thickness_of(known: &Known, least: &mut f32) {
    if known.body.is_some() {
        *least = least.min(known.thickness);
    }
}

impl Known {
    fn new(info: &GeomInfo, geom: &ferrode_collide::Geom, motion: Motion) -> Self {
        // Half the least extent: what moves less can't get past a surface's middle.
        let own = geom.shape().aabb_in(&Frame::IDENTITY).extent();
        let least = own.x.min(own.y).min(own.z);
        Self {
            key: info.key,
            body: info.body,
            offset: geom.offset().copied(),
            pose_version: 0,
            motion,
            arm: [0.0; 3],
            thickness: (0.5 * least) as f32,
            directed: info.material.friction_direction.is_some(),
            ahead: 0.0,
        }
    }
}

impl Known {
    /// Brings the geom to where its body is.
    fn follow(&mut self, body: &Body, h: f64, margin: f64, geom: &mut Told<'_>) {
        let awake = body.is_enabled() && !body.is_quarantined();
        if self.motion != Motion::Fixed && awake != (self.motion == Motion::Awake) {
            self.motion = if awake { Motion::Awake } else { Motion::Asleep };
            geom.set_awake(awake);
        }
        if self.pose_version != body.pose_version() {
            self.pose_version = body.pose_version();
            let mut frame = Frame { position: body.position(), rotation: body.rotation() };
            if let Some(offset) = &self.offset {
                let arm = frame.rotation * offset.position;
                frame.position += arm;
                frame.rotation = frame.rotation * offset.rotation.to_matrix();
                self.arm = [arm.x as f32, arm.y as f32, arm.z as f32];
            }
            geom.move_geom(&frame);
        }
        if !awake {
            return;
        }
        let way = body.linear_velocity() * h;
        let travel = way.length();
        let ahead = if travel > margin { (travel - margin) as f32 } else { 0.0 };
        if ahead != self.ahead || ahead > 0.0 {
            self.ahead = ahead;
            geom.set_ahead(ahead.min(self.thickness), Vec3f::new(way.x as f32, way.y as f32, way.z as f32));
        }
    }
}

fn motion_of(body: &Body) -> Motion {
    if body.is_kinematic() {
        Motion::Fixed
    } else if body.is_enabled() && !body.is_quarantined() {
        Motion::Awake
    } else {
        Motion::Asleep
    }
}
