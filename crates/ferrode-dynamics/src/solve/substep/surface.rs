//! Surfaces as the kernels want them.

use crate::ends::StepContext;
use crate::{Softness, Surface, SurfaceMode};

/// What of a surface the kernels read, per substep.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceCoefficients {
    /// Friction along the first tangent: times the normal impulse, or with `limited` an impulse.
    pub mu: f32,
    /// Whether anything beyond plain Coulomb friction is asked for.
    pub special: bool,
    /// Friction along the second tangent, as `mu`.
    pub mu2: f32,
    /// Bounds of friction are impulses, not coefficients (ODE without `APPROX1`).
    pub limited: [bool; 3],
    /// Rolling about the tangents and spinning about the normal, metres or impulses.
    pub rolling: Option<[f32; 3]>,
    pub bounce: f32,
    pub bounce_velocity: f32,
    /// Surface motion along the tangents and the normal.
    pub motion: [f32; 3],
    /// Slip along the tangents, per impulse.
    pub slip: [f32; 2],
    /// Bias rate and γ of a contact with a softness of its own.
    pub softness: Option<(f32, f32)>,
    /// Depth that is left.
    pub layer: f32,
    /// Cap of the push-out speed.
    pub push_out: f32,
}

/// Infinite friction, kept finite so that times a zero impulse it is zero.
const STICK: f64 = 1e30;

impl SurfaceCoefficients {
    /// Of a lane without manifold.
    pub const NONE: Self = Self {
        mu: 0.0,
        special: false,
        mu2: 0.0,
        limited: [false; 3],
        rolling: None,
        bounce: 0.0,
        bounce_velocity: 0.0,
        motion: [0.0; 3],
        slip: [0.0; 2],
        softness: None,
        layer: 0.0,
        push_out: 0.0,
    };

    /// Converts a surface, at `n` substeps of `ctx.h / n`.
    pub fn new(s: &Surface, ctx: &StepContext, n: f64, push_out: f64) -> Self {
        let m = s.mode;
        let h = ctx.h / n;
        let on = |mode: SurfaceMode, x: f64| if m.has(mode) { x } else { 0.0 };
        let limited =
            [SurfaceMode::APPROX1_1, SurfaceMode::APPROX1_2, SurfaceMode::APPROX1_N].map(|mode| !m.has(mode));
        // A bound in newtons is one of h times as many newton seconds.
        let bound = |x: f64, limited: bool| {
            let x = x.clamp(0.0, STICK);
            (if limited && x < STICK { x * h } else { x }) as f32
        };
        let two = m.has(SurfaceMode::MU2);
        let mu2 = if two { s.mu2 } else { s.mu };
        let rolling = m.has(SurfaceMode::ROLLING).then(|| {
            let [a, b, c] = if two { [s.rho, s.rho2, s.rho_n] } else { [s.rho; 3] };
            [bound(a, limited[0]), bound(b, limited[1]), bound(c, limited[2])]
        });
        let softness = (m.has(SurfaceMode::SOFT_ERP) || m.has(SurfaceMode::SOFT_CFM)).then(|| {
            let erp = if m.has(SurfaceMode::SOFT_ERP) { s.soft_erp } else { ctx.erp };
            let cfm = if m.has(SurfaceMode::SOFT_CFM) { s.soft_cfm } else { ctx.cfm };
            let part = Softness { erp, cfm }.at_substep(n);
            ((part.erp / h) as f32, (part.cfm / h) as f32)
        });
        let out = Self {
            mu: bound(s.mu, limited[0]),
            special: false,
            mu2: bound(mu2, limited[1]),
            limited,
            rolling: rolling.filter(|r| r.iter().any(|x| *x > 0.0)),
            bounce: on(SurfaceMode::BOUNCE, s.bounce) as f32,
            bounce_velocity: s.bounce_velocity.max(0.0) as f32,
            motion: [
                on(SurfaceMode::MOTION1, s.motion1) as f32,
                on(SurfaceMode::MOTION2, s.motion2) as f32,
                on(SurfaceMode::MOTION_N, s.motion_n) as f32,
            ],
            slip: [
                (on(SurfaceMode::SLIP1, s.slip1).max(0.0) / h) as f32,
                (on(SurfaceMode::SLIP2, s.slip2).max(0.0) / h) as f32,
            ],
            softness,
            layer: s.surface_layer.unwrap_or(ctx.contact_surface_layer) as f32,
            push_out: s.max_correcting_velocity.unwrap_or(ctx.contact_max_correcting_velocity).min(push_out)
                as f32,
        };
        let plain_cone = out.mu == out.mu2 && (out.mu == 0.0 || !(limited[0] || limited[1]));
        let special = !plain_cone
            || out.rolling.is_some()
            || out.bounce > 0.0
            || out.motion != [0.0; 3]
            || out.slip != [0.0; 2]
            || out.softness.is_some();
        Self { special, ..out }
    }
}
