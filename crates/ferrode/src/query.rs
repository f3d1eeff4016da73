//! Questions to the shapes of a world.

use crate::{Error, GeomInfo, World};
use ferrode_collide::{ClosestPoint, Geom, GeomKey, RayHit, Shape, ShapeCastHit};
use ferrode_math::{Aabb, Pose, Vec3};

/// A view of a world's geoms, with the bodies where they are now: answers any number of questions, from any number of
/// threads. Switched-off geoms are not met; each question takes a filter.
///
/// ```
/// use ferrode::prelude::*;
/// # fn main() -> Result<(), Error> {
/// let mut world = World::new();
/// let ground = world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
/// let ball = world.add_body(BodyBuilder::new().at(Vec3::new(0.0, 0.0, 2.0)).with_shape(Sphere::new(0.5)?, 1000.0))?;
/// let queries = world.queries()?;
/// // A box falls onto the ball, or beside it onto the ground.
/// let cube = Shape::from(Cuboid::new(Vec3::splat(0.2))?);
/// let down = -Vec3::Z * 10.0;
/// let hit = queries.shape_cast(&cube, &Pose::from_position(Vec3::Z * 5.1), down, |_| true).expect("the ball");
/// assert_eq!(queries.info(hit.geom).and_then(|geom| geom.body), Some(ball));
/// assert!((hit.fraction - 0.25).abs() < 1e-9);
/// let beside = Pose::from_position(Vec3::new(3.0, 0.0, 5.1));
/// let hit = queries.shape_cast(&cube, &beside, down, |_| true).expect("the ground");
/// assert!(hit.geom == ground && (hit.fraction - 0.5).abs() < 1e-12);
/// // What is nearest to a place, and what a shape at a place would touch.
/// let (near, at) = queries.closest_point(Vec3::new(0.0, 0.0, 1.0), 1.0, |_| true).expect("the ball");
/// assert!(near != ground && (at.distance - 0.5).abs() < 1e-12 && (at.position - Vec3::Z * 1.5).length() < 1e-12);
/// let mut touched = Vec::new();
/// queries.overlaps(&cube, &Pose::from_position(Vec3::Z * 0.05), |key, _| touched.push(key));
/// assert_eq!(touched, [ground]);
/// # Ok(()) }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Queries<'a> {
    inner: ferrode_collide::Queries<'a>,
    infos: &'a [Option<GeomInfo>],
}

impl World {
    /// Moves the geoms to where the bodies are and lends a view of them to ask questions of.
    ///
    /// # Errors
    /// None in a world whose space was not removed by hand.
    pub fn queries(&mut self) -> Result<Queries<'_>, Error> {
        self.sync_geoms();
        Ok(Queries { inner: self.colliders.queries(self.space)?, infos: &self.geom_infos })
    }

    /// The first geom that a ray meets within `length` metres, of those that `filter` lets through, with the bodies where
    /// they are now. `direction` need not be a unit vector; a zero one meets nothing. Switched-off geoms are not met.
    ///
    /// For more than one question at a time see [`World::queries`].
    ///
    /// ```
    /// use ferrode::prelude::*;
    /// # fn main() -> Result<(), Error> {
    /// let mut world = World::new();
    /// let ground = world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    /// let ball = world.add_body(BodyBuilder::new().at(Vec3::new(0.0, 0.0, 2.0)).with_shape(Sphere::new(0.5)?, 1000.0))?;
    /// let eye = Vec3::new(0.0, 0.0, 5.0);
    /// let hit = world.ray_cast(eye, -Vec3::Z, 10.0, |_| true)?.expect("the ball is below");
    /// assert_eq!(world.geom_info(hit.geom)?.body, Some(ball));
    /// assert!((hit.distance - 2.5).abs() < 1e-12 && (hit.normal - Vec3::Z).length() < 1e-12);
    /// let hit = world.ray_cast(eye, -Vec3::Z, 10.0, |geom| geom.body.is_none())?.expect("and the ground");
    /// assert_eq!(hit.geom, ground);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    /// None for the rays themselves: one that is not finite meets nothing.
    pub fn ray_cast(
        &mut self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(&GeomInfo) -> bool,
    ) -> Result<Option<RayHit>, Error> {
        Ok(self.queries()?.ray_cast(origin, direction, length, filter))
    }
}

impl<'a> Queries<'a> {
    /// Body, surface and user data of a geom.
    pub fn info(&self, key: GeomKey) -> Option<&'a GeomInfo> {
        self.info_of(self.inner.colliders().geom(key)?)
    }

    fn info_of(&self, geom: &Geom) -> Option<&'a GeomInfo> {
        self.infos.get(geom.user() as usize)?.as_ref()
    }

    /// The filter that the layer below understands.
    fn passes(&self, filter: impl Fn(&GeomInfo) -> bool) -> impl Fn(GeomKey, &Geom) -> bool {
        let view = *self;
        move |_, geom| view.info_of(geom).is_some_and(&filter)
    }

    /// The first geom that a ray meets within `length` metres. `direction` need not be a unit vector.
    pub fn ray_cast(
        &self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(&GeomInfo) -> bool,
    ) -> Option<RayHit> {
        self.inner.ray_cast(origin, direction, length, self.passes(filter))
    }

    /// Whether a ray meets any geom: less work than the first.
    pub fn ray_meets(
        &self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(&GeomInfo) -> bool,
    ) -> bool {
        self.inner.ray_meets(origin, direction, length, self.passes(filter))
    }

    /// All hits of a ray, nearest first, put into `hits` in place of what it held.
    pub fn ray_cast_all(
        &self,
        origin: Vec3,
        direction: Vec3,
        length: f64,
        filter: impl Fn(&GeomInfo) -> bool,
        hits: &mut Vec<RayHit>,
    ) {
        self.inner.ray_cast_all(origin, direction, length, self.passes(filter), hits);
    }

    /// What a shape hits first that starts at `pose` and moves along `path` without turning.
    pub fn shape_cast(
        &self,
        shape: &Shape,
        pose: &Pose,
        path: Vec3,
        filter: impl Fn(&GeomInfo) -> bool,
    ) -> Option<ShapeCastHit> {
        self.inner.shape_cast(shape, pose, path, self.passes(filter))
    }

    /// The nearest point of any geom that is no further than `max_distance` from `point`.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f64,
        filter: impl Fn(&GeomInfo) -> bool,
    ) -> Option<(GeomKey, ClosestPoint)> {
        self.inner.closest_point(point, max_distance, self.passes(filter))
    }

    /// Calls `found` with each geom that contains the point, and how deep.
    pub fn geoms_at(&self, point: Vec3, found: impl FnMut(GeomKey, f64)) {
        self.inner.geoms_at(point, found);
    }

    /// Calls `found` with each geom whose box touches `aabb`.
    pub fn geoms_near(&self, aabb: &Aabb, mut found: impl FnMut(GeomKey, &GeomInfo)) {
        self.inner.geoms_near(aabb, |key, geom| {
            if let Some(info) = self.info_of(geom) {
                found(key, info);
            }
        });
    }

    /// Calls `found` with each geom that touches a shape at a pose.
    pub fn overlaps(&self, shape: &Shape, pose: &Pose, mut found: impl FnMut(GeomKey, &GeomInfo)) {
        self.inner.overlaps(shape, pose, |key, geom| {
            if let Some(info) = self.info_of(geom) {
                found(key, info);
            }
        });
    }
}
