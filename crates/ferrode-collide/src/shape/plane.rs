use super::ShapeError;
use ferrode_math::{Aabb, Vec3};

/// The half-space `normal · x ≤ d` of the world: everything below the plane is solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: Vec3,
    d: f64,
}

impl Plane {
    /// The plane a x + b y + c z = d in world coordinates, with normal (a, b, c) of any length but zero.
    pub fn new(normal: Vec3, d: f64) -> Result<Self, ShapeError> {
        let mut length = normal.length();
        // The square of a very small number has lost digits, or all: along the unit vector nothing is squared.
        let tiny = if length < 1e-145 { normal.normalized() } else { None };
        if let Some(n) = tiny {
            length = n.dot(normal);
        }
        if !(length > 0.0 && length.is_finite()) {
            return Err(ShapeError { what: "length of a plane's normal", value: length });
        }
        if !d.is_finite() {
            return Err(ShapeError { what: "plane distance", value: d });
        }
        let scale = 1.0 / length;
        let (n, d) = match tiny {
            Some(n) => (n, d / length),
            None if scale.is_finite() => (normal * scale, d * scale),
            None => (normal / length, d / length),
        };
        if !d.is_finite() {
            return Err(ShapeError { what: "plane distance over the length of its normal", value: d });
        }
        Ok(Self { normal: n, d })
    }

    /// The plane through `point`.
    pub fn through(point: Vec3, normal: Vec3) -> Result<Self, ShapeError> {
        Self::new(normal, normal.dot(point))
    }

    /// Unit normal, out of the solid side.
    #[inline]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Distance of the plane from the world's origin along the normal.
    #[inline]
    pub fn d(&self) -> f64 {
        self.d
    }

    /// Depth of a point below the plane; negative above.
    #[inline]
    pub fn depth(&self, p: Vec3) -> f64 {
        self.d - self.normal.dot(p)
    }

    /// The world box around the half-space: bounded only for an axis-parallel normal, and then on one side.
    pub fn aabb(&self) -> Aabb {
        let mut aabb = Aabb::EVERYTHING;
        let n = self.normal;
        for i in 0..3 {
            if n[(i + 1) % 3] == 0.0 && n[(i + 2) % 3] == 0.0 {
                if n[i] > 0.0 {
                    aabb.max[i] = self.d;
                } else {
                    aabb.min[i] = -self.d;
                }
            }
        }
        aabb
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_whose_squares_underflow_become_unit_vectors() {
        for size in [1e-140, 1e-149, 1e-155, 1e-160, 1e-161, 1e-200, 1e-300, 1e-320] {
            let plane = Plane::new(Vec3::new(0.6 * size, 0.0, 0.8 * size), 2.0 * size).unwrap();
            assert!((plane.normal().length() - 1.0).abs() < 1e-15, "{size}: {plane:?}");
            let off = (plane.normal() - Vec3::new(0.6, 0.0, 0.8)).length().max((plane.d() - 2.0).abs());
            assert!(off < if size > 1e-308 { 1e-15 } else { 1e-3 }, "{size}: {plane:?}");
        }
        assert!(Plane::new(Vec3::ZERO, 0.0).is_err());
    }
}
