//! Convex bodies by their support functions, for the algorithms that need no more.

use crate::{Capsule, Convex, Cuboid, CustomShape, Cylinder, Ellipsoid, Frame, Shape, Sphere};
use ferrode_math::{Mat3, Vec3};

/// The part of a convex body that is left when a margin of constant width is taken off, in its own coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Core<'a> {
    /// The origin.
    Point,
    /// ±half on the z axis.
    Segment(f64),
    /// Half sides.
    Cuboid(Vec3),
    /// Radius and half length.
    Cylinder(f64, f64),
    Ellipsoid(Ellipsoid),
    /// Radius of the base at −half on the z axis, and half length.
    Cone(f64, f64),
    Hull(&'a Convex),
    /// One's own, convex.
    Custom(&'a dyn CustomShape),
    /// Corners relative to the body's centre, in the pair's coordinates.
    Triangle([Vec3; 3]),
}

/// A convex body: all points within `margin` of a core at a place. Rounded shapes have exact contacts that way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body<'a> {
    pub core: Core<'a>,
    pub rotation: Mat3,
    /// Relative to the pair's origin, so that a pair far from the world's loses nothing.
    pub center: Vec3,
    pub margin: f64,
    reach: f64,
}

impl<'a> Body<'a> {
    /// The body of a convex shape of finite size; of one's own if it has a support function.
    pub fn of(shape: &'a Shape, frame: &Frame, origin: Vec3) -> Option<Self> {
        Some(match shape {
            Shape::Sphere(s) => Self::sphere(s, frame, origin),
            Shape::Cuboid(s) => Self::cuboid(s, frame, origin),
            Shape::Capsule(s) => Self::capsule(s, frame, origin),
            Shape::Cylinder(s) => Self::cylinder(s, frame, origin),
            Shape::Ellipsoid(s) => Self::new(Core::Ellipsoid(*s), 0.0, s.reach(), frame, origin),
            Shape::Cone(s) => {
                Self::new(Core::Cone(s.radius(), 0.5 * s.length()), 0.0, s.reach(), frame, origin)
            }
            Shape::Convex(s) => Self::new(Core::Hull(s), 0.0, s.reach(), frame, origin),
            Shape::Custom(s) => {
                let (own, mut most) = (s.get(), Vec3::ZERO);
                for (i, d) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
                    most[i] = own.support(d)?[i].abs().max(own.support(-d)?[i].abs());
                }
                if !most.is_finite() {
                    return None;
                }
                Self::new(Core::Custom(own), 0.0, most.length(), frame, origin)
            }
            Shape::Plane(_)
            | Shape::Ray(_)
            | Shape::TriMesh(_)
            | Shape::Heightfield(_)
            | Shape::Compound(_) => return None,
        })
    }

    pub fn sphere(s: &Sphere, frame: &Frame, origin: Vec3) -> Self {
        Self::new(Core::Point, s.radius(), s.reach(), frame, origin)
    }

    pub fn cuboid(s: &Cuboid, frame: &Frame, origin: Vec3) -> Self {
        Self::new(Core::Cuboid(s.half_sides()), 0.0, s.reach(), frame, origin)
    }

    pub fn capsule(s: &Capsule, frame: &Frame, origin: Vec3) -> Self {
        Self::new(Core::Segment(0.5 * s.length()), s.radius(), s.reach(), frame, origin)
    }

    pub fn cylinder(s: &Cylinder, frame: &Frame, origin: Vec3) -> Self {
        Self::new(Core::Cylinder(s.radius(), 0.5 * s.length()), 0.0, s.reach(), frame, origin)
    }

    /// A triangle with the given corners in the pair's coordinates.
    pub fn triangle(corners: [Vec3; 3]) -> Self {
        let center = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
        let corners = corners.map(|p| p - center);
        let reach = corners.iter().map(|p| p.length_squared()).fold(0.0, f64::max).sqrt();
        Self { core: Core::Triangle(corners), rotation: Mat3::IDENTITY, center, margin: 0.0, reach }
    }

    fn new(core: Core<'a>, margin: f64, reach: f64, frame: &Frame, origin: Vec3) -> Self {
        Self { core, rotation: frame.rotation, center: frame.position - origin, margin, reach }
    }

    /// The point of the core furthest along `d`, which need not be a unit vector.
    #[inline]
    pub fn support(&self, d: Vec3) -> Vec3 {
        let l = self.rotation.transpose_mul(d);
        let sign = |x: f64, s: f64| if x < 0.0 { -s } else { s };
        let p = match self.core {
            Core::Point => return self.center,
            Core::Segment(half) => Vec3::new(0.0, 0.0, sign(l.z, half)),
            Core::Cuboid(h) => Vec3::new(sign(l.x, h.x), sign(l.y, h.y), sign(l.z, h.z)),
            Core::Cylinder(radius, half) => {
                let flat = (l.x * l.x + l.y * l.y).sqrt();
                let scale = if flat > 0.0 { radius / flat } else { 0.0 };
                Vec3::new(l.x * scale, l.y * scale, sign(l.z, half))
            }
            Core::Ellipsoid(e) => e.support(l),
            Core::Cone(radius, half) => {
                let flat = (l.x * l.x + l.y * l.y).sqrt();
                if l.z * 2.0 * half >= radius * flat {
                    Vec3::new(0.0, 0.0, half)
                } else {
                    let scale = if flat > 0.0 { radius / flat } else { 0.0 };
                    Vec3::new(l.x * scale, l.y * scale, -half)
                }
            }
            Core::Hull(hull) => hull.support(l),
            // Where it has no answer it is taken to be its origin.
            Core::Custom(own) => own.support(l).unwrap_or(Vec3::ZERO),
            Core::Triangle(corners) => {
                let [a, b, c] = corners.map(|p| p.dot(d));
                let i = if a >= b && a >= c {
                    0
                } else if b >= c {
                    1
                } else {
                    2
                };
                return self.center + corners[i];
            }
        };
        self.center + self.rotation * p
    }

    /// A length that no part of the body is further than from its centre.
    #[inline]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Whether its core is curved.
    pub fn is_round(&self) -> bool {
        matches!(self.core, Core::Cylinder(..) | Core::Cone(..) | Core::Ellipsoid(_) | Core::Custom(_))
    }

    /// A point within the body.
    pub fn middle(&self) -> Vec3 {
        match self.core {
            Core::Hull(hull) => self.place(hull.middle()),
            Core::Custom(_) => (self.support(Vec3::X) + self.support(-Vec3::X)) * 0.5,
            _ => self.center,
        }
    }

    /// World axis `i` of the body.
    pub fn axis(&self, i: usize) -> Vec3 {
        self.rotation.column(i)
    }

    /// A point from the body's own coordinates.
    pub fn place(&self, p: Vec3) -> Vec3 {
        self.center + self.rotation * p
    }
}

/// A point of the difference of two bodies, and the points of either that it comes from.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vertex {
    pub w: Vec3,
    pub a: Vec3,
    pub b: Vec3,
}

/// The point of a − b furthest along `d`.
#[inline]
pub(crate) fn difference(a: &Body<'_>, b: &Body<'_>, d: Vec3) -> Vertex {
    let (a, b) = (a.support(d), b.support(-d));
    Vertex { w: a - b, a, b }
}
