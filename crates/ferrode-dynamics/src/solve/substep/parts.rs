//! The world in parts, which threads work on side by side.
//!
//! Colours alone make threads wait for each other after each of them, and hand the same bodies to one thread after the other. So bodies
//! are split into slabs, with as many contacts in each. Contacts within a slab concern no other, and are solved first, slabs side by
//! side; then those between slabs, colour after colour.
//!
//! The slabs depend on where the bodies and their contacts are, and were, and on nothing else: so the order in which contacts are solved is
//! the same for any number of threads.

use super::bodies::SolverBodies;
use super::contact::{ManifoldKey, NOT_SOLVED};
use ferrode_math::Vec3;
use ferrode_math::stage::{Crew, chunks};

/// Bodies that make a part worth having.
const LEAST_BODIES: usize = 200;
/// Bodies of a part in a world that has more than [`FEW`] times as many.
const MANY_BODIES: usize = 1000;
/// Parts that a world has as soon as it has the bodies for them: what lies between parts is solved with more waiting.
const FEW: usize = 4;
/// Most parts.
const MOST: usize = 32;
/// Contacts by which a world with few parts is judged; with more, as many for each part.
const SAMPLES: usize = 256;
const SAMPLES_OF_PART: usize = 32;
/// Bodies of one task.
const SHARE: usize = 2048;
/// Steps between two looks whether the parts are still alike.
const PATIENCE: u32 = 30;
/// Contacts of the largest part over those of parts alike, beyond which the world is cut anew.
const UNEVEN: f32 = 1.25;

/// The parts of a world, and which part each body is in.
///
/// Cuts stay where they are for a while: contacts that are solved in one order now and in another in the next step come to rest later.
#[derive(Debug, Default)]
pub(super) struct Parts {
    /// Parts that there should be.
    wanted: usize,
    /// Cuts between them in the world's frame, and their axis.
    cuts: Vec<f64>,
    axis: Axis,
    /// Steps since the cuts were looked at.
    age: u32,
    /// Contacts of each part, and between them.
    sizes: Vec<u32>,
    owners: Vec<u8>,
    samples: Vec<f32>,
}

impl Clone for Parts {
    fn clone(&self) -> Self {
        let Self { wanted, axis, age, .. } = *self;
        let (cuts, sizes) = (self.cuts.clone(), self.sizes.clone());
        Self { wanted, cuts, axis, age, sizes, ..Self::default() }
    }
}

impl Parts {
    /// Splits the bodies of a step, given its contacts; returns the number of parts.
    pub fn find(&mut self, crew: &Crew, bodies: &SolverBodies, keys: &[ManifoldKey]) -> usize {
        let number = bodies.centres.len();
        let wanted = (number / LEAST_BODIES).clamp(1, FEW).max((number / MANY_BODIES).min(MOST));
        self.age += 1;
        if wanted != self.wanted || self.age >= PATIENCE {
            self.age = 0;
            if wanted != self.wanted || self.are_uneven() {
                self.wanted = wanted;
                self.cut_across(bodies, keys);
            }
        }
        let count = self.cuts.len() + 1;
        self.sizes.clear();
        self.sizes.resize(count + 1, 0);
        self.owners.resize(number, 0);
        if count == 1 {
            self.owners.fill(0);
            return 1;
        }
        let (axis, cuts) = (self.axis, self.cuts.as_slice());
        let origin = axis.along_far(bodies.origin);
        crew.each(chunks(&mut self.owners, SHARE), |share, owners| {
            for (owner, centre) in owners.iter_mut().zip(&bodies.centres[share * SHARE..]) {
                let x = origin + f64::from(axis.along(centre));
                *owner = cuts.partition_point(|cut| *cut <= x) as u8;
            }
        });
        count
    }

    /// Whether it is time to cut anew.
    fn are_uneven(&self) -> bool {
        if self.cuts.len() + 1 < self.wanted {
            return true;
        }
        let parts = &self.sizes[..self.cuts.len() + 1];
        let most = parts.iter().max().copied().unwrap_or(0) as f32;
        most * parts.len() as f32 > UNEVEN * parts.iter().sum::<u32>() as f32
    }

    /// Finds the cuts, and along which axis they lie; none where too few contacts are solved.
    fn cut_across(&mut self, bodies: &SolverBodies, keys: &[ManifoldKey]) {
        self.cuts.clear();
        if self.wanted == 1 {
            return;
        }
        let centres = bodies.centres.as_slice();
        let count = SAMPLES.max(SAMPLES_OF_PART * self.wanted);
        // Bodies are often made in rows and layers: even steps would meet the same place in all of them. Multiples of the golden
        // ratio don't (Knuth, TAOCP 3, 6.4).
        let places = (0..count as u64).map(|i| {
            let part = i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
            ((part * keys.len() as u64) >> 32) as usize
        });
        let body = |place: usize| {
            let key = keys.get(place).filter(|key| key.sort != NOT_SOLVED)?;
            let [a, b] = key.movable_bodies();
            a.or(b)
        };
        let sampled = || places.clone().filter_map(body);
        let axis = Axis::best(centres, sampled);
        let list = &mut self.samples;
        list.clear();
        list.extend(sampled().map(|body| axis.along(&centres[body as usize])));
        list.sort_unstable_by(f32::total_cmp);
        let reach = list.len() / (8 * self.wanted);
        if reach == 0 {
            return;
        }
        self.axis = axis;
        for k in 1..self.wanted {
            // In the widest gap nearby, so that what lies in layers is not cut by chance.
            let middle = k * list.len() / self.wanted;
            let gap = |i: usize| list[i] - list[i - 1];
            let mut best = middle;
            for i in middle - reach..=middle + reach {
                if gap(i) > gap(best) {
                    best = i;
                }
            }
            let cut = f64::from(list[best - 1]) + 0.5 * f64::from(gap(best));
            self.cuts.push(axis.along_far(bodies.origin) + cut);
        }
    }

    /// Where a contact belongs: the part of its bodies, or the number of parts if they are in two.
    #[inline]
    pub fn section(&mut self, bodies: [Option<u32>; 2]) -> usize {
        let part = |body: Option<u32>| body.map(|body| usize::from(self.owners[body as usize]));
        let section = match (part(bodies[0]), part(bodies[1])) {
            (Some(a), Some(b)) if a != b => self.cuts.len() + 1,
            (Some(part), _) | (None, Some(part)) => part,
            (None, None) => 0,
        };
        self.sizes[section] += 1;
        section
    }
}

/// Across which slabs lie side by side.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    number: usize,
    /// Down it.
    down: bool,
}

impl Axis {
    fn along(self, centre: &[f32; 3]) -> f32 {
        if self.down { -centre[self.number] } else { centre[self.number] }
    }

    fn along_far(self, place: Vec3) -> f64 {
        if self.down { -place[self.number] } else { place[self.number] }
    }

    /// The axis and direction in which the world is long, and in which the bodies' numbers go up: what is done body by body is shared out
    /// by their numbers, and then falls to the same thread.
    fn best<I: Iterator<Item = u32>>(centres: &[[f32; 3]], bodies: impl Fn() -> I) -> Self {
        let (mut count, mut mean_place, mut mean) = (0.0, 0.0, [0.0; 3]);
        for body in bodies() {
            count += 1.0;
            mean_place += body as f32;
            for (mean, x) in mean.iter_mut().zip(centres[body as usize]) {
                *mean += x;
            }
        }
        let count = if count > 0.0 { count } else { 1.0 };
        mean_place /= count;
        // Sums of absolute differences: one that has gone astray counts for less than by squares.
        let (mut length, mut along) = ([0.0f32; 3], [0.0f32; 3]);
        for body in bodies() {
            let up = if body as f32 >= mean_place { 1.0 } else { -1.0 };
            for k in 0..3 {
                let x = centres[body as usize][k] - mean[k] / count;
                length[k] += x.abs();
                along[k] += up * x;
            }
        }
        let score = |k: usize| length[k] + along[k].abs();
        let number = (1..3).fold(0, |best, k| if score(k) > score(best) { k } else { best });
        Self { number, down: along[number] < 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::substep::contact::sort_key;

    /// Bodies along x, each in contact with the next one, and with so many contacts to the ground.
    fn row(places: &[f32], on_ground: impl Fn(usize) -> usize) -> (SolverBodies, Vec<ManifoldKey>) {
        let mut bodies = SolverBodies::default();
        bodies.centres = places.iter().map(|x| [*x, 0.0, 0.5]).collect();
        bodies.origin = Vec3::new(1e7, 0.0, 0.0);
        let key = |bodies, movable| ManifoldKey { bodies, place: 0, movable, sort: sort_key(0, 0, false, 4) };
        let mut keys = Vec::new();
        for i in 0..places.len() as u32 {
            keys.extend((0..on_ground(i as usize)).map(|_| key([i, u32::MAX], [true, false])));
            if i > 0 {
                keys.push(key([i - 1, i], [true, true]));
            }
        }
        (bodies, keys)
    }

    /// Contacts of each part, and between parts.
    fn split(parts: &mut Parts, (bodies, keys): &(SolverBodies, Vec<ManifoldKey>)) -> Vec<usize> {
        let count = parts.find(&Crew::new(2), bodies, keys);
        let mut sizes = vec![0; count + 1];
        for key in keys {
            let section = parts.section(key.movable_bodies());
            let owners =
                key.movable_bodies().map(|body| body.map(|body| usize::from(parts.owners[body as usize])));
            match owners {
                [Some(a), Some(b)] if a != b => assert_eq!(section, count),
                owners => assert!(owners.into_iter().flatten().all(|owner| owner == section)),
            }
            sizes[section] += 1;
        }
        sizes
    }

    /// Whether such cuts would stay.
    fn even(sizes: &[usize]) -> bool {
        let parts = &sizes[..sizes.len() - 1];
        let most = parts.iter().max().copied().unwrap_or(0) * parts.len();
        most as f32 <= UNEVEN * parts.iter().sum::<usize>() as f32
    }

    #[test]
    fn parts_have_as_many_contacts() {
        // More contacts at one end; the last bodies' numbers first, and not.
        for down in [false, true] {
            let place = |i: usize| if down { 1000 - i } else { i } as f32;
            let places: Vec<f32> = (0..1000).map(place).collect();
            let world = row(&places, |i| if places[i] < 300.0 { 4 } else { 1 });
            let mut parts = Parts::default();
            let sizes = split(&mut parts, &world);
            assert_eq!((sizes.len(), parts.axis.number, parts.axis.down), (FEW + 1, 0, down));
            assert!(even(&sizes), "{sizes:?}");
            assert_eq!(sizes[FEW], FEW - 1, "one contact across each cut");
            assert!(parts.owners.is_sorted());
        }
    }

    #[test]
    fn small_worlds_and_those_without_contacts_are_one_part() {
        let places: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        assert_eq!(split(&mut Parts::default(), &row(&places[..399], |_| 1)).len(), 2);
        assert_eq!(split(&mut Parts::default(), &row(&places[..400], |_| 1)).len(), 3);
        let (bodies, mut keys) = row(&places, |_| 1);
        keys.iter_mut().for_each(|key| *key = ManifoldKey::LEFT_OUT);
        assert_eq!(Parts::default().find(&Crew::default(), &bodies, &keys), 1);
        assert_eq!(Parts::default().find(&Crew::default(), &bodies, &[]), 1);
    }

    #[test]
    fn cuts_stay_until_parts_are_uneven_and_go_with_a_clone() {
        let places: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        let before = row(&places, |_| 1);
        let mut parts = Parts::default();
        split(&mut parts, &before);
        let cuts = parts.cuts.clone();
        for _ in 0..2 * PATIENCE {
            split(&mut parts, &before);
        }
        assert_eq!(parts.cuts, cuts);
        // All move to one side.
        let after = row(&places.iter().map(|x| 0.3 * x).collect::<Vec<_>>(), |_| 1);
        let mut changes = 0;
        for _ in 0..2 * PATIENCE {
            let mut copy = parts.clone();
            let old = parts.cuts.clone();
            let sizes = split(&mut parts, &after);
            assert_eq!(split(&mut copy, &after), sizes);
            assert_eq!(copy.cuts, parts.cuts);
            changes += usize::from(parts.cuts != old);
        }
        assert_eq!(changes, 1);
        let sizes = split(&mut parts, &after);
        assert!(even(&sizes), "{sizes:?}");
    }

    #[test]
    fn places_that_are_no_numbers_do_no_harm() {
        let mut places: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        places[7] = f32::NAN;
        places[500] = f32::INFINITY;
        let mut parts = Parts::default();
        let sizes = split(&mut parts, &row(&places, |_| 1));
        assert_eq!(sizes.iter().sum::<usize>(), 1999);
    }
}
