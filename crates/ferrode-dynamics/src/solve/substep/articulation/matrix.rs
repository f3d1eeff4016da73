//! The matrix J̃ J̃ᵀ + Γ of the rows that take part.

use super::batch::{Batch, Linear, linear_part, node};
use super::factor::Block;
use super::plan::NODE;
use super::row::{LaneRow, SOFTNESS};
use super::triple::dot;
use ferrode_math::simd::Lanes;

impl<L: Lanes> Batch<L> {
    /// The matrix of the rows that take part, and its factor.
    #[inline(always)]
    pub fn factorise(&mut self) {
        let Self { list, rows, linear, plain, plan, factor, .. } = self;
        factor.begin(plan);
        for (number, (joint, first)) in list.iter().zip(&plan.first).enumerate() {
            for i in 0..joint.nodes {
                for j in 0..=i {
                    let a = node(rows, joint, i);
                    let b = node(rows, joint, j);
                    let mut block = if i == j {
                        add_products(&turning_squares(a, 0), &turning_squares(a, 1))
                    } else {
                        add_products(&turning_products(a, b, [0, 0]), &turning_products(a, b, [1, 1]))
                    };
                    match joint.linear {
                        Linear::Points([s, t]) if i == 0 => {
                            let mass = s * s + t * t;
                            add_to_diagonal(&mut block, mass);
                        }
                        Linear::Points(_) => {}
                        Linear::Any(at) => {
                            for side in 0..2 {
                                for k in 0..NODE {
                                    for l in 0..NODE {
                                        let (a, b) = (&linear[at + i * NODE + k], &linear[at + j * NODE + l]);
                                        block[k * NODE + l] += dot(&a[side], &b[side]);
                                    }
                                }
                            }
                        }
                    }
                    let (row, column) = (*first as usize + i, *first as usize + j);
                    if !plain[row] || !plain[column] {
                        mask(&mut block, a, b);
                    }
                    if i == j {
                        for (k, row) in rows[joint.first + i * NODE..][..NODE].iter_mut().enumerate() {
                            let diagonal = block[k * NODE + k];
                            row.softness = diagonal * L::splat(SOFTNESS);
                            // A row that is fixed has the equation Δλ = 0.
                            block[k * NODE + k] =
                                (diagonal + row.softness + row.gamma) * row.free + (L::ONE - row.free);
                        }
                    }
                    factor.blocks[plan.own(number, i, j)] = block;
                }
            }
        }
        for product in &plan.products {
            let ((p, i, x), (q, j, y)) = (product.a, product.b);
            let (one, two) = (&list[p as usize], &list[q as usize]);
            let (i, j, sides) = (i as usize, j as usize, [usize::from(x), usize::from(y)]);
            let (a, b) = (node(rows, one, i), node(rows, two, j));
            let mut block = turning_products(a, b, sides);
            match (one.linear, two.linear) {
                (Linear::Points(s), Linear::Points(t)) => {
                    if i == 0 && j == 0 {
                        let mass = s[sides[0]] * t[sides[1]];
                        let mass = if x == y { mass } else { -mass };
                        add_to_diagonal(&mut block, mass);
                    }
                }
                _ => {
                    for k in 0..NODE {
                        for l in 0..NODE {
                            let a = linear_part(one, linear, i * NODE + k, sides[0]);
                            let b = linear_part(two, linear, j * NODE + l, sides[1]);
                            block[k * NODE + l] += dot(&a, &b);
                        }
                    }
                }
            }
            if !plain[plan.first[p as usize] as usize + i] || !plain[plan.first[q as usize] as usize + j] {
                mask(&mut block, a, b);
            }
            let target = &mut factor.blocks[product.target as usize];
            *target = if product.again { add_products(target, &block) } else { block };
        }
        factor.factorise(plan);
        self.stale = false;
    }
}

/// Products of the angular parts of two nodes, for a body at these ends of theirs.
#[inline(always)]
fn turning_products<L: Lanes>(a: &[LaneRow<L>], b: &[LaneRow<L>], sides: [usize; 2]) -> Block<L> {
    let (x, y) = (sides[0] & 1, sides[1] & 1);
    let a = [&a[0].angular[x], &a[1].angular[x], &a[2].angular[x]];
    let b = [&b[0].angular[y], &b[1].angular[y], &b[2].angular[y]];
    [
        dot(a[0], b[0]),
        dot(a[0], b[1]),
        dot(a[0], b[2]),
        dot(a[1], b[0]),
        dot(a[1], b[1]),
        dot(a[1], b[2]),
        dot(a[2], b[0]),
        dot(a[2], b[1]),
        dot(a[2], b[2]),
    ]
}

/// The lower triangle of those of a node with itself.
#[inline(always)]
fn turning_squares<L: Lanes>(a: &[LaneRow<L>], side: usize) -> Block<L> {
    let side = side & 1;
    let [a, b, c] = [&a[0].angular[side], &a[1].angular[side], &a[2].angular[side]];
    let zero = L::ZERO;
    [dot(a, a), zero, zero, dot(b, a), dot(b, b), zero, dot(c, a), dot(c, b), dot(c, c)]
}

#[inline(always)]
fn add_products<L: Lanes>(a: &Block<L>, b: &Block<L>) -> Block<L> {
    let mut sum = *a;
    for (s, b) in sum.iter_mut().zip(b) {
        *s += *b;
    }
    sum
}

/// What masses, moved without being turned, add to a block of three rows along x, y and z.
#[inline(always)]
fn add_to_diagonal<L: Lanes>(block: &mut Block<L>, mass: L) {
    for k in 0..NODE {
        block[k * NODE + k] += mass;
    }
}

/// Takes rows that don't take part out of a block.
#[inline(always)]
fn mask<L: Lanes>(block: &mut Block<L>, a: &[LaneRow<L>], b: &[LaneRow<L>]) {
    for k in 0..NODE {
        for l in 0..NODE {
            block[k * NODE + l] = block[k * NODE + l] * a[k].free * b[l].free;
        }
    }
}
