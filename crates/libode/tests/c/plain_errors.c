/* What programs do by mistake and libode forgives, or tells in words of its own: no offset on planes and spaces, null where
   nothing is to be destroyed, no numbers, a double hinge taken for a double ball, geoms of another class, indices. */
#include "check.h"
#include <setjmp.h>

static jmp_buf escape;
static char heard[200];
static void debug(int number, const char *format, va_list arguments) {
    int n = snprintf(heard, sizeof heard, "%d ", number);
    vsnprintf(heard + n, sizeof heard - n, format, arguments);
    /* Which of its functions finds the mistake is libode's own business. */
    if (strstr(heard, " in ")) *strstr(heard, " in ") = 0;
    longjmp(escape, 1);
}
#define TRY(call) do { if (!setjmp(escape)) { call; printf("%s\n", "done"); } else printf("%s\n", heard); } while (0)

int main(void) {
    dInitODE2(0);
    dSetDebugHandler(debug);
    dContactGeom c[4];
    const dVector3 middle = {0, 0, 0}, extents = {5, 5, 5};
    dSpaceID space = dSimpleSpaceCreate(0), other = dQuadTreeSpaceCreate(0, middle, extents, 3);
    dGeomID plane = dCreatePlane(0, 0, 0, 1, 2), ball = dCreateSphere(space, 1), box = dCreateBox(space, 1, 1, 1);
    dGeomID placeless[] = {plane, (dGeomID)space, (dGeomID)other};
    for (int i = 0; i < 3; i++) {
        dVector3 p = {7, 7, 7, 7};
        dMatrix3 r = {0};
        dQuaternion q;
        dGeomID g = placeless[i];
        showi("dGeomIsOffset", dGeomIsOffset(g));
        show("offset", dGeomGetOffsetPosition(g), 3);
        show("offset", dGeomGetOffsetRotation(g), 11);
        dGeomCopyOffsetPosition(g, p);
        dGeomCopyOffsetRotation(g, r);
        dGeomGetOffsetQuaternion(g, q);
        show("copy", p, 3);
        show("copy", r, 11);
        show("copy", q, 4);
        TRY(dGeomGetPosition(g));
        TRY(dGeomSetPosition(g, 1, 2, 3));
        TRY(dGeomSetBody(g, 0));
        TRY(dGeomClearOffset(g));
        TRY(dGeomSetOffsetPosition(g, 1, 2, 3));
    }
    TRY(dCooperativeDestroy(0));
    TRY(dResourceRequirementsDestroy(0));
    TRY(dResourceContainerDestroy(0));
    TRY(dGeomTriMeshDataDestroy(0));
    TRY(dThreadingFreeImplementation(0));
    TRY(dThreadingFreeThreadPool(0));
    TRY(dThreadingAllocateThreadPool(0, 0, 0, 0));
    TRY(dFree(0, 8));
    TRY(dGeomDestroy(dCreateHeightfield(0, 0, 1)));
    TRY(dSetZero(0, 0));
    TRY(dSetValue(0, 0, 1));
    TRY(dMakeRandomVector(0, 0, 1));
    TRY(dMakeRandomMatrix(0, 0, 0, 1));
    TRY(dClearUpperTriangle(0, 0));
    show1("dot", dDot(0, 0, 0));
    show1("difference", dMaxDifference(0, 0, 0, 0));

    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dJointID rod = dJointCreateDHinge(w, 0), ball_joint = dJointCreateBall(w, 0);
    dJointAttach(rod, a, b);
    dJointAttach(ball_joint, a, b);
    dJointSetDBallAnchor1(rod, 0.1, 0.2, 0.3);
    dJointSetDBallAnchor2(rod, 1, 0.5, 0.3);
    dJointSetDBallParam(rod, dParamCFM, 1e-4);
    V3(dJointGetDBallAnchor1, rod);
    V3(dJointGetDBallAnchor2, rod);
    R1(dJointGetDBallDistance, rod);
    R1(dJointGetDHingeDistance, rod);
    show1("cfm", dJointGetDBallParam(rod, dParamCFM));
    show1("cfm", dJointGetDHingeParam(rod, dParamCFM));
    TRY(dJointSetHingeAnchor(ball_joint, 0, 0, 0));
    TRY(dJointGetSliderPosition(ball_joint));
    TRY(dJointSetBallAnchor(rod, 0, 0, 0));
    TRY(dJointAttach(ball_joint, a, a));
    TRY(dJointGetNumBodies(0));
    TRY(dJointGetBallAnchor(ball_joint, 0));
    TRY(dWorldStep(0, 0.1));
    TRY(dWorldQuickStep(0, 0.1));
    TRY(dWorldStep(w, 0));
    TRY(dWorldQuickStep(w, -1));
    TRY(dBodySetMass(a, 0));
    TRY(dBodyGetPosition(0));
    TRY(dBodyGetNumJoints(0));
    TRY(dWorldSetGravity(0, 0, 0, 1));
    TRY(dGeomSphereGetRadius(box));
    TRY(dGeomSphereGetRadius(0));
    TRY(dGeomBoxSetLengths(ball, 1, 1, 1));
    TRY(dGeomBoxSetLengths(box, 1, -1, 1));
    TRY(dGeomCapsuleSetParams(ball, 1, 1));
    TRY(dGeomPlaneSetParams(0, 0, 0, 1, 0));
    TRY(dGeomRaySet(ball, 0, 0, 0, 0, 0, 1));
    TRY(dGeomTriMeshGetTriangleCount(ball));
    TRY(dGeomTriMeshGetLastTransform(ball));
    TRY(dGeomTriMeshDataUpdate(0));
    TRY(dGeomTransformGetGeom(ball));
    TRY(dGeomGetClassData(ball));
    TRY(dSpaceGetGeom(space, 2));
    TRY(dSpaceGetGeom(space, -1));
    TRY(dSpaceAdd(space, ball));
    TRY(dSpaceRemove(other, ball));
    TRY(dSpaceGetNumGeoms((dSpaceID)ball));
    TRY(dHashSpaceSetLevels(space, 1, 3));
    TRY(dCollide(ball, box, 0, c, sizeof *c));
    TRY(dSetColliderOverride(99, 0, 0));
    showi("itself", dCollide(ball, ball, 4, c, 1));
    showi("itself", dCollide((dGeomID)space, (dGeomID)space, 4, c, sizeof *c));
    TRY(dMassSetSphere(0, 1, 1));
    dMass m;
    TRY(dMassSetParameters(&m, 1, 0, 0, 0, 1, 1, 1, 2, 2, 2));
    TRY(dMassSetSphere(&m, -1, 1));
    TRY(dMassAdjust(&m, 0));
    TRY(dFactorCholesky(0, 3));
    TRY(dJointSetAMotorAxis(dJointCreateAMotor(w, 0), 5, 0, 1, 0, 0));
    TRY(dBodyGetJoint(a, 99));
    TRY(dCloseODE());
    TRY(dCloseODE());
    dWorldDestroy(w);
    dSpaceDestroy(space);
    dSpaceDestroy(other);
    dGeomDestroy(plane);
    return 0;
}
