/* What the programs here share: names for ODE's precision, a ground, contacts, and drawing of any geom. */
#ifndef DEMO_H
#define DEMO_H

#include <drawstuff/drawstuff.h>
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef dDOUBLE
#define dsDrawBox dsDrawBoxD
#define dsDrawSphere dsDrawSphereD
#define dsDrawCylinder dsDrawCylinderD
#define dsDrawCapsule dsDrawCapsuleD
#define dsDrawTriangle dsDrawTriangleD
#define dsDrawTriangles dsDrawTrianglesD
#define dsDrawLine dsDrawLineD
#define dsDrawConvex dsDrawConvexD
#endif

static dWorldID world;
static dSpaceID space;
static dJointGroupID contacts;

/* What contacts are like; a program may change it before its first step. */
static dSurfaceParameters surface = {.mode = dContactApprox1, .mu = 0.8};

static void near(void *unused, dGeomID a, dGeomID b) {
    enum { MOST = 8 };
    dContact contact[MOST];
    dBodyID first, second;
    int i, n;
    (void)unused;
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
        dSpaceCollide2(a, b, unused, near);
        return;
    }
    first = dGeomGetBody(a), second = dGeomGetBody(b);
    if (first && second && dAreConnectedExcluding(first, second, dJointTypeContact)) return;
    memset(contact, 0, sizeof contact);
    n = dCollide(a, b, MOST, &contact[0].geom, sizeof contact[0]);
    for (i = 0; i < n; i++) {
        contact[i].surface = surface;
        dJointAttach(dJointCreateContact(world, contacts, &contact[i]), first, second);
    }
}

/* A world with gravity and a ground. */
static void make_world(void) {
    dInitODE2(0);
    world = dWorldCreate();
    space = dHashSpaceCreate(0);
    contacts = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, 0, -9.81);
    dCreatePlane(space, 0, 0, 1, 0);
}

static void destroy_world(void) {
    dJointGroupDestroy(contacts);
    dSpaceDestroy(space);
    dWorldDestroy(world);
    dCloseODE();
}

/* Contacts within a space, and within the spaces in it. */
static void collide(dSpaceID within) {
    int i;
    dSpaceCollide(within, 0, near);
    for (i = 0; i < dSpaceGetNumGeoms(within); i++) {
        dGeomID geom = dSpaceGetGeom(within, i);
        if (dGeomIsSpace(geom)) collide((dSpaceID)geom);
    }
}

/* Finds contacts and steps, some times. */
static void advance(int times, dReal step) {
    while (times-- > 0) {
        collide(space);
        dWorldQuickStep(world, step);
        dJointGroupEmpty(contacts);
    }
}

/* A body with a geom, of a density. */
static dBodyID give_body(dGeomID geom, dReal density, dReal x, dReal y, dReal z) {
    dBodyID body = dBodyCreate(world);
    dMass mass;
    dReal radius, length;
    dVector3 sides;
    switch (dGeomGetClass(geom)) {
    case dBoxClass:
        dGeomBoxGetLengths(geom, sides);
        dMassSetBox(&mass, density, sides[0], sides[1], sides[2]);
        break;
    case dCapsuleClass:
        dGeomCapsuleGetParams(geom, &radius, &length);
        dMassSetCapsule(&mass, density, 3, radius, length);
        break;
    case dCylinderClass:
        dGeomCylinderGetParams(geom, &radius, &length);
        dMassSetCylinder(&mass, density, 3, radius, length);
        break;
    default:
        dMassSetSphere(&mass, density, dGeomGetClass(geom) == dSphereClass ? dGeomSphereGetRadius(geom) : 0.3);
    }
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, x, y, z);
    return body;
}

/* Draws a geom that has a place. */
static void draw(dGeomID geom) {
    const dReal *at, *turn;
    dReal radius, length;
    dVector3 sides;
    if (dGeomGetClass(geom) == dPlaneClass || dGeomGetClass(geom) == dRayClass) return;
    at = dGeomGetPosition(geom), turn = dGeomGetRotation(geom);
    switch (dGeomGetClass(geom)) {
    case dBoxClass:
        dGeomBoxGetLengths(geom, sides);
        dsDrawBox(at, turn, sides);
        break;
    case dSphereClass:
        dsDrawSphere(at, turn, (float)dGeomSphereGetRadius(geom));
        break;
    case dCapsuleClass:
        dGeomCapsuleGetParams(geom, &radius, &length);
        dsDrawCapsule(at, turn, (float)length, (float)radius);
        break;
    case dCylinderClass:
        dGeomCylinderGetParams(geom, &radius, &length);
        dsDrawCylinder(at, turn, (float)length, (float)radius);
        break;
    default:
        break;
    }
}

/* Draws all geoms of the space. */
static void draw_all(void) {
    int i;
    for (i = 0; i < dSpaceGetNumGeoms(space); i++) draw(dSpaceGetGeom(space, i));
}

static void view(float x, float y, float z, float heading, float pitch) {
    float xyz[3] = {x, y, z}, hpr[3] = {heading, pitch, 0};
    dsSetViewpoint(xyz, hpr);
}

/* A program: what happens at its start, at a frame, at a key. */
static int show(int argc, char **argv, void (*start)(void), void (*step)(int), void (*command)(int)) {
    dsFunctions functions = {DS_VERSION, start, step, command, 0, 0};
    dsSimulationLoop(argc, argv, DS_SIMULATION_DEFAULT_WIDTH, DS_SIMULATION_DEFAULT_HEIGHT, &functions);
    destroy_world();
    return 0;
}

#endif
