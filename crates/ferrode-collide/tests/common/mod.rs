//! Reading recorded cases.
#![allow(dead_code)]

pub mod classes;
pub mod judge;

use ferrode_collide::*;
use ferrode_math::{Mat3, Vec3, rotation};
use serde_json::Value;

/// The seed of random tests: `PROPTEST_RNG_SEED`, else always the same.
pub fn seed_number() -> u64 {
    std::env::var("PROPTEST_RNG_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(1)
}

/// As [`seed_number`], for property tests.
pub fn seed() -> proptest::test_runner::RngSeed {
    proptest::test_runner::RngSeed::Fixed(seed_number())
}

/// A recorded number; "inf", "-inf" and "nan" are strings.
pub fn number(v: &Value) -> f64 {
    match v.as_str() {
        Some("inf") => f64::INFINITY,
        Some("-inf") => f64::NEG_INFINITY,
        Some(_) => f64::NAN,
        None => v.as_f64().expect("a number"),
    }
}

pub fn vector(v: &Value) -> Vec3 {
    Vec3::new(number(&v[0]), number(&v[1]), number(&v[2]))
}

/// Recorded cases and the hulls they name.
pub struct Record {
    files: Vec<Value>,
}

impl Record {
    /// The lean files kept with the crate, or the full record if `FERRODE_SPEC` names its folder.
    pub fn open(files: &[&str]) -> Self {
        let read = |path: String| {
            let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
            serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
        };
        let files = match std::env::var("FERRODE_SPEC") {
            Ok(folder) => vec![read(format!("{folder}/collision_golden.json"))],
            Err(_) => {
                let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data");
                files.iter().map(|file| read(format!("{folder}/{file}"))).collect()
            }
        };
        Self { files }
    }

    /// The items of the list `name` in all files.
    pub fn list(&self, name: &str) -> impl Iterator<Item = &Value> {
        self.files.iter().filter_map(move |f| f[name].as_array()).flatten()
    }

    fn field(&self, name: &str) -> Heightfield {
        let field = self.list("fields").find(|h| h["name"] == name).unwrap_or_else(|| panic!("{name}"));
        let n = |key: &str| number(&field[key]);
        let heights: Vec<_> = field["samples"]
            .as_array()
            .unwrap()
            .iter()
            .map(|h| number(h) * n("scale") + n("offset"))
            .collect();
        let (columns, rows) = (n("width_samples") as usize, n("depth_samples") as usize);
        let made = Heightfield::new(n("width"), n("depth"), columns, rows, heights, n("thickness")).unwrap();
        let made = match field["bounds_set"].as_array() {
            Some(b) => made.with_bounds(
                number(&b[0]) * n("scale") + n("offset"),
                number(&b[1]) * n("scale") + n("offset"),
            ),
            None => made,
        };
        if n("wrap") == 1.0 { made.wrapped() } else { made }
    }

    fn mesh(&self, name: &str) -> TriMesh {
        let mesh = self.list("meshes").find(|h| h["name"] == name).unwrap_or_else(|| panic!("{name}"));
        let vertices = mesh["vertices"].as_array().unwrap().iter().map(vector).collect();
        let number = |n: &Value| n.as_u64().unwrap() as u32;
        let triangle = |t: &Value| [number(&t[0]), number(&t[1]), number(&t[2])];
        let triangles = mesh["triangles"].as_array().unwrap().iter().map(triangle).collect();
        TriMesh::new(vertices, triangles).unwrap().with_use_flags(use_flags(name)).unwrap()
    }

    fn hull(&self, name: &str) -> Convex {
        let hull = self.list("hulls").find(|h| h["name"] == name).unwrap_or_else(|| panic!("{name}"));
        let points: Vec<_> = hull["points"].as_array().unwrap().iter().map(vector).collect();
        let numbers: Vec<u32> =
            hull["polygons"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap() as u32).collect();
        let (mut faces, mut i) = (Vec::new(), 0);
        while i < numbers.len() {
            let n = numbers[i] as usize;
            faces.push(&numbers[i + 1..=i + n]);
            i += n + 1;
        }
        Convex::from_faces(&points, &faces).unwrap()
    }

    /// The shape and frame of a recorded geom; `None` for classes not built here.
    pub fn geom(&self, g: &Value) -> Option<(Shape, Frame)> {
        let n = |key: &str| number(&g[key]);
        let shape: Shape = match g["class"].as_str()? {
            "sphere" => Sphere::new(n("radius")).unwrap().into(),
            "box" => Cuboid::new(vector(&g["lengths"])).unwrap().into(),
            "capsule" => Capsule::new(n("radius"), n("length")).unwrap().into(),
            "cylinder" => Cylinder::new(n("radius"), n("length")).unwrap().into(),
            "plane" => {
                let p = &g["params"];
                return Some((Plane::new(vector(p), number(&p[3])).unwrap().into(), Frame::IDENTITY));
            }
            "ray" => {
                let mut ray = Ray::new(n("length")).unwrap();
                let flag = |key: &str| g.get(key).is_some_and(|v| number(v) != 0.0);
                ray.first_contact = flag("first_contact");
                ray.backface_cull = flag("backface_cull");
                ray.closest_hit = flag("closest_hit");
                let direction = vector(&g["dir"]);
                let (x, y) = {
                    let m = rotation::from_z_axis(direction).unwrap();
                    (m.column(0), m.column(1))
                };
                let frame = Frame::new(vector(&g["start"]), Mat3::from_columns(x, y, direction));
                return Some((ray.into(), frame));
            }
            "convex" => self.hull(g["hull"].as_str()?).into(),
            "heightfield" => self.field(g["field"].as_str()?).into(),
            "trimesh" => self.mesh(g["mesh"].as_str()?).into(),
            _ => return None,
        };
        let Some(r) = g["R"].as_array() else { return Some((shape, Frame::IDENTITY)) };
        let r: Vec<f64> = r.iter().map(number).collect();
        let rotation = Mat3::from_rows([[r[0], r[1], r[2]], [r[3], r[4], r[5]], [r[6], r[7], r[8]]]);
        Some((shape, Frame::new(vector(&g["pos"]), rotation)))
    }
}

/// The edges and vertices that libode lets each triangle of a recorded mesh touch (`dGeomTriMeshDataGet2` after both
/// preprocessings). Which of the two triangles at an edge has it is by libode's sorting, and without meaning.
fn use_flags(mesh: &str) -> Vec<u8> {
    let all: Value = serde_json::from_str(include_str!("../data/use_flags.json")).unwrap();
    all[mesh].as_array().unwrap().iter().map(|f| f.as_u64().unwrap() as u8).collect()
}

/// The recorded contacts of a case.
pub fn contacts(case: &Value) -> Vec<GeomContact> {
    let read = |c: &Value| GeomContact::new(vector(&c["pos"]), vector(&c["normal"]), number(&c["depth"]));
    case["contacts"].as_array().map(|list| list.iter().map(read).collect()).unwrap_or_default()
}
