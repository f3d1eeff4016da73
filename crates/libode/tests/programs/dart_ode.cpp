// Debian's DART with ODE as its collision detector: shapes of every kind, contacts, a simulation.
#include <memory>
#include <algorithm>
#include <dart/simulation/World.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/collision/CollisionGroup.hpp>
#include <dart/collision/CollisionResult.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/CapsuleShape.hpp>
#include <dart/dynamics/ShapeNode.hpp>
#include <dart/collision/ode/ode.hpp>
#include <algorithm>
#include <cstdio>
using namespace dart::dynamics;
using namespace dart::simulation;
using dart::collision::OdeCollisionDetector;

static SkeletonPtr make(const std::string &name, const ShapePtr &shape, const Eigen::Vector3d &at, bool fixed) {
    auto skeleton = Skeleton::create(name);
    BodyNode *body;
    if (fixed) body = skeleton->createJointAndBodyNodePair<WeldJoint>().second;
    else body = skeleton->createJointAndBodyNodePair<FreeJoint>().second;
    body->createShapeNodeWith<VisualAspect, CollisionAspect, DynamicsAspect>(shape);
    Eigen::Isometry3d t = Eigen::Isometry3d::Identity();
    t.translation() = at;
    if (fixed) body->getParentJoint()->setTransformFromParentBodyNode(t);
    else {
        t.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 0.5, 0.2).normalized()).toRotationMatrix();
        skeleton->setPositions(FreeJoint::convertToPositions(t));
    }
    return skeleton;
}

int main() {
    auto world = std::make_shared<World>();
    auto detector = OdeCollisionDetector::create();
    world->getConstraintSolver()->setCollisionDetector(detector);
    world->setGravity(Eigen::Vector3d(0, 0, -9.81));
    world->addSkeleton(make("ground", std::make_shared<BoxShape>(Eigen::Vector3d(10, 10, 0.2)), {0, 0, -0.1}, true));
    std::vector<ShapePtr> shapes = {std::make_shared<BoxShape>(Eigen::Vector3d(0.5, 0.4, 0.3)), std::make_shared<SphereShape>(0.25),
        std::make_shared<CapsuleShape>(0.2, 0.5), std::make_shared<SphereShape>(0.3)};
    std::vector<SkeletonPtr> bodies;
    for (size_t i = 0; i < shapes.size(); ++i) {
        bodies.push_back(make("body" + std::to_string(i), shapes[i], {1.2 * i, 0.1 * i, 0.6}, false));
        world->addSkeleton(bodies.back());
    }
    auto group = detector->createCollisionGroup();
    for (auto &b : bodies) group->addShapeFramesOf(b.get());
    group->addShapeFramesOf(world->getSkeleton("ground").get());
    dart::collision::CollisionOption option;
    dart::collision::CollisionResult result;
    for (int step = 0; step < 600; ++step) {
        world->step();
        if (step % 100 == 99) {
            result.clear();
            group->collide(option, &result);
            std::vector<double> depths;
            for (auto &c : result.getContacts()) depths.push_back(c.penetrationDepth);
            std::sort(depths.begin(), depths.end());
            printf("contacts %zu", depths.size());
            for (double d : depths) printf(" %.9g", d);
            printf("\n");
            for (auto &b : bodies) {
                auto p = b->getPositions();
                printf("%s", b->getName().c_str());
                for (int k = 0; k < 6; ++k) printf(" %.9g", p[k]);
                printf("\n");
            }
        }
    }
    return 0;
}
