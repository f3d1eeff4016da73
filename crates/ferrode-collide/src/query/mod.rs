//! Questions to a space: what does a ray or a moving shape hit, what is at a place, what is near it.
//!
//! [`Colliders::queries`] brings a space up to date and gives a view of it that answers any number of questions, from
//! any number of threads. The same questions to a pair of shapes are in [`narrow`](crate::narrow).

mod overlap;
mod point;
mod ray_cast;
mod shape_cast;

pub use point::{ClosestPoint, closest_point, point_depth};
pub use ray_cast::{RayHit, ShapeRayHit, ray_cast};
pub use shape_cast::ShapeCastHit;

use crate::space::Probe;
use crate::{ColliderError, Colliders, Geom, GeomKey, Item, SpaceKey};

/// A view of a space that is up to date, to ask questions of. Questions go to the enabled geoms of the space and of the
/// spaces in it, category and collide bits do not matter; each takes a filter.
///
/// ```
/// use ferrode_collide::{Colliders, Cuboid, Geom, Shape, SpaceKind, Sphere};
/// use ferrode_math::{Pose, Vec3};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut colliders = Colliders::new();
/// let space = colliders.add_space(None, SpaceKind::Bvh)?;
/// let at = |x: f64| Pose::from_position(Vec3::X * x);
/// let wall = colliders.add_geom(Some(space), Geom::new(Cuboid::new(Vec3::splat(2.0))?).at(at(5.0)))?;
/// let ball = colliders.add_geom(Some(space), Geom::new(Sphere::new(0.5)?).at(at(2.0)))?;
///
/// let queries = colliders.queries(space)?;
/// let hit = queries.ray_cast(Vec3::ZERO, Vec3::X, 10.0, |_, _| true).ok_or("a hit")?;
/// assert_eq!((hit.geom, hit.distance), (ball, 1.5));
/// let hit = queries.ray_cast(Vec3::ZERO, Vec3::X, 10.0, |key, _| key != ball).ok_or("a hit")?;
/// assert_eq!((hit.geom, hit.distance), (wall, 4.0));
/// let probe = Shape::from(Sphere::new(0.25)?);
/// let hit = queries.shape_cast(&probe, &at(0.0), Vec3::X * 10.0, |_, _| true).ok_or("a hit")?;
/// assert!(hit.geom == ball && (hit.fraction - 0.125).abs() < 1e-12);
/// let (near, _) = queries.closest_point(Vec3::X * 3.5, 1.0, |_, _| true).ok_or("something near")?;
/// assert_eq!(near, wall);
/// # Ok(()) }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Queries<'a> {
    colliders: &'a Colliders,
    space: SpaceKey,
}

impl Colliders {
    /// Brings a space up to date and lends a view of it to ask questions of.
    pub fn queries(&mut self, space: SpaceKey) -> Result<Queries<'_>, ColliderError> {
        self.refresh(space)?;
        Ok(Queries { colliders: self, space })
    }
}

impl<'a> Queries<'a> {
    /// What is asked.
    pub fn colliders(&self) -> &'a Colliders {
        self.colliders
    }

    /// The enabled geoms whose boxes the probe meets within the limit.
    fn seek(&self, probe: &Probe, limit: &mut f64, found: &mut dyn FnMut(GeomKey, &Geom, &mut f64)) {
        self.colliders.seek(self.space, probe, limit, found);
    }

    /// All enabled geoms.
    fn each(&self, found: &mut dyn FnMut(GeomKey, &Geom)) {
        for item in self.colliders.members(self.space) {
            match item {
                Item::Geom(key) => {
                    if let Some(geom) = self.colliders.geom(key).filter(|g| g.is_enabled()) {
                        found(key, geom);
                    }
                }
                Item::Space(space) => Self { space, ..*self }.each(found),
            }
        }
    }
}

/// Whether a hit is to be preferred to the best one so far: nearer, or as near and of a geom added earlier.
fn better(distance: f64, geom: GeomKey, best: Option<(f64, GeomKey)>) -> bool {
    best.is_none_or(|(d, key)| distance < d || (distance == d && geom.serial() < key.serial()))
}
