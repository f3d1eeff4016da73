//! Reading recorded cases.
#![allow(dead_code)]

use ferrode_collide::*;
use ferrode_math::{Mat3, Vec3, rotation};
use serde_json::Value;

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

/// The shape and frame of a recorded geom; `None` for classes not built here.
pub fn geom(g: &Value) -> Option<(Shape, Frame)> {
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
        _ => return None,
    };
    let r: Vec<f64> = g["R"].as_array()?.iter().map(number).collect();
    let rotation = Mat3::from_rows([[r[0], r[1], r[2]], [r[3], r[4], r[5]], [r[6], r[7], r[8]]]);
    Some((shape, Frame::new(vector(&g["pos"]), rotation)))
}

/// The recorded contacts of a case.
pub fn contacts(case: &Value) -> Vec<GeomContact> {
    let read = |c: &Value| GeomContact::new(vector(&c["pos"]), vector(&c["normal"]), number(&c["depth"]));
    case["contacts"].as_array().map(|list| list.iter().map(read).collect()).unwrap_or_default()
}

/// A file of recorded cases: the one kept with the crate, or the full record if `FERRODE_SPEC` names its folder.
pub fn recorded(file: &str) -> Value {
    let path = match std::env::var("FERRODE_SPEC") {
        Ok(folder) => format!("{folder}/collision_golden.json"),
        Err(_) => format!("{}/tests/data/{file}", env!("CARGO_MANIFEST_DIR")),
    };
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}
