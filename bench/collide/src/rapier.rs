//! Rapier and Parry, in single and in double precision.

macro_rules! engine {
    ($module:ident, $rapier:ident, $real:ty) => {
        /// The engine in one precision.
        pub mod $module {
            use crate::scene::{Body, Solid};
            use ferrode_math::Vec3;
            use $rapier::parry::bounding_volume::Aabb;
            use $rapier::parry::partitioning::{Bvh, BvhBuildStrategy};
            use $rapier::parry::query::{Ray, RayCast};
            use $rapier::parry::shape::TriMesh;
            use $rapier::prelude::*;

            type Real = $real;

            fn vector(v: Vec3) -> Vector {
                Vector::new(v.x as Real, v.y as Real, v.z as Real)
            }

            /// Colliders without bodies, and what finds their contacts.
            pub struct Scene {
                bodies: RigidBodySet,
                colliders: ColliderSet,
                handles: Vec<ColliderHandle>,
                islands: IslandManager,
                broad: BroadPhaseBvh,
                narrow: NarrowPhase,
                pipeline: CollisionPipeline,
            }

            impl Scene {
                /// All bodies as colliders that collide with each other.
                pub fn new(bodies: &[Body]) -> Self {
                    let mut colliders = ColliderSet::new();
                    let handles = bodies
                        .iter()
                        .map(|b| {
                            let builder = match b.solid {
                                Solid::Ball(r) => ColliderBuilder::ball(r as Real),
                                Solid::Cuboid(s) => {
                                    let h = s * 0.5;
                                    ColliderBuilder::cuboid(h.x as Real, h.y as Real, h.z as Real)
                                }
                            };
                            let q = b.rotation;
                            let rotation =
                                Rotation::from_xyzw(q.x as Real, q.y as Real, q.z as Real, q.w as Real);
                            colliders.insert(
                                builder
                                    .position(Pose::from_parts(vector(b.position), rotation.normalize()))
                                    .active_collision_types(ActiveCollisionTypes::all())
                                    .build(),
                            )
                        })
                        .collect();
                    Self {
                        bodies: RigidBodySet::new(),
                        colliders,
                        handles,
                        islands: IslandManager::new(),
                        broad: BroadPhaseBvh::new(),
                        narrow: NarrowPhase::new(),
                        pipeline: CollisionPipeline::new(),
                    }
                }

                /// Moves a collider.
                pub fn put(&mut self, i: usize, p: Vec3) {
                    self.colliders[self.handles[i]].set_translation(vector(p));
                }

                /// Broad and narrow phase.
                pub fn collide(&mut self) {
                    self.pipeline.step(
                        0.002,
                        &mut self.islands,
                        &mut self.broad,
                        &mut self.narrow,
                        &mut self.bodies,
                        &mut self.colliders,
                        &(),
                        &(),
                    );
                }

                /// Numbers of near pairs and of contacts.
                pub fn contacts(&self) -> (usize, usize) {
                    let (mut pairs, mut contacts) = (0, 0);
                    for pair in self.narrow.contact_pairs() {
                        pairs += 1;
                        for m in pair.manifolds() {
                            contacts += m.points.iter().filter(|c| c.dist <= 0.0).count();
                        }
                    }
                    (pairs, contacts)
                }

                /// Distance of the first hit.
                pub fn cast(&self, from: Vec3, direction: Vec3, length: f64) -> Option<f64> {
                    let query = self.broad.as_query_pipeline(
                        self.narrow.query_dispatcher(),
                        &self.bodies,
                        &self.colliders,
                        QueryFilter::default(),
                    );
                    let ray = Ray::new(vector(from), vector(direction));
                    query
                        .cast_ray_and_get_normal(&ray, length as Real, false)
                        .map(|h| f64::from(h.1.time_of_impact))
                }
            }

            /// Parry alone: a tree over shapes, built at once.
            pub struct Shapes {
                bvh: Bvh,
                shapes: Vec<(SharedShape, Pose)>,
            }

            impl Shapes {
                /// All bodies.
                pub fn new(bodies: &[Body]) -> Self {
                    let scene = Scene::new(bodies);
                    let shapes: Vec<_> = scene
                        .handles
                        .iter()
                        .map(|h| {
                            (scene.colliders[*h].shared_shape().clone(), *scene.colliders[*h].position())
                        })
                        .collect();
                    let boxes: Vec<Aabb> = shapes.iter().map(|(s, p)| s.compute_aabb(p)).collect();
                    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
                    Self { bvh, shapes }
                }

                /// Distance of the first hit.
                pub fn cast(&self, from: Vec3, direction: Vec3, length: f64) -> Option<f64> {
                    let ray = Ray::new(vector(from), vector(direction));
                    let hit = self.bvh.cast_ray(&ray, length as Real, |i, best| {
                        let (shape, pose) = &self.shapes[i as usize];
                        shape.cast_ray(pose, &ray, best, false)
                    });
                    hit.map(|h| f64::from(h.1))
                }
            }

            /// A mesh.
            pub struct Mesh(TriMesh);

            impl Mesh {
                /// From vertices and triangles. Panics if Parry does not take them.
                pub fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
                    let vertices = vertices.iter().map(|v| vector(*v)).collect();
                    Self(TriMesh::new(vertices, triangles.to_vec()).expect("a mesh"))
                }

                /// Distance of the first hit.
                pub fn cast(&self, from: Vec3, direction: Vec3, length: f64) -> Option<f64> {
                    let ray = Ray::new(vector(from), vector(direction));
                    self.0
                        .cast_local_ray_and_get_normal(&ray, length as Real, false)
                        .map(|h| f64::from(h.time_of_impact))
                }
            }
        }
    };
}

engine!(single, rapier3d, f32);
engine!(double, rapier3d_f64, f64);
