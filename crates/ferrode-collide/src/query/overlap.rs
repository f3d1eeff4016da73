use super::Queries;
use crate::{ColliderError, Colliders, Frame, Geom, GeomKey, Shape, SpaceKey, narrow};
use ferrode_math::{Aabb, Pose};

impl Queries<'_> {
    /// Calls `found` with each geom whose box touches `aabb`.
    pub fn geoms_near(&self, aabb: &Aabb, mut found: impl FnMut(GeomKey, &Geom)) {
        self.colliders.visit_boxes(self.space, &|b| b.overlaps(aabb), &mut found);
    }

    /// Calls `found` with each geom that touches a shape at a pose.
    pub fn overlaps(&self, shape: &Shape, pose: &Pose, mut found: impl FnMut(GeomKey, &Geom)) {
        let frame = Frame::from(pose);
        self.geoms_near(&shape.aabb_in(&frame), |key, geom| {
            if narrow::touches((shape, &frame), (geom.shape(), geom.frame())) {
                found(key, geom);
            }
        });
    }
}

impl Colliders {
    /// Calls `found` with each enabled geom of a space, and of the spaces in it, whose box touches `aabb`.
    pub fn geoms_near(
        &mut self,
        space: SpaceKey,
        aabb: &Aabb,
        found: impl FnMut(GeomKey, &Geom),
    ) -> Result<(), ColliderError> {
        self.queries(space)?.geoms_near(aabb, found);
        Ok(())
    }

    /// The distance of two geoms; see [`narrow::distance`].
    pub fn distance(&self, a: GeomKey, b: GeomKey) -> Option<narrow::Distance> {
        let (a, b) = (self.geom(a)?, self.geom(b)?);
        narrow::distance_frames((a.shape(), a.frame()), (b.shape(), b.frame()))
    }
}
