//! ODE's old StepFast (`dWorldStepFast1`, ODE 0.4 to 0.11): joint by joint, in substeps.
//!
//! A step is cut into N substeps of k = h/N. Each visits the joints of an island in a random order and solves every joint's
//! own few rows exactly, given the forces found so far; then all bodies move by k. Kept for programs of old manuals: `Quick`
//! is better at most things.

use super::few_rows::FewRows;
use super::{Island, SolverBody, Stepping, ends_of};
use crate::arena::NIL;
use crate::ends::StepContext;
use crate::foreign::MovedObserver;
use crate::rows::{JointRows, Row, Wrench};
use crate::solve::Solved;
use crate::solve::direct::IslandWork;
use crate::{Error, StepReport, Stepper, World};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Mat3, Vec3};

/// Memory of the method.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    body_seen: Vec<bool>,
    joint_seen: Vec<bool>,
    /// Bodies to walk on from, with the layers of sleeping bodies that may still be woken.
    stack: Vec<(u32, u32)>,
    awake: Vec<u32>,
    bodies: Vec<u32>,
    joints: Vec<u32>,
    /// Forces and torques that the program put on the island's bodies: they act in every substep.
    given: Vec<Wrench>,
    inv_mass_j: Vec<[Vec3; 4]>,
    problem: FewRows,
}

impl World {
    /// Advances the world by `h` seconds in `iterations` substeps (at least one). A sleeping body is woken by its awake
    /// neighbours through at most `depth` layers of sleeping bodies; those farther away are as the static world.
    ///
    /// # Errors
    /// As [`World::step`].
    #[doc(hidden)]
    pub fn step_fast(
        &mut self,
        h: f64,
        iterations: u32,
        depth: u32,
        random: &mut OdeRandom,
        moved: MovedObserver<'_>,
    ) -> Result<StepReport, Error> {
        crate::softness::step_size(h)?;
        let mut report = StepReport::default();
        let mut stepping = self.scratch.stepping.take().unwrap_or_default();
        let Stepping { works, fast: work, .. } = &mut *stepping;
        if works.is_empty() {
            works.push(IslandWork::default());
        }
        let island = &mut works[0].island;
        self.judge_bodies(h, &mut report);
        work.body_seen.clear();
        work.body_seen.resize(self.bodies.capacity(), false);
        work.joint_seen.clear();
        work.joint_seen.resize(self.joints.capacity(), false);
        let ctx = self.step_context(h);
        let iterations = iterations.max(1);
        // A callback may destroy any body, but slots stay in the order that they had.
        let mut awake = core::mem::take(&mut work.awake);
        awake.clear();
        let mut seed = self.body_list.first;
        while seed != NIL {
            let body = self.bodies.at(seed);
            if body.enabled && !body.quarantined {
                awake.push(seed);
            }
            seed = body.next;
        }
        for &seed in &awake {
            if work.body_seen.get(seed as usize) != Some(&false) || self.bodies.get(seed).is_none() {
                continue;
            }
            self.walk_to_depth(seed, depth, work);
            self.keep_given_forces(work);
            for _ in 0..iterations {
                self.fast_substep(
                    h / f64::from(iterations),
                    &ctx,
                    random,
                    moved,
                    (island, work),
                    &mut report,
                );
            }
            report.islands += 1;
        }
        work.awake = awake;
        self.scratch.stepping = Some(stepping);
        Ok(report)
    }

    /// One island, from an awake body.
    fn walk_to_depth(&mut self, seed: u32, depth: u32, work: &mut Workspace) {
        work.bodies.clear();
        work.joints.clear();
        work.body_seen[seed as usize] = true;
        work.stack.push((seed, depth));
        while let Some((body, layers)) = work.stack.pop() {
            work.bodies.push(body);
            let mut link = self.bodies.at(body).first_joint;
            while link != NIL {
                let (index, side) = (link >> 1, (link & 1) as usize);
                let joint = self.joints.at(index);
                link = joint.nodes[side].next;
                let Some(seen) = work.joint_seen.get_mut(index as usize) else { continue };
                if core::mem::replace(seen, true) || !joint.enabled || !self.moves_a_body(joint) {
                    continue;
                }
                work.joints.push(index);
                let other = joint.nodes[1 - side].body;
                if other == NIL || work.body_seen.get(other as usize) != Some(&false) {
                    continue;
                }
                let neighbour = self.bodies.at(other);
                let left = if neighbour.enabled { Some(depth) } else { layers.checked_sub(1) };
                if let Some(left) = left.filter(|_| !neighbour.quarantined) {
                    work.body_seen[other as usize] = true;
                    self.bodies.at_mut(other).enabled = true;
                    self.roll.call(other);
                    work.stack.push((other, left));
                }
            }
        }
    }

    fn keep_given_forces(&self, work: &mut Workspace) {
        let given = |index: &u32| {
            let body = self.bodies.at(*index);
            Wrench { force: body.force, torque: body.torque }
        };
        work.given.clear();
        work.given.extend(work.bodies.iter().map(given));
    }

    /// Forces from the joints one after the other, then all bodies move by `k`.
    fn fast_substep(
        &mut self,
        k: f64,
        ctx: &StepContext,
        random: &mut OdeRandom,
        moved: MovedObserver<'_>,
        (island, work): (&mut Island, &mut Workspace),
        report: &mut StepReport,
    ) {
        // A callback may have destroyed some, or taken a body out.
        let mut kept = 0;
        for i in 0..work.bodies.len() {
            if self.bodies.get(work.bodies[i]).is_some_and(|body| !body.quarantined) {
                work.bodies[kept] = work.bodies[i];
                work.given[kept] = work.given[i];
                kept += 1;
            }
        }
        work.bodies.truncate(kept);
        work.given.truncate(kept);
        work.joints.retain(|joint| self.joints.get(*joint).is_some());
        for j in 0..work.joints.len() {
            work.joints.swap(j, random.next_below(j as u32 + 1) as usize);
        }
        self.gather(&work.bodies, &work.joints, island);
        self.gather_sleepers(island);
        for (body, given) in island.bodies.iter_mut().zip(&work.given) {
            (body.force, body.torque) = (given.force, given.torque);
        }
        self.apply_gravity(island);
        for (index, solver_body) in work.bodies.iter().zip(&mut island.bodies) {
            let body = self.bodies.at(*index);
            if body.gyroscopic_mode && !body.is_kinematic() {
                let w = body.frame.angular_velocity;
                solver_body.torque -= w.cross(body.inertia_world() * w);
            }
        }
        island.rows.clear();
        island.lambda.clear();
        let mut solved = Solved::Completely;
        for i in 0..island.spans.len() {
            self.write_rows_of_one(island, i, ctx);
            if work.solve_one(island, i, k) == Solved::Partly {
                solved = Solved::Partly;
            }
        }
        self.write_feedback(island);
        report.count_island(work.bodies.len(), island.rows.len(), solved);
        report.islands -= 1;
        self.move_bodies(island, (Stepper::Direct, k, false), Some(moved), report);
    }

    /// Bodies at the end of a joint that sleep on come along as immovable ones.
    fn gather_sleepers(&self, island: &mut Island) {
        for i in 0..island.spans.len() {
            for side in 0..2 {
                let index = self.joints.at(island.spans[i].joint).nodes[side].body;
                if index == NIL || island.spans[i].bodies[side] != NIL {
                    continue;
                }
                if island.place[index as usize] == NIL {
                    island.place[index as usize] = island.bodies.len() as u32;
                    island.slots.push(index);
                    let mut sleeper = SolverBody::new(self.bodies.at(index));
                    (sleeper.inv_mass, sleeper.inv_inertia) = (0.0, Mat3::ZERO);
                    sleeper.frame.linear_velocity = Vec3::ZERO;
                    sleeper.frame.angular_velocity = Vec3::ZERO;
                    island.bodies.push(sleeper);
                }
                island.spans[i].bodies[side] = island.place[index as usize];
            }
        }
    }

    /// A joint's rows behind those of the joints before it; the forces that it adds count at once.
    fn write_rows_of_one(&mut self, island: &mut Island, i: usize, ctx: &StepContext) {
        let span = &mut island.spans[i];
        let joint = self.joints.at_mut(span.joint);
        let ends = ends_of(joint, span, &island.bodies);
        span.count = joint.kind.model_mut().row_count(&ends, ctx);
        span.first = island.rows.len();
        island.rows.resize(span.first + span.count.rows, Row::blank(ctx.cfm));
        island.lambda.resize(island.rows.len(), 0.0);
        if span.count.rows == 0 {
            return;
        }
        let joint = self.joints.at_mut(span.joint);
        let mut out = JointRows { rows: &mut island.rows[span.first..], forces: [Wrench::default(); 2] };
        let ends = ends_of(joint, span, &island.bodies);
        joint.kind.model_mut().write_rows(&ends, ctx, &mut out);
        let forces = out.forces;
        for (place, wrench) in span.bodies.into_iter().zip(forces) {
            if let Some(body) = island.bodies.get_mut(place as usize) {
                body.force += wrench.force;
                body.torque += wrench.torque;
            }
        }
    }
}

impl Workspace {
    /// Solves a joint's own rows for its own forces, and adds these to its bodies:
    /// (J M⁻¹ Jᵀ + CFM/k) λ = c/k − J (V/k + M⁻¹ F).
    fn solve_one(&mut self, island: &mut Island, i: usize, k: f64) -> Solved {
        let span = island.spans[i];
        let m = span.count.rows;
        if m == 0 {
            return Solved::Completely;
        }
        let rows = &island.rows[span.first..];
        let ends = span.bodies.map(|place| island.bodies.get(place as usize));
        let free = ends.map(|body| {
            body.map_or((Vec3::ZERO, Vec3::ZERO), |b| {
                let linear = b.frame.linear_velocity / k + b.force * b.inv_mass;
                (linear, b.frame.angular_velocity / k + b.inv_inertia * b.torque)
            })
        });
        let inverse = |body: Option<&SolverBody>, l: Vec3, a: Vec3| {
            body.map_or((Vec3::ZERO, Vec3::ZERO), |b| (l * b.inv_mass, b.inv_inertia * a))
        };
        self.inv_mass_j.clear();
        self.problem.begin(m);
        for row in rows {
            let (l1, a1) = inverse(ends[0], row.linear1, row.angular1);
            let (l2, a2) = inverse(ends[1], row.linear2, row.angular2);
            self.inv_mass_j.push([l1, a1, l2, a2]);
            let moving = row.linear1.dot(free[0].0)
                + row.angular1.dot(free[0].1)
                + row.linear2.dot(free[1].0)
                + row.angular2.dot(free[1].1);
            self.problem.push(row.c / k - moving, (row.lo, row.hi), row.friction_index);
        }
        for r in 0..m {
            let [l1, a1, l2, a2] = self.inv_mass_j[r];
            for (c, row) in rows.iter().enumerate().take(r + 1) {
                *self.problem.entry(r, c) =
                    l1.dot(row.linear1) + a1.dot(row.angular1) + l2.dot(row.linear2) + a2.dot(row.angular2);
            }
            *self.problem.entry(r, r) += rows[r].cfm / k;
        }
        let solved = match self.problem.solve() {
            Some(true) => Solved::Completely,
            Some(false) => Solved::Partly,
            None => {
                // Bounds that exclude zero: no force rather than a wrong one.
                self.problem.x.fill(0.0);
                Solved::Partly
            }
        };
        for (row, lambda) in rows.iter().zip(&self.problem.x) {
            if let Some(body) = island.bodies.get_mut(span.bodies[0] as usize) {
                body.force += row.linear1 * *lambda;
                body.torque += row.angular1 * *lambda;
            }
            if let Some(body) = island.bodies.get_mut(span.bodies[1] as usize) {
                body.force += row.linear2 * *lambda;
                body.torque += row.angular2 * *lambda;
            }
        }
        island.lambda[span.first..].copy_from_slice(&self.problem.x);
        solved
    }
}
