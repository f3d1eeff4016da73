//! Coulomb's friction cone: contacts whose friction is as strong in every direction, and opposes what slides.
//!
//! Boxed problems bound each tangent for itself, and freeze the bounds at forces that were found without friction. Here the
//! boxed problem is solved again and again, each time from the answer before, with
//!
//! - bounds µ λₙ of the normal forces of the answer before;
//! - tangents turned so that the first points against the sliding direction d = −v/|v|. There the force of a sliding contact is at its
//!   bound, and across it is zero;
//! - a softness |v|/(µ λₙ) of the second tangent: λ = −µ λₙ v/|v| turns by that as v turns, to first order. So directions
//!   converge as Newton's method does (after Alart & Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991).
//!
//! At the fixed point forces are on the cone and against the sliding velocity, or within it and nothing slides. The
//! velocity along the normal is what the contact's own row asks for: this is Coulomb's law itself, not its relaxation to a convex
//! problem, in which contacts open as they slide (de Saxcé & Feng, Math. Comput. Modelling 28, 1998, tell the two apart).
//! Different coefficients µ₁, µ₂ make the cone elliptic: tangents are scaled by them, and the force is the one of greatest dissipation.

use crate::rows::{NO_FRICTION_INDEX, Row, RowKind};
use crate::step::Island;
use ferrode_math::Vec3;

/// The most times that the boxed problem is solved.
pub(super) const MOST_SWEEPS: u32 = 60;
/// Change of forces, as part of the largest, at which all is said: while rounds converge quickly, and once they are averaged.
const CONVERGED: [f64; 2] = [1e-9, 1e-6];
/// Sliding, as part of the accelerations whose difference it is; less is rounding.
const SLIDES: f64 = 1e-9;
/// From this round on bounds are averaged.
const DAMPED_FROM: u32 = 20;

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    contacts: Vec<Contact>,
    /// Rows whose bounds hang on a normal force, but are no pair of tangents.
    singles: Vec<Single>,
    /// Acceleration by constraint forces, of each body.
    pushed: Vec<[Vec3; 2]>,
    /// Forces of the round before, in the rows' own directions.
    before: Vec<f64>,
}

/// A contact with friction along both tangents.
#[derive(Clone, Copy, Debug)]
struct Contact {
    span: usize,
    normal: usize,
    /// Its two tangents, one after the other.
    tangent: usize,
    /// As the joint wrote them, but scaled by their coefficients.
    rows: [Row; 2],
    mu: [f64; 2],
    /// Unit: the first turned tangent in the scaled ones.
    direction: [f64; 2],
    /// The normal force that bounds it now.
    bound: f64,
    /// Softness across the direction, acceleration per scaled force.
    across: f64,
}

#[derive(Clone, Copy, Debug)]
struct Single {
    row: usize,
    normal: usize,
    /// The number of the normal row within its joint.
    local: i32,
    coefficient: f64,
    bound: f64,
}

impl Workspace {
    /// Finds the contacts of an island. Returns whether there is anything to do.
    pub fn find(&mut self, island: &Island) -> bool {
        self.contacts.clear();
        self.singles.clear();
        for (s, span) in island.spans.iter().enumerate() {
            let rows = &island.rows[span.first..span.first + span.count.rows];
            let mut i = 0;
            while i < rows.len() {
                let row = &rows[i];
                if row.friction_index == NO_FRICTION_INDEX {
                    i += 1;
                    continue;
                }
                let normal = span.first + row.friction_index as usize;
                let second = rows.get(i + 1).filter(|next| {
                    row.kind == RowKind::Tangent1
                        && next.kind == RowKind::Tangent2
                        && next.friction_index == row.friction_index
                        && row.hi.is_finite()
                        && next.hi.is_finite()
                });
                if let Some(second) = second {
                    let mu = [row.hi, second.hi];
                    self.contacts.push(Contact {
                        span: s,
                        normal,
                        tangent: span.first + i,
                        rows: [scaled(row, mu[0]), scaled(second, mu[1])],
                        mu,
                        direction: [1.0, 0.0],
                        bound: 0.0,
                        across: 0.0,
                    });
                    i += 2;
                } else {
                    let coefficient = row.hi;
                    self.singles.push(Single {
                        row: span.first + i,
                        normal,
                        local: row.friction_index,
                        coefficient,
                        bound: 0.0,
                    });
                    i += 1;
                }
            }
        }
        !self.contacts.is_empty() || !self.singles.is_empty()
    }

    /// Sets up the next boxed problem from forces in the rows' own directions: turns tangents, and sets the bounds.
    ///
    /// `slip` tells, of a span's row, the acceleration by constraint forces and the one asked for: Ja and b.
    pub fn turn(
        &mut self,
        island: &mut Island,
        sweep: u32,
        fps: f64,
        slip: impl Fn(&Island, usize, &Row) -> [f64; 2],
    ) {
        // The mean of all rounds from there on: it settles where the rounds themselves go in a circle (Krasnosel'skiĭ 1955, Mann 1953).
        let keep = match sweep.checked_sub(DAMPED_FROM) {
            Some(rounds) => 1.0 - 1.0 / f64::from(rounds + 2),
            None => 0.0,
        };
        for c in &mut self.contacts {
            let normal = island.lambda[c.normal].max(0.0);
            c.bound = keep * c.bound + (1.0 - keep) * normal;
            let force = [island.lambda[c.tangent] / c.mu[0], island.lambda[c.tangent + 1] / c.mu[1]];
            let mut w = [0.0; 2];
            let mut scale = 0.0_f64;
            for i in 0..2 {
                let [found, asked] = slip(island, c.span, &c.rows[i]);
                // What is left beside the row's own softness, in which a contact that sticks gives way.
                w[i] = found - asked + c.rows[i].cfm * fps * force[i];
                scale = scale.max(found.abs()).max(asked.abs());
            }
            let speed = length(w);
            // Against the sliding where it slides, along the force where it sticks.
            let slides = speed > SLIDES * scale && c.bound > 0.0;
            let turned = if slides { [-w[0], -w[1]] } else { force };
            let size = length(turned);
            if size > 0.0 {
                c.direction = [turned[0] / size, turned[1] / size];
            }
            let across = if slides { speed / c.bound } else { 0.0 };
            c.across = keep * c.across + (1.0 - keep) * across;
            let [x, y] = c.direction;
            island.rows[c.tangent] = turned_row(&c.rows, [x, y], c.bound, 0.0);
            island.rows[c.tangent + 1] = turned_row(&c.rows, [-y, x], c.bound, c.across / fps);
        }
        for s in &mut self.singles {
            let normal = island.lambda[s.normal].max(0.0);
            s.bound = keep * s.bound + (1.0 - keep) * normal;
            let bound = bounded(s.coefficient, s.bound);
            let row = &mut island.rows[s.row];
            (row.lo, row.hi, row.friction_index) = (-bound, bound, NO_FRICTION_INDEX);
        }
    }

    /// Turns forces back to the rows' own directions. Returns the largest change against the round before, as part of the largest
    /// force.
    pub fn turn_back(&mut self, island: &mut Island) -> f64 {
        for c in &self.contacts {
            let [x, y] = c.direction;
            let [a, b] = [island.lambda[c.tangent], island.lambda[c.tangent + 1]];
            island.lambda[c.tangent] = (x * a - y * b) * c.mu[0];
            island.lambda[c.tangent + 1] = (y * a + x * b) * c.mu[1];
        }
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        if self.before.len() == island.lambda.len() {
            for (now, before) in island.lambda.iter().zip(&self.before) {
                change = change.max((now - before).abs());
                largest = largest.max(now.abs());
            }
        } else {
            change = f64::INFINITY;
        }
        self.before.clear();
        self.before.extend_from_slice(&island.lambda);
        if largest > 0.0 { change / largest } else { change }
    }

    /// Forgets the round before.
    pub fn begin(&mut self, island: &Island) {
        self.before.clear();
        self.before.extend_from_slice(&island.lambda);
    }

    /// Whether the change of a round is small enough to end.
    pub fn converged(change: f64, sweep: u32) -> bool {
        change <= CONVERGED[usize::from(sweep >= DAMPED_FROM)]
    }

    /// Puts the rows back as the joints wrote them.
    pub fn restore(&self, island: &mut Island) {
        for c in &self.contacts {
            for (i, mu) in c.mu.into_iter().enumerate() {
                island.rows[c.tangent + i] = unscaled(&c.rows[i], mu);
            }
        }
        for s in &self.singles {
            let row = &mut island.rows[s.row];
            (row.lo, row.hi, row.friction_index) = (-s.coefficient, s.coefficient, s.local);
        }
    }

    /// Sums up the accelerations that the forces of the rows as they are now give to the bodies.
    pub fn push(&mut self, island: &Island) {
        self.pushed.clear();
        self.pushed.resize(island.bodies.len(), [Vec3::ZERO; 2]);
        for span in &island.spans {
            let range = span.first..span.first + span.count.rows;
            for (row, lambda) in island.rows[range.clone()].iter().zip(&island.lambda[range]) {
                let sides = [(row.linear1, row.angular1), (row.linear2, row.angular2)];
                for (place, (linear, angular)) in span.bodies.into_iter().zip(sides) {
                    if let Some([l, a]) = self.pushed.get_mut(place as usize) {
                        *l += linear * *lambda;
                        *a += angular * *lambda;
                    }
                }
            }
        }
        for (body, [l, a]) in island.bodies.iter().zip(&mut self.pushed) {
            *l *= body.inv_mass;
            *a = body.inv_inertia * *a;
        }
    }

    /// Lends the accelerations out, to be given back.
    pub fn take_pushed(&mut self) -> Vec<[Vec3; 2]> {
        core::mem::take(&mut self.pushed)
    }

    /// Takes them back.
    pub fn give_pushed(&mut self, pushed: Vec<[Vec3; 2]>) {
        self.pushed = pushed;
    }
}

/// Acceleration along a row by constraint forces.
pub(super) fn along(row: &Row, bodies: [u32; 2], pushed: &[[Vec3; 2]]) -> f64 {
    let sides = [(row.linear1, row.angular1), (row.linear2, row.angular2)];
    let mut sum = 0.0;
    for (place, (linear, angular)) in bodies.into_iter().zip(sides) {
        if let Some([l, a]) = pushed.get(place as usize) {
            sum += linear.dot(*l) + angular.dot(*a);
        }
    }
    sum
}

fn length(v: [f64; 2]) -> f64 {
    (v[0] * v[0] + v[1] * v[1]).sqrt()
}

/// µ λ, where no force has no bound above zero, whatever the coefficient.
fn bounded(coefficient: f64, force: f64) -> f64 {
    if force == 0.0 { 0.0 } else { coefficient * force }
}

/// A row in units of its friction coefficient.
fn scaled(row: &Row, mu: f64) -> Row {
    Row {
        linear1: row.linear1 * mu,
        angular1: row.angular1 * mu,
        linear2: row.linear2 * mu,
        angular2: row.angular2 * mu,
        c: row.c * mu,
        cfm: row.cfm * mu * mu,
        ..*row
    }
}

/// The row that a scaled one came from.
fn unscaled(row: &Row, mu: f64) -> Row {
    Row { lo: row.lo, hi: row.hi, ..scaled(row, 1.0 / mu) }
}

/// The combination of two tangents along a direction, with its bounds and what is added to its softness.
fn turned_row(rows: &[Row; 2], [x, y]: [f64; 2], bound: f64, softness: f64) -> Row {
    let mix = |a: Vec3, b: Vec3| a * x + b * y;
    Row {
        linear1: mix(rows[0].linear1, rows[1].linear1),
        angular1: mix(rows[0].angular1, rows[1].angular1),
        linear2: mix(rows[0].linear2, rows[1].linear2),
        angular2: mix(rows[0].angular2, rows[1].angular2),
        c: rows[0].c * x + rows[1].c * y,
        cfm: rows[0].cfm * (x * x) + rows[1].cfm * (y * y) + softness,
        lo: -bound,
        hi: bound,
        friction_index: NO_FRICTION_INDEX,
        ..rows[0]
    }
}
