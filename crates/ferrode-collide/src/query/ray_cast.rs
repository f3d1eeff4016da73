use super::{Queries, better};
use crate::narrow;
use crate::space::Probe;
use crate::{
    CollideOptions, ColliderError, Colliders, Frame, Geom, GeomContact, GeomKey, Ray, Shape, SpaceKey,
};
use core::cell::Cell;
use ferrode_math::{Mat3, Vec3, plane_space};

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

/// Where a ray met a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeRayHit {
    /// World position of the hit.
    pub position: Vec3,
    /// Unit normal of the surface, turned against the ray (of a mesh: the triangle's own).
    pub normal: Vec3,
    /// Metres along the ray.
    pub distance: f64,
    /// The triangle of a mesh; −1 for other shapes.
    pub side: i32,
}

impl From<&GeomContact> for ShapeRayHit {
    fn from(c: &GeomContact) -> Self {
        Self { position: c.point.position, normal: c.point.normal, distance: c.point.depth, side: c.side2 }
    }
}

impl ShapeRayHit {
    fn of(self, geom: GeomKey) -> RayHit {
        let Self { position, normal, distance, side } = self;
        RayHit { geom, position, normal, distance, side }
    }
}

thread_local! {
    /// Working memory of casts, so that none allocates.
    static HITS: Cell<Vec<GeomContact>> = const { Cell::new(Vec::new()) };
}

/// A ray that is asked of many shapes.
struct Caster {
    origin: Vec3,
    /// A unit vector.
    direction: Vec3,
    /// Longest that the ray can be: what it stands for, whatever is asked.
    length: f64,
    closest: bool,
    /// For shapes that are asked by way of the table of pairs: made for the first of them.
    general: Option<General>,
}

/// The ray as a shape.
struct General {
    frame: Frame,
    /// As long as was asked for last.
    ray: Shape,
    contacts: Vec<GeomContact>,
}

/// The rotation of a ray along a unit vector.
fn turned_to(direction: Vec3) -> Mat3 {
    let (p, q) = plane_space(direction);
    Mat3::from_columns(p, q, direction)
}

impl Caster {
    /// `None` for a ray without direction or length.
    #[inline]
    fn new(origin: Vec3, direction: Vec3, length: f64, closest: bool) -> Option<Self> {
        let direction = direction.normalized()?;
        // As long as a ray may be stands for endless.
        let length = if length > 0.0 { length.min(1e150) } else { length };
        (length >= 0.0).then_some(Self { origin, direction, length, closest, general: None })
    }

    /// The first hit with one shape up to `limit`.
    #[inline]
    fn first(&mut self, shape: &Shape, frame: &Frame, limit: f64) -> Option<ShapeRayHit> {
        // The commonest shape without a detour. What is not made of finite numbers is left out, as it is of contacts.
        if let Shape::Cuboid(cuboid) = shape {
            let (o, u) = (self.origin, self.direction);
            let (normal, distance) = narrow::ray_cuboid_hit(o, u, limit, cuboid, frame)?;
            let position = o + u * distance;
            let hit = ShapeRayHit { position, normal, distance, side: -1 };
            return (position.is_finite() && normal.is_finite()).then_some(hit);
        }
        self.cast(shape, frame, limit).first().map(ShapeRayHit::from)
    }

    /// The hits with one shape up to `limit`.
    fn cast(&mut self, shape: &Shape, frame: &Frame, limit: f64) -> &[GeomContact] {
        let general = self.general.get_or_insert_with(|| {
            let mut ray = Ray::UNMEASURED;
            ray.closest_hit = self.closest;
            let frame = Frame::new(self.origin, turned_to(self.direction));
            General { frame, ray: Shape::Ray(ray), contacts: HITS.take() }
        });
        general.contacts.clear();
        if let Shape::Ray(ray) = &mut general.ray
            && !matches!(shape, Shape::Ray(_))
            && ray.set_length(limit).is_ok()
        {
            let max_contacts = if self.closest { 1 } else { u16::MAX };
            let options = CollideOptions { max_contacts, unimportant: false };
            let General { frame: own, ray, contacts } = general;
            narrow::collide_frames((ray, own), (shape, frame), options, contacts);
        }
        &general.contacts
    }
}

impl Drop for General {
    fn drop(&mut self) {
        HITS.set(core::mem::take(&mut self.contacts));
    }
}

/// The first hit of a ray with a shape.
///
/// `direction` need not be a unit vector; a zero one hits nothing. A ray that begins inside hits the surface where it
/// leaves.
pub fn ray_cast(
    shape: &Shape,
    frame: &Frame,
    origin: Vec3,
    direction: Vec3,
    length: f64,
) -> Option<ShapeRayHit> {
    let mut caster = Caster::new(origin, direction, length, true)?;
    caster.first(shape, frame, caster.length)
}

impl Queries<'_> {
    /// The first hit of a ray among the geoms that `filter` lets through.
    ///
    /// `direction` need not be a unit vector; a zero one hits nothing. Among equal distances the geom that was added
    /// first wins.
    pub fn ray_cast(
        &self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
    ) -> Option<RayHit> {
        let mut caster = Caster::new(origin, direction, length, true)?;
        let mut best: Option<RayHit> = None;
        let mut limit = caster.length;
        let probe = Probe::ray(origin, caster.direction);
        self.seek(&probe, &mut limit, &mut |key, geom, limit| {
            if !filter(key, geom) {
                return;
            }
            if let Some(hit) = caster.first(geom.shape(), geom.frame(), *limit)
                && better(hit.distance, key, best.as_ref().map(|b| (b.distance, b.geom)))
            {
                *limit = hit.distance;
                best = Some(hit.of(key));
            }
        });
        best
    }

    /// Whether a ray hits any geom that `filter` lets through: less work than the first hit.
    pub fn ray_meets(
        &self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
    ) -> bool {
        let Some(mut caster) = Caster::new(origin, direction, length, true) else { return false };
        let mut limit = caster.length;
        let probe = Probe::ray(origin, caster.direction);
        let mut any = false;
        self.seek(&probe, &mut limit, &mut |key, geom, limit| {
            if !any && filter(key, geom) && caster.first(geom.shape(), geom.frame(), *limit).is_some() {
                any = true;
                // Nothing is met before the start: the search ends.
                *limit = -1.0;
            }
        });
        any
    }

    /// All hits of a ray, nearest first, put into `hits` in place of what it held. A mesh is hit once a triangle.
    pub fn ray_cast_all(
        &self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
        hits: &mut Vec<RayHit>,
    ) {
        hits.clear();
        let Some(mut caster) = Caster::new(origin, direction, length, false) else { return };
        let mut limit = caster.length;
        let probe = Probe::ray(origin, caster.direction);
        self.seek(&probe, &mut limit, &mut |key, geom, limit| {
            if filter(key, geom) {
                let found = caster.cast(geom.shape(), geom.frame(), *limit);
                hits.extend(found.iter().map(|c| ShapeRayHit::from(c).of(key)));
            }
        });
        hits.sort_unstable_by(|a, b| {
            let order = a.distance.total_cmp(&b.distance);
            order.then(a.geom.serial().cmp(&b.geom.serial())).then(a.side.cmp(&b.side))
        });
    }
}

impl Colliders {
    /// The first hit of a ray; see [`Queries::ray_cast`], which is for more than one question.
    pub fn ray_cast(
        &mut self,
        space: SpaceKey,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
    ) -> Result<Option<RayHit>, ColliderError> {
        Ok(self.queries(space)?.ray_cast(origin, direction, length, filter))
    }

    /// All hits of a ray; see [`Queries::ray_cast_all`].
    pub fn ray_cast_all(
        &mut self,
        space: SpaceKey,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(GeomKey, &Geom) -> bool,
        hits: &mut Vec<RayHit>,
    ) -> Result<(), ColliderError> {
        self.queries(space)?.ray_cast_all(origin, direction, length, filter, hits);
        Ok(())
    }
}
