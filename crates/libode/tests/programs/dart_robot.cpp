// Debian's DART with ODE as its collision detector, as its users write it: a robot arm of four links with joint limits and a controller
// that sweeps a table clean of boxes and balls, 1,000 steps; then which of its links touch what, and what the detector says of distances.
#include <algorithm>
#include <cstdio>
#include <map>
#include <dart/collision/CollisionGroup.hpp>
#include <dart/collision/ode/ode.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CylinderShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/ShapeNode.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
using namespace dart::dynamics;

static void give_shape(BodyNode *body, const ShapePtr &shape, double mass) {
    auto *node = body->createShapeNodeWith<VisualAspect, CollisionAspect, DynamicsAspect>(shape);
    node->getDynamicsAspect()->setFrictionCoeff(0.4);
    Inertia inertia;
    inertia.setMass(mass);
    inertia.setMoment(shape->computeInertia(mass));
    body->setInertia(inertia);
}

int main() {
    auto world = std::make_shared<dart::simulation::World>();
    auto detector = dart::collision::OdeCollisionDetector::create();
    world->getConstraintSolver()->setCollisionDetector(detector);
    world->setGravity({0, 0, -9.81});
    world->setTimeStep(0.001);

    auto table = Skeleton::create("table");
    auto *top = table->createJointAndBodyNodePair<WeldJoint>().second;
    give_shape(top, std::make_shared<BoxShape>(Eigen::Vector3d(3, 3, 0.2)), 100);
    Eigen::Isometry3d below = Eigen::Isometry3d::Identity();
    below.translation().z() = -0.1;
    top->getParentJoint()->setTransformFromParentBodyNode(below);
    world->addSkeleton(table);

    auto arm = Skeleton::create("arm");
    BodyNode *parent = nullptr;
    for (int i = 0; i < 4; ++i) {
        RevoluteJoint::Properties joint;
        joint.mName = "joint" + std::to_string(i);
        joint.mAxis = i == 0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
        joint.mT_ParentBodyToJoint.translation() = i == 0 ? Eigen::Vector3d(0, 0, 0.3) : Eigen::Vector3d(0.25, 0, 0);
        joint.mT_ChildBodyToJoint.translation() = Eigen::Vector3d(-0.25, 0, 0);
        joint.mPositionLowerLimits[0] = -1.2;
        joint.mPositionUpperLimits[0] = i == 0 ? 2.5 : 1.2;
        joint.mDampingCoefficients[0] = 0.8;
        auto made = arm->createJointAndBodyNodePair<RevoluteJoint>(parent, joint, BodyNode::AspectProperties("link" + std::to_string(i)));
        made.first->setLimitEnforcement(true);
        parent = made.second;
        give_shape(parent, i % 2 ? ShapePtr(std::make_shared<BoxShape>(Eigen::Vector3d(0.46, 0.08, 0.08)))
                                 : ShapePtr(std::make_shared<BoxShape>(Eigen::Vector3d(0.46, 0.1, 0.06))), 0.8);
    }
    world->addSkeleton(arm);

    std::vector<SkeletonPtr> things;
    for (int i = 0; i < 6; ++i) {
        auto thing = Skeleton::create("thing" + std::to_string(i));
        auto *body = thing->createJointAndBodyNodePair<FreeJoint>().second;
        give_shape(body, i % 2 ? ShapePtr(std::make_shared<SphereShape>(0.08 + 0.01 * i))
                               : ShapePtr(std::make_shared<BoxShape>(Eigen::Vector3d(0.2, 0.15, 0.1 + 0.02 * i))), 0.2 + 0.1 * i);
        Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
        at.translation() = Eigen::Vector3d(0.5 + 0.17 * (i % 3), 0.25 + 0.35 * (i / 3), 0.12 + 0.02 * i);
        thing->setPositions(FreeJoint::convertToPositions(at));
        world->addSkeleton(thing);
        things.push_back(thing);
    }

    std::map<std::string, int> touches;
    for (int step = 0; step < 1000; ++step) {
        Eigen::VectorXd wanted(4);
        wanted << 1.6 * step / 1000.0, 0.15, 0.1, -0.05;
        arm->setForces(40 * (wanted - arm->getPositions()) - 4 * arm->getVelocities() + arm->getCoriolisAndGravityForces());
        world->step();
        for (auto &contact : world->getLastCollisionResult().getContacts()) {
            auto name = [](dart::collision::CollisionObject *o) {
                return o->getShapeFrame()->asShapeNode()->getBodyNodePtr()->getSkeleton()->getName();
            };
            auto a = name(contact.collisionObject1), b = name(contact.collisionObject2);
            touches[std::min(a, b) + " " + std::max(a, b)]++;
        }
        if (step % 100 == 99) {
            auto q = arm->getPositions(), v = arm->getVelocities();
            printf("arm %.9g %.9g %.9g %.9g  %.9g %.9g %.9g %.9g\n", q[0], q[1], q[2], q[3], v[0], v[1], v[2], v[3]);
            for (auto &thing : things) {
                auto p = thing->getPositions();
                printf("%s %.9g %.9g %.9g %.9g %.9g %.9g\n", thing->getName().c_str(), p[0], p[1], p[2], p[3], p[4], p[5]);
            }
        }
    }
    for (auto &touch : touches) printf("%s: %d contacts\n", touch.first.c_str(), touch.second);
    auto group = detector->createCollisionGroup(arm.get()), others = detector->createCollisionGroup();
    for (auto &thing : things) others->addShapeFramesOf(thing.get());
    dart::collision::CollisionOption option;
    dart::collision::CollisionResult result;
    printf("arm hits things %d\n", group->collide(others.get(), option, &result));
    others->addShapeFramesOf(table.get());
    result.clear();
    printf("things lie on the table %d\n", others->collide(option, &result));
    double deepest = 0;
    for (auto &contact : result.getContacts()) deepest = std::max(deepest, contact.penetrationDepth);
    printf("contacts %zu, deepest %.9g\n", result.getNumContacts(), deepest);
    others->removeShapeFramesOf(table.get());
    result.clear();
    printf("without it %d\n", others->collide(option, &result));
    return 0;
}
