//! From manifolds to rows.

use super::extra;
use super::vector::{Motion, lanes, mul_lower_transpose, store3, tangent};
use super::{Batch, Context, FrictionRows, ManifoldKey, PointRow, Span};
use crate::solve::substep::manifold::{MANIFOLD_POINTS, STATIC};
use crate::solve::substep::surface::SurfaceCoefficients;
use ferrode_math::Vector3;
use ferrode_math::simd::{Lanes, NO_RECORD, Record, Work};

static NOTHING: Record = Record::ZERO;
static NO_SURFACE: SurfaceCoefficients = SurfaceCoefficients::NONE;

/// Geometry of a batch that only preparation needs.
pub(super) struct Sides<L: Lanes> {
    /// Scales of the bodies, by [`mul_lower_transpose`]'s layout.
    pub scales: [[L; 8]; 2],
    pub normal: Vector3<L>,
    pub tangents: [Vector3<L>; 2],
    /// Arms of the points, and whether each is there: 1 or 0.
    pub arms: [[Vector3<L>; 2]; MANIFOLD_POINTS],
    pub present: [L; MANIFOLD_POINTS],
    /// Arms of the centre of the points.
    pub centre: [Vector3<L>; 2],
    /// Rolling impulse carried over.
    pub rolling: Vector3<L>,
}

/// Makes the rows of some batches.
pub(super) struct PrepareLot<'a, L: Lanes> {
    pub batches: &'a mut [Batch<L>],
    /// Filled with the batches' bodies.
    pub rows: &'a mut [[L::Index; 2]],
    pub spans: &'a [Span],
    pub context: &'a Context<'a>,
    pub keys: &'a [ManifoldKey],
    pub order: &'a [u32],
}

impl<L: Lanes> Work<L> for PrepareLot<'_, L> {
    #[inline(always)]
    fn run(self) {
        for ((batch, bodies), span) in self.batches.iter_mut().zip(self.rows).zip(self.spans) {
            prepare(batch, bodies, self.context, self.keys, self.order, span);
        }
    }
}

#[inline(always)]
fn prepare<L: Lanes>(
    batch: &mut Batch<L>,
    bodies: &mut [L::Index; 2],
    context: &Context<'_>,
    keys: &[ManifoldKey],
    order: &[u32],
    span: &Span,
) {
    let special = span.special;
    let manifolds = &order[span.first as usize..span.end as usize];
    let at = |i: &u32| &context.manifolds[keys[*i as usize].place as usize];
    let manifold = |lane: usize| manifolds.get(lane).map(at);
    let surface = |lane: usize| manifold(lane).map_or(&NO_SURFACE, |m| &context.surfaces[m.surface as usize]);
    for (side, index) in bodies.iter_mut().enumerate() {
        for (lane, i) in index.as_mut().iter_mut().enumerate() {
            *i = manifolds
                .get(lane)
                .map_or(NO_RECORD, |i| context.bodies.record(keys[*i as usize].bodies[side]));
        }
    }
    let gather_scales = |index: &L::Index| {
        L::transpose(|lane| context.bodies.scales.get(index.as_ref()[lane] as usize).unwrap_or(&NOTHING))
    };
    let scales = [gather_scales(&bodies[0]), gather_scales(&bodies[1])];
    let head = L::transpose(|lane| manifold(lane).map_or(&NOTHING, |m| &m.head));
    let tail = L::transpose(|lane| manifold(lane).map_or(&NOTHING, |m| &m.tail));
    let normal = Vector3::new(head[0], head[1], head[2]);
    let ratio = L::splat(context.ratio);
    let carried = Vector3::new(head[4], head[5], head[6]) * ratio;
    let given = Vector3::new(tail[0], tail[1], tail[2]);
    let has_tangent = L::splat(0.25).lt(given.length_squared());
    let free = tangent(normal);
    let t1 = Vector3::new(
        L::select(has_tangent, given.x, free.x),
        L::select(has_tangent, given.y, free.y),
        L::select(has_tangent, given.z, free.z),
    );
    let t2 = normal.cross(t1);

    let count = lanes::<L>(|lane| manifold(lane).map_or(0.0, |m| f32::from(m.count)));
    let layer = lanes::<L>(|lane| surface(lane).layer);
    let (inv_mass1, inv_mass2) = (scales[0][0] * scales[0][0], scales[1][0] * scales[1][0]);
    let inv_mass = inv_mass1 + inv_mass2;

    // Rows along the normal.
    let most = manifolds.iter().map(|i| at(i).count).max().unwrap_or(0);
    let mut arms = [[Vector3::ZERO; 2]; MANIFOLD_POINTS];
    let mut present = [L::ZERO; MANIFOLD_POINTS];
    let mut centre = [Vector3::ZERO; 2];
    for k in 0..usize::from(most) {
        let r = L::transpose(|lane| manifold(lane).map_or(&NOTHING, |m| &m.points[k]));
        let here = L::splat(k as f32).lt(count);
        let one = L::select(here, L::ONE, L::ZERO);
        let arm = [Vector3::new(r[0], r[1], r[2]), Vector3::new(r[4], r[5], r[6])];
        let a = mul_lower_transpose(&scales[0], arm[0].cross(normal)) * one;
        let b = -(mul_lower_transpose(&scales[1], arm[1].cross(normal)) * one);
        let inverse = inv_mass + a.length_squared() + b.length_squared();
        let mass = L::select(here & L::ZERO.lt(inverse), L::ONE / inverse, L::ZERO);
        let separation = r[3] + layer;
        batch.points[k] = PointRow {
            angular: [store3(a), store3(b)],
            mass: mass.store(),
            separation0: separation.store(),
            separation: separation.store(),
            impulse: (r[7] * one * ratio).store(),
        };
        centre[0] += arm[0] * one;
        centre[1] += arm[1] * one;
        (arms[k], present[k]) = (arm, one);
    }
    let share = L::select(L::ZERO.lt(count), L::ONE / count, L::ZERO);
    // By name: closures within `map` don't inherit the instruction set.
    centre = [centre[0] * share, centre[1] * share];
    let mut radius = L::ZERO;
    for (arm, one) in arms.iter().zip(present).take(usize::from(most)) {
        radius += (arm[0] - centre[0]).length() * one;
    }

    // Friction.
    let rows = [
        [
            mul_lower_transpose(&scales[0], centre[0].cross(t1)),
            -mul_lower_transpose(&scales[1], centre[1].cross(t1)),
        ],
        [
            mul_lower_transpose(&scales[0], centre[0].cross(t2)),
            -mul_lower_transpose(&scales[1], centre[1].cross(t2)),
        ],
        [mul_lower_transpose(&scales[0], normal), -mul_lower_transpose(&scales[1], normal)],
    ];
    let product = |i: usize, j: usize| rows[i][0].dot(rows[j][0]) + rows[i][1].dot(rows[j][1]);
    let (mut k11, k12, mut k22) = (inv_mass + product(0, 0), product(0, 1), inv_mass + product(1, 1));
    if special {
        k11 += lanes::<L>(|lane| surface(lane).slip[0]);
        k22 += lanes::<L>(|lane| surface(lane).slip[1]);
    }
    let determinant = k11 * k22 - k12 * k12;
    let inverse = L::select(L::ZERO.lt(determinant), L::ONE / determinant, L::ZERO);
    let twist = product(2, 2);
    let twist_mass = L::select(L::ZERO.lt(twist), L::ONE / twist, L::ZERO);
    let both = |row: &[Vector3<L>; 2]| [store3(row[0]), store3(row[1])];
    batch.friction = FrictionRows {
        angular: [both(&rows[0]), both(&rows[1]), both(&rows[2])],
        mass: [(k22 * inverse).store(), (-k12 * inverse).store(), (k11 * inverse).store()],
        twist_mass: twist_mass.store(),
        impulse: [carried.dot(t1).store(), carried.dot(t2).store(), (head[3] * ratio).store()],
        mu: lanes::<L>(|lane| surface(lane).mu).store(),
        radius: (radius * share).store(),
    };

    let soft = context.soft;
    batch.normal = store3(normal);
    batch.tangent = store3(t1);
    batch.scale = [scales[0][0].store(), scales[1][0].store()];
    batch.bias_rate = L::splat(soft.bias_rate).store();
    batch.mass_scale = L::splat(soft.mass_scale).store();
    batch.impulse_scale = L::splat(soft.impulse_scale).store();
    batch.push_out = lanes::<L>(|lane| surface(lane).push_out).store();
    batch.count = u32::from(most);
    batch.special = special;
    if special {
        let sides = Sides {
            scales,
            normal,
            tangents: [t1, t2],
            arms,
            present,
            centre,
            rolling: Vector3::new(tail[4], tail[5], tail[6]) * ratio,
        };
        // Velocities of what no force moves.
        let motion = |side: usize| {
            let record = |lane: usize| {
                let body = manifolds.get(lane).map_or(STATIC, |i| keys[*i as usize].bodies[side]);
                let kinematic = body != STATIC && !context.bodies.is_movable(body);
                let list = &context.bodies.motions;
                if kinematic { list.get(body as usize).unwrap_or(&NOTHING) } else { &NOTHING }
            };
            Motion::from_record(L::transpose(record))
        };
        let motions = [motion(0), motion(1)];
        let velocity = |side: usize| {
            let index = &bodies[side];
            Motion::from_record(L::transpose(|lane| {
                context.bodies.velocities.get(index.as_ref()[lane] as usize).unwrap_or(&NOTHING)
            }))
        };
        let velocities = [velocity(0), velocity(1)];
        let made = extra::prepare(batch, &sides, &surface, motions, velocities);
        match &mut batch.extra {
            Some(extra) => **extra = made,
            None => batch.extra = Some(Box::new(made)),
        }
    }
}
