//! Rows of balls and hinges, carried along as their bodies move within a step.
//!
//! With R the rotation of a body since the start of the step and t its displacement, an arm r becomes R r, and the gap between two anchors grows
//! by (t₂ + (R₂ − 1) r₂) − (t₁ + (R₁ − 1) r₁). All of these are small numbers from small numbers, so that `f32` keeps them to a part of
//! 10⁻⁷ of the motion, wherever the bodies are; the next step begins with errors measured in `f64`.

use super::row::LaneRow;
use super::triple::{add, apply, cross, dot, scaled, sub, unscaled, without_trifles};
use crate::carried::{Carried, Drive};
use crate::solve::substep::manifold::to_f32;
use ferrode_math::simd::{Lanes, Mask};

/// Of lengths and angles, in m and rad: parts of 10⁻⁷ of it are rounded away.
pub(super) const TRIFLE: f32 = 1e-8;
/// Numbers of a carried joint in one lane.
const NUMBERS: usize = 9 + 12 + 2 + 3 + 8;

/// A carried joint at the start of a step, in `f32`, with the impulses of the step before.
#[derive(Clone, Copy, Debug)]
pub(in crate::solve::substep) struct CarriedJoint {
    numbers: [f32; NUMBERS],
}

/// What the rows of all joints need to be made.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::solve::substep) struct Rates {
    /// At which errors are corrected, 1/s, and the largest speed that does.
    pub correct: f32,
    pub most: f32,
    /// Substeps per second.
    pub substeps: f32,
}

impl Default for CarriedJoint {
    fn default() -> Self {
        Self { numbers: [0.0; NUMBERS] }
    }
}

impl CarriedJoint {
    /// `give`: γ as a multiple of a CFM; `h`: the length of a substep.
    pub fn new(carried: &Carried, give: f64, h: f64, impulses: &[f32; 6]) -> Self {
        let mut numbers = [0.0; NUMBERS];
        let trifle = f64::from(TRIFLE) * 1e-7;
        let mut put = |at: usize, v| {
            numbers[at..at + 3]
                .copy_from_slice(&to_f32(v).map(|x| if f64::from(x).abs() < trifle { 0.0 } else { x }));
        };
        put(0, carried.arms[0]);
        put(3, carried.arms[1]);
        put(6, carried.gap);
        // γ, wanted velocity, bounds, stop and room.
        let mut drive = [0.0; 6];
        if let Some(hinge) = &carried.hinge {
            put(9, hinge.axis);
            put(12, hinge.slip);
            put(15, hinge.across[0]);
            put(18, hinge.across[1]);
            let gamma = |cfm: f64| (cfm.max(0.0) * give) as f32;
            match hinge.drive {
                Drive::Free => {}
                Drive::Motor { velocity, force, cfm } => {
                    let force = (force * h) as f32;
                    drive = [gamma(cfm), velocity as f32, -force, force, 0.0, 0.0];
                }
                Drive::Stop { room, upper: false, cfm } => {
                    drive = [gamma(cfm), 0.0, 0.0, f32::INFINITY, 1.0, room as f32];
                }
                Drive::Stop { room, upper: true, cfm } => {
                    drive = [gamma(cfm), 0.0, f32::NEG_INFINITY, 0.0, -1.0, room as f32];
                }
            }
        }
        numbers[21] = (carried.cfm.max(0.0) * give) as f32;
        numbers[22..28].copy_from_slice(&drive);
        numbers[28..34].copy_from_slice(impulses);
        numbers[33] = numbers[33].max(drive[2]).min(drive[3]);
        Self { numbers }
    }
}

/// The start of a step of the same joint in several articulations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<L> {
    arms: [[L; 3]; 2],
    gap: [L; 3],
    /// Of hinges.
    axis: [L; 3],
    slip: [L; 3],
    across: [[L; 3]; 2],
    /// Wanted velocity of a motor.
    velocity: L,
    /// 1 for a lower stop, −1 for an upper one, else 0; and the room before it.
    stop: L,
    room: L,
}

/// How a body has moved since the start of the step: displacement, rotation vector, rotation less the identity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<L> {
    displacement: [L; 3],
    rotation: [L; 3],
    turn: [L; 9],
}

impl<L: Lanes> Motion<L> {
    pub const NONE: Self = Self { displacement: [L::ZERO; 3], rotation: [L::ZERO; 3], turn: [L::ZERO; 9] };

    /// Of a body by its displacement and rotation in scaled coordinates.
    #[inline(always)]
    pub fn new(delta: &[L; 6], scales: &[L; 8]) -> Self {
        let s = scales[0];
        let unit = L::splat(TRIFLE);
        let rotation = without_trifles(&unscaled(scales, &[delta[3], delta[4], delta[5]]), unit);
        let displacement = without_trifles(&[delta[0] * s, delta[1] * s, delta[2] * s], unit);
        Self { displacement, rotation, turn: turn(&rotation) }
    }
}

/// The rotation by a vector less the identity: sin θ/θ [θ]ₓ + (1 − cos θ)/θ² [θ]ₓ², by their series.
#[inline(always)]
fn turn<L: Lanes>(rotation: &[L; 3]) -> [L; 9] {
    let mut v = *rotation;
    let x = dot(&v, &v);
    // Exact to 1e-8 up to half a radian, which is 30 rad/s at 60 Hz.
    let mut sine = L::splat(-1.0 / 5_040.0);
    let mut cosine = L::splat(-1.0 / 40_320.0);
    for (s, c) in [(1.0 / 120.0, 1.0 / 720.0), (-1.0 / 6.0, -1.0 / 24.0), (1.0, 0.5)] {
        sine = sine * x + L::splat(s);
        cosine = cosine * x + L::splat(c);
    }
    let far = L::splat(0.25).lt(x);
    if far.any() {
        let (part, s, c) = far_turn(x);
        let part = L::select(far, part, L::ONE);
        v = [v[0] * part, v[1] * part, v[2] * part];
        (sine, cosine) = (L::select(far, s, sine), L::select(far, c, cosine));
    }
    let [a, b, c] = v;
    let (aa, bb, cc) = (cosine * a * a, cosine * b * b, cosine * c * c);
    let (ab, ac, bc) = (cosine * a * b, cosine * a * c, cosine * b * c);
    let (sa, sb, sc) = (sine * a, sine * b, sine * c);
    [-(bb + cc), ab - sc, ac + sb, ab + sc, -(aa + cc), bc - sa, ac - sb, bc + sa, -(aa + bb)]
}

/// For a rotation vector of length √`square`: the part of it that is left without whole turns, with sin θ/θ and (1 − cos θ)/θ² of that. Exact
/// to 1e-6.
#[inline(always)]
fn far_turn<L: Lanes>(square: L) -> (L, L, L) {
    let far = L::splat(9.0).lt(square);
    let angle = L::select(far, square, L::ONE).sqrt();
    let (full, magic) = (L::splat(core::f32::consts::TAU), L::splat(12_582_912.0));
    // Adding and subtracting 1.5·2²³ rounds to the nearest whole number.
    let turns = angle / full + magic - magic;
    let part = L::select(far, L::ONE - turns * full / angle, L::ONE);
    let x = square * part * part;
    let mut sine = L::splat(1.0 / 355_687_428_096_000.0);
    let mut cosine = L::splat(1.0 / 6_402_373_705_728_000.0);
    for (s, c) in [
        (-1.0 / 1_307_674_368_000.0, -1.0 / 20_922_789_888_000.0),
        (1.0 / 6_227_020_800.0, 1.0 / 87_178_291_200.0),
        (-1.0 / 39_916_800.0, -1.0 / 479_001_600.0),
        (1.0 / 362_880.0, 1.0 / 3_628_800.0),
        (-1.0 / 5_040.0, -1.0 / 40_320.0),
        (1.0 / 120.0, 1.0 / 720.0),
        (-1.0 / 6.0, -1.0 / 24.0),
        (1.0, 0.5),
    ] {
        sine = sine * x + L::splat(s);
        cosine = cosine * x + L::splat(c);
    }
    (part, sine, cosine)
}

/// Takes carried joints over, lane by lane: the start of the step; with γ, impulses and bounds put into the rows, six for a hinge.
#[inline(always)]
pub(super) fn take<'a, L: Lanes>(
    joints: impl Iterator<Item = Option<&'a CarriedJoint>>,
    rows: &mut [LaneRow<L>],
) -> (Start<L>, [L; 2]) {
    let mut blocks = [L::Block::default(); NUMBERS];
    for (lane, joint) in joints.enumerate() {
        let Some(joint) = joint else { continue };
        for (block, x) in blocks.iter_mut().zip(&joint.numbers) {
            block.as_mut()[lane] = *x;
        }
    }
    let plain = L::load(&blocks[21]);
    for (i, row) in rows.iter_mut().enumerate() {
        row.gamma = if i == 5 { L::load(&blocks[22]) } else { plain };
        row.impulse = L::load(&blocks[28 + i]);
    }
    let start = Start {
        arms: [three::<L>(&blocks, 0), three::<L>(&blocks, 3)],
        gap: three::<L>(&blocks, 6),
        axis: three::<L>(&blocks, 9),
        slip: three::<L>(&blocks, 12),
        across: [three::<L>(&blocks, 15), three::<L>(&blocks, 18)],
        velocity: L::load(&blocks[23]),
        stop: L::load(&blocks[26]),
        room: L::load(&blocks[27]),
    };
    (start, [L::load(&blocks[24]), L::load(&blocks[25])])
}

#[inline(always)]
fn three<L: Lanes>(blocks: &[L::Block; NUMBERS], at: usize) -> [L; 3] {
    [L::load(&blocks[at]), L::load(&blocks[at + 1]), L::load(&blocks[at + 2])]
}

impl<L: Lanes> Start<L> {
    /// Writes the rows, three or six, at the place to which the bodies have moved.
    #[inline(always)]
    pub fn write(
        &self,
        rates: Rates,
        motions: [&Motion<L>; 2],
        scales: [&[L; 8]; 2],
        rows: &mut [LaneRow<L>],
    ) {
        let [one, two] = motions;
        let (correct, most) = (L::splat(rates.correct), L::splat(rates.most));
        let moved = [apply(&one.turn, &self.arms[0]), apply(&two.turn, &self.arms[1])];
        let unit = L::splat(TRIFLE);
        let arms = [
            without_trifles(&add(&self.arms[0], &moved[0]), unit),
            without_trifles(&add(&self.arms[1], &moved[1]), unit),
        ];
        let apart = sub(&add(&two.displacement, &moved[1]), &add(&one.displacement, &moved[0]));
        let error = without_trifles(&add(&self.gap, &apart), unit);
        let Some((points, rest)) = rows.split_first_chunk_mut::<3>() else { return };
        let [x, y, z] = arms[1];
        let (first, second) = (levers(scales[0], &arms[0]), levers(scales[1], &[-x, -y, -z]));
        for ((point, first), second) in points.iter_mut().zip(first).zip(second) {
            point.angular = [first, second];
        }
        for k in 0..3 {
            points[k].error = error[k];
            points[k].wanted[0] = (correct * error[k]).max(-most).min(most);
        }
        let Some(turning) = rest.first_chunk_mut::<3>() else { return };
        let axis = without_trifles(&add(&self.axis, &apply(&one.turn, &self.axis)), unit);
        // (a + Δ) turned with the second body, less a turned with the first.
        let second = add(&self.axis, &self.slip);
        let slip = add(&self.slip, &sub(&apply(&two.turn, &second), &apply(&one.turn, &self.axis)));
        let error = without_trifles(&cross(&axis, &slip), unit);
        for (row, across) in turning.iter_mut().zip(&self.across) {
            let across = without_trifles(&add(across, &apply(&one.turn, across)), unit);
            row.angular = about(scales, &across);
            row.error = dot(&error, &across);
            row.wanted[0] = (correct * row.error).max(-most).min(most);
        }
        let drive = &mut turning[2];
        drive.angular = about(scales, &axis);
        let room = self.room + self.stop * dot(&axis, &sub(&one.rotation, &two.rotation));
        let (before, beyond) = (room.max(L::ZERO), room.min(L::ZERO));
        let near = self.stop * before * L::splat(rates.substeps);
        let back = (self.stop * beyond * correct).max(-most).min(most);
        drive.wanted = [self.velocity - near - back, self.velocity - near];
    }
}

/// The angular parts of rows along x, y and z at an arm: Sᵀ (r × e) of each.
#[inline(always)]
fn levers<L: Lanes>(s: &[L; 8], r: &[L; 3]) -> [[L; 3]; 3] {
    let [a, b, c] = *r;
    [
        [s[2] * c - s[4] * b, s[3] * c - s[5] * b, -(s[6] * b)],
        [s[4] * a - s[1] * c, s[5] * a, s[6] * a],
        [s[1] * b - s[2] * a, -(s[3] * a), L::ZERO],
    ]
}

/// The angular parts of a row about a world axis.
#[inline(always)]
fn about<L: Lanes>(scales: [&[L; 8]; 2], axis: &[L; 3]) -> [[L; 3]; 2] {
    [scaled(scales[0], axis), scaled(scales[1], &[-axis[0], -axis[1], -axis[2]])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ferrode_math::simd::{Kernel, Level, dispatch_at};
    use ferrode_math::{Quat, Vec3};

    struct Turn([f32; 3]);

    impl Kernel for Turn {
        type Out = [f32; 9];

        fn run<L: Lanes>(self) -> [f32; 9] {
            turn(&self.0.map(L::splat)).map(|x| x.store().as_ref()[0])
        }
    }

    #[test]
    fn rotations_are_those_of_quaternions() {
        let axis = Vec3::new(0.48, -0.6, 0.64);
        for (angle, most) in [(0.0, 0.0), (1e-3, 5e-10), (0.49, 1e-7), (0.51, 2e-7), (3.0, 2e-6), (9.0, 4e-6)]
        {
            let found = dispatch_at(Level::Scalar, Turn(to_f32(axis * angle)));
            let wanted = Quat::from_axis_angle(axis, angle).to_matrix();
            for (i, x) in found.iter().enumerate() {
                let wanted = wanted.rows[i / 3][i % 3] - if i % 4 == 0 { 1.0 } else { 0.0 };
                assert!((f64::from(*x) - wanted).abs() <= most, "{angle}: {x} for {wanted}");
            }
        }
    }
}
