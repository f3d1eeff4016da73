//! Questions to the shapes of a world.

use crate::{Error, GeomInfo, World};
use ferrode_collide::{GeomKey, RayHit};
use ferrode_math::Vec3;

impl World {
    /// The first geom that a ray meets within `length` metres, of those that `filter` lets through, with the bodies where
    /// they are now. `direction` need not be a unit vector; a zero one meets nothing. Switched-off geoms are not met.
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
        self.sync_geoms();
        let infos = &self.geom_infos;
        let passes = |_: GeomKey, geom: &ferrode_collide::Geom| {
            infos.get(geom.user() as usize).and_then(Option::as_ref).is_some_and(&filter)
        };
        Ok(self.colliders.ray_cast(self.space, origin, direction, length, passes)?)
    }
}
