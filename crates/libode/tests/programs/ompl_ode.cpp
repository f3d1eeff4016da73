// Debian's OMPL with its ODE extension: a box is pushed over a plane with obstacles; states are read, written, propagated,
// checked, and a planner looks for a way.
#include <ompl/extensions/ode/OpenDESimpleSetup.h>
#include <ompl/base/goals/GoalRegion.h>
#include <ompl/util/RandomNumbers.h>
#include <ompl/util/Console.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/control/planners/kpiece/KPIECE1.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <cstdio>
namespace oc = ompl::control;
namespace ob = ompl::base;

struct Environment : oc::OpenDEEnvironment {
    Environment() {
        bodyWorld = dWorldCreate();
        space = dHashSpaceCreate(0);
        dWorldSetGravity(bodyWorld, 0, 0, -9.81);
        dCreatePlane(space, 0, 0, 1, 0);
        for (int i = 0; i < 2; ++i) {
            dBodyID b = dBodyCreate(bodyWorld);
            dMass m;
            dMassSetBoxTotal(&m, 1 + i, 0.8, 0.6, 0.4);
            dBodySetMass(b, &m);
            dGeomID g = dCreateBox(space, 0.8, 0.6, 0.4);
            dGeomSetBody(g, b);
            dBodySetPosition(b, 1.5 * i, 0.2 * i, 0.2);
            stateBodies_.push_back(b);
        }
        wall = dCreateBox(space, 0.5, 4, 2);
        dGeomSetPosition(wall, 5, 0, 1);
        setPlanningParameters();
    }
    ~Environment() override { dSpaceDestroy(space); dWorldDestroy(bodyWorld); }
    void setPlanningParameters() {
        world_ = bodyWorld;
        collisionSpaces_.push_back(space);
        stepSize_ = 0.02;
        maxContacts_ = 8;
        minControlSteps_ = 5;
        maxControlSteps_ = 40;
    }
    unsigned int getControlDimension() const override { return 2; }
    void getControlBounds(std::vector<double> &low, std::vector<double> &high) const override {
        low.assign(2, -4);
        high.assign(2, 4);
    }
    void applyControl(const double *control) const override {
        dBodyAddForce(stateBodies_[0], control[0], control[1], 0);
    }
    bool isValidCollision(dGeomID, dGeomID, const dContact &) const override { return true; }
    void setupContact(dGeomID, dGeomID, dContact &contact) const override {
        contact.surface.mode = dContactSoftCFM | dContactApprox1;
        contact.surface.mu = 0.2;
        contact.surface.soft_cfm = 1e-5;
    }
    dWorldID bodyWorld;
    dSpaceID space;
    dGeomID wall;
};

struct Goal : ob::GoalRegion {
    Goal(const ob::SpaceInformationPtr &si) : GoalRegion(si) { threshold_ = 0.4; }
    double distanceGoal(const ob::State *state) const override {
        const double *p = state->as<oc::OpenDEStateSpace::StateType>()->getBodyPosition(0);
        return std::hypot(p[0] + 1, p[1] - 1);
    }
};

// Where the first box is.
struct Places : ob::ProjectionEvaluator {
    Places(const ob::StateSpacePtr &space) : ProjectionEvaluator(space) {}
    unsigned int getDimension() const override { return 2; }
    void defaultCellSizes() override { cellSizes_ = {0.2, 0.2}; }
    void project(const ob::State *state, Eigen::Ref<Eigen::VectorXd> to) const override {
        const double *p = state->as<oc::OpenDEStateSpace::StateType>()->getBodyPosition(0);
        to[0] = p[0];
        to[1] = p[1];
    }
};

static void show(const char *name, const ob::State *state) {
    auto *s = state->as<oc::OpenDEStateSpace::StateType>();
    for (int i = 0; i < 2; ++i) {
        const double *p = s->getBodyPosition(i), *v = s->getBodyLinearVelocity(i), *w = s->getBodyAngularVelocity(i);
        const auto &q = s->getBodyRotation(i);
        printf("%s %.12g %.12g %.12g  %.12g %.12g %.12g %.12g  %.12g %.12g %.12g  %.12g %.12g %.12g\n", name, p[0], p[1], p[2],
            q.x, q.y, q.z, q.w, v[0], v[1], v[2], w[0], w[1], w[2]);
    }
}

int main() {
    ompl::RNG::setSeed(1);
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    dInitODE2(0);
    {
        auto environment = std::make_shared<Environment>();
        dRandSetSeed(1);
        auto stateSpace = std::make_shared<oc::OpenDEStateSpace>(environment);
        oc::OpenDESimpleSetup setup{ob::StateSpacePtr(stateSpace)};
        stateSpace->setDefaultBounds();
        auto si = setup.getSpaceInformation();
        si->setup();
        ob::State *from = si->allocState(), *to = si->allocState();
        stateSpace->readState(from);
        show("start", from);
        oc::Control *control = si->allocControl();
        auto *u = control->as<oc::OpenDEControlSpace::ControlType>();
        for (int i = 0; i < 12; ++i) {
            u->values[0] = 3.0 * (i % 3) - 1;
            u->values[1] = 2.0 - 0.5 * i;
            unsigned steps = si->propagateWhileValid(from, control, 15, to);
            printf("steps %u collision %d valid %d\n", steps, (int)stateSpace->evaluateCollision(to), (int)si->isValid(to));
            show("state", to);
            si->copyState(from, to);
        }
        stateSpace->writeState(from);
        ob::ScopedState<> start(stateSpace);
        stateSpace->readState(start.get());
        setup.setStartState(start);
        setup.setGoal(std::make_shared<Goal>(si));
        setup.setPlanner(std::make_shared<oc::RRT>(si));
        ob::IterationTerminationCondition iterations(60);
        ob::PlannerTerminationCondition limit = iterations;
        auto status = setup.solve(limit);
        printf("solved %s, states %zu\n", status.asString().c_str(), setup.haveSolutionPath() ? setup.getSolutionPath().getStateCount() : 0);
        if (setup.haveSolutionPath()) show("end", setup.getSolutionPath().getStates().back());
        // A planner that projects states, to an easy goal; the way it found is driven again, control by control.
        stateSpace->writeState(start.get());
        stateSpace->registerDefaultProjection(std::make_shared<Places>(stateSpace));
        setup.clear();
        setup.setStartState(start);
        auto near = std::make_shared<Goal>(si);
        near->setThreshold(1.2);
        setup.setGoal(near);
        auto kpiece = std::make_shared<oc::KPIECE1>(si);
        kpiece->setProjectionEvaluator(std::make_shared<Places>(stateSpace));
        setup.setPlanner(kpiece);
        ob::IterationTerminationCondition more(3000);
        ob::PlannerTerminationCondition enough = more;
        status = setup.solve(enough);
        printf("solved %s\n", status.asString().c_str());
        if (setup.haveSolutionPath()) {
            auto &path = setup.getSolutionPath();
            printf("path of %zu states, %.9g seconds\n", path.getStateCount(), path.length());
            si->copyState(from, path.getState(0));
            for (std::size_t i = 0; i < path.getControlCount(); ++i) {
                unsigned steps = std::lround(path.getControlDuration(i) / si->getPropagationStepSize());
                si->propagate(from, path.getControl(i), steps, to);
                printf("control %zu for %u steps\n", i, steps);
                show("driven", to);
                show("planned", path.getState(i + 1));
                si->copyState(from, to);
            }
        }
        si->freeControl(control);
        si->freeState(from);
        si->freeState(to);
    }
    dCloseODE();
    return 0;
}
