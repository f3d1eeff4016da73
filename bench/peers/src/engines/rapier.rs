//! Rapier in single and in double precision.

macro_rules! engine {
    ($module:ident, $rapier:ident, $real:ty, $name:literal) => {
        /// The engine in one precision.
        pub mod $module {
            use crate::engine::Engine;
            use crate::scene::{Form, Link, STEP, Scene, Solid};
            use ferrode_math as math;
            use $rapier::prelude::*;

            type Real = $real;

            fn vector(v: math::Vec3) -> Vector {
                Vector::new(v.x as Real, v.y as Real, v.z as Real)
            }

            fn pose(p: &math::Pose) -> Pose {
                let q = p.rotation;
                let q = Rotation::from_xyzw(q.x as Real, q.y as Real, q.z as Real, q.w as Real);
                Pose::from_parts(vector(p.position), q.normalize())
            }

            /// A world.
            pub struct Rapier {
                gravity: Vector,
                parameters: IntegrationParameters,
                bodies: RigidBodySet,
                colliders: ColliderSet,
                handles: Vec<RigidBodyHandle>,
                islands: IslandManager,
                broad: BroadPhaseBvh,
                narrow: NarrowPhase,
                joints: ImpulseJointSet,
                multibodies: MultibodyJointSet,
                fast: CCDSolver,
                soft: SoftBodySet,
                pipeline: PhysicsPipeline,
            }

            fn collider(scene: &Scene, solid: &Solid) -> ColliderBuilder {
                // Its capsules and cylinders lie along y.
                let upright = math::Quat::from_axis_angle(math::Vec3::X, core::f64::consts::FRAC_PI_2);
                let upright = pose(&math::Pose::new(math::Vec3::ZERO, upright));
                let builder = match &solid.form {
                    Form::Cuboid(sides) => {
                        let h = *sides * 0.5;
                        ColliderBuilder::cuboid(h.x as Real, h.y as Real, h.z as Real)
                    }
                    Form::Sphere(radius) => ColliderBuilder::ball(*radius as Real),
                    Form::Capsule(radius, length) => {
                        ColliderBuilder::capsule_z((0.5 * length) as Real, *radius as Real)
                    }
                    Form::Cylinder(radius, length) => {
                        ColliderBuilder::cylinder((0.5 * length) as Real, *radius as Real).position(upright)
                    }
                    Form::Mesh(vertices, triangles) => {
                        let vertices = vertices.iter().copied().map(vector).collect();
                        ColliderBuilder::trimesh(vertices, triangles.clone()).expect("Rapier takes the mesh")
                    }
                };
                let groups = if solid.ghost {
                    InteractionGroups::new(Group::GROUP_2, Group::GROUP_1, InteractionTestMode::And)
                } else {
                    InteractionGroups::new(Group::GROUP_1, Group::ALL, InteractionTestMode::And)
                };
                builder
                    .density(solid.density.unwrap_or(1000.0) as Real)
                    .friction(scene.friction as Real)
                    .collision_groups(groups)
            }

            impl Rapier {
                /// Panics if the engine does not take the scene.
                pub fn new(scene: &Scene, _threads: usize) -> Self {
                    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
                    let mut handles = Vec::new();
                    for solid in &scene.solids {
                        let builder = match solid.density {
                            Some(_) => RigidBodyBuilder::dynamic(),
                            None => RigidBodyBuilder::fixed(),
                        };
                        let builder = builder.pose(pose(&solid.pose)).linvel(vector(solid.velocity));
                        let handle = bodies.insert(builder.can_sleep(scene.sleeping));
                        colliders.insert_with_parent(collider(scene, solid), handle, &mut bodies);
                        handles.push(handle);
                    }
                    let origin = bodies.insert(RigidBodyBuilder::fixed());
                    let mut joints = ImpulseJointSet::new();
                    for joint in &scene.joints {
                        let (a, b) = (handles[joint.a], joint.b.map_or(origin, |b| handles[b]));
                        let place = |solid: Option<usize>| {
                            let pose = solid.map_or(math::Pose::IDENTITY, |i| scene.solids[i].pose);
                            vector(pose.inverse_transform_point(joint.anchor))
                        };
                        // Solids of one joint start unturned against each other, so one axis serves both.
                        let turn = scene.solids[joint.a].pose;
                        match joint.link {
                            Link::Ball => {
                                let joint = SphericalJointBuilder::new()
                                    .local_anchor1(place(Some(joint.a)))
                                    .local_anchor2(place(joint.b))
                                    .contacts_enabled(false);
                                joints.insert(a, b, joint, true);
                            }
                            Link::Hinge { axis, stops, brake } => {
                                let axis = vector(turn.inverse_transform_vector(axis)).normalize();
                                let mut builder = RevoluteJointBuilder::new(axis)
                                    .local_anchor1(place(Some(joint.a)))
                                    .local_anchor2(place(joint.b))
                                    .contacts_enabled(false);
                                if let Some((low, high)) = stops {
                                    // The angle is that of the second body against the first.
                                    builder = builder.limits([-high as Real, -low as Real]);
                                }
                                if let Some(torque) = brake {
                                    builder = builder
                                        .motor_model(MotorModel::ForceBased)
                                        .motor_velocity(0.0, 1e4)
                                        .motor_max_force(torque as Real);
                                }
                                joints.insert(a, b, builder, true);
                            }
                        }
                    }
                    let mut parameters = IntegrationParameters::default();
                    parameters.dt = STEP as Real;
                    Self {
                        gravity: vector(math::Vec3::Z * -scene.gravity),
                        parameters,
                        bodies,
                        colliders,
                        handles,
                        islands: IslandManager::new(),
                        broad: BroadPhaseBvh::new(),
                        narrow: NarrowPhase::new(),
                        joints,
                        multibodies: MultibodyJointSet::new(),
                        fast: CCDSolver::new(),
                        soft: SoftBodySet::new(),
                        pipeline: PhysicsPipeline::new(),
                    }
                }
            }

            impl Engine for Rapier {
                fn about(&self) -> String {
                    concat!($name, " 0.36.1, its defaults").into()
                }

                fn step(&mut self) {
                    self.pipeline.step(
                        self.gravity,
                        &self.parameters,
                        &mut self.islands,
                        &mut self.broad,
                        &mut self.narrow,
                        &mut self.bodies,
                        &mut self.colliders,
                        &mut self.joints,
                        &mut self.multibodies,
                        &mut self.soft,
                        &mut self.fast,
                        &(),
                        &(),
                    );
                }

                fn poses(&self, out: &mut Vec<math::Pose>) {
                    let wide = |x: Real| f64::from(x);
                    out.clear();
                    out.extend(self.handles.iter().map(|h| {
                        let p = self.bodies[*h].position();
                        let (t, q) = (p.translation, p.rotation);
                        math::Pose::new(
                            math::Vec3::new(wide(t.x), wide(t.y), wide(t.z)),
                            math::Quat::from_parts(
                                wide(q.w),
                                math::Vec3::new(wide(q.x), wide(q.y), wide(q.z)),
                            ),
                        )
                    }));
                }
            }
        }
    };
}

engine!(single, rapier3d, f32, "rapier3d");
engine!(double, rapier3d_f64, f64, "rapier3d-f64");
