use super::{Queries, better};
use crate::shape::within;
use crate::space::Probe;
use crate::{
    CollideOptions, ColliderError, Colliders, Frame, Geom, GeomKey, Ray, Shape, SpaceKey, Sphere, TriMesh,
    narrow,
};
use ferrode_math::{Aabb, Mat3, Vec3, rotation};

/// The point of a surface that is nearest to a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// The point of the surface, in the world.
    pub position: Vec3,
    /// Metres from there to the place; within the shape, minus the depth.
    pub distance: f64,
    /// Unit vector out of the shape: from the surface to a place outside.
    pub normal: Vec3,
}

/// The point of a shape's surface nearest to `point`. `None` for rays, and for shapes of one's own that neither have a
/// [support function](crate::CustomShape::support) nor tell [distances](crate::CustomShape::distance) or
/// [depths](crate::CustomShape::point_depth).
pub fn closest_point(shape: &Shape, frame: &Frame, point: Vec3) -> Option<ClosestPoint> {
    if let Shape::Compound(compound) = shape {
        // Of the parts that contain the point, the deepest.
        let each = (0..compound.len() as u32).map(|i| compound.part(i));
        let found = each.filter_map(|(part, at)| closest_point(part, &within(frame, at), point));
        return found.min_by(|a, b| a.distance.total_cmp(&b.distance));
    }
    let speck = Shape::from(Sphere::new(0.0).ok()?);
    let at = Frame::new(point, Mat3::IDENTITY);
    let d = narrow::distance_frames((&speck, &at), (shape, frame))?;
    // From a point, distance and direction say where; the witness of a depth within a round shape is less exact.
    let position = point - d.normal * d.distance;
    let mut closest = ClosestPoint { position, distance: d.distance, normal: d.normal };
    let within = match shape {
        Shape::TriMesh(mesh) => is_within(mesh, frame, point),
        Shape::Heightfield(field) => {
            let p = frame.point_to_local(point);
            let bottom = field.aabb(&Frame::IDENTITY).min.y;
            field.surface_at(p.x, p.z).is_some_and(|y| p.y < y && p.y >= bottom)
        }
        _ => false,
    };
    if within {
        (closest.distance, closest.normal) = (-d.distance.abs(), -d.normal);
    }
    Some(closest)
}

impl Queries<'_> {
    /// Calls `found` with each geom that contains the point, and how deep.
    pub fn geoms_at(&self, point: Vec3, mut found: impl FnMut(GeomKey, f64)) {
        self.geoms_near(&Aabb::new(point, point), |key, geom| {
            if let Some(depth) = point_depth(geom.shape(), geom.frame(), point)
                && depth >= 0.0
            {
                found(key, depth);
            }
        });
    }

    /// The point nearest to `point` on the geoms that `filter` lets through and that are no further than
    /// `max_distance`. What contains the point is nearer than what does not: the deeper, the nearer.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
    ) -> Option<(GeomKey, ClosestPoint)> {
        let mut best: Option<(GeomKey, ClosestPoint)> = None;
        let mut limit = max_distance;
        self.seek(&Probe::near(&Aabb::new(point, point)), &mut limit, &mut |key, geom, limit| {
            if filter(key, geom)
                && let Some(found) = closest_point(geom.shape(), geom.frame(), point)
                && found.distance <= max_distance
                && better(found.distance, key, best.as_ref().map(|(key, b)| (b.distance, *key)))
            {
                // What else contains the point is at no distance.
                *limit = found.distance.max(0.0);
                best = Some((key, found));
            }
        });
        best
    }
}

impl Colliders {
    /// Calls `found` with each enabled geom of a space, and of the spaces in it, that contains the point, and how deep.
    pub fn geoms_at(
        &mut self,
        space: SpaceKey,
        point: Vec3,
        found: impl FnMut(GeomKey, f64),
    ) -> Result<(), ColliderError> {
        self.queries(space)?.geoms_at(point, found);
        Ok(())
    }

    /// Depth of a point within a geom; see [`point_depth`].
    pub fn point_depth(&self, key: GeomKey, point: Vec3) -> Option<f64> {
        let geom = self.geom(key)?;
        point_depth(geom.shape(), geom.frame(), point)
    }
}

/// Depth of a point within a shape: the least distance to its surface; outside, minus the distance. A mesh counts as
/// closed; what is straight below a heightfield is within it, down to the bottom of its box (its thickness below the lowest
/// sample), which is no surface; of a compound the part that contains the point most deeply counts. `None` for rays, and for shapes of one's own that cannot tell.
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
            if depth >= 0.0 { depth } else { -closest_point(shape, frame, point)?.distance }
        }
        Shape::Ray(_) => return None,
        Shape::Compound(compound) => {
            let each = (0..compound.len() as u32).map(|i| compound.part(i));
            let depths = each.filter_map(|(part, at)| point_depth(part, &within(frame, at), point));
            depths.max_by(f64::total_cmp)?
        }
        Shape::Custom(s) => match s.get().point_depth(frame, point) {
            Some(depth) => depth,
            None => -closest_point(shape, frame, point)?.distance,
        },
        _ => -closest_point(shape, frame, point)?.distance,
    })
}

/// Whether a closed mesh contains a point: whether a ray from there crosses the surface an odd number of times. Where a
/// ray passes through an edge it may count twice, so three of them vote.
fn is_within(mesh: &TriMesh, frame: &Frame, point: Vec3) -> bool {
    let local = frame.point_to_local(point);
    if !mesh.bounds().contains_point(local) {
        return false;
    }
    let Ok(ray) = Ray::new(2.0 * mesh.bounds().extent().length()) else { return false };
    let mut votes = 0;
    let mut hits = Vec::new();
    for direction in [[0.61, 0.37, 0.70], [-0.43, 0.83, 0.35], [0.21, -0.57, -0.79]] {
        let Some(axes) = rotation::from_z_axis(Vec3::from_array(direction)) else { continue };
        hits.clear();
        let mut out = crate::Contacts::new(&mut hits, CollideOptions::default());
        narrow::ray_trimesh(&ray, &Frame::new(local, axes), mesh, &Frame::IDENTITY, &mut out);
        votes += hits.len() % 2;
    }
    votes >= 2
}
