/* A ball falls on the ground, bounces, and comes to rest: a world, a space, and contact joints.

   gcc bouncing_ball.c -o bouncing_ball `pkg-config ode --cflags --libs`
   ./bouncing_ball */
#include <ode/ode.h>
#include <stdio.h>

static dWorldID world;
static dSpaceID space;
static dJointGroupID contacts;

/* Called for each pair of geoms that may touch: find the contacts, and make a joint of each. The joints live for one
   step. */
static void near_callback(void *data, dGeomID o1, dGeomID o2) {
    dContact contact[4];
    int i, count = dCollide(o1, o2, 4, &contact[0].geom, sizeof(dContact));
    (void)data;
    for (i = 0; i < count; i++) {
        dJointID joint;
        contact[i].surface.mode = dContactBounce;
        contact[i].surface.mu = dInfinity;
        contact[i].surface.bounce = REAL(0.7);
        contact[i].surface.bounce_vel = REAL(0.1);
        joint = dJointCreateContact(world, contacts, &contact[i]);
        dJointAttach(joint, dGeomGetBody(contact[i].geom.g1), dGeomGetBody(contact[i].geom.g2));
    }
}

int main(void) {
    const dReal stepsize = REAL(0.01);
    dBodyID ball;
    dGeomID geom;
    dMass mass;
    int i;

    dInitODE2(0);
    world = dWorldCreate();
    space = dHashSpaceCreate(0);
    contacts = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, 0, REAL(-9.81));
    dCreatePlane(space, 0, 0, 1, 0);

    /* A body is a mass that moves; a geom is a shape that touches. Tied together they are a ball. */
    ball = dBodyCreate(world);
    dMassSetSphereTotal(&mass, 1, REAL(0.5));
    dBodySetMass(ball, &mass);
    geom = dCreateSphere(space, REAL(0.5));
    dGeomSetBody(geom, ball);
    dBodySetPosition(ball, 0, 0, 3);

    for (i = 0; i <= 500; i++) {
        if (i % 25 == 0) {
            const dReal *p = dBodyGetPosition(ball);
            printf("%4.2f s  height %.3f m\n", i * stepsize, p[2]);
        }
        dSpaceCollide(space, 0, near_callback);
        dWorldQuickStep(world, stepsize);
        dJointGroupEmpty(contacts);
    }

    dJointGroupDestroy(contacts);
    dSpaceDestroy(space);
    dWorldDestroy(world);
    dCloseODE();
    return 0;
}
