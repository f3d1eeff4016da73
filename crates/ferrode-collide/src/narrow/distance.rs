//! How far two shapes are apart.

use super::convex::touch;
use super::gjk::{Gap, gjk};
use super::support::Body;
use crate::{Frame, Plane, Shape};
use ferrode_math::{Pose, Vec3};

/// The nearest points of two shapes, or the deepest if they overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Metres between the shapes; if they overlap, minus the least depth.
    pub distance: f64,
    /// The point of the first shape, in the world.
    pub a: Vec3,
    /// The point of the second shape.
    pub b: Vec3,
    /// Unit vector from the second to the first: the way the first goes away soonest.
    pub normal: Vec3,
}

/// The distance of two shapes. `None` for pairs that have none: rays, and two planes.
pub fn distance(a: (&Shape, &Pose), b: (&Shape, &Pose)) -> Option<Distance> {
    let (fa, fb) = (Frame::from(a.1), Frame::from(b.1));
    match (a.0, b.0) {
        (Shape::Plane(_), Shape::Plane(_)) => None,
        (Shape::Plane(p), shape) => {
            let d = plane_distance(p, &Body::of(shape, &fb, Vec3::ZERO)?);
            Some(Distance { a: d.b, b: d.a, normal: -d.normal, ..d })
        }
        (shape, Shape::Plane(p)) => Some(plane_distance(p, &Body::of(shape, &fa, Vec3::ZERO)?)),
        (sa, sb) => {
            let origin = fa.position;
            let (ba, bb) = (Body::of(sa, &fa, origin)?, Body::of(sb, &fb, origin)?);
            Some(body_distance(&ba, &bb, origin))
        }
    }
}

fn plane_distance(plane: &Plane, body: &Body<'_>) -> Distance {
    let n = plane.normal();
    let a = body.support(-n) - n * body.margin;
    let depth = plane.depth(a);
    Distance { distance: -depth, a, b: a + n * depth, normal: n }
}

fn body_distance(a: &Body<'_>, b: &Body<'_>, origin: Vec3) -> Distance {
    if let Some(t) = touch(a, b) {
        return Distance { distance: -t.depth, a: t.a + origin, b: t.b + origin, normal: t.normal };
    }
    let (pa, pb, between) = match gjk(a, b, f64::INFINITY) {
        Gap::Apart { a, b, between } => (a, b, between),
        // Between touching and not, to the last bit.
        Gap::Overlap(simplex) => {
            let (a, b) = simplex.witnesses();
            (a, b, Vec3::ZERO)
        }
        Gap::Far => (a.center, b.center, a.center - b.center),
    };
    let normal = between.normalized().unwrap_or_else(|| (a.middle() - b.middle()).normalized_or(Vec3::X));
    Distance {
        distance: between.length() - a.margin - b.margin,
        a: pa - normal * a.margin + origin,
        b: pb + normal * b.margin + origin,
        normal,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cuboid, Cylinder, Sphere};

    #[test]
    fn known_distances() {
        let ball = Shape::from(Sphere::new(0.5).unwrap());
        let cube = Shape::from(Cuboid::new(Vec3::splat(2.0)).unwrap());
        let disc = Shape::from(Cylinder::new(1.0, 0.2).unwrap());
        let ground = Shape::from(Plane::new(Vec3::Z, 0.0).unwrap());
        let at = |x: f64, y: f64, z: f64| Pose::from_position(Vec3::new(x, y, z));
        let d = distance((&ball, &at(3.0, 0.0, 0.0)), (&cube, &at(0.0, 0.0, 0.0))).unwrap();
        assert!((d.distance - 1.5).abs() < 1e-12 && (d.a - Vec3::new(2.5, 0.0, 0.0)).length() < 1e-12);
        assert!((d.b - Vec3::X).length() < 1e-12 && (d.normal - Vec3::X).length() < 1e-12);
        let d = distance((&disc, &at(0.0, 0.0, 3.0)), (&ground, &Pose::IDENTITY)).unwrap();
        assert!((d.distance - 2.9).abs() < 1e-12 && d.normal == Vec3::Z);
        let d = distance((&disc, &at(3.0, 0.0, 0.0)), (&disc, &Pose::IDENTITY)).unwrap();
        assert!((d.distance - 1.0).abs() < 1e-9, "{d:?}");
        // Far from the origin nothing is lost but the rounding of the positions.
        let d = distance((&cube, &at(1e6 + 1.5, 0.0, 0.0)), (&cube, &at(1e6, 0.0, 0.0))).unwrap();
        assert!((d.distance + 0.5).abs() < 1e-12, "{d:?}");
        assert_eq!(distance((&ground, &Pose::IDENTITY), (&ground, &Pose::IDENTITY)), None);
    }
}
