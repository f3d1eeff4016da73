//! Random scenes, each from a seed of its own.

mod joints;

use super::engine::Engine;
use super::{Line, Record};
use ferrode_dynamics::{Axis, DirectSettings, Error, JointType, Mass, SurfaceMode};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Mat3, Quat, Vec3};

/// How this crate finds the forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// `Direct` with its defaults: small islands by ODE's method.
    Direct,
    /// `Direct` with block pivoting on the sparse factorisation even for the smallest island.
    Sparse,
    /// `Quick`.
    Quick,
}

/// A scene: how it is made, and what happens before each of its steps.
pub struct Scene {
    pub seed: u32,
    pub setup: Vec<Line>,
    /// What is done before every step.
    each_step: Vec<Line>,
    touching: Vec<Touching>,
    pub h: f64,
    /// Whether the constraints may depend on each other, so that forces, and what follows from them, are decided by
    /// rounding.
    pub redundant: bool,
    /// The types of joints in it, contacts included.
    pub types: Vec<JointType>,
}

/// A contact that is made in each step from the bodies' state: spheres and boxes against the plane z = 0, and spheres against
/// each other.
struct Touching {
    first: usize,
    /// The other sphere, or `None` for the plane.
    second: Option<usize>,
    /// Radius, or half sides.
    size: [Vec3; 2],
    reverse: bool,
    surface: Vec<f64>,
    fdir1: Vec3,
}

/// Random numbers in the ranges that scenes need.
struct Dice(OdeRandom);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0.next_below(n as u32) as usize
    }

    fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next_real()
    }

    fn chance(&mut self, p: f64) -> bool {
        self.0.next_real() < p
    }

    fn vector(&mut self, range: f64) -> Vec3 {
        self.0.next_vector(range)
    }

    fn rotation(&mut self) -> Quat {
        loop {
            let q = Quat::from_parts(self.0.next_signed(1.0), self.vector(1.0));
            if let (true, Some(unit)) = (q.dot(q) > 0.01, q.normalized()) {
                return unit;
            }
        }
    }

    /// Three perpendicular unit vectors.
    fn frame(&mut self) -> [Vec3; 3] {
        let m = self.rotation().to_matrix();
        [m.column(0), m.column(1), m.column(2)]
    }
}

/// Which bodies hang together, to tell when constraints may be redundant.
struct Components {
    parent: Vec<usize>,
    /// How often the component is held by something that does not move.
    held: Vec<usize>,
    loops: bool,
}

impl Components {
    fn new(n: usize) -> Self {
        Self { parent: (0..n).collect(), held: vec![0; n], loops: false }
    }

    fn root(&self, mut i: usize) -> usize {
        while self.parent[i] != i {
            i = self.parent[i];
        }
        i
    }

    fn link(&mut self, a: usize, b: Option<usize>) {
        let a = self.root(a);
        match b.map(|b| self.root(b)) {
            None => self.held[a] += 1,
            Some(b) if a == b => self.loops = true,
            Some(b) => {
                self.parent[a] = b;
                self.held[b] += self.held[a];
            }
        }
    }

    /// Whether one more link would, or might, be redundant.
    fn would_close(&self, a: usize, b: Option<usize>) -> bool {
        let a = self.root(a);
        match b.map(|b| self.root(b)) {
            None => self.held[a] > 0,
            Some(b) => a == b || self.held[a] + self.held[b] > 1,
        }
    }

    fn redundant(&self) -> bool {
        self.loops || (0..self.parent.len()).any(|i| self.root(i) == i && self.held[i] > 1)
    }
}

impl Scene {
    pub fn random(seed: u32) -> Self {
        let mut dice = Dice(OdeRandom::new(seed.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995));
        dice.0.skip(8);
        let mut scene = Self {
            seed,
            setup: Vec::new(),
            each_step: Vec::new(),
            touching: Vec::new(),
            h: [0.005, 0.01, 0.02][dice.below(3)],
            redundant: false,
            types: Vec::new(),
        };
        scene.add_world(&mut dice);
        let n = 1 + dice.below(6);
        let mut positions = Vec::new();
        let mut kinematic = Vec::new();
        for i in 0..n {
            let p = dice.vector(1.5);
            kinematic.push(scene.add_body(&mut dice, i, p));
            positions.push(p);
        }
        let mut components = Components::new(n);
        // A body by itself, or as part of what does not move.
        let dynamic = |i: usize| (!kinematic[i]).then_some(i);
        let ends = |pair: [Option<usize>; 2]| match pair.map(|i| i.and_then(dynamic)) {
            [Some(a), b] => Some((a, b)),
            [None, Some(b)] => Some((b, None)),
            [None, None] => None,
        };
        let loose = dice.chance(0.6);
        // A tree of joints, and now and then one that closes a loop.
        let mut pairs: Vec<[Option<usize>; 2]> = Vec::new();
        for i in 0..n {
            match dice.below(6) {
                0 | 1 if i > 0 => pairs.push([Some(i), Some(dice.below(i))]),
                2 if i > 0 => pairs.push([Some(dice.below(i)), Some(i)]),
                3 => pairs.push([Some(i), None]),
                4 => pairs.push([None, Some(i)]),
                _ => {}
            }
        }
        if n > 1 && dice.chance(0.15) {
            let i = dice.below(n - 1);
            pairs.push([Some(i), Some(i + 1)]);
        }
        let mut count = 0;
        for pair in pairs {
            let kind = joints::choose(&mut dice, pair);
            // That joint holds one body only.
            let pair = if kind == JointType::Plane2D { [pair[0].or(pair[1]), None] } else { pair };
            let link = ends(pair);
            if loose && link.is_some_and(|(a, b)| components.would_close(a, b)) {
                continue;
            }
            link.into_iter().for_each(|(a, b)| components.link(a, b));
            scene.add_joint(&mut dice, count, kind, pair, &positions);
            count += 1;
        }
        for i in 0..n {
            if !dice.chance(0.35) {
                continue;
            }
            let other = (n > 1 && dice.chance(0.3)).then(|| (i + 1 + dice.below(n - 1)) % n);
            let link = ends([Some(i), other]);
            if loose && link.is_some_and(|(a, b)| components.would_close(a, b)) {
                continue;
            }
            let corners = if other.is_none() && !loose && dice.chance(0.4) { 4 } else { 1 };
            for _ in 0..corners {
                link.into_iter().for_each(|(a, b)| components.link(a, b));
            }
            scene.add_touching(&mut dice, i, other, corners == 4, &positions);
        }
        for i in 0..n {
            if dice.chance(0.3) {
                let (f, t) = (dice.vector(5.0), dice.vector(2.0));
                let op = if dice.chance(0.5) { "force" } else { "relative_force_at" };
                scene.each_step.push(Line::new(op, i, &[f.x, f.y, f.z, t.x, t.y, t.z]));
            }
        }
        scene.redundant = components.redundant();
        scene
    }

    fn set(&mut self, op: &'static str, index: usize, numbers: &[f64]) {
        self.setup.push(Line::new(op, index, numbers));
    }

    fn add_world(&mut self, dice: &mut Dice) {
        let g = if dice.chance(0.7) { Vec3::new(0.0, 0.0, -9.81) } else { dice.vector(10.0) };
        self.set("gravity", 0, &g.to_array());
        let erp = if dice.chance(0.5) { 0.2 } else { dice.range(0.05, 0.9) };
        self.set("erp", 0, &[erp]);
        self.set("cfm", 0, &[[1e-10, 1e-10, 1e-8, 1e-5, 1e-3][dice.below(5)]]);
        if dice.chance(0.5) {
            self.set("iterations", 0, &[(1 + dice.below(50)) as f64]);
            self.set("over_relaxation", 0, &[dice.range(0.7, 1.6)]);
        }
        if dice.chance(0.2) {
            self.set("max_correcting_velocity", 0, &[dice.range(0.05, 1.0)]);
        }
        if dice.chance(0.2) {
            self.set("surface_layer", 0, &[dice.range(0.0, 0.02)]);
        }
        if dice.chance(0.15) {
            let d = [dice.range(0.0, 0.1), dice.range(0.0, 0.1), dice.range(0.0, 1.0), dice.range(0.0, 1.0)];
            self.set("world_damping", 0, &d);
        }
        if dice.chance(0.1) {
            self.set("world_max_angular_speed", 0, &[dice.range(0.5, 4.0)]);
        }
        if dice.chance(0.15) {
            let sleep = auto_disable(dice);
            self.set("world_auto_disable", 0, &sleep);
        }
        let seed = dice.below(1 << 31) as f64;
        self.set("seed", 0, &[seed]);
    }

    /// Adds a body; true if it is kinematic.
    fn add_body(&mut self, dice: &mut Dice, i: usize, p: Vec3) -> bool {
        self.set("body", i, &[]);
        let total = dice.range(0.2, 5.0);
        let mass = match dice.below(3) {
            0 => Mass::sphere_total(total, dice.range(0.2, 0.6)),
            1 => Mass::cuboid_total(total, Vec3::splat(0.7) + dice.vector(0.5)),
            _ => Mass::capsule_total(total, Axis::X, dice.range(0.1, 0.4), dice.range(0.1, 1.0)),
        };
        let mut mass = mass.expect("sizes are positive");
        if dice.chance(0.3) {
            mass = mass.rotate(dice.rotation().to_matrix()).expect("a rotation");
        }
        let Mat3 { rows: r } = mass.inertia;
        let numbers = [mass.mass, r[0][0], r[1][1], r[2][2], r[0][1], r[0][2], r[1][2]];
        self.set("mass", i, &numbers);
        self.set("position", i, &p.to_array());
        if dice.chance(0.8) {
            let q = dice.rotation();
            self.set("quaternion", i, &[q.w, q.imaginary().x, q.imaginary().y, q.imaginary().z]);
        }
        if dice.chance(0.7) {
            self.set("linear_velocity", i, &dice.vector(1.0).to_array());
            self.set("angular_velocity", i, &dice.vector(2.0).to_array());
        }
        if dice.chance(0.15) {
            self.set("gravity_mode", i, &[0.0]);
        }
        if dice.chance(0.25) {
            self.set("gyroscopic_mode", i, &[0.0]);
        }
        if dice.chance(0.25) {
            let axis = if dice.chance(0.5) { dice.vector(1.0) } else { Vec3::ZERO };
            self.set("finite_rotation", i, &[1.0, axis.x, axis.y, axis.z]);
        }
        if dice.chance(0.15) {
            let d = [dice.range(0.0, 0.2), dice.range(0.0, 0.2), dice.range(0.0, 1.0), dice.range(0.0, 1.0)];
            self.set("damping", i, &d);
        }
        if dice.chance(0.15) {
            self.set("max_angular_speed", i, &[dice.range(0.5, 4.0)]);
        }
        if dice.chance(0.15) {
            let sleep = auto_disable(dice);
            self.set("auto_disable", i, &sleep);
        }
        if dice.chance(0.08) {
            self.set("body_enabled", i, &[0.0]);
        }
        let kinematic = dice.chance(0.1);
        if kinematic {
            self.set("kinematic", i, &[]);
        }
        kinematic
    }

    /// Adds contacts of a body with the plane or another body: a sphere's one, or those of a box's four corners.
    fn add_touching(
        &mut self,
        dice: &mut Dice,
        first: usize,
        second: Option<usize>,
        corners: bool,
        positions: &[Vec3],
    ) {
        self.types.push(JointType::Contact);
        let size = match second {
            // Spheres that overlap a little.
            Some(j) => {
                let d = (positions[first] - positions[j]).length() * dice.range(0.49, 0.55);
                [Vec3::splat(d); 2]
            }
            None if corners => [Vec3::splat(0.5) + dice.vector(0.3), Vec3::ZERO],
            None => [Vec3::splat(dice.range(0.3, 0.6)), Vec3::ZERO],
        };
        if second.is_none() {
            // Down to the plane.
            let (p, sink) = (positions[first], dice.range(-0.01, 0.05));
            self.set("position", first, &[p.x, p.y, size[0].z - sink]);
            if corners {
                self.set("quaternion", first, &[1.0, 0.0, 0.0, 0.0]);
            }
        }
        let mut mode = 0;
        let mut may = |bit: SurfaceMode, p: f64| {
            if dice.chance(p) {
                mode |= bit.0;
            }
        };
        may(SurfaceMode::MU2, 0.25);
        may(SurfaceMode::FDIR1, 0.2);
        may(SurfaceMode::BOUNCE, 0.4);
        may(SurfaceMode::SOFT_ERP, 0.2);
        may(SurfaceMode::SOFT_CFM, 0.2);
        may(SurfaceMode::MOTION1, 0.15);
        may(SurfaceMode::MOTION2, 0.15);
        may(SurfaceMode::MOTION_N, 0.1);
        may(SurfaceMode::SLIP1, 0.15);
        may(SurfaceMode::SLIP2, 0.15);
        may(SurfaceMode::ROLLING, 0.25);
        if dice.chance(0.7) {
            mode |= SurfaceMode::APPROX1.0;
        } else {
            mode |= SurfaceMode::APPROX1_1.0 * dice.below(8) as u32;
        }
        let mu = |dice: &mut Dice| match dice.below(10) {
            0 => 0.0,
            1 => f64::INFINITY,
            2 => -0.5,
            _ => dice.range(0.05, 1.5),
        };
        let mut surface = vec![f64::from(mode), mu(dice), mu(dice)];
        surface.extend((0..3).map(|_| if dice.chance(0.15) { 0.0 } else { dice.range(0.01, 0.2) }));
        surface.extend([dice.range(0.0, 1.0), dice.range(0.0, 0.5), dice.range(0.1, 0.9)]);
        surface.push([1e-8, 1e-4, 1e-2][dice.below(3)]);
        surface.extend((0..3).map(|_| dice.range(-0.5, 0.5)));
        surface.extend([dice.range(0.0, 0.1), dice.range(0.0, 0.1)]);
        let [t, _, _] = dice.frame();
        let fdir1 = if second.is_none() { Vec3::new(t.x, t.y, 0.0).normalized_or(Vec3::X) } else { t };
        let reverse = second.is_none() && dice.chance(0.2);
        self.touching.push(Touching { first, second, size, reverse, surface, fdir1 });
    }

    /// The contacts of this moment, from this engine's state.
    fn contacts(&self, engine: &Engine) -> Vec<Line> {
        let mut lines = Vec::new();
        for t in &self.touching {
            let body =
                |i: usize| engine.world.body(engine.bodies[i]).expect("bodies live as long as the scene");
            let a = body(t.first);
            let points: Vec<(Vec3, Vec3, f64)> = match t.second {
                Some(j) => {
                    let (p, q) = (a.position(), body(j).position());
                    let Some(n) = (p - q).normalized() else { continue };
                    let depth = t.size[0].x + t.size[1].x - (p - q).length();
                    vec![(q + n * t.size[1].x, n, depth)]
                }
                None if t.size[0] == Vec3::splat(t.size[0].x) => {
                    let p = a.position();
                    vec![(Vec3::new(p.x, p.y, 0.0), Vec3::Z, t.size[0].z - p.z)]
                }
                None => {
                    let bottom = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
                    let s = t.size[0];
                    let corner =
                        |[x, y]: [f64; 2]| a.relative_point_position(Vec3::new(x * s.x, y * s.y, -s.z));
                    bottom.map(corner).into_iter().map(|p| (p, Vec3::Z, -p.z)).collect()
                }
            };
            for (p, n, depth) in points.into_iter().filter(|(_, _, depth)| *depth > -0.01) {
                let first = t.first as f64;
                let mut numbers = match t.second {
                    Some(j) => vec![first, j as f64],
                    None if t.reverse => vec![-1.0, first],
                    None => vec![first, -1.0],
                };
                numbers.extend(&t.surface);
                let n = if t.reverse { -n } else { n };
                numbers.extend([p, n].into_iter().flat_map(Vec3::to_array));
                numbers.push(depth);
                numbers.extend(t.fdir1.to_array());
                lines.push(Line::new("contact", 0, &numbers));
            }
        }
        lines
    }

    /// Runs the scene with this crate. The script that it wrote on the way, contacts included, repeats it elsewhere.
    pub fn run(&self, steps: usize, method: Method) -> Result<(Vec<Line>, Vec<Record>), Error> {
        let mut engine = Engine::default();
        if method == Method::Sparse {
            engine.world.set_direct(DirectSettings { dense_rows: 0, ..*engine.world.direct() });
        }
        let mut script = self.setup.clone();
        let mut records = engine.run(&script)?;
        for _ in 0..steps {
            let mut lines = self.each_step.clone();
            lines.extend(self.contacts(&engine));
            lines.push(Line::new("step", 0, &[f64::from(u8::from(method == Method::Quick)), self.h]));
            lines.push(Line::new("print", 0, &[]));
            records.extend(engine.run(&lines)?);
            script.extend(lines);
        }
        Ok((script, records))
    }
}

fn auto_disable(dice: &mut Dice) -> [f64; 6] {
    let flag = if dice.chance(0.8) { 1.0 } else { 0.0 };
    let steps = dice.below(6) as f64;
    let time = if dice.chance(0.5) { 0.0 } else { dice.range(0.0, 0.1) };
    [flag, dice.range(0.01, 1.5), dice.range(0.01, 2.5), steps, time, dice.below(5) as f64]
}
