//! The parts of a core's surface, and what each says about the direction that it faces.

use super::super::support::{Body, Core};
use ferrode_math::Vec3;

/// A part of the surface of a core, in the pair's coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) enum Part {
    /// A corner, or the tip of a cone: faces many directions.
    Corner(Vec3),
    /// A circle about the outward axis of its disc.
    Rim { center: Vec3, axis: Vec3, radius: f64 },
    /// The whole of an ellipsoid.
    Ellipsoid,
    /// From one end to the other: what faces along it does so across it. The side of a cylinder is its axis with a margin.
    Line { from: Vec3, to: Vec3, margin: f64 },
    /// The side of a cone: what faces along it makes an angle with the axis, whose sine is given.
    Slope { tip: Vec3, axis: Vec3, sine: f64 },
    /// Faces one way. Three corners of a flat face.
    Triangle { corners: [Vec3; 3], normal: Vec3 },
    /// The flat end of a cylinder or cone.
    Disc { center: Vec3, axis: Vec3, radius: f64 },
}

/// What a part asks of the unit vector that it faces.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    Free,
    /// The product with a unit vector has a value.
    Circle(Vec3, f64),
    Fixed(Vec3),
}

/// Where a point of a flat part's plane lies.
pub(super) enum Beside {
    /// On the part, this far from its edge, or less than that.
    Within(f64),
    /// Beside it, where this part is the next.
    On(Part),
}

/// Part of a line or face by which a point beside it still counts as on it: rounding, no more.
const SHARE: f64 = 1e-9;
/// Cosine of direction and axis from which a disc may be what is sought.
pub(super) const ON_DISC: f64 = 0.98;
/// Cosine of direction and axis from which they are one: then a rim has no point that looks that way.
pub(super) const ON_AXIS: f64 = 1.0 - 1e-14;

impl Part {
    /// The part that has the given support points, and about which the unit vector `d` looks outward; where that may be a
    /// disc or its rim, the disc if `discs` says so. `None` for a shape of one's own.
    pub fn through(body: &Body<'_>, points: &[Vec3], d: Vec3, discs: bool) -> Option<Self> {
        let u = body.axis(2);
        let up = |p: &&Vec3| u.dot(**p - body.center) > 0.0;
        let flat = |center: Vec3, axis: Vec3, radius: f64| {
            let along = axis.dot(d);
            if points.len() > 1 && along > if discs { ON_DISC } else { ON_AXIS } {
                Self::Disc { center, axis, radius }
            } else {
                Self::Rim { center, axis, radius }
            }
        };
        let above = points.iter().filter(up).count();
        Some(match body.core {
            Core::Custom(_) => return None,
            Core::Ellipsoid(_) => Self::Ellipsoid,
            Core::Point => Self::Corner(body.center),
            Core::Cylinder(radius, half) => {
                if above > 0 && above < points.len() {
                    Self::Line { from: body.center - u * half, to: body.center + u * half, margin: radius }
                } else {
                    let axis = if above > 0 { u } else { -u };
                    flat(body.center + axis * half, axis, radius)
                }
            }
            Core::Cone(radius, half) => {
                let tip = body.center + u * half;
                if above == points.len() {
                    Self::Corner(tip)
                } else if above > 0 {
                    Self::Slope { tip, axis: u, sine: slope_sine(radius, half) }
                } else {
                    flat(body.center - u * half, -u, radius)
                }
            }
            _ => {
                let p = *points.first()?;
                let Some(q) = points.iter().copied().find(|x| *x != p) else { return Some(Self::Corner(p)) };
                let line = Self::Line { from: p, to: q, margin: 0.0 };
                let Some(r) = points.iter().copied().find(|x| *x != p && *x != q) else { return Some(line) };
                match (q - p).cross(r - p).normalized() {
                    Some(n) => {
                        let normal = if n.dot(d) < 0.0 { -n } else { n };
                        Self::Triangle { corners: [p, q, r], normal }
                    }
                    None => line,
                }
            }
        })
    }

    /// For lines and slopes, the least and greatest share of the ruling that is on the part.
    pub fn shares(&self) -> (f64, f64) {
        if matches!(self, Self::Slope { .. }) { (0.0, 1.0) } else { (-0.5, 0.5) }
    }

    pub fn bound(&self) -> Bound {
        match *self {
            Self::Corner(_) | Self::Rim { .. } | Self::Ellipsoid => Bound::Free,
            Self::Line { from, to, .. } => match super::super::unit::unit(to - from) {
                Some(e) => Bound::Circle(e, 0.0),
                None => Bound::Free,
            },
            Self::Slope { axis, sine, .. } => Bound::Circle(axis, sine),
            Self::Triangle { normal, .. } => Bound::Fixed(normal),
            Self::Disc { axis, .. } => Bound::Fixed(axis),
        }
    }

    /// A point of the part that faces the unit vector `d`, and for those that turn with it how the point moves when `d`
    /// moves along either of the tangents: three numbers of a symmetric matrix, ss, st and tt.
    #[inline]
    pub fn point(&self, body: &Body<'_>, d: Vec3, s: Vec3, t: Vec3) -> (Vec3, [f64; 3]) {
        match *self {
            Self::Corner(p) => (p, [0.0; 3]),
            Self::Rim { center, axis, radius } => {
                let across = d - axis * axis.dot(d);
                let length = across.length();
                if !(length > 0.0) {
                    return (center, [0.0; 3]);
                }
                let tangent = axis.cross(across) * (1.0 / length);
                let (k, cs, ct) = (radius / length, tangent.dot(s), tangent.dot(t));
                (center + across * k, [k * cs * cs, k * cs * ct, k * ct * ct])
            }
            Self::Ellipsoid => {
                let Core::Ellipsoid(e) = body.core else { return (body.center, [0.0; 3]) };
                let r = e.radii();
                let squares = r.component_mul(r);
                let local = |v: Vec3| body.rotation.transpose_mul(v);
                let (ld, ls, lt) = (local(d), local(s), local(t));
                let length = r.component_mul(ld).length();
                if !(length > 0.0) {
                    return (body.center, [0.0; 3]);
                }
                let p = squares.component_mul(ld) * (1.0 / length);
                let by = |v: Vec3, w: Vec3| (squares.component_mul(v).dot(w) - p.dot(v) * p.dot(w)) / length;
                (body.place(p), [by(ls, ls), by(ls, lt), by(lt, lt)])
            }
            Self::Line { from, to, margin } => ((from + to) * 0.5 + d * margin, [0.0; 3]),
            Self::Slope { tip, .. } => (tip, [0.0; 3]),
            Self::Triangle { corners, .. } => (corners[0], [0.0; 3]),
            Self::Disc { center, .. } => (center, [0.0; 3]),
        }
    }

    /// For parts that are ruled: the straight line on which they face `d`, from the point that [`Self::point`] gives.
    pub fn ruling(&self, body: &Body<'_>, d: Vec3) -> Option<Vec3> {
        match *self {
            Self::Line { from, to, .. } => Some(to - from),
            Self::Slope { tip, axis, .. } => {
                let Core::Cone(radius, half) = body.core else { return None };
                let across = (d - axis * axis.dot(d)).normalized()?;
                Some(body.center - axis * half + across * radius - tip)
            }
            _ => None,
        }
    }

    /// The part on which the point at `share` of the ruling lies, from [`Self::point`]; `None` if it is this one.
    pub fn beyond(&self, body: &Body<'_>, share: f64) -> Option<Self> {
        match *self {
            Self::Line { from, to, .. } => {
                if share.abs() <= 0.5 + SHARE {
                    return None;
                }
                let end = if share < 0.0 { from } else { to };
                Some(match body.core {
                    Core::Cylinder(radius, _) => Self::Rim {
                        center: end,
                        axis: if share < 0.0 { -body.axis(2) } else { body.axis(2) },
                        radius,
                    },
                    _ => Self::Corner(end),
                })
            }
            Self::Slope { tip, axis, .. } => {
                if share < -SHARE {
                    Some(Self::Corner(tip))
                } else if share > 1.0 + SHARE {
                    let Core::Cone(radius, half) = body.core else { return None };
                    Some(Self::Rim { center: body.center - axis * half, axis: -axis, radius })
                } else {
                    None
                }
            }
            _ => None,
        }
    }

    /// For flat parts: where a point of their plane lies.
    pub fn beside(&self, p: Vec3) -> Beside {
        match *self {
            Self::Triangle { corners: [a, b, c], normal } => {
                let area = (b - a).cross(c - a).dot(normal);
                let shares = [
                    (c - b).cross(p - b).dot(normal) / area,
                    (a - c).cross(p - c).dot(normal) / area,
                    (b - a).cross(p - a).dot(normal) / area,
                ];
                let mut least = 0;
                for i in 1..3 {
                    if shares[i] < shares[least] {
                        least = i;
                    }
                }
                let (from, to) = [(b, c), (c, a), (a, b)][least];
                if shares[least] < -SHARE {
                    Beside::On(Self::Line { from, to, margin: 0.0 })
                } else {
                    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
                    Beside::Within(shares[least] * area / longest)
                }
            }
            Self::Disc { center, axis, radius } => {
                let off = p - center;
                let inside = radius - (off - axis * axis.dot(off)).length();
                if inside < -SHARE * radius {
                    Beside::On(Self::Rim { center, axis, radius })
                } else {
                    Beside::Within(inside)
                }
            }
            _ => Beside::Within(0.0),
        }
    }

    /// For rims: whether the way from one direction to another leads across the axis, to the other side of the disc.
    pub fn crosses(&self, d: Vec3, before: Vec3) -> bool {
        let Self::Rim { axis, .. } = *self else { return false };
        let across = |d: Vec3| d - axis * axis.dot(d);
        axis.dot(d) > 0.0 && across(d).dot(across(before)) < 0.0
    }

    /// Whether it is a rim whose disc looks nearly along `d`.
    pub fn may_be_disc(&self, d: Vec3) -> bool {
        matches!(self, Self::Rim { axis, .. } if axis.dot(d) > ON_DISC)
    }

    /// For discs: the point of the rim that is nearest to a point of their plane, or beside it.
    pub fn rim_towards(&self, p: Vec3) -> Option<Vec3> {
        let Self::Disc { center, axis, radius } = *self else { return None };
        let off = p - center;
        Some(center + (off - axis * axis.dot(off)).normalized()? * radius)
    }

    /// What to look at instead once `d` has turned away from what this part faces; `None` if it has not.
    /// `before` is the direction of the last step.
    pub fn left(&self, body: &Body<'_>, d: Vec3, before: Vec3, slack: f64) -> Option<Self> {
        match (*self, &body.core) {
            (Self::Corner(tip), Core::Cone(radius, half)) => {
                let (u, sine) = (body.axis(2), slope_sine(*radius, *half));
                (u.dot(d) < sine).then_some(Self::Slope { tip, axis: u, sine })
            }
            (Self::Corner(p), _) => {
                let q = body.support(d);
                (d.dot(q - p) > slack).then_some(Self::Line { from: p, to: q, margin: 0.0 })
            }
            (Self::Rim { center, axis, radius }, core) => {
                if self.crosses(d, before) {
                    return Some(Self::Disc { center, axis, radius });
                }
                match *core {
                    Core::Cylinder(_, half) => (axis.dot(d) < 0.0).then(|| Self::Line {
                        from: body.center - body.axis(2) * half,
                        to: body.center + body.axis(2) * half,
                        margin: radius,
                    }),
                    Core::Cone(radius, half) => {
                        let (u, sine) = (body.axis(2), slope_sine(radius, half));
                        (u.dot(d) > sine).then(|| Self::Slope { tip: body.center + u * half, axis: u, sine })
                    }
                    _ => None,
                }
            }
            // Across an edge the faces at it are all that can be nearer.
            (Self::Line { from, to, margin: 0.0 }, _) => {
                let q = body.support(d);
                (d.dot(q - from) > slack)
                    .then(|| {
                        let normal = (to - from).cross(q - from).normalized()?;
                        let normal = if normal.dot(d) < 0.0 { -normal } else { normal };
                        Some(Self::Triangle { corners: [from, to, q], normal })
                    })
                    .flatten()
            }
            _ => None,
        }
    }
}

/// Sine of the angle between the outward normals of a cone's side and the plane across its axis.
fn slope_sine(radius: f64, half: f64) -> f64 {
    let length = 2.0 * half;
    let slant = (radius * radius + length * length).sqrt();
    if slant > 0.0 { radius / slant } else { 0.0 }
}
