//! Bodies of an island four at a time, one in each lane: what is computed for each body by itself, to the bits that it would have alone.

use super::SolverBody;
use crate::body::{Body, FiniteRotation};
use crate::{World, gyroscopic, integrate};
use ferrode_math::simd::{Quad, QuadKernel, dispatch_quads};
use ferrode_math::{Mat3, Matrix3, Quat, Quaternion, Vec3, Vector3};

/// Number `i` of each of four lists, for all numbers.
#[inline(always)]
fn across<Q: Quad, const N: usize>(from: [&[f64; N]; 4]) -> [Q; N] {
    let mut out = [Q::ZERO; N];
    for four in 0..N / 4 {
        let mut rows = [Q::ZERO; 4];
        for l in 0..4 {
            if let Some(numbers) = from[l][4 * four..].first_chunk() {
                rows[l] = Q::load(numbers);
            }
        }
        let columns = Q::columns(rows);
        for i in 0..4 {
            out[4 * four + i] = columns[i];
        }
    }
    for i in N / 4 * 4..N {
        out[i] = Q::load(&[from[0][i], from[1][i], from[2][i], from[3][i]]);
    }
    out
}

/// The way back.
#[inline(always)]
fn apart<Q: Quad, const N: usize>(x: [Q; N]) -> [[f64; N]; 4] {
    let mut to = [[0.0; N]; 4];
    for four in 0..N / 4 {
        let rows = Q::columns([x[4 * four], x[4 * four + 1], x[4 * four + 2], x[4 * four + 3]]);
        for l in 0..4 {
            if let Some(numbers) = to[l][4 * four..].first_chunk_mut() {
                rows[l].store(numbers);
            }
        }
    }
    for i in N / 4 * 4..N {
        let mut numbers = [0.0; 4];
        x[i].store(&mut numbers);
        for l in 0..4 {
            to[l][i] = numbers[l];
        }
    }
    to
}

#[inline(always)]
fn list(m: &Mat3) -> &[f64; 9] {
    m.rows.as_flattened().first_chunk().unwrap_or(&[0.0; 9])
}

#[inline(always)]
fn matrix<T>([a, b, c, d, e, f, g, h, i]: [T; 9]) -> Matrix3<T> {
    Matrix3 { rows: [[a, b, c], [d, e, f], [g, h, i]] }
}

#[inline(always)]
fn matrices<Q: Quad>(of: [&Mat3; 4]) -> Matrix3<Q> {
    let [a, b, c, d] = of;
    matrix(across([list(a), list(b), list(c), list(d)]))
}

#[inline(always)]
fn vectors<Q: Quad>([a, b, c, d]: [Vec3; 4]) -> Vector3<Q> {
    Vector3::new(
        Q::load(&[a.x, b.x, c.x, d.x]),
        Q::load(&[a.y, b.y, c.y, d.y]),
        Q::load(&[a.z, b.z, c.z, d.z]),
    )
}

/// `x`, or zero where `on` is not above zero.
#[inline(always)]
fn where_on<Q: Quad>(on: Q, x: Q) -> Q {
    Q::select(Q::ZERO.lt(on), x, Q::ZERO)
}

/// So many bodies are worth lanes: fewer are moved in and out of them for longer than they are computed with.
pub(super) const WORTH_LANES: usize = 3;

/// Turns the bodies' inverse inertia, as it is in their own frames, into the world's.
pub(super) fn turn_inertia(bodies: &mut [SolverBody]) {
    dispatch_quads(TurnInertia(bodies));
}

struct TurnInertia<'a>(&'a mut [SolverBody]);

impl QuadKernel for TurnInertia<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let (fours, rest) = self.0.as_chunks_mut::<4>();
        for four in fours {
            turn_four::<Q>(four);
        }
        if let [first, ..] = rest {
            let mut four = [*first; 4];
            four[..rest.len()].copy_from_slice(rest);
            turn_four::<Q>(&mut four);
            rest.copy_from_slice(&four[..rest.len()]);
        }
    }
}

#[inline(always)]
fn turn_four<Q: Quad>(bodies: &mut [SolverBody; 4]) {
    let [a, b, c, d] = &*bodies;
    let rotation =
        matrices::<Q>([&a.frame.rotation, &b.frame.rotation, &c.frame.rotation, &d.frame.rotation]);
    let inertia = matrices::<Q>([&a.inv_inertia, &b.inv_inertia, &c.inv_inertia, &d.inv_inertia]);
    let movable = Q::load(&[a.inv_mass, b.inv_mass, c.inv_mass, d.inv_mass]);
    let [[x, y, z], [u, v, w], [r, s, t]] = (rotation * inertia * rotation.transpose()).rows;
    let mut turned = [x, y, z, u, v, w, r, s, t];
    for x in &mut turned {
        *x = where_on(movable, *x);
    }
    let turned = apart(turned);
    for l in 0..4 {
        bodies[l].inv_inertia = matrix(turned[l]);
    }
}

/// Adds the gyroscopic torques of a step of `h` seconds; `slots` are the world's of the bodies.
pub(super) fn add_gyroscopic_torques(world: &World, slots: &[u32], bodies: &mut [SolverBody], h: f64) {
    if bodies.len() >= WORTH_LANES {
        dispatch_quads(GyroscopicTorques { world, slots, bodies, h });
        return;
    }
    for (slot, solver_body) in slots.iter().zip(bodies) {
        let (body, velocity) = (world.bodies.at(*slot), solver_body.frame.angular_velocity);
        if body.gyroscopic_mode && !body.is_kinematic() && velocity != Vec3::ZERO {
            solver_body.torque += gyroscopic::torque(&body.inertia_world(), velocity, h);
        }
    }
}

struct GyroscopicTorques<'a> {
    world: &'a World,
    slots: &'a [u32],
    bodies: &'a mut [SolverBody],
    h: f64,
}

impl QuadKernel for GyroscopicTorques<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { world, slots, bodies, h } = self;
        let h = Q::splat(h);
        for (bodies, slots) in bodies.chunks_mut(4).zip(slots.chunks(4)) {
            // The last ones fill the lanes up.
            let mut slot = [slots[slots.len() - 1]; 4];
            let mut place = [bodies.len() - 1; 4];
            for l in 0..slots.len().min(bodies.len()) {
                (slot[l], place[l]) = (slots[l], l);
            }
            let mut on = [0.0; 4];
            for l in 0..4 {
                let body = world.bodies.at(slot[l]);
                let turns = bodies[place[l]].frame.angular_velocity != Vec3::ZERO;
                if turns && body.gyroscopic_mode && !body.is_kinematic() {
                    on[l] = 1.0;
                }
            }
            if on == [0.0; 4] {
                continue;
            }
            let [a, b, c, d] = place;
            let [a, b, c, d] = [&bodies[a].frame, &bodies[b].frame, &bodies[c].frame, &bodies[d].frame];
            let rotation = matrices::<Q>([&a.rotation, &b.rotation, &c.rotation, &d.rotation]);
            let velocity =
                vectors([a.angular_velocity, b.angular_velocity, c.angular_velocity, d.angular_velocity]);
            let [a, b, c, d] = slot;
            let inertia = matrices::<Q>([
                &world.bodies.at(a).mass.inertia,
                &world.bodies.at(b).mass.inertia,
                &world.bodies.at(c).mass.inertia,
                &world.bodies.at(d).mass.inertia,
            ]);
            let inertia = rotation * inertia * rotation.transpose();
            let Vector3 { x, y, z } = gyroscopic::torque(&inertia, velocity, h);
            let torques = apart([x, y, z]);
            for l in 0..bodies.len() {
                if on[l] > 0.0 {
                    bodies[l].torque += Vec3::from_array(torques[l]);
                }
            }
        }
    }
}

/// Gives the bodies the velocities and poses that the forces on `bodies` lead to in `h` seconds; `slots` are the world's of them.
pub(super) fn advance(world: &mut World, slots: &[u32], bodies: &[SolverBody], h: f64) {
    dispatch_quads(Advance { world, slots, bodies, h });
}

struct Advance<'a> {
    world: &'a mut World,
    slots: &'a [u32],
    bodies: &'a [SolverBody],
    h: f64,
}

impl QuadKernel for Advance<'_> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { world, slots, bodies, h } = self;
        for (bodies, slots) in bodies.chunks(4).zip(slots.chunks(4)) {
            let mut plain = true;
            for slot in slots {
                let body = world.bodies.at(*slot);
                plain &= body.finite_rotation() == FiniteRotation::Off && !body.has_angular_speed_limit();
            }
            let last = &bodies[bodies.len() - 1];
            let mut four = [last; 4];
            for l in 0..bodies.len() {
                four[l] = &bodies[l];
            }
            if plain {
                let (moved, usable) = advance_four::<Q>(four, h);
                if usable {
                    for l in 0..slots.len().min(4) {
                        world.bodies.at_mut(slots[l]).set_motion(&moved[l]);
                    }
                    continue;
                }
            }
            for (slot, from) in slots.iter().zip(bodies) {
                let body = world.bodies.at_mut(*slot);
                body.advance_velocity(from, h);
                integrate::advance_pose(body, h);
            }
        }
    }
}

/// Linear and angular velocity, position, quaternion and rotation.
pub(super) type Motion = [f64; 22];

/// What four bodies do after the step: see `direct::velocity_after` and `integrate::advance_pose`; whether all quaternions have been
/// normalised without more care.
#[inline(always)]
fn advance_four<Q: Quad>([a, b, c, d]: [&SolverBody; 4], h: f64) -> ([Motion; 4], bool) {
    let (fa, fb, fc, fd) = (&a.frame, &b.frame, &c.frame, &d.frame);
    let step = Q::splat(h);
    let inv_mass = Q::load(&[a.inv_mass, b.inv_mass, c.inv_mass, d.inv_mass]);
    let inv_inertia = matrices::<Q>([&a.inv_inertia, &b.inv_inertia, &c.inv_inertia, &d.inv_inertia]);
    let linear: Vector3<Q> =
        vectors([fa.linear_velocity, fb.linear_velocity, fc.linear_velocity, fd.linear_velocity]);
    let angular: Vector3<Q> =
        vectors([fa.angular_velocity, fb.angular_velocity, fc.angular_velocity, fd.angular_velocity]);
    let force: Vector3<Q> = vectors([a.force, b.force, c.force, d.force]);
    let torque: Vector3<Q> = vectors([a.torque, b.torque, c.torque, d.torque]);
    let position: Vector3<Q> = vectors([fa.position, fb.position, fc.position, fd.position]);
    let [qa, qb, qc, qd] = [fa.quaternion, fb.quaternion, fc.quaternion, fd.quaternion];
    let [w, x, y, z] = Q::columns([
        Q::load(&qa.to_array()),
        Q::load(&qb.to_array()),
        Q::load(&qc.to_array()),
        Q::load(&qd.to_array()),
    ]);
    let q = Quaternion { w, x, y, z };

    let linear = linear + force * (step * inv_mass);
    let angular = angular + inv_inertia * (torque * step);
    let position = position + linear * step;
    let q = q + q.derivative(angular).scale(step);
    let length = q.dot(q);
    let usable = Q::splat(Quat::LEAST_SQUARE).lt(length) & length.le(Q::splat(f64::MAX));
    let q = q.scale(Q::ONE / length.sqrt());
    let [[r0, r1, r2], [r3, r4, r5], [r6, r7, r8]] = q.to_matrix().rows;
    let motion = apart([
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z, position.x, position.y, position.z,
        q.w, q.x, q.y, q.z, r0, r1, r2, r3, r4, r5, r6, r7, r8,
    ]);
    (motion, Q::bits(usable) == 15)
}

impl Body {
    #[inline(always)]
    fn set_motion(&mut self, motion: &Motion) {
        let [vx, vy, vz, wx, wy, wz, px, py, pz, qw, qx, qy, qz, rotation @ ..] = motion;
        let frame = &mut self.frame;
        frame.linear_velocity = Vec3::new(*vx, *vy, *vz);
        frame.angular_velocity = Vec3::new(*wx, *wy, *wz);
        frame.position = Vec3::new(*px, *py, *pz);
        frame.quaternion = Quat::new(*qw, *qx, *qy, *qz);
        frame.rotation = matrix(*rotation);
        self.pose_version = self.pose_version.wrapping_add(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ends::Frame;
    use crate::solve::direct::velocity_after;

    /// Bodies of all kinds: the fourth can't move, the sixth has an orientation that shrinks to next to nothing.
    fn bodies() -> Vec<SolverBody> {
        (0..7)
            .map(|i| {
                let t = f64::from(i);
                let q = Quat::new(0.3 * t, 1.0, -0.2 * t, 0.7).normalized().unwrap();
                let q = if i == 5 { q.scale(1e-160) } else { q };
                SolverBody {
                    frame: Frame {
                        position: Vec3::new(t, 2.0, -1.0 / 3.0),
                        rotation: q.to_matrix(),
                        quaternion: q,
                        linear_velocity: Vec3::new(0.1, -t, 3.0),
                        angular_velocity: Vec3::new(2.0 - t, 0.7 * t, 1.0),
                    },
                    inv_mass: if i == 3 { 0.0 } else { 0.1 + t },
                    inv_inertia: Mat3::from_rows([[1.0 + t, 0.1, 0.0], [0.1, 2.0, -0.3], [0.0, -0.3, 3.0]]),
                    force: Vec3::new(0.2, t, -t),
                    torque: Vec3::new(1.0 / 7.0, -0.4, t),
                }
            })
            .collect()
    }

    #[test]
    fn inertia_is_turned_as_that_of_one_body() {
        for count in 0..=7 {
            let mut turned = bodies()[..count].to_vec();
            turn_inertia(&mut turned);
            for (body, turned) in bodies().iter().zip(&turned) {
                let r = body.frame.rotation;
                let alone = r * body.inv_inertia * r.transpose();
                assert_eq!(turned.inv_inertia, if body.inv_mass > 0.0 { alone } else { Mat3::ZERO });
            }
        }
    }

    #[test]
    fn bodies_end_where_each_would_alone() {
        let mut world = World::new();
        let from = bodies();
        let slots: Vec<u32> = from
            .iter()
            .map(|body| {
                let key = world.create_body();
                let slot = key.0.index;
                world.bodies.at_mut(slot).frame = body.frame;
                slot
            })
            .collect();
        // One of the first four spins no faster than this.
        for limited in [false, true] {
            if limited {
                world.bodies.at_mut(slots[1]).set_max_angular_speed(0.5).unwrap();
            }
            let mut alone = world.clone();
            advance(&mut world, &slots, &from, 0.01);
            for (slot, from) in slots.iter().zip(&from) {
                let body = alone.bodies.at_mut(*slot);
                let [linear, angular] = velocity_after(from, 0.01);
                (body.frame.linear_velocity, body.frame.angular_velocity) = (linear, angular);
                integrate::advance_pose(body, 0.01);
                let moved = world.bodies.at(*slot);
                assert_eq!(moved.frame, body.frame);
                assert_eq!(moved.pose_version, body.pose_version);
                assert!(moved.frame.position != from.frame.position);
            }
            for (slot, from) in slots.iter().zip(&from) {
                world.bodies.at_mut(*slot).frame = from.frame;
            }
        }
    }
}
