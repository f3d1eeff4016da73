//! What special manifolds have beyond plain friction: restitution, surface motion, other frictions, a softness of their
//! own, and bodies that move but can't be moved.

use super::prepare::Sides;
use super::vector::{Motion, lanes, load3, mul_lower_transpose, store3};
use super::{Batch, Block3};
use crate::solve::substep::manifold::MANIFOLD_POINTS;
use crate::solve::substep::surface::SurfaceCoefficients;
use ferrode_math::Vector3;
use ferrode_math::simd::Lanes;

/// A bound on an impulse: proportional to the normal impulse, plus a constant. One of the two is zero.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bound<B> {
    pub coefficient: B,
    pub constant: B,
}

/// The extras of a batch.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Extra<L: Lanes> {
    /// Normal velocity at each point of bodies that can't be moved.
    pub(super) drift: [L::Block; MANIFOLD_POINTS],
    /// The surface's own velocity along the normal.
    pub(super) lift: L::Block,
    /// Added to the velocities along the tangents and about the normal: those of bodies that can't be moved, less the
    /// surface's own.
    pub(super) offset: Block3<L>,
    /// Bounds along the tangents and, beside that of the points' friction, about the normal.
    pub(super) bounds: [Bound<L::Block>; 3],
    pub(super) slip: [L::Block; 2],
    /// γ of a contact with a softness of its own; 0 for others.
    pub(super) gamma: L::Block,
    /// Rolling about the tangents: angular parts of each body, their mass, impulses and bounds.
    pub(super) rolling: [[Block3<L>; 2]; 2],
    pub(super) rolling_mass: [L::Block; 2],
    pub(super) rolling_impulse: [L::Block; 2],
    pub(super) rolling_bounds: [Bound<L::Block>; 2],
    /// Velocity along the normal at the start of the step, and the largest impulse since.
    pub(super) approach: [L::Block; MANIFOLD_POINTS],
    pub(super) peak: [L::Block; MANIFOLD_POINTS],
    pub(super) bounce: L::Block,
    pub(super) bounce_velocity: L::Block,
}

#[inline(always)]
pub(super) fn prepare<'s, L: Lanes>(
    batch: &mut Batch<L>,
    sides: &Sides<L>,
    surface: &impl Fn(usize) -> &'s SurfaceCoefficients,
    still: [Motion<L>; 2],
    velocities: [Motion<L>; 2],
) -> Extra<L> {
    let zero = L::ZERO.store();
    // Relative velocity, at arms from the centres, of what no force moves.
    let relative = |arms: [Vector3<L>; 2]| {
        let [a, b] = still;
        a.linear + a.angular.cross(arms[0]) - b.linear - b.angular.cross(arms[1])
    };
    let mut drift = [zero; MANIFOLD_POINTS];
    let mut approach = [zero; MANIFOLD_POINTS];
    let lift = lanes::<L>(|lane| surface(lane).motion[2]);
    let (s1, s2) = (L::load(&batch.scale[0]), L::load(&batch.scale[1]));
    let linear = sides.normal.dot(velocities[0].linear * s1 - velocities[1].linear * s2);
    for k in 0..batch.count as usize {
        let d = sides.normal.dot(relative(sides.arms[k])) * sides.present[k];
        drift[k] = d.store();
        let row = &batch.points[k];
        let angular = load3::<L>(&row.angular[0]).dot(velocities[0].angular)
            + load3::<L>(&row.angular[1]).dot(velocities[1].angular);
        approach[k] = ((linear + angular + d - lift) * sides.present[k]).store();
    }
    let sliding = relative(sides.centre);
    let spinning = sides.normal.dot(still[0].angular - still[1].angular);
    let motion = |axis: usize| lanes::<L>(|lane| surface(lane).motion[axis]);
    let offset = [
        (sides.tangents[0].dot(sliding) - motion(0)).store(),
        (sides.tangents[1].dot(sliding) - motion(1)).store(),
        spinning.store(),
    ];
    let bound = |value: &dyn Fn(&SurfaceCoefficients) -> f32, axis: usize| Bound {
        coefficient: lanes::<L>(|lane| {
            let s = surface(lane);
            if s.limited[axis] { 0.0 } else { value(s) }
        })
        .store(),
        constant: lanes::<L>(|lane| {
            let s = surface(lane);
            if s.limited[axis] { value(s) } else { 0.0 }
        })
        .store(),
    };
    let roll = |axis: usize| move |s: &SurfaceCoefficients| s.rolling.map_or(0.0, |r| r[axis]);
    // By name: closures within `map` don't inherit the instruction set.
    let [t1, t2] = sides.tangents;
    let rows = [rolling_row(&sides.scales, t1), rolling_row(&sides.scales, t2)];
    let rolling_mass = [rolling_mass(&rows[0]), rolling_mass(&rows[1])];
    let own = |f: &dyn Fn((f32, f32)) -> f32| lanes::<L>(|lane| surface(lane).softness.map_or(-1.0, f));
    let (rate, gamma) = (own(&|s| s.0), own(&|s| s.1));
    batch.bias_rate = L::select(L::ZERO.le(rate), rate, L::load(&batch.bias_rate)).store();
    // With γ the scales follow from each row's mass; 1 and 0 stand for a hard contact.
    batch.mass_scale = L::select(L::ZERO.le(gamma), L::ONE, L::load(&batch.mass_scale)).store();
    batch.impulse_scale = L::select(L::ZERO.le(gamma), L::ZERO, L::load(&batch.impulse_scale)).store();
    Extra {
        drift,
        lift: lift.store(),
        offset,
        bounds: [bound(&|s| s.mu, 0), bound(&|s| s.mu2, 1), bound(&roll(2), 2)],
        slip: [0, 1].map(|axis: usize| lanes::<L>(|lane| surface(lane).slip[axis]).store()),
        gamma: gamma.max(L::ZERO).store(),
        rolling: [[store3(rows[0][0]), store3(rows[0][1])], [store3(rows[1][0]), store3(rows[1][1])]],
        rolling_mass,
        rolling_impulse: [sides.rolling.dot(t1).store(), sides.rolling.dot(t2).store()],
        rolling_bounds: [bound(&roll(0), 0), bound(&roll(1), 1)],
        approach,
        peak: [zero; MANIFOLD_POINTS],
        bounce: lanes::<L>(|lane| surface(lane).bounce).store(),
        bounce_velocity: lanes::<L>(|lane| surface(lane).bounce_velocity).store(),
    }
}

/// J̃ of rolling about a tangent.
#[inline(always)]
fn rolling_row<L: Lanes>(scales: &[[L; 8]; 2], t: Vector3<L>) -> [Vector3<L>; 2] {
    [mul_lower_transpose(&scales[0], t), -mul_lower_transpose(&scales[1], t)]
}

#[inline(always)]
fn rolling_mass<L: Lanes>(row: &[Vector3<L>; 2]) -> L::Block {
    let k = row[0].length_squared() + row[1].length_squared();
    L::select(L::ZERO.lt(k), L::ONE / k, L::ZERO).store()
}
