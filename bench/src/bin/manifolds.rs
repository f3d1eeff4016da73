//! What manifolds of two boxes cost, and an update of the pairs of 20,000 boxes.
//!
//! ```text
//! cargo run --release --bin manifolds -- [--reps N] [--side N] [--only PART]
//! ```
//!
//! Processor time of the one thread, least of the repetitions.
#![deny(unsafe_code)]

#[allow(unsafe_code)]
#[path = "../cpu.rs"]
mod cpu;

use ferrode_collide::manifold::{Axis, Manifold, Touching, Workspace, convex_manifold, manifolds};
use ferrode_collide::pairs::{Motion, PairCache, PairSettings};
use ferrode_collide::{
    Capsule, CollideOptions, Cone, Convex, Cuboid, Cylinder, Ellipsoid, Frame, Plane, Shape, Sphere, TriMesh,
    narrow,
};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Pose, Quat, Vec3};

const MARGIN: f64 = 0.02;

struct Dice(OdeRandom);

impl Dice {
    fn number(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4294967296.0 * 2.0 - 1.0
    }
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }
    fn turn(&mut self) -> Quat {
        let q = [self.number(), self.number(), self.number(), self.number()];
        Quat::from_array(q).normalized().unwrap_or(Quat::IDENTITY)
    }
}

/// Least time of a call of `run`, in seconds.
fn least(reps: usize, mut run: impl FnMut()) -> f64 {
    (0..reps)
        .map(|_| {
            let start = cpu::seconds();
            run();
            cpu::seconds() - start
        })
        .fold(f64::INFINITY, f64::min)
}

struct Pair {
    a: Frame,
    b: Frame,
    axis: Axis,
    manifold: Manifold,
}

/// Prints nanoseconds a pair: first look, with the last axis and manifold, refresh, and `collide`.
fn boxes(name: &str, reps: usize, mut place: impl FnMut(&mut Dice) -> (Pose, Pose)) {
    let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).expect("a cube"));
    let mut dice = Dice(OdeRandom::new(1));
    let mut pairs: Vec<Pair> = (0..1000)
        .map(|_| {
            let (a, b) = place(&mut dice);
            let (axis, manifold) = (Axis::default(), Manifold::default());
            Pair { a: Frame::from(&a), b: Frame::from(&b), axis, manifold }
        })
        .collect();
    let n = pairs.len() as f64 * 1e-9;
    let cold = least(reps, || {
        for p in &mut pairs {
            (p.axis, p.manifold) = (Axis::default(), Manifold::default());
            convex_manifold((&cube, &p.a), (&cube, &p.b), MARGIN, &mut p.axis, &mut p.manifold);
        }
    });
    let (mut touching, mut points) = (0, 0);
    let warm = least(reps, || {
        (touching, points) = (0, 0);
        for p in &mut pairs {
            let answer = convex_manifold((&cube, &p.a), (&cube, &p.b), MARGIN, &mut p.axis, &mut p.manifold);
            if answer == Touching::Yes {
                touching += 1;
                points += p.manifold.points().len();
            }
        }
    });
    let refresh = least(reps, || {
        for p in &mut pairs {
            p.manifold.refresh(&p.a, &p.b);
        }
    });
    let mut list = Vec::with_capacity(100);
    let collide = least(reps, || {
        for p in &pairs {
            list.clear();
            narrow::collide_frames((&cube, &p.a), (&cube, &p.b), CollideOptions::default(), &mut list);
        }
    });
    println!(
        "{name:<26} touching {touching:4} points {points:4}   first {:6.1}   again {:6.1}   refresh {:5.1}   collide {:6.1} ns",
        cold / n,
        warm / n,
        refresh / n,
        collide / n
    );
}

/// A block of boxes on the ground, each moved in each step by about `shift` metres.
fn pile(name: &str, reps: usize, side: usize, shift: f64) {
    let cube = Shape::from(Cuboid::new(Vec3::splat(1.0)).expect("a cube"));
    let mut dice = Dice(OdeRandom::new(2));
    let mut cache = PairCache::new(PairSettings::default());
    cache.insert(0, Plane::new(Vec3::Z, 0.0).expect("a plane").into(), &Frame::IDENTITY, Motion::Fixed);
    let mut poses = Vec::new();
    for i in 0..side * side * side {
        // Layers shifted by half a box: each box lies on four.
        let at = |k: usize| (i / side.pow(k as u32) % side) as f64;
        let shift = 0.5 * f64::from(u8::from(i / (side * side) % 2 == 0));
        let turn = Quat::from_axis_angle(Vec3::Z, 0.02 * dice.number());
        let pose =
            Pose::new(Vec3::new(1.06 * at(0) + shift, 1.06 * at(1) + shift, 0.999 * at(2) + 0.499), turn);
        cache.insert(i as u32 + 1, cube.clone(), &Frame::from(&pose), Motion::Awake);
        poses.push(pose);
    }
    let start = cpu::seconds();
    cache.update(&|_, _| true);
    let first = cpu::seconds() - start;
    let mut frames: Vec<Vec<Frame>> = Vec::new();
    for _ in 0..2 {
        let mut moved = || Pose::new(dice.vector() * shift, Quat::from_axis_angle(dice.vector(), shift));
        frames.push(
            poses
                .iter()
                .map(|p| {
                    let m = moved();
                    Frame::from(&Pose::new(p.position + m.position, m.rotation * p.rotation))
                })
                .collect(),
        );
    }
    let mut turn = 0;
    let mut moving = f64::INFINITY;
    let whole = least(reps, || {
        turn += 1;
        let start = cpu::seconds();
        for (i, f) in frames[turn % 2].iter().enumerate() {
            cache.move_geom(i as u32 + 1, f);
        }
        moving = moving.min(cpu::seconds() - start);
        cache.update(&|_, _| true);
    });
    let points: usize = cache.contacts().map(|c| c.1.manifold.points().len()).sum();
    for i in 0..poses.len() as u32 {
        cache.set_awake(i + 1, false);
    }
    cache.update(&|_, _| true);
    let asleep = least(reps, || cache.update(&|_, _| true));
    println!(
        "{name:<26} {:6} boxes {:6} pairs {:6} contacts {points:6} points   first {:6.1}   step {:6.2} (moving {:4.2})   asleep {:6.4} ms   {:.1} MB",
        poses.len(),
        cache.pair_count(),
        cache.contact_count(),
        1e3 * first,
        1e3 * whole,
        1e3 * moving,
        1e3 * asleep,
        1e-6 * cache.memory() as f64
    );
}

/// The kinds of bodies, of about a metre.
fn solids() -> Vec<(&'static str, Shape)> {
    let points: Vec<Vec3> = (0..16)
        .map(|i| {
            let t = f64::from(i);
            let part = |x: f64| (t * x).rem_euclid(1.0) - 0.5;
            Vec3::new(part(1.7), part(0.37), part(0.61)).normalized_or(Vec3::X) * 0.5
        })
        .collect();
    vec![
        ("sphere", Sphere::new(0.5).expect("a ball").into()),
        ("box", Cuboid::new(Vec3::splat(0.9)).expect("a box").into()),
        ("capsule", Capsule::new(0.3, 0.5).expect("a capsule").into()),
        ("cylinder", Cylinder::new(0.4, 0.8).expect("a cylinder").into()),
        ("convex", Convex::from_points(&points).expect("a hull").into()),
        ("ellipsoid", Ellipsoid::new(Vec3::new(0.4, 0.5, 0.6)).expect("an ellipsoid").into()),
        ("cone", Cone::new(0.5, 0.9).expect("a cone").into()),
    ]
}

/// A bumpy mesh of triangles of about half a metre.
fn terrain() -> TriMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let n = 41u32;
    let mut dice = Dice(OdeRandom::new(9));
    for i in 0..n {
        for j in 0..n {
            vertices.push(Vec3::new(
                0.5 * f64::from(i) - 10.0,
                0.5 * f64::from(j) - 10.0,
                0.1 * dice.number(),
            ));
            if i + 1 < n && j + 1 < n {
                let k = i * n + j;
                triangles.extend([[k, k + n, k + n + 1], [k, k + n + 1, k + 1]]);
            }
        }
    }
    TriMesh::new(vertices, triangles).expect("a mesh")
}

/// Nanoseconds of a search for bodies that touch, are near, or lie on terrain.
fn kinds(reps: usize) {
    let list = solids();
    let mesh = Shape::from(terrain());
    let mut work = Workspace::default();
    let mut time = |a: &Shape, b: &Shape, places: &[(Frame, Frame)]| {
        let (mut out, mut found, mut points) = (Vec::with_capacity(64), 0, 0);
        let t = least(reps, || {
            (found, points) = (0, 0);
            for (fa, fb) in places {
                out.clear();
                manifolds((a, fa), (b, fb), MARGIN, &mut work, &mut out);
                found += usize::from(!out.is_empty());
                points += out.iter().map(|m| m.points().len()).sum::<usize>();
            }
        });
        let n = places.len() as f64;
        (1e9 * t / n, 100 * found / places.len(), points as f64 / n)
    };
    let again = |a: &Shape, b: &Shape, places: &[(Frame, Frame)]| {
        let mut known = vec![(Axis::default(), Manifold::default()); places.len()];
        let t = least(reps, || {
            for ((fa, fb), (axis, m)) in places.iter().zip(&mut known) {
                convex_manifold((a, fa), (b, fb), MARGIN, axis, m);
            }
        });
        1e9 * t / places.len() as f64
    };
    for (i, (name, a)) in list.iter().enumerate() {
        for (other, b) in &list[i..] {
            let mut dice = Dice(OdeRandom::new(4));
            let mut places = |gap: f64| -> Vec<(Frame, Frame)> {
                (0..300)
                    .map(|_| {
                        let (ta, tb) = (dice.turn(), dice.turn());
                        let mut at = Pose::new(dice.vector().normalized_or(Vec3::X) * 3.0, ta);
                        let fixed = Pose::new(Vec3::ZERO, tb);
                        if let Some(d) = narrow::distance((a, &at), (b, &fixed)) {
                            at.position -= d.normal * (d.distance - gap);
                        }
                        (Frame::from(&at), Frame::from(&fixed))
                    })
                    .collect()
            };
            let (touch, near) = (places(-0.01), places(0.1));
            let (t, n) = (time(a, b, &touch), time(a, b, &near));
            println!(
                "{name:>10} {other:<10} touching {:7.0}, again {:7.0} ns ({:3} % {:.1} points)   near {:7.0}, again {:7.0} ns",
                t.0,
                again(a, b, &touch),
                t.1,
                t.2,
                n.0,
                again(a, b, &near)
            );
        }
        let mut dice = Dice(OdeRandom::new(4));
        let mut over = |height: f64| -> Vec<(Frame, Frame)> {
            (0..300)
                .map(|_| {
                    let mut at =
                        Pose::new(Vec3::new(8.0 * dice.number(), 8.0 * dice.number(), 3.0), dice.turn());
                    if let Some(d) = narrow::distance((a, &at), (&mesh, &Pose::IDENTITY)) {
                        at.position -= Vec3::Z * (d.distance - height);
                    }
                    (Frame::from(&at), Frame::IDENTITY)
                })
                .collect()
        };
        let (touch, near) = (over(-0.01), over(0.1));
        let (t, n) = (time(a, &mesh, &touch), time(a, &mesh, &near));
        println!(
            "{name:>10} {:<10} touching {:7.0} ns ({:3} % {:.1} points)   near {:7.0} ns",
            "terrain", t.0, t.1, t.2, n.0
        );
    }
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let value = |name: &str| args.iter().position(|a| a == name).and_then(|i| args.get(i + 1));
    let number = |name: &str, or: usize| value(name).and_then(|v| v.parse().ok()).unwrap_or(or);
    let (reps, side) = (number("--reps", 50), number("--side", 27));
    let only = value("--only").cloned().unwrap_or_default();
    if "boxes".contains(only.as_str()) {
        println!("contacts of {} bytes", size_of::<ferrode_collide::pairs::Contact>());
        let up = |h: f64| Pose::from_position(Vec3::Z * h);
        boxes("stacked, four points", reps, |d| {
            let turn = Quat::from_axis_angle(Vec3::Z, 0.02 * d.number());
            (Pose::new(d.vector() * 0.1 + Vec3::Z * 0.95, turn), Pose::IDENTITY)
        });
        boxes("turned on a face", reps, |d| {
            let turn = Quat::from_axis_angle(Vec3::Z, d.number());
            (Pose::new(Vec3::new(d.number(), d.number(), 0.0) * 0.3 + Vec3::Z * 0.99, turn), Pose::IDENTITY)
        });
        boxes("any way, overlapping", reps, |d| (Pose::new(d.vector() * 0.7, d.turn()), Pose::IDENTITY));
        boxes("apart", reps, |d| {
            (Pose::new(d.vector().normalized_or(Vec3::X) * 1.6, d.turn()), Pose::new(Vec3::ZERO, d.turn()))
        });
        boxes("apart, level", reps, |d| {
            let turn = Quat::from_axis_angle(Vec3::Z, 0.02 * d.number());
            (Pose::new(Vec3::new(d.number(), d.number(), 1.1), turn), up(0.0))
        });
    }
    if "kinds".contains(only.as_str()) {
        kinds(reps / 4 + 2);
    }
    if "pile".contains(only.as_str()) {
        for (name, shift) in [
            ("pile at rest", 0.0),
            ("pile, 1 µm a step", 1e-6),
            ("pile, 0.1 mm a step", 1e-4),
            ("pile, 5 mm a step", 5e-3),
        ] {
            pile(name, reps / 4 + 2, side, shift);
        }
    }
}
