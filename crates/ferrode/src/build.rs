//! Bodies from their shapes.

use crate::{Error, Material, World};
use ferrode_collide::Shape;
use ferrode_dynamics::{Axis, BodyKey, Mass};
use ferrode_math::{Pose, Quat, Vec3};

/// What a new body is made of.
///
/// ```
/// use ferrode::prelude::*;
/// # fn main() -> Result<(), Error> {
/// let mut world = World::new();
/// let crate_ = BodyBuilder::new()
///     .at(Vec3::new(0.0, 0.0, 2.0))
///     .with_velocity(Vec3::X)
///     .with_shape(Cuboid::new(Vec3::new(1.0, 1.0, 0.5))?, 700.0)
///     .with_material(Material::with_friction(0.4));
/// let key = world.add_body(crate_)?;
/// assert!((world.body(key)?.mass().mass - 350.0).abs() < 1e-9);
/// # Ok(()) }
/// ```
#[derive(Clone, Debug, Default)]
pub struct BodyBuilder {
    pose: Pose,
    linear_velocity: Vec3,
    angular_velocity: Vec3,
    shapes: Vec<(Shape, Pose, f64)>,
    mass: Option<Mass>,
    material: Option<Material>,
    kinematic: bool,
}

impl BodyBuilder {
    /// A body at the origin, at rest, without shapes.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same with its origin at a world point.
    #[must_use]
    pub fn at(mut self, position: Vec3) -> Self {
        self.pose.position = position;
        self
    }

    /// The same with another rotation from body to world.
    #[must_use]
    pub fn rotated(mut self, rotation: Quat) -> Self {
        self.pose.rotation = rotation;
        self
    }

    /// The same moving at a velocity, m/s.
    #[must_use]
    pub fn with_velocity(mut self, linear: Vec3) -> Self {
        self.linear_velocity = linear;
        self
    }

    /// The same spinning, rad/s, world frame.
    #[must_use]
    pub fn with_spin(mut self, angular: Vec3) -> Self {
        self.angular_velocity = angular;
        self
    }

    /// The same with a shape of the given density (kg/m³) at the origin.
    #[must_use]
    pub fn with_shape(self, shape: impl Into<Shape>, density: f64) -> Self {
        self.with_shape_at(shape, density, Pose::IDENTITY)
    }

    /// The same with a shape of the given density at a pose in the body's frame. Density 0 adds no mass.
    #[must_use]
    pub fn with_shape_at(mut self, shape: impl Into<Shape>, density: f64, pose: Pose) -> Self {
        self.shapes.push((shape.into(), pose, density));
        self
    }

    /// The same with a mass of its own, in place of that of its shapes.
    #[must_use]
    pub fn with_mass(mut self, mass: Mass) -> Self {
        self.mass = Some(mass);
        self
    }

    /// The same with a surface for all its shapes.
    #[must_use]
    pub fn with_material(mut self, material: Material) -> Self {
        self.material = Some(material);
        self
    }

    /// The same, but kinematic: moved by its velocity alone.
    #[must_use]
    pub fn kinematic(mut self) -> Self {
        self.kinematic = true;
        self
    }

    fn mass(&self) -> Result<Mass, Error> {
        if let Some(mass) = self.mass {
            return Ok(mass);
        }
        let mut total: Option<Mass> = None;
        for (shape, pose, density) in &self.shapes {
            if *density == 0.0 {
                continue;
            }
            let mass =
                mass_of(shape, *density)?.rotate(pose.rotation.to_matrix())?.translate(pose.position)?;
            total = Some(total.map_or(mass, |sum| sum + mass));
        }
        Ok(total.unwrap_or_default())
    }
}

/// Mass properties of a shape of the given density (kg/m³), about its own origin; of a compound the sum of its parts', though they
/// overlap.
///
/// ```
/// use ferrode::{Convex, mass_of, prelude::*};
/// # fn main() -> Result<(), Error> {
/// let corners: Vec<Vec3> = (0..8_u8)
///     .map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
///     .collect();
/// let cube = mass_of(&Convex::from_points(&corners)?.into(), 6.0)?; // one corner at the origin
/// assert!((cube.mass - 6.0).abs() < 1e-12);
/// assert!((cube.centre - Vec3::splat(0.5)).length() < 1e-12);
/// assert!((cube.about_centre().rows[0][0] - 1.0).abs() < 1e-12); // m a²/6
/// # Ok(()) }
/// ```
///
/// # Errors
/// [`Error::NoVolume`] for planes, rays and heightfields; [`Error::Dynamics`] for a density that is not positive, or a mesh that is
/// open or inside out.
pub fn mass_of(shape: &Shape, density: f64) -> Result<Mass, Error> {
    Ok(match shape {
        Shape::Sphere(s) => Mass::sphere(density, s.radius())?,
        Shape::Cuboid(s) => Mass::cuboid(density, s.sides())?,
        Shape::Capsule(s) => Mass::capsule(density, Axis::Z, s.radius(), s.length())?,
        Shape::Cylinder(s) => Mass::cylinder(density, Axis::Z, s.radius(), s.length())?,
        Shape::Ellipsoid(s) => Mass::ellipsoid(density, s.radii())?,
        Shape::Cone(s) => Mass::cone(density, Axis::Z, s.radius(), s.length())?,
        Shape::Convex(s) => {
            let fan = |face: &[u32]| -> Vec<[u32; 3]> {
                face[1..].windows(2).map(|edge| [face[0], edge[0], edge[1]]).collect()
            };
            let triangles: Vec<_> = (0..s.face_count()).flat_map(|i| fan(s.face(i))).collect();
            Mass::trimesh(density, s.points(), &triangles)?
        }
        Shape::TriMesh(s) => Mass::trimesh(density, s.vertices(), s.triangles())?,
        Shape::Compound(s) => {
            let mut total: Option<Mass> = None;
            for (part, pose) in s.parts() {
                let mass =
                    mass_of(part, density)?.rotate(pose.rotation.to_matrix())?.translate(pose.position)?;
                total = Some(total.map_or(mass, |sum| sum + mass));
            }
            total.unwrap_or_default()
        }
        Shape::Heightfield(_) => return Err(Error::NoVolume { shape: "heightfield" }),
        Shape::Plane(_) => return Err(Error::NoVolume { shape: "plane" }),
        Shape::Ray(_) => return Err(Error::NoVolume { shape: "ray" }),
        _ => return Err(Error::NoVolume { shape: "shape of this kind" }),
    })
}

impl World {
    /// Adds a body with its shapes. The body's frame is moved to the common centre of mass, along the same axes; the
    /// shapes stay where they were described.
    ///
    /// # Errors
    /// As [`World::add_geom`], [`mass_of`] and the body's setters; then nothing is added.
    pub fn add_body(&mut self, builder: BodyBuilder) -> Result<BodyKey, Error> {
        let mass = builder.mass()?;
        mass.check()?;
        if let Some(material) = &builder.material {
            material.check()?;
        }
        let centre = mass.centre;
        let mass = Mass { centre: Vec3::ZERO, ..mass.translate(-centre)? };
        let key = self.dynamics.create_body();
        let result = self.fill_body(key, &builder, &mass, centre);
        if result.is_err() {
            self.destroy_body(key)?;
        }
        result.map(|()| key)
    }

    fn fill_body(
        &mut self,
        key: BodyKey,
        builder: &BodyBuilder,
        mass: &Mass,
        centre: Vec3,
    ) -> Result<(), Error> {
        let body = self.dynamics.body_mut(key)?;
        body.set_mass(mass)?;
        body.set_pose(builder.pose * Pose::from_position(centre))?;
        body.set_linear_velocity(builder.linear_velocity)?;
        body.set_angular_velocity(builder.angular_velocity)?;
        if builder.kinematic {
            body.set_kinematic();
        }
        for (shape, pose, _) in &builder.shapes {
            let geom = self.add_geom(key, shape.clone(), Pose::from_position(-centre) * *pose)?;
            if let Some(material) = builder.material {
                self.set_material(geom, material)?;
            }
        }
        Ok(())
    }
}
