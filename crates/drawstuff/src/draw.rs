//! `dsDraw…`, in single and double precision.

use crate::convex;
use crate::drawing::Round;
use crate::fault::{Outcome, export};
use crate::numbers::{Array, List, Real};
use crate::state;
use core::ffi::{c_int, c_uint};
use ferrode_math::{Mat3, Pose, Quat, Vec3};

fn vec3<T: Real>(numbers: [T; 3]) -> Vec3 {
    Vec3::from_array(numbers.map(Into::into))
}

/// A place: position, and the nine numbers of the rotation's twelve that count.
#[derive(Clone, Copy, Debug)]
struct Place<T> {
    at: [T; 3],
    turn: [T; 9],
}

impl<T: Real> Place<T> {
    fn read(at: Array<T, 3>, turn: Array<T, 12>) -> Outcome<Self> {
        let (at, m) = (at.read()?, turn.read()?);
        Ok(Self { at, turn: core::array::from_fn(|n| m[n / 3 * 4 + n % 3]) })
    }

    fn pose(&self) -> Pose {
        let m = self.turn.map(Into::into);
        let rows = [[m[0], m[1], m[2]], [m[3], m[4], m[5]], [m[6], m[7], m[8]]];
        let rotation = Quat::from_matrix(&Mat3::from_rows(rows)).normalized().unwrap_or(Quat::IDENTITY);
        Pose::new(vec3(self.at), rotation)
    }
}

fn cuboid<T: Real>(at: Array<T, 3>, turn: Array<T, 12>, sides: Array<T, 3>) -> Outcome<()> {
    let (place, sides) = (Place::read(at, turn)?, sides.read()?);
    state::draw(|frame| {
        frame.note("box", &[("at", &place.at), ("turn", &place.turn), ("sides", &sides)], true);
        frame.cuboid(&place.pose(), vec3(sides));
    })
}

fn sphere<T: Real>(at: Array<T, 3>, turn: Array<T, 12>, radius: f32) -> Outcome<()> {
    let place = Place::read(at, turn)?;
    state::draw(|frame| {
        frame.note("sphere", &[("at", &place.at), ("turn", &place.turn), ("radius", &[radius])], true);
        frame.round(&place.pose(), Round::Sphere(radius.into()));
    })
}

fn tall<T: Real>(at: Array<T, 3>, turn: Array<T, 12>, length: f32, radius: f32, caps: bool) -> Outcome<()> {
    let place = Place::read(at, turn)?;
    let (name, shape) = if caps {
        ("capsule", Round::Capsule(length.into(), radius.into()))
    } else {
        ("cylinder", Round::Cylinder(length.into(), radius.into()))
    };
    state::draw(|frame| {
        let [length, radius] = [[length], [radius]];
        let parts: [(&str, &dyn crate::note::Note); 4] =
            [("at", &place.at), ("turn", &place.turn), ("length", &length), ("radius", &radius)];
        frame.note(name, &parts, true);
        frame.round(&place.pose(), shape);
    })
}

fn triangles<T: Real>(
    at: Array<T, 3>,
    turn: Array<T, 12>,
    numbers: &[T],
    name: &str,
    solid: c_int,
) -> Outcome<()> {
    let place = Place::read(at, turn)?;
    let solid = solid != 0;
    let corner = |c: &[T]| vec3([c[0], c[1], c[2]]);
    let all: Vec<[Vec3; 3]> =
        numbers.chunks_exact(9).map(|t| [corner(&t[..3]), corner(&t[3..6]), corner(&t[6..])]).collect();
    state::draw(|frame| {
        let corners = numbers.to_vec();
        frame.note(name, &[("at", &place.at), ("turn", &place.turn), ("corners", &corners)], solid);
        frame.triangles(&place.pose(), &all, solid);
    })
}

fn one_triangle<T: Real>(
    at: Array<T, 3>,
    turn: Array<T, 12>,
    corners: [Array<T, 3>; 3],
    solid: c_int,
) -> Outcome<()> {
    let [a, b, c] = corners;
    triangles(at, turn, &[a.read()?, b.read()?, c.read()?].concat(), "triangle", solid)
}

fn many_triangles<T: Real>(
    at: Array<T, 3>,
    turn: Array<T, 12>,
    corners: List<T>,
    count: c_int,
    solid: c_int,
) -> Outcome<()> {
    let count = usize::try_from(count).unwrap_or(0);
    triangles(at, turn, &corners.read(count * 9)?, "triangles", solid)
}

fn line<T: Real>(from: Array<T, 3>, to: Array<T, 3>) -> Outcome<()> {
    let (from, to) = (from.read()?, to.read()?);
    state::draw(|frame| {
        frame.note("line", &[("from", &from), ("to", &to)], true);
        frame.line(vec3(from), vec3(to));
    })
}

/// The planes are not looked at: polygons say it all.
fn convex<T: Real>(
    at: Array<T, 3>,
    turn: Array<T, 12>,
    planes: c_uint,
    points: (List<T>, c_uint),
    polygons: List<c_uint>,
) -> Outcome<()> {
    let place = Place::read(at, turn)?;
    let numbers = points.0.read(points.1 as usize * 3)?;
    let polygons = convex::polygons(polygons, planes as usize, points.1 as usize)?;
    let points: Vec<Vec3> = numbers.chunks_exact(3).map(|p| vec3([p[0], p[1], p[2]])).collect();
    state::draw(|frame| {
        frame.note("convex", &[("at", &place.at), ("turn", &place.turn), ("points", &numbers)], true);
        frame.triangles(&place.pose(), &convex::triangles(&polygons, &points), true);
    })
}

/// Declares each function for one type of numbers.
macro_rules! draws {
    ($real:ty: $cuboid:ident, $sphere:ident, $cylinder:ident, $capsule:ident, $triangle:ident, $triangles:ident, $line:ident,
     $convex:ident) => {
        export! {
            fn $cuboid(pos: Array<$real, 3>, R: Array<$real, 12>, sides: Array<$real, 3>) { cuboid(pos, R, sides) }
            fn $sphere(pos: Array<$real, 3>, R: Array<$real, 12>, radius: f32) { sphere(pos, R, radius) }
            fn $cylinder(pos: Array<$real, 3>, R: Array<$real, 12>, length: f32, radius: f32) {
                tall(pos, R, length, radius, false)
            }
            fn $capsule(pos: Array<$real, 3>, R: Array<$real, 12>, length: f32, radius: f32) {
                tall(pos, R, length, radius, true)
            }
            fn $triangle(
                pos: Array<$real, 3>,
                R: Array<$real, 12>,
                v0: Array<$real, 3>,
                v1: Array<$real, 3>,
                v2: Array<$real, 3>,
                solid: c_int,
            ) {
                one_triangle(pos, R, [v0, v1, v2], solid)
            }
            fn $triangles(pos: Array<$real, 3>, R: Array<$real, 12>, v: List<$real>, n: c_int, solid: c_int) {
                many_triangles(pos, R, v, n, solid)
            }
            fn $line(from: Array<$real, 3>, to: Array<$real, 3>) { line(from, to) }
            fn $convex(
                pos: Array<$real, 3>,
                R: Array<$real, 12>,
                _planes: List<$real>,
                plane_count: c_uint,
                points: List<$real>,
                point_count: c_uint,
                polygons: List<c_uint>,
            ) {
                convex(pos, R, plane_count, (points, point_count), polygons)
            }
        }
    };
}

draws! { f32: dsDrawBox, dsDrawSphere, dsDrawCylinder, dsDrawCapsule, dsDrawTriangle, dsDrawTriangles, dsDrawLine, dsDrawConvex }
draws! { f64: dsDrawBoxD, dsDrawSphereD, dsDrawCylinderD, dsDrawCapsuleD, dsDrawTriangleD, dsDrawTrianglesD, dsDrawLineD,
dsDrawConvexD }
