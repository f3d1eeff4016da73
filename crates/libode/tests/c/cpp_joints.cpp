/* C++: worlds, bodies, groups and joints by their classes, as a program of a small robot uses them. */
#include "check.h"

static void line(const char *name, const dReal *x, int n) { show(name, x, n); }

int main() {
    dInitODE2(0);
    {
        dWorld world;
        world.setGravity(0, 0, -9.81);
        world.setERP(0.3);
        world.setCFM(1e-5);
        show1("erp", world.getERP());
        dBody base(world), arm(world), hand(world);
        dMass m;
        m.setBox(1, 1, 0.5, 0.2);
        base.setMass(m);
        m.setCapsule(2, 3, 0.1, 0.8);
        m.adjust(0.5);
        arm.setMass(m);
        m.setSphere(3, 0.2);
        hand.setMass(m);
        arm.setPosition(0, 0, 0.6);
        hand.setPosition(0.1, 0, 1.2);
        dFixedJoint ground(world);
        ground.attach(base, 0);
        ground.set();
        dHingeJoint shoulder(world);
        shoulder.attach(base, arm);
        shoulder.setAnchor(0, 0, 0.1);
        shoulder.setAxis(0, 1, 0);
        shoulder.setParam(dParamLoStop, -0.5);
        shoulder.setParam(dParamHiStop, 0.5);
        dUniversalJoint wrist(world);
        wrist.attach(arm, hand);
        wrist.setAnchor(0.05, 0, 1.1);
        wrist.setAxis1(1, 0, 0);
        wrist.setAxis2(0, 1, 0);
        dJointFeedback force;
        shoulder.setFeedback(&force);
        for (int i = 0; i < 20; i++) {
            if (i == 10) shoulder.addTorque(-3);
            arm.addRelForce(0.2, 0.1, 0);
            if (i % 2) world.step(0.02); else world.quickStep(0.02);
        }
        line("arm", arm.getPosition(), 3);
        line("hand", hand.getPosition(), 3);
        line("turn", hand.getAngularVel(), 3);
        show1("angle", shoulder.getAngle());
        show1("rate", shoulder.getAngleRate());
        show1("wrist", wrist.getAngle1());
        line("force", force.f1, 3);
        showi("joints", arm.getNumJoints());
        showi("linked", arm.isConnectedTo(hand) + 10 * base.isConnectedTo(hand));
        dJointGroup group;
        dContact c;
        memset(&c, 0, sizeof c);
        c.surface.mu = 1;
        c.geom.normal[2] = 1;
        c.geom.depth = 0.01;
        /* The group destroys the joint; the wrapper must not do so again, and stays. */
        static dContactJoint *contact;
        contact = new dContactJoint(world, group, &c);
        contact->attach(hand, 0);
        showi("with contact", hand.getNumJoints());
        group.empty();
        showi("without", hand.getNumJoints());
        hand.disable();
        showi("enabled", hand.isEnabled());
    }
    dCloseODE();
    return 0;
}
