//! Contact: keeps two bodies from penetrating, with friction, restitution, softness and rolling resistance.
//!
//! The rows, in this order: normal; friction along the first and second tangent; rolling about the first tangent, the
//! second, and spinning about the normal (ODE manual, "Contact").

use super::{JointError, JointModel};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number, not_nan};
use crate::rows::{JointRows, Row, RowCount, RowKind};
use core::ops::{BitOr, BitOrAssign};
use ferrode_math::{ContactPoint, Vec3, plane_space};

/// Which of a surface's parameters count: ODE's mode bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SurfaceMode(pub u32);

impl SurfaceMode {
    /// `mu2` holds for the second tangent, and `rho`, `rho2`, `rho_n` each for their axis.
    pub const MU2: Self = Self(0x001);
    /// The first tangent is `fdir1`.
    pub const FDIR1: Self = Self(0x002);
    /// Restitution.
    pub const BOUNCE: Self = Self(0x004);
    /// The normal row uses `soft_erp`.
    pub const SOFT_ERP: Self = Self(0x008);
    /// The normal row uses `soft_cfm`.
    pub const SOFT_CFM: Self = Self(0x010);
    /// The surface moves along the first tangent.
    pub const MOTION1: Self = Self(0x020);
    /// The surface moves along the second tangent.
    pub const MOTION2: Self = Self(0x040);
    /// The surface moves along the normal.
    pub const MOTION_N: Self = Self(0x080);
    /// Force-dependent slip along the first tangent.
    pub const SLIP1: Self = Self(0x100);
    /// Force-dependent slip along the second tangent.
    pub const SLIP2: Self = Self(0x200);
    /// Rolling and spinning friction.
    pub const ROLLING: Self = Self(0x400);
    /// The limit along the first tangent is proportional to the normal force.
    pub const APPROX1_1: Self = Self(0x1000);
    /// The limit along the second tangent is proportional to the normal force.
    pub const APPROX1_2: Self = Self(0x2000);
    /// The limit of spinning is proportional to the normal force.
    pub const APPROX1_N: Self = Self(0x4000);
    /// All friction limits are proportional to the normal force: the friction pyramid.
    pub const APPROX1: Self = Self(0x7000);

    /// Whether any bit of `mode` is set.
    #[inline]
    pub const fn has(self, mode: Self) -> bool {
        self.0 & mode.0 != 0
    }
}

impl BitOr for SurfaceMode {
    type Output = Self;
    fn bitor(self, b: Self) -> Self {
        Self(self.0 | b.0)
    }
}

impl BitOrAssign for SurfaceMode {
    fn bitor_assign(&mut self, b: Self) {
        self.0 |= b.0;
    }
}

/// How two surfaces act on each other at a contact (ODE manual, `dSurfaceParameters`).
///
/// Only `mode` and `mu` always count; a mode bit switches each of the others on. The `with_…` functions set value and
/// bit together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// Which parameters count.
    pub mode: SurfaceMode,
    /// Friction: a coefficient with [`SurfaceMode::APPROX1`], else the largest force in newtons. ∞ sticks.
    pub mu: f64,
    /// Friction along the second tangent.
    pub mu2: f64,
    /// Rolling friction about the first tangent: metres with [`SurfaceMode::APPROX1`], else newton metres.
    pub rho: f64,
    /// Rolling friction about the second tangent.
    pub rho2: f64,
    /// Spinning friction about the normal.
    pub rho_n: f64,
    /// Restitution, 0 … 1.
    pub bounce: f64,
    /// Approach speed in m/s above which restitution acts.
    pub bounce_velocity: f64,
    /// Error reduction of the normal row.
    pub soft_erp: f64,
    /// Constraint force mixing of the normal row.
    pub soft_cfm: f64,
    /// Surface velocity along the first tangent, m/s.
    pub motion1: f64,
    /// Surface velocity along the second tangent.
    pub motion2: f64,
    /// Surface velocity along the normal.
    pub motion_n: f64,
    /// Slip along the first tangent: sliding speed per newton.
    pub slip1: f64,
    /// Slip along the second tangent.
    pub slip2: f64,
    /// Largest speed in m/s at which this contact pushes apart; `None` for the world's. ODE has the world's only.
    pub max_correcting_velocity: Option<f64>,
    /// Depth in metres that this contact is left at; `None` for the world's. ODE has the world's only.
    pub surface_layer: Option<f64>,
}

impl Surface {
    /// No friction, no restitution.
    pub fn frictionless() -> Self {
        Self::default()
    }

    /// Coulomb friction with the coefficient `mu`, as a pyramid of limits proportional to the normal force.
    pub fn with_friction(mu: f64) -> Self {
        Self { mode: SurfaceMode::APPROX1, mu, ..Self::default() }
    }

    /// The same with its own coefficient along the second tangent.
    #[must_use]
    pub fn with_mu2(mut self, mu2: f64) -> Self {
        self.mode |= SurfaceMode::MU2;
        self.mu2 = mu2;
        self
    }

    /// The same with restitution `bounce` for contacts that approach faster than `velocity`.
    #[must_use]
    pub fn with_bounce(mut self, bounce: f64, velocity: f64) -> Self {
        self.mode |= SurfaceMode::BOUNCE;
        self.bounce = bounce;
        self.bounce_velocity = velocity;
        self
    }

    /// The same with a soft normal.
    #[must_use]
    pub fn with_softness(mut self, softness: crate::Softness) -> Self {
        self.mode |= SurfaceMode::SOFT_ERP | SurfaceMode::SOFT_CFM;
        self.soft_erp = softness.erp;
        self.soft_cfm = softness.cfm;
        self
    }

    /// The same with surface velocities along the tangents: a conveyor belt.
    #[must_use]
    pub fn with_motion(mut self, motion1: f64, motion2: f64) -> Self {
        self.mode |= SurfaceMode::MOTION1 | SurfaceMode::MOTION2;
        self.motion1 = motion1;
        self.motion2 = motion2;
        self
    }

    /// The same with force-dependent slip along the tangents, in m/s per newton.
    #[must_use]
    pub fn with_slip(mut self, slip1: f64, slip2: f64) -> Self {
        self.mode |= SurfaceMode::SLIP1 | SurfaceMode::SLIP2;
        self.slip1 = slip1;
        self.slip2 = slip2;
        self
    }

    /// The same with rolling friction about both tangents, and spinning friction about the normal.
    #[must_use]
    pub fn with_rolling(mut self, rho: f64, rho2: f64, rho_n: f64) -> Self {
        // Axis-dependent rolling makes friction axis-dependent too; keep that as it was.
        if !self.mode.has(SurfaceMode::MU2) {
            self.mu2 = self.mu;
        }
        self.mode |= SurfaceMode::ROLLING | SurfaceMode::MU2;
        self.rho = rho;
        self.rho2 = rho2;
        self.rho_n = rho_n;
        self
    }

    /// The error that names the first parameter that is NaN, or infinite where it may not be.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check(&self) -> Result<(), Error> {
        // Friction may be infinite (stick); everything else enters products.
        not_nan("mu", self.mu)?;
        let m = self.mode;
        let used = [
            (m.has(SurfaceMode::MU2), "mu2", self.mu2, true),
            (m.has(SurfaceMode::ROLLING), "rho", self.rho, true),
            (m.has(SurfaceMode::ROLLING) && m.has(SurfaceMode::MU2), "rho2", self.rho2, true),
            (m.has(SurfaceMode::ROLLING) && m.has(SurfaceMode::MU2), "rho_n", self.rho_n, true),
            (m.has(SurfaceMode::BOUNCE), "bounce", self.bounce, false),
            (m.has(SurfaceMode::BOUNCE), "bounce_velocity", self.bounce_velocity, true),
            (m.has(SurfaceMode::SOFT_ERP), "soft_erp", self.soft_erp, false),
            (m.has(SurfaceMode::SOFT_CFM), "soft_cfm", self.soft_cfm, false),
            (m.has(SurfaceMode::MOTION1), "motion1", self.motion1, false),
            (m.has(SurfaceMode::MOTION2), "motion2", self.motion2, false),
            (m.has(SurfaceMode::MOTION_N), "motion_n", self.motion_n, false),
            (m.has(SurfaceMode::SLIP1), "slip1", self.slip1, false),
            (m.has(SurfaceMode::SLIP2), "slip2", self.slip2, false),
            (true, "max correcting velocity", self.max_correcting_velocity.unwrap_or(0.0), true),
            (true, "surface layer", self.surface_layer.unwrap_or(0.0), false),
        ];
        for (counts, what, value, may_be_infinite) in used {
            if counts {
                if may_be_infinite { not_nan(what, value) } else { finite_number(what, value) }?;
            }
        }
        Ok(())
    }
}

/// A contact: where, and how the surfaces act there (ODE manual, `dContact`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contact {
    /// How the surfaces act.
    pub surface: Surface,
    /// Where they touch; the normal points into the first body.
    pub point: ContactPoint,
    /// First tangent, used exactly as given, with [`SurfaceMode::FDIR1`].
    pub fdir1: Vec3,
}

impl Contact {
    pub(crate) fn new(_erp: f64, _cfm: f64) -> Self {
        Self::default()
    }

    /// A contact at a point, without a direction of its own for friction.
    pub fn at(point: ContactPoint, surface: Surface) -> Self {
        Self { surface, point, fdir1: Vec3::ZERO }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        self.surface.check()?;
        finite("contact position", self.point.position)?;
        finite("contact normal", self.point.normal)?;
        finite_number("contact depth", self.point.depth)?;
        if self.surface.mode.has(SurfaceMode::FDIR1) {
            finite("contact fdir1", self.fdir1)?;
        }
        Ok(())
    }

    /// Coefficients of the friction and rolling rows, in the rows' order, by what the mode says.
    fn friction(&self) -> [f64; 2] {
        let s = &self.surface;
        [s.mu, if s.mode.has(SurfaceMode::MU2) { s.mu2 } else { s.mu }]
    }

    fn rolling(&self) -> Option<[f64; 3]> {
        let s = &self.surface;
        if !s.mode.has(SurfaceMode::ROLLING) {
            None
        } else if s.mode.has(SurfaceMode::MU2) {
            Some([s.rho, s.rho2, s.rho_n])
        } else {
            Some([s.rho; 3])
        }
    }

    /// Velocity wanted along the normal after the step, and the parts that it is made of.
    fn normal_target(&self, row: &mut Row, ends: &Ends<'_>, ctx: &StepContext) {
        let s = &self.surface;
        let erp = if s.mode.has(SurfaceMode::SOFT_ERP) { s.soft_erp } else { ctx.erp };
        let motion = if s.mode.has(SurfaceMode::MOTION_N) { s.motion_n } else { 0.0 };
        let layer = s.surface_layer.unwrap_or(ctx.contact_surface_layer);
        let fastest = s.max_correcting_velocity.unwrap_or(ctx.contact_max_correcting_velocity);
        let depth = (self.point.depth - layer).max(0.0);
        row.position_error = depth;
        row.velocity_target = motion;
        row.c = (ctx.fps * erp * depth + motion).min(fastest);
        if s.mode.has(SurfaceMode::BOUNCE) && s.bounce_velocity >= 0.0 {
            let approach = motion - relative_velocity(row, ends);
            if approach > s.bounce_velocity {
                row.restitution_target = s.bounce * approach + motion;
                row.c = row.c.max(row.restitution_target);
            }
        }
    }
}

/// J v at the start of the step.
fn relative_velocity(row: &Row, ends: &Ends<'_>) -> f64 {
    let (a, b) = (ends.a(), ends.b());
    let first = row.linear1.dot(a.linear_velocity) + row.angular1.dot(a.angular_velocity);
    first + (row.linear2.dot(b.linear_velocity) + row.angular2.dot(b.angular_velocity))
}

impl JointModel for Contact {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        let s = &self.surface;
        let mut details = vec![
            ("pos", self.point.position.to_array().to_vec()),
            ("normal", self.point.normal.to_array().to_vec()),
            ("depth", vec![self.point.depth]),
            ("mu", vec![s.mu]),
        ];
        let optional = [
            (SurfaceMode::MU2, "mu2", s.mu2),
            (SurfaceMode::BOUNCE, "bounce", s.bounce),
            (SurfaceMode::BOUNCE, "bounce_vel", s.bounce_velocity),
            (SurfaceMode::SOFT_ERP, "soft_ERP", s.soft_erp),
            (SurfaceMode::SOFT_CFM, "soft_CFM", s.soft_cfm),
            (SurfaceMode::MOTION1, "motion1", s.motion1),
            (SurfaceMode::MOTION2, "motion2", s.motion2),
            (SurfaceMode::SLIP1, "slip1", s.slip1),
            (SurfaceMode::SLIP2, "slip2", s.slip2),
        ];
        let used = optional.iter().filter(|(mode, ..)| s.mode.has(*mode));
        details.extend(used.map(|(_, name, value)| (*name, vec![*value])));
        let approximation = (s.mode.0 >> 12) & 3;
        if approximation != 0 {
            details.push(("friction_approximation", vec![f64::from(approximation)]));
        }
        if s.mode.has(SurfaceMode::FDIR1) {
            details.push(("fdir1", self.fdir1.to_array().to_vec()));
        }
        details
    }

    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let s = &mut self.surface;
        for coefficient in [&mut s.mu, &mut s.mu2, &mut s.rho, &mut s.rho2, &mut s.rho_n] {
            // Not `max`: it would turn a NaN into 0 and hide it.
            if *coefficient < 0.0 {
                *coefficient = 0.0;
            }
        }
        let mut count = RowCount::new(1, 0);
        let mut add = |coefficient: f64| {
            count.rows += 1;
            count.unbounded += usize::from(coefficient == f64::INFINITY);
        };
        self.friction().into_iter().filter(|mu| *mu > 0.0).for_each(&mut add);
        // A rolling coefficient of exactly 0 still counts: ODE reserves its row, and the row count decides how many
        // random numbers `Quick` draws.
        self.rolling().into_iter().flatten().for_each(&mut add);
        count
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let s = &self.surface;
        let n = self.point.normal * ends.sign();
        let r1 = self.point.position - ends.a().position;
        let r2 = ends.second.map(|b| self.point.position - b.position);
        let directional = |row: &mut Row, t: Vec3| match r2 {
            Some(r2) => row.set_jacobian(t, r1.cross(t), -t, t.cross(r2)),
            None => row.set_jacobian(t, r1.cross(t), Vec3::ZERO, Vec3::ZERO),
        };

        let mut rows = out.rows.iter_mut();
        let Some(normal) = rows.next() else { return };
        directional(normal, n);
        self.normal_target(normal, ends, ctx);
        if s.mode.has(SurfaceMode::SOFT_CFM) {
            normal.cfm = s.soft_cfm;
        }
        normal.lo = 0.0;
        normal.kind = RowKind::Normal;
        if rows.len() == 0 {
            return;
        }

        let (t1, t2) =
            if s.mode.has(SurfaceMode::FDIR1) { (self.fdir1, n.cross(self.fdir1)) } else { plane_space(n) };
        let proportional = [SurfaceMode::APPROX1_1, SurfaceMode::APPROX1_2, SurfaceMode::APPROX1_N];
        let bound = |row: &mut Row, coefficient: f64, proportional: SurfaceMode, slot: u8| {
            row.lo = -coefficient;
            row.hi = coefficient;
            row.friction_index = if s.mode.has(proportional) { 0 } else { crate::rows::NO_FRICTION_INDEX };
            row.slot = slot;
        };
        let motion = [(SurfaceMode::MOTION1, s.motion1), (SurfaceMode::MOTION2, s.motion2)];
        let slip = [(SurfaceMode::SLIP1, s.slip1), (SurfaceMode::SLIP2, s.slip2)];
        let kinds = [RowKind::Tangent1, RowKind::Tangent2];
        for (i, mu) in self.friction().into_iter().enumerate() {
            if mu > 0.0 {
                let Some(row) = rows.next() else { return };
                directional(row, [t1, t2][i]);
                if s.mode.has(motion[i].0) {
                    row.c = motion[i].1;
                    row.velocity_target = motion[i].1;
                }
                if s.mode.has(slip[i].0) {
                    row.cfm = slip[i].1;
                }
                bound(row, mu, proportional[i], 1 + i as u8);
                row.kind = kinds[i];
            }
        }
        for (i, rho) in self.rolling().into_iter().flatten().enumerate() {
            if rho > 0.0 {
                let Some(row) = rows.next() else { return };
                row.set_angular([t1, t2, n][i], ends.two());
                bound(row, rho, proportional[i], 3 + i as u8);
                row.kind = RowKind::Roll;
            }
        }
        // What is left stands for rolling coefficients of 0. Without bounds of 0 and with a CFM of 0 such an empty row
        // would divide by zero; with them it is inert in every stepper.
        for row in rows {
            (row.lo, row.hi, row.kind, row.slot) = (0.0, 0.0, RowKind::Roll, 5);
        }
    }

    fn error(&self, _ends: &Ends<'_>) -> JointError {
        JointError { position: self.point.depth.max(0.0), angle: 0.0 }
    }
}
