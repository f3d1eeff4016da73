//! Links under a tension so high that substeps would not carry it stably.

use super::batch::{Batch, Linear};
use super::plan::NODE;
use super::triple::{dot, over};
use ferrode_math::simd::{Lanes, Mask};

impl<L: Lanes> Batch<L> {
    /// Makes bodies harder to turn that are under a tension at which the direction of the forces, that of the start of a substep, would be
    /// unstable.
    ///
    /// A force F at an arm r turns a body of inertia I back with ω² = F r/I; h²ω² may not be much larger than 1, the limit being 4. Of the joint's rows
    /// along unit directions e, Σ|r × e|² is 2r², and Σ|S⁻¹-scaled r × e|² over it the mean inverse inertia about axes across r.
    #[inline(always)]
    pub fn feel_tension(&mut self, h: L) {
        let Self { list, rows, linear, scales, yields, .. } = self;
        let mut tight = vec![L::ZERO; yields.len()];
        for joint in list.iter() {
            let own = &rows[joint.first..][..joint.nodes * NODE];
            for (side, body) in joint.ends.into_iter().enumerate() {
                let s = &scales[body as usize];
                let (mut force, mut arms, mut turns) = ([L::ZERO; 3], L::ZERO, L::ZERO);
                for (i, row) in own.iter().enumerate() {
                    let unit = match joint.linear {
                        Linear::Points(_) => unit_of::<L>(i, s[0]),
                        Linear::Any(at) => {
                            let l = &linear[at + i][side];
                            [over(l[0], s[0]), over(l[1], s[0]), over(l[2], s[0])]
                        }
                    };
                    let present = dot(&unit, &unit);
                    for (f, e) in force.iter_mut().zip(unit) {
                        *f += e * row.impulse;
                    }
                    // Back to r × e.
                    let j = &row.angular[side];
                    let z = over(j[2], s[6]);
                    let y = over(j[1] - s[5] * z, s[3]);
                    let x = over(j[0] - s[2] * y - s[4] * z, s[1]);
                    arms += present * (x * x + y * y + z * z);
                    turns += present * dot(j, j);
                }
                tight[body as usize] += over(h * dot(&force, &force).sqrt() * turns, (arms + arms).sqrt());
            }
        }
        let mut any = false;
        for ((y, tight), s) in yields.iter_mut().zip(tight).zip(scales.iter_mut()) {
            let part = L::select(L::ONE.lt(tight), L::ONE / tight, L::ONE).sqrt();
            any |= part.lt(L::ONE).any();
            *y = [part, L::ONE / part];
            for s in &mut s[1..7] {
                *s *= part;
            }
        }
        if any {
            for joint in list.iter() {
                for row in &mut rows[joint.first..][..joint.nodes * NODE] {
                    for (j, body) in row.angular.iter_mut().zip(joint.ends) {
                        let part = yields[body as usize][0];
                        *j = [j[0] * part, j[1] * part, j[2] * part];
                    }
                }
            }
        }
    }
}

/// The unit vector along which row i holds points together, on a body that moves.
#[inline(always)]
fn unit_of<L: Lanes>(i: usize, scale: L) -> [L; 3] {
    let mut unit = [L::ZERO; 3];
    if i < NODE {
        unit[i] = L::select(L::ZERO.lt(scale), L::ONE, L::ZERO);
    }
    unit
}
