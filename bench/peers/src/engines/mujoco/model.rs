//! A scene in MuJoCo's language, as text.

use crate::scene::{Form, Link, STEP, Scene, Solid};
use core::fmt::Write;
use ferrode_math::{Pose, Vec3};
use std::collections::VecDeque;

/// Part of a model: MuJoCo's reader takes elements only some hundreds deep, so longer chains are cut and put together again.
pub struct Piece {
    /// A model by itself.
    pub xml: String,
    /// The solid whose body is to be attached to its frame in the first piece; none for that one.
    pub root: Option<usize>,
}

/// Bodies one inside the other in a piece.
const DEPTH: usize = 100;

/// The body of a solid.
pub fn body_name(i: usize) -> String {
    format!("s{i}")
}

/// Where a solid's body belongs, if it begins a piece.
pub fn frame_name(i: usize) -> String {
    format!("f{i}")
}

/// Why a scene is not run.
pub fn refuses(scene: &Scene) -> Option<String> {
    let tree = Tree::new(scene);
    let plain = |i: &usize| {
        matches!(scene.joints[*i].link, Link::Ball | Link::Hinge { stops: None, brake: None, .. })
    };
    if !tree.loops.iter().all(plain) {
        return Some("hinges with stops or brakes close loops".into());
    }
    let grids = |solid: &Solid| match &solid.form {
        Form::Mesh(vertices, triangles) => Grid::new(vertices, triangles).is_some(),
        _ => true,
    };
    if !scene.solids.iter().all(grids) {
        return Some("a mesh is not over a grid".into());
    }
    if tree.depth() > 500 {
        return Some("a tree so deep takes it seconds a step".into());
    }
    // In a heap, which begins at rest, all contacts are one system.
    let heap = scene.solids.iter().filter(|s| s.density.is_some() && s.velocity == Vec3::ZERO).count();
    (heap > 2500 && !scene.sleeping).then(|| "a heap so large takes it seconds a step".into())
}

/// The joints as trees.
struct Tree {
    /// Of each solid, those that hang on it and by which joint.
    children: Vec<Vec<(usize, usize)>>,
    /// What hangs on the world, by a joint or freely.
    roots: Vec<(usize, Option<usize>)>,
    /// Joints that are left.
    loops: Vec<usize>,
}

impl Tree {
    fn new(scene: &Scene) -> Self {
        let count = scene.solids.len();
        let moves = |i: usize| scene.solids[i].density.is_some();
        let mut tree = Self { children: vec![Vec::new(); count], roots: Vec::new(), loops: Vec::new() };
        let mut joints = vec![Vec::new(); count];
        let mut held = Vec::new();
        for (k, joint) in scene.joints.iter().enumerate() {
            match joint.b.filter(|b| moves(*b)) {
                Some(b) if moves(joint.a) => {
                    joints[joint.a].push((b, k));
                    joints[b].push((joint.a, k));
                }
                Some(b) => held.push((b, Some(k))),
                None => held.push((joint.a, Some(k))),
            }
        }
        let (mut seen, mut used) = (vec![false; count], vec![false; scene.joints.len()]);
        for (root, joint) in held.into_iter().chain((0..count).map(|i| (i, None))) {
            if !moves(root) || seen[root] {
                continue;
            }
            seen[root] = true;
            tree.roots.push((root, joint));
            if let Some(k) = joint {
                used[k] = true;
            }
            let mut queue = VecDeque::from([root]);
            while let Some(i) = queue.pop_front() {
                for &(child, k) in &joints[i] {
                    if !seen[child] {
                        (seen[child], used[k]) = (true, true);
                        tree.children[i].push((child, k));
                        queue.push_back(child);
                    }
                }
            }
        }
        let free = |k: &usize| {
            let joint = &scene.joints[*k];
            !used[*k] && (moves(joint.a) || joint.b.is_some_and(moves))
        };
        tree.loops = (0..scene.joints.len()).filter(free).collect();
        tree
    }

    /// The longest way from a root, in joints.
    fn depth(&self) -> usize {
        let mut level: Vec<usize> = self.roots.iter().map(|root| root.0).collect();
        let mut depth = 0;
        while !level.is_empty() {
            level = level.iter().flat_map(|i| &self.children[*i]).map(|child| child.0).collect();
            depth += 1;
        }
        depth
    }
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(|x| x.to_string()).collect::<Vec<_>>().join(" ")
}

fn vector(v: Vec3) -> String {
    numbers(v.to_array())
}

fn place(pose: &Pose) -> String {
    let q = pose.rotation;
    format!("pos=\"{}\" quat=\"{}\"", vector(pose.position), numbers([q.w, q.x, q.y, q.z]))
}

/// A mesh as heights over a grid.
struct Grid {
    rows: usize,
    columns: usize,
    centre: Vec3,
    half: Vec3,
    /// By rows along x, that of the largest y first.
    heights: Vec<f64>,
}

impl Grid {
    /// None if it is no such mesh.
    fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let (first, last) = (*vertices.first()?, *vertices.last()?);
        let columns = vertices.iter().take_while(|v| v.y == first.y).count();
        let rows = vertices.len() / columns;
        let (across, along) = (columns.checked_sub(1)?, rows.checked_sub(1)?);
        let step = Vec3::new((last.x - first.x) / across as f64, (last.y - first.y) / along as f64, 0.0);
        let regular = vertices.iter().enumerate().all(|(k, v)| {
            let at = first + Vec3::new(step.x * (k % columns) as f64, step.y * (k / columns) as f64, 0.0);
            (at.x - v.x).abs() < 1e-9 && (at.y - v.y).abs() < 1e-9
        });
        if !regular || step.x <= 0.0 || step.y <= 0.0 || triangles.len() != 2 * across * along {
            return None;
        }
        let low = vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
        let high = vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
        // Elevations are scaled to their range, which must not be nothing.
        let half = Vec3::new(last.x - first.x, last.y - first.y, (high - low).max(1e-6)) * 0.5;
        Some(Self {
            rows,
            columns,
            centre: Vec3::new(first.x + half.x, first.y + half.y, low + half.z),
            half,
            heights: vertices.chunks(columns).rev().flatten().map(|v| v.z).collect(),
        })
    }
}

struct Writer<'a> {
    scene: &'a Scene,
    tree: Tree,
    pieces: Vec<Piece>,
    assets: String,
}

impl Writer<'_> {
    fn open(&mut self, root: Option<usize>) -> usize {
        let mut xml = String::from("<mujoco><compiler angle=\"radian\"/>");
        if root.is_none() {
            let sleep = if self.scene.sleeping { "enable" } else { "disable" };
            let gravity = vector(Vec3::Z * -self.scene.gravity);
            // The memory is room for contacts: the compiler's own guess is more than there is for thousands of bodies.
            // Writing to a string can't fail, here and below.
            let _ = write!(
                xml,
                "<option timestep=\"{STEP}\" gravity=\"{gravity}\" integrator=\"implicitfast\"><flag sleep=\"{sleep}\"/></option><size memory=\"4G\"/>"
            );
        }
        xml += "<worldbody>";
        self.pieces.push(Piece { xml, root });
        self.pieces.len() - 1
    }

    /// What is inside a body: its shape.
    fn geom(&mut self, piece: usize, i: usize) {
        let (scene, xml) = (self.scene, &mut self.pieces[piece].xml);
        let solid = &scene.solids[i];
        let (kind, sizes) = match &solid.form {
            Form::Cuboid(sides) => ("box", vector(*sides * 0.5)),
            Form::Sphere(radius) => ("sphere", numbers([*radius])),
            Form::Capsule(radius, length) => ("capsule", numbers([*radius, 0.5 * length])),
            Form::Cylinder(radius, length) => ("cylinder", numbers([*radius, 0.5 * length])),
            Form::Mesh(vertices, triangles) => {
                // A mesh would be taken for its convex hull, and boxes fall through a rigid flex.
                let grid = Grid::new(vertices, triangles).expect("a mesh over a grid");
                let _ = write!(
                    self.assets,
                    "<hfield name=\"h{i}\" nrow=\"{}\" ncol=\"{}\" size=\"{} {} {} 1\" elevation=\"{}\"/>",
                    grid.rows,
                    grid.columns,
                    grid.half.x,
                    grid.half.y,
                    grid.half.z * 2.0,
                    numbers(grid.heights)
                );
                let at = vector(grid.centre - Vec3::Z * grid.half.z);
                ("hfield", format!("0\" hfield=\"h{i}\" pos=\"{at}"))
            }
        };
        let (is, meets) = if solid.ghost { (2, 0) } else { (1, 3) };
        let _ = write!(
            xml,
            "<geom type=\"{kind}\" size=\"{sizes}\" density=\"{}\" friction=\"{} 0.005 0.0001\" contype=\"{is}\" conaffinity=\"{meets}\"/>",
            solid.density.unwrap_or(1000.0),
            scene.friction
        );
    }

    fn body(&mut self, piece: usize, i: usize, parent: Option<usize>, joint: Option<usize>, depth: usize) {
        let scene = self.scene;
        let pose = scene.solids[i].pose;
        let local = parent.map_or(pose, |p| {
            let p = &scene.solids[p].pose;
            Pose::new(p.inverse_transform_point(pose.position), p.rotation.conjugate() * pose.rotation)
        });
        let piece = if depth > 0 && depth.is_multiple_of(DEPTH) {
            let _ = write!(self.pieces[piece].xml, "<frame name=\"{}\"/>", frame_name(i));
            self.open(Some(i))
        } else {
            piece
        };
        let opened = depth > 0 && depth.is_multiple_of(DEPTH);
        let _ = write!(self.pieces[piece].xml, "<body name=\"{}\" {}>", body_name(i), place(&local));
        self.joint(piece, i, joint);
        self.geom(piece, i);
        for (child, k) in core::mem::take(&mut self.tree.children[i]) {
            self.body(piece, child, Some(i), Some(k), depth + 1);
        }
        self.pieces[piece].xml += "</body>";
        if opened {
            self.pieces[piece].xml += "</worldbody></mujoco>";
        }
    }

    /// The joint by which a body hangs, in its own frame.
    fn joint(&mut self, piece: usize, i: usize, joint: Option<usize>) {
        let (scene, xml) = (self.scene, &mut self.pieces[piece].xml);
        let Some(k) = joint else {
            *xml += "<freejoint/>";
            return;
        };
        let (joint, pose) = (&scene.joints[k], &scene.solids[i].pose);
        let at = vector(pose.inverse_transform_point(joint.anchor));
        match joint.link {
            Link::Ball => {
                let _ = write!(xml, "<joint type=\"ball\" pos=\"{at}\"/>");
            }
            Link::Hinge { axis, stops, brake } => {
                // The angle is that of the inner body against the outer one; the scene's is that of the joint's first.
                let axis = if joint.a == i { axis } else { -axis };
                let axis = vector(pose.inverse_transform_vector(axis));
                let _ = write!(xml, "<joint type=\"hinge\" pos=\"{at}\" axis=\"{axis}\"");
                if let Some((low, high)) = stops {
                    let _ = write!(xml, " limited=\"true\" range=\"{low} {high}\"");
                }
                let _ = write!(xml, " frictionloss=\"{}\"/>", brake.unwrap_or(0.0));
            }
        }
    }

    /// Joints that close loops, and pairs that must not meet.
    fn rest(&mut self) {
        let scene = self.scene;
        let mut loops = String::new();
        for &k in &self.tree.loops {
            let joint = &scene.joints[k];
            let bodies = match joint.b {
                Some(b) => format!("body1=\"{}\" body2=\"{}\"", body_name(joint.a), body_name(b)),
                None => format!("body1=\"{}\"", body_name(joint.a)),
            };
            // A hinge holds two points of its axis.
            let points = match joint.link {
                Link::Ball => vec![joint.anchor],
                Link::Hinge { axis, .. } => vec![joint.anchor - axis * 0.5, joint.anchor + axis * 0.5],
            };
            for point in points {
                let at = vector(scene.solids[joint.a].pose.inverse_transform_point(point));
                let _ = write!(loops, "<connect {bodies} anchor=\"{at}\"/>");
            }
        }
        let mut pairs: Vec<(usize, usize)> =
            scene.joints.iter().filter_map(|j| Some((j.a.min(j.b?), j.a.max(j.b?)))).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let xml = &mut self.pieces[0].xml;
        let _ = write!(xml, "<equality>{loops}</equality><contact>");
        for (a, b) in pairs {
            let _ = write!(xml, "<exclude body1=\"{}\" body2=\"{}\"/>", body_name(a), body_name(b));
        }
        let _ = write!(xml, "</contact><asset>{}</asset></mujoco>", self.assets);
    }
}

/// The scene's model in pieces, the whole of it first.
pub fn pieces(scene: &Scene) -> Vec<Piece> {
    let tree = Tree::new(scene);
    let roots = tree.roots.clone();
    let mut writer = Writer { scene, tree, pieces: Vec::new(), assets: String::new() };
    writer.open(None);
    for (i, solid) in scene.solids.iter().enumerate() {
        if solid.density.is_none() {
            let _ = write!(writer.pieces[0].xml, "<body name=\"{}\" {}>", body_name(i), place(&solid.pose));
            writer.geom(0, i);
            writer.pieces[0].xml += "</body>";
        }
    }
    for (root, joint) in roots {
        writer.body(0, root, None, joint, 0);
    }
    writer.pieces[0].xml += "</worldbody>";
    writer.rest();
    writer.pieces
}
