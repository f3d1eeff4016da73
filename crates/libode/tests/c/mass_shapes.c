/* The mass functions, by name, each on a record that held something else before. */
#include "check.h"

static dMass m;
static const dReal *numbers(void) {
    static dReal x[13];
    x[0] = m.mass;
    memcpy(x + 1, m.c, 3 * sizeof *x);
    for (int i = 0; i < 9; i++) x[4 + i] = m.I[i / 3 * 4 + i % 3];
    return x;
}
#define MASS(f, ...) do { dMassSetSphereTotal(&m, 3, 0.7); f(&m, __VA_ARGS__); CHECK(f, numbers(), 13); } while (0)

int main(void) {
    dInitODE2(0);
    dMassSetSphereTotal(&m, 3, 0.7);
    dMassSetZero(&m);
    CHECK(dMassSetZero, numbers(), 13);
    MASS(dMassSetParameters, 2, 0.1, 0.2, 0.3, 3, 4, 5, 0.1, 0.2, 0.3);
    MASS(dMassSetSphere, 2, 0.5);
    MASS(dMassSetSphereTotal, 2, 0.5);
    MASS(dMassSetBox, 2, 1, 2, 3);
    MASS(dMassSetBoxTotal, 2, 1, 2, 3);
    MASS(dMassSetCapsule, 2, 1, 0.5, 2);
    MASS(dMassSetCapsuleTotal, 2, 2, 0.5, 2);
    MASS(dMassSetCappedCylinder, 3, 3, 0.5, 2);
    MASS(dMassSetCappedCylinderTotal, 4, 1, 0.5, 2);
    MASS(dMassSetCylinder, 2, 2, 0.5, 2);
    MASS(dMassSetCylinderTotal, 2, 3, 0.5, 2);
    MASS(dMassAdjust, 9);
    MASS(dMassTranslate, 1, 2, 3);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 1, 2, 3, 0.6);
    dMassSetBox(&m, 1, 1, 2, 3);
    dMassRotate(&m, r);
    CHECK(dMassRotate, numbers(), 13);
    dMass other;
    dMassSetBox(&other, 1, 2, 1, 1);
    dMassTranslate(&other, 1, 0, 0.5);
    dMassAdd(&m, &other);
    CHECK(dMassAdd, numbers(), 13);
    I1(dMassCheck, &m);

    static const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const unsigned faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data, corners, 12, 4, faces, 12, 12);
    dGeomID tetrahedron = dCreateTriMesh(0, data, 0, 0, 0);
    MASS(dMassSetTrimesh, 6, tetrahedron);
    MASS(dMassSetTrimeshTotal, 5, tetrahedron);
    dGeomDestroy(tetrahedron);
    dGeomTriMeshDataDestroy(data);

    dWorldID w = dWorldCreate();
    dBodyID b = dBodyCreate(w);
    dMassSetBoxTotal(&m, 5, 1, 2, 3);
    dBodySetMass(b, &m);
    dMassSetZero(&m);
    dBodyGetMass(b, &m);
    CHECK(dBodyGetMass, numbers(), 13);
    dBodyAddForce(b, 1, 2, 3);
    dBodyAddTorque(b, 3, 2, 1);
    dWorldStep(w, 0.1);
    MOVES(dBodySetMass, b);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
