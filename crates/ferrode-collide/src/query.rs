//! Questions to a container: what does a ray hit, what is at a point, how far apart are two geoms.

use crate::narrow::{self, Distance};
use crate::space::tree::segment_meets;
use crate::{
    CollideOptions, ColliderError, Colliders, Frame, Geom, GeomContact, GeomKey, Item, Ray, Shape, SpaceKey,
    Sphere,
};
use ferrode_math::{Aabb, Pose, Vec3};

/// Where a ray met a geom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The geom that was hit.
    pub geom: GeomKey,
    /// World position of the hit.
    pub position: Vec3,
    /// Unit normal of the surface, turned against the ray (of a mesh: the triangle's own).
    pub normal: Vec3,
    /// Metres along the ray.
    pub distance: f64,
    /// The triangle of a mesh; −1 for other shapes.
    pub side: i32,
}

impl Colliders {
    /// The first hit of a ray with the enabled geoms of a space, and of the spaces in it, that `filter` lets through.
    ///
    /// `direction` need not be a unit vector; a zero one hits nothing. Among equal distances the geom that was added
    /// first wins.
    pub fn ray_cast(
        &mut self,
        space: SpaceKey,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
    ) -> Result<Option<RayHit>, ColliderError> {
        let mut best: Option<RayHit> = None;
        self.cast(space, origin, direction, length, true, &filter, &mut |hit| {
            let nearer = |b: &RayHit| {
                hit.distance < b.distance
                    || (hit.distance == b.distance && hit.geom.serial() < b.geom.serial())
            };
            if best.as_ref().is_none_or(nearer) {
                best = Some(hit);
            }
        })?;
        Ok(best)
    }

    /// All hits of a ray, nearest first, put into `hits` in place of what it held. See [`ray_cast`](Self::ray_cast).
    pub fn ray_cast_all(
        &mut self,
        space: SpaceKey,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
        hits: &mut Vec<RayHit>,
    ) -> Result<(), ColliderError> {
        hits.clear();
        self.cast(space, origin, direction, length, false, &filter, &mut |hit| hits.push(hit))?;
        hits.sort_by(|a, b| {
            let order = a.distance.total_cmp(&b.distance);
            order.then(a.geom.serial().cmp(&b.geom.serial())).then(a.side.cmp(&b.side))
        });
        Ok(())
    }

    #[allow(clippy::too_many_arguments)]
    fn cast(
        &mut self,
        space: SpaceKey,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        closest: bool,
        filter: &dyn Fn(GeomKey, &Geom) -> bool,
        report: &mut dyn FnMut(RayHit),
    ) -> Result<(), ColliderError> {
        self.refresh(space)?;
        let (Ok(mut ray), Some(pose)) = (Ray::new(length), Ray::pose(origin, direction)) else {
            return Ok(());
        };
        ray.closest_hit = closest;
        let frame = Frame::from(&pose);
        let span = frame.axis(2) * length;
        let inverse = Vec3::new(1.0 / span.x, 1.0 / span.y, 1.0 / span.z);
        let shape = Shape::from(ray);
        let options = CollideOptions { max_contacts: if closest { 1 } else { u16::MAX }, unimportant: false };
        let mut contacts: Vec<GeomContact> = Vec::new();
        self.visit(space, &|aabb| segment_meets(aabb, origin, inverse), &mut |key, geom| {
            if matches!(geom.shape(), Shape::Ray(_)) || !filter(key, geom) {
                return;
            }
            contacts.clear();
            narrow::collide_frames((&shape, &frame), (geom.shape(), geom.frame()), options, &mut contacts);
            for c in &contacts {
                report(RayHit {
                    geom: key,
                    position: c.point.position,
                    normal: c.point.normal,
                    distance: c.point.depth,
                    side: c.side2,
                });
            }
        });
        Ok(())
    }

    /// Calls `found` with each enabled geom of a space, and of the spaces in it, whose box touches `aabb`.
    pub fn geoms_near(
        &mut self,
        space: SpaceKey,
        aabb: &Aabb,
        mut found: impl FnMut(GeomKey, &Geom),
    ) -> Result<(), ColliderError> {
        self.refresh(space)?;
        self.visit(space, &|b| b.overlaps(aabb), &mut found);
        Ok(())
    }

    /// Calls `found` with each enabled geom of a space, and of the spaces in it, that contains the point, and how deep.
    pub fn geoms_at(
        &mut self,
        space: SpaceKey,
        point: Vec3,
        mut found: impl FnMut(GeomKey, f64),
    ) -> Result<(), ColliderError> {
        self.geoms_near(space, &Aabb::new(point, point), |key, geom| {
            if let Some(depth) = point_depth(geom.shape(), geom.frame(), point)
                && depth >= 0.0
            {
                found(key, depth);
            }
        })
    }

    /// Depth of a point within a geom; negative outside: minus the distance. `None` for shapes without inside.
    pub fn point_depth(&self, key: GeomKey, point: Vec3) -> Option<f64> {
        let geom = self.geom(key)?;
        point_depth(geom.shape(), geom.frame(), point)
    }

    /// The distance of two geoms; see [`narrow::distance`].
    pub fn distance(&self, a: GeomKey, b: GeomKey) -> Option<Distance> {
        let (a, b) = (self.geom(a)?, self.geom(b)?);
        narrow::distance((a.shape(), a.pose()), (b.shape(), b.pose()))
    }

    /// Visits the enabled geoms in a space whose boxes pass, spaces within it included.
    fn visit(&self, space: SpaceKey, test: &dyn Fn(&Aabb) -> bool, found: &mut dyn FnMut(GeomKey, &Geom)) {
        self.members_passing(space, test, &mut |item| match item {
            Item::Geom(key) => {
                if let Some(geom) = self.geom(key) {
                    found(key, geom);
                }
            }
            Item::Space(inner) => self.visit(inner, test, found),
        });
    }
}

/// Depth of a point within a shape: the least distance to its surface; outside, minus the distance. `None` for rays and
/// surfaces, which have no inside.
pub fn point_depth(shape: &Shape, frame: &Frame, point: Vec3) -> Option<f64> {
    let local = frame.point_to_local(point);
    Some(match shape {
        Shape::Sphere(s) => s.radius() - local.length(),
        Shape::Plane(s) => s.depth(point),
        Shape::Capsule(s) => {
            let half = 0.5 * s.length();
            s.radius() - (local - Vec3::new(0.0, 0.0, local.z.clamp(-half, half))).length()
        }
        Shape::Cuboid(s) => {
            let beyond = local.abs() - s.half_sides();
            let outside = beyond.max(Vec3::ZERO).length();
            if outside > 0.0 { -outside } else { -beyond.x.max(beyond.y).max(beyond.z) }
        }
        Shape::Cylinder(s) => {
            let side = (local.x * local.x + local.y * local.y).sqrt() - s.radius();
            let cap = local.z.abs() - 0.5 * s.length();
            if side <= 0.0 && cap <= 0.0 {
                -side.max(cap)
            } else {
                -Vec3::new(side.max(0.0), cap.max(0.0), 0.0).length()
            }
        }
        Shape::Convex(s) => {
            let planes = (0..s.face_count()).map(|i| {
                let (n, d) = s.face_plane(i);
                d - n.dot(local)
            });
            let depth = planes.fold(f64::INFINITY, f64::min);
            if depth >= 0.0 { depth } else { by_distance(shape, frame, point)? }
        }
        Shape::Ellipsoid(_) | Shape::Cone(_) => by_distance(shape, frame, point)?,
        Shape::Ray(_) | Shape::TriMesh(_) => return None,
    })
}

fn by_distance(shape: &Shape, frame: &Frame, point: Vec3) -> Option<f64> {
    let speck = Shape::from(Sphere::new(0.0).ok()?);
    let at = Pose::new(frame.position, ferrode_math::Quat::from_matrix(&frame.rotation));
    narrow::distance((&speck, &Pose::from_position(point)), (shape, &at)).map(|d| -d.distance)
}
