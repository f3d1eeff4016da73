//! Which manifolds are solved, between which bodies, and in which order: by colour, kind and number of points.

use super::Workspace;
use super::bodies::SolverBodies;
use super::colour::OVERFLOW;
use super::contact::{self, ManifoldKey, NOT_SOLVED};
use super::manifold::{ContactManifold, STATIC, check_surface};
use super::room::make_room;
use super::surface::SurfaceCoefficients;
use crate::arena::{Arena, NIL};
use crate::body::Body;
use crate::{Error, Surface, World};
use core::sync::atomic::{AtomicBool, Ordering};
use ferrode_math::stage::{Crew, chunks};

/// Manifolds of one task.
const SHARE: usize = 512;

/// What a task found beside keys.
#[derive(Clone, Debug, Default)]
pub(super) struct Keyed {
    /// Sleepers that are touched, by their slots.
    asleep: Vec<u32>,
    has_bounce: bool,
}

/// What keys are made from.
struct Keying<'a> {
    world: &'a Arena<Body>,
    bodies: &'a SolverBodies,
    places: &'a [(u32, u32)],
    surfaces: &'a [SurfaceCoefficients],
}

/// What became of a body that is not among the awake ones.
enum Sleeper {
    /// There is none, or it counts as a part of the static world.
    None,
    /// It sleeps, and is touched.
    Asleep(u32),
    /// It was destroyed.
    Gone,
}

/// Lists the places of the manifolds that count: all, or those whose bits are set.
pub(super) fn list_active(count: usize, awake: Option<&[u64]>, work: &mut Workspace) {
    let active = &mut work.active;
    active.clear();
    match awake {
        None => {
            make_room(active, count);
            active.extend(0..count as u32);
        }
        Some(words) => {
            make_room(active, words.iter().map(|word| word.count_ones() as usize).sum());
            for (w, word) in words.iter().enumerate() {
                let mut bits = *word;
                while bits != 0 {
                    active.push(64 * w as u32 + bits.trailing_zeros());
                    bits &= bits - 1;
                }
            }
            while active.last().is_some_and(|place| *place as usize >= count) {
                active.pop();
            }
        }
    }
    work.own_active = active.len();
}

/// The error of the first manifold that counts and names a surface that there is none of.
pub(super) fn check_surfaces(
    crew: &Crew,
    manifolds: &[ContactManifold],
    active: &[u32],
    surfaces: &[Surface],
) -> Result<(), Error> {
    let check = |place: &u32| check_surface(&manifolds[*place as usize], surfaces);
    let wrong = AtomicBool::new(false);
    crew.run(active.len().div_ceil(SHARE), |task| {
        let mut share = active[task * SHARE..].iter().take(SHARE);
        if share.any(|place| check(place).is_err()) {
            wrong.store(true, Ordering::Relaxed);
        }
    });
    if wrong.into_inner() {
        return active.iter().try_for_each(check);
    }
    Ok(())
}

impl World {
    /// Finds the bodies and the colour of each manifold, and sorts them.
    pub(super) fn colour_manifolds(&mut self, manifolds: &[ContactManifold], work: &mut Workspace) {
        let Workspace { bodies, contacts, places, surfaces, keyed, parts, colouring, active, .. } = work;
        let keys = &mut contacts.keys;
        make_room(keys, active.len());
        keys.resize(active.len(), ManifoldKey::LEFT_OUT);
        keyed.resize_with(active.len().div_ceil(SHARE), Keyed::default);
        let keying = Keying { world: &self.bodies, bodies, places, surfaces };
        self.crew.each((chunks(keys, SHARE), chunks(keyed, 1)), |task, (keys, found)| {
            let found = &mut found[0];
            found.asleep.clear();
            found.has_bounce = false;
            for (key, place) in keys.iter_mut().zip(&active[task * SHARE..]) {
                *key = keying.key(*place, &manifolds[*place as usize], found);
            }
        });
        contacts.parts = parts.find(&self.crew, bodies, keys);
        colouring.begin(bodies.len());
        for key in keys.iter_mut().filter(|key| key.sort != NOT_SOLVED) {
            let movable = key.movable_bodies();
            let section = parts.section(movable);
            let (section, colour) = match colouring.colour(movable, section == contacts.parts) {
                OVERFLOW => (contacts.parts + 1, 0),
                colour => (section, colour),
            };
            key.sort += contact::sort_key(section, colour, false, contact::MOST_POINTS);
        }
        contacts.has_bounce = keyed.iter().any(|found| found.has_bounce);
        contacts.arrange();
        for found in &work.keyed {
            for slot in &found.asleep {
                self.rouse(*slot, &mut work.waking);
                // The body itself is awake now; something must make the caller gather again.
                work.waking.push(0);
            }
        }
    }
}

impl Keying<'_> {
    /// The key of a manifold, its colour left open.
    fn key(&self, place: u32, manifold: &ContactManifold, found: &mut Keyed) -> ManifoldKey {
        if manifold.count == 0 || manifold.is_ignored() {
            return ManifoldKey::LEFT_OUT;
        }
        let places = manifold.bodies.map(|(slot, serial)| match self.places.get(slot as usize) {
            Some((place, s)) if *place != NIL && *s == serial => *place,
            _ => NIL,
        });
        let movable = places.map(|place| self.bodies.is_movable(place));
        if movable[0] || movable[1] {
            match self.sleeper(manifold, places) {
                Sleeper::Gone => {}
                Sleeper::Asleep(slot) => found.asleep.push(slot),
                Sleeper::None => {
                    let surface = &self.surfaces[manifold.surface as usize];
                    let kinematic = (0..2).any(|side| places[side] != NIL && !movable[side]);
                    let special = surface.special || kinematic;
                    found.has_bounce |= surface.bounce > 0.0;
                    let sort = contact::sort_key(0, 0, special, manifold.len());
                    return ManifoldKey { bodies: places, place, movable, sort };
                }
            }
        } else if let Some(side) = (0..2).find(|side| places[*side] != NIL)
            && self.bodies.motions[places[side] as usize].0 != [0.0; 8]
            && let Sleeper::Asleep(slot) = self.sleeper(manifold, places)
        {
            // A kinematic body runs into a sleeper.
            found.asleep.push(slot);
        }
        ManifoldKey::LEFT_OUT
    }

    /// Whether the body of a manifold that is not among the awake ones sleeps, or is no more.
    fn sleeper(&self, manifold: &ContactManifold, places: [u32; 2]) -> Sleeper {
        for ((slot, serial), place) in manifold.bodies.into_iter().zip(places) {
            if slot == STATIC || place != NIL {
                continue;
            }
            let Some(body) = self.world.get(slot) else { return Sleeper::Gone };
            if self.world.key_of(slot).serial as u32 != serial {
                return Sleeper::Gone;
            }
            if !body.is_kinematic() && manifold.touches() {
                return Sleeper::Asleep(slot);
            }
        }
        Sleeper::None
    }
}
