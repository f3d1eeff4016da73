// What Bullet needs of C++: a world behind plain functions, for bullet.rs. Everything lives as long as the program.

#include <btBulletDynamicsCommon.h>

namespace {

// Who meets whom: ghosts pass through each other, and nothing fixed meets its like.
enum Group { SOLID = 1, GHOST = 2, FIXED = 4 };

struct World {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btAlignedObjectArray<btRigidBody *> bodies;
    bool sleeping;
};

btVector3 vector(const float *v) { return {v[0], v[1], v[2]}; }

// Position, then rotation as x, y, z, w.
btTransform transform(const float *pose) {
    return btTransform(btQuaternion(pose[3], pose[4], pose[5], pose[6]), vector(pose));
}

btRigidBody &body(World *world, int i) { return i < 0 ? btTypedConstraint::getFixedBody() : *world->bodies[i]; }

} // namespace

extern "C" {

World *bench_bullet_world(float gravity, bool sleeping) {
    auto *world = new World;
    world->world.setGravity({0, 0, -gravity});
    world->sleeping = sleeping;
    return world;
}

btCollisionShape *bench_bullet_box(const float *sides) { return new btBoxShape(vector(sides) * 0.5f); }

btCollisionShape *bench_bullet_sphere(float radius) { return new btSphereShape(radius); }

btCollisionShape *bench_bullet_capsule(float radius, float length) { return new btCapsuleShapeZ(radius, length); }

btCollisionShape *bench_bullet_cylinder(float radius, float length) {
    return new btCylinderShapeZ({radius, radius, 0.5f * length});
}

// The arrays are kept.
btCollisionShape *bench_bullet_mesh(float *vertices, int vertex_count, int *indices, int triangle_count) {
    auto *mesh = new btTriangleIndexVertexArray(triangle_count, indices, 3 * sizeof(int), vertex_count, vertices,
                                                3 * sizeof(float));
    return new btBvhTriangleMeshShape(mesh, true);
}

// A mass of zero is for what never moves.
void bench_bullet_body(World *world, btCollisionShape *shape, const float *pose, const float *velocity, float mass,
                       const float *inertia, float friction, bool ghost) {
    auto *state = new btDefaultMotionState(transform(pose));
    btRigidBody::btRigidBodyConstructionInfo info(mass, state, shape, vector(inertia));
    info.m_friction = friction;
    auto *body = new btRigidBody(info);
    body->setLinearVelocity(vector(velocity));
    if (!world->sleeping) {
        body->setActivationState(DISABLE_DEACTIVATION);
    }
    int group = mass == 0 ? FIXED : ghost ? GHOST : SOLID;
    int meets = mass == 0 ? SOLID | GHOST : ghost ? SOLID | FIXED : SOLID | GHOST | FIXED;
    world->world.addRigidBody(body, group, meets);
    world->bodies.push_back(body);
}

void bench_bullet_ball(World *world, int a, int b, const float *at_a, const float *at_b) {
    auto *joint = new btPoint2PointConstraint(body(world, a), body(world, b), vector(at_a), vector(at_b));
    world->world.addConstraint(joint, true);
}

// The hinge's axis is the z axis of the two frames. No stops where low > high; a brake's torque as an impulse over a step.
void bench_bullet_hinge(World *world, int a, int b, const float *frame_a, const float *frame_b, float low, float high,
                        float brake) {
    auto *joint = new btHingeConstraint(body(world, a), body(world, b), transform(frame_a), transform(frame_b));
    joint->setLimit(low, high);
    if (brake > 0) {
        joint->enableAngularMotor(true, 0, brake);
    }
    world->world.addConstraint(joint, true);
}

void bench_bullet_step(World *world, float step) { world->world.stepSimulation(step, 0); }

void bench_bullet_pose(const World *world, int i, float *pose) {
    const btTransform &at = world->bodies[i]->getWorldTransform();
    const btQuaternion turn = at.getRotation();
    for (int k = 0; k < 3; ++k) {
        pose[k] = at.getOrigin()[k];
        pose[3 + k] = turn[k];
    }
    pose[6] = turn.w();
}

int bench_bullet_version() { return btGetVersion(); }
}
