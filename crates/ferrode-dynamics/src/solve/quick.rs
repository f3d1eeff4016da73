//! `Quick`: projected successive over-relaxation, in ODE's row order and with ODE's shuffles.

use super::{FreeMotion, Solved, free_motions, right_hand_side, right_hand_side_of_one};
use crate::rows::{NO_FRICTION_INDEX, Row};
use crate::step::{Island, JointSpan};
use crate::world::QuickSettings;
use ferrode_lcp::sor::{
    InfTimesZero, LoneRow, NO_BODY, SorBody, SorExit, SorParams, SorRow, SorWorkspace, begin_sor_alone,
    begin_sor_rows, finish_sor,
};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Mat3, Vec3};

/// Memory of the stepper.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    free: Vec<FreeMotion>,
    bodies: Vec<SorBody>,
    sor: SorWorkspace,
    /// The problem was accepted.
    begun: bool,
    solved: bool,
    /// What ended the last solve.
    pub exit: Option<SorExit>,
}

/// Begins to find the forces of an island's rows: draws all random numbers, and solves the island unless it has few rows. These wait
/// for [`solve`], which finds the forces of several islands side by side.
pub(crate) fn begin(
    island: &mut Island,
    h: f64,
    settings: &QuickSettings,
    random: &mut OdeRandom,
    work: &mut Workspace,
) {
    let m = island.rows.len();
    work.begun = false;
    work.solved = false;
    work.exit = None;
    if m == 0 {
        return;
    }
    let fps = 1.0 / h;
    free_motions(&island.bodies, fps, &mut work.free);
    work.bodies.clear();
    work.bodies.extend(
        island.bodies.iter().map(|b| SorBody { inv_mass: b.inv_mass, inv_inertia: flatten(&b.inv_inertia) }),
    );
    const { assert!(NO_BODY == crate::arena::NIL) };
    let params = SorParams {
        iterations: settings.iterations,
        over_relaxation: settings.over_relaxation,
        inf_times_zero: if settings.infinite_friction_needs_contact {
            InfTimesZero::Zero
        } else {
            InfTimesZero::Unbounded
        },
        dynamic: settings.dynamic,
    };
    let mut random = |n| random.next_below(n);
    let Island { rows, spans, .. } = island;
    let of_one = |span: &JointSpan| span.bodies == [0, NO_BODY];
    let begun = match (&work.bodies[..], &work.free[..]) {
        ([body], [free]) if spans.iter().all(of_one) => {
            let rows =
                LoneRows { spans: spans.iter(), rows: rows.iter(), first: 0, end: 0, at: 0, free, fps };
            begin_sor_alone(body, m, rows, &params, &mut random, &mut work.sor)
        }
        _ => {
            let rows = SorRows {
                spans: spans.iter(),
                rows: rows.iter(),
                span: None,
                left: 0,
                free: &work.free,
                fps,
            };
            begin_sor_rows(&work.bodies, m, rows, &params, &mut random, &mut work.sor)
        }
    };
    work.begun = begun.is_ok();
}

/// Solves the islands that wait.
pub(crate) fn solve<'a>(islands: impl Iterator<Item = &'a mut Workspace>) {
    finish_sor(islands.filter(|work| work.begun).map(|work| &mut work.sor));
}

/// Writes the forces of a solved island down.
pub(crate) fn finish(island: &mut Island, work: &mut Workspace) -> Solved {
    let Island { rows, lambda, .. } = island;
    lambda.clear();
    if rows.is_empty() {
        return Solved::Completely;
    }
    match work.sor.report().filter(|report| work.begun && report.finite) {
        Some(report) => {
            lambda.extend_from_slice(work.sor.lambda());
            work.solved = true;
            work.exit = Some(report.exit);
            Solved::Completely
        }
        // No forces at all rather than forces that are no numbers.
        None => {
            lambda.resize(rows.len(), 0.0);
            Solved::Partly
        }
    }
}

/// An island's rows as the solver takes them, made one by one.
struct SorRows<'a> {
    spans: core::slice::Iter<'a, JointSpan>,
    rows: core::slice::Iter<'a, Row>,
    span: Option<&'a JointSpan>,
    /// How many rows of the span are left.
    left: usize,
    free: &'a [FreeMotion],
    fps: f64,
}

impl Iterator for SorRows<'_> {
    type Item = SorRow;

    #[inline(always)]
    fn next(&mut self) -> Option<SorRow> {
        while self.left == 0 {
            self.span = self.spans.next();
            self.left = self.span?.count.rows;
        }
        self.left -= 1;
        let (row, span) = (self.rows.next()?, self.span?);
        let (a, b, c, d) = (row.linear1, row.angular1, row.linear2, row.angular2);
        let findex = match row.friction_index {
            NO_FRICTION_INDEX => -1,
            local => span.first as i32 + local,
        };
        Some(SorRow {
            j: [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z],
            rhs: right_hand_side(row, span, self.fps, self.free),
            cfm: row.cfm * self.fps,
            lo: row.lo,
            hi: row.hi,
            findex,
            body: span.bodies,
        })
    }
}

/// The rows of an island of one body as the solver takes them, made one by one.
struct LoneRows<'a> {
    spans: core::slice::Iter<'a, JointSpan>,
    rows: core::slice::Iter<'a, Row>,
    /// The span that the next row is in, and the number of that row.
    first: usize,
    end: usize,
    at: usize,
    free: &'a FreeMotion,
    fps: f64,
}

impl Iterator for LoneRows<'_> {
    type Item = LoneRow;

    #[inline(always)]
    fn next(&mut self) -> Option<LoneRow> {
        while self.at == self.end {
            let span = self.spans.next()?;
            (self.first, self.end) = (span.first, span.first + span.count.rows);
        }
        self.at += 1;
        let row = self.rows.next()?;
        let (a, b) = (row.linear1, row.angular1);
        Some(LoneRow {
            j: [a.x, a.y, a.z, b.x, b.y, b.z],
            rhs: right_hand_side_of_one(row, self.fps, self.free),
            cfm: row.cfm * self.fps,
            lo: row.lo,
            hi: row.hi,
            findex: match row.friction_index {
                NO_FRICTION_INDEX => -1,
                local => self.first as i32 + local,
            },
        })
    }
}

/// Velocities after the step: constraint forces as the iteration accumulated them, then all others.
pub(crate) fn update_velocities(island: &mut Island, h: f64, work: &Workspace) {
    if work.solved {
        for (body, a) in island.bodies.iter_mut().zip(work.sor.acceleration()) {
            body.frame.linear_velocity += Vec3::from_array(a.linear()) * h;
            body.frame.angular_velocity += Vec3::from_array(a.angular()) * h;
        }
    }
    for body in &mut island.bodies {
        body.frame.linear_velocity += body.force * (h * body.inv_mass);
        body.frame.angular_velocity += body.inv_inertia * (body.torque * h);
    }
}

fn flatten(m: &Mat3) -> [f64; 9] {
    let r = &m.rows;
    [r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2]]
}
