//! This engine, with its stepper for crowds.

use crate::engine::Engine;
use crate::quality::shape;
use crate::scene::{Link, STEP, Scene};
use ferrode::prelude::*;
use ferrode::{Ball, Hinge};
use ferrode_math::Pose;

/// A world, and the keys of its solids.
pub struct Ferrode {
    world: World,
    bodies: Vec<Result<BodyKey, Pose>>,
}

impl Ferrode {
    /// Panics if a scene can't be built, which is a fault of its file.
    pub fn new(scene: &Scene, threads: usize) -> Self {
        Self::build(scene, threads).unwrap_or_else(|e| panic!("{}: {e}", scene.name))
    }

    fn build(scene: &Scene, threads: usize) -> Result<Self, Error> {
        let mut world = World::new();
        world.stepper = Stepper::Substep;
        world.set_threads(threads);
        world.set_gravity(Vec3::Z * -scene.gravity)?;
        world.set_default_material(Material::with_friction(scene.friction))?;
        if !scene.sleeping {
            let mut settings = *world.dynamics().substep();
            settings.sleep_speed = 0.0;
            world.set_substep(settings)?;
        }
        let mut bodies = Vec::new();
        for solid in &scene.solids {
            let shape = shape(&solid.form)?;
            let Some(density) = solid.density else {
                world.add_static(shape, solid.pose)?;
                bodies.push(Err(solid.pose));
                continue;
            };
            let builder = BodyBuilder::new().at(solid.pose.position).rotated(solid.pose.rotation);
            let body = world.add_body(builder.with_shape(shape, density).with_velocity(solid.velocity))?;
            if solid.ghost {
                let geoms = world.body_geoms(body)?.to_vec();
                for geom in geoms {
                    world.set_geom_bits(geom, 2, 1)?;
                }
            }
            bodies.push(Ok(body));
        }
        let body = |i: usize| bodies[i].as_ref().ok().copied();
        for joint in &scene.joints {
            let (a, b) = (body(joint.a), joint.b.and_then(body));
            match joint.link {
                Link::Ball => {
                    let key = world.create_joint::<Ball>(None)?;
                    world.attach(key, a, b)?;
                    world.joint_mut::<Ball>(key)?.set_anchor(joint.anchor)?;
                }
                Link::Hinge { axis, stops, brake } => {
                    let key = world.create_joint::<Hinge>(None)?;
                    world.attach(key, a, b)?;
                    let mut hinge = world.joint_mut::<Hinge>(key)?;
                    hinge.set_anchor(joint.anchor)?;
                    hinge.set_axis(axis)?;
                    if let Some((low, high)) = stops {
                        hinge.set_limits(low, high)?;
                    }
                    if let Some(torque) = brake {
                        hinge.set_motor(0.0, torque)?;
                    }
                }
            }
        }
        Ok(Self { world, bodies })
    }
}

impl Engine for Ferrode {
    fn about(&self) -> String {
        format!("ferrode {}, Substep, its defaults", env!("CARGO_PKG_VERSION"))
    }

    fn step(&mut self) {
        if let Err(error) = self.world.step(STEP) {
            panic!("ferrode could not step: {error}");
        }
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        out.clear();
        out.extend(self.bodies.iter().map(|body| match body {
            Ok(key) => self.world.body(*key).map_or(Pose::IDENTITY, |b| b.pose()),
            Err(pose) => *pose,
        }));
    }
}
