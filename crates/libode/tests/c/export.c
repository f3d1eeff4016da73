/* A world with geoms and every joint, exported as text; braces and commas become blanks, so that numbers compare. */
#include "check.h"

int main(){ dInitODE2(0); dWorldID w=dWorldCreate(); dBodyID a=dBodyCreate(w),b=dBodyCreate(w); dBodySetPosition(a,1,2,3); dBodySetForce(a,1,2,3); dBodySetTorque(a,1,2,3); dBodySetAutoDisableFlag(a,1); dBodySetFiniteRotationMode(a,1); dBodySetFiniteRotationAxis(a,0,0,1); dBodySetGravityMode(a,0); dBodyDisable(b);
dGeomID g=dCreateBox(0,1,2,3); dGeomSetBody(g,a); dGeomSetCategoryBits(g,1); dGeomSetCollideBits(g,2); dGeomDisable(g);
dGeomID s=dCreateSphere(0,1); dGeomSetBody(s,a);dGeomID c=dCreateCapsule(0,1,2); dGeomSetBody(c,a);dGeomID y=dCreateCylinder(0,1,2); dGeomSetBody(y,b);dGeomID r=dCreateRay(0,1); dGeomSetBody(r,b);dGeomSetOffsetPosition(y,1,2,3);
dJointID j;
#define J(T) j=dJointCreate##T(w,0); dJointAttach(j,a,b);
J(Ball) dJointSetBallAnchor(j,1,1,1);
J(Hinge) dJointSetHingeAxis(j,0,0,1); dJointSetHingeParam(j,dParamVel,1); dJointSetHingeParam(j,dParamFMax,2); dJointSetHingeParam(j,dParamBounce,0.5);
J(Slider) J(Universal) J(Hinge2) J(PR) J(PU) J(Piston) J(Fixed) J(Null) J(AMotor) dJointSetAMotorNumAxes(j,2); J(LMotor) dJointSetLMotorNumAxes(j,1); dJointSetLMotorAxis(j,0,0,1,0,0); J(Plane2D) J(DBall) J(DHinge) J(Transmission)
j=dJointCreateHinge(w,0); dJointAttach(j,0,a); 
dContact k; memset(&k,0,sizeof k); k.surface.mode=0x7fff; k.surface.mu=1; k.geom.normal[2]=1; j=dJointCreateContact(w,0,&k); dJointAttach(j,a,0); k.surface.mu=dInfinity; k.surface.mode=dContactApprox1; j=dJointCreateContact(w,0,&k);
static char text[100000];
    FILE *file = fmemopen(text, sizeof text, "w");
    dWorldExportDIF(w, file, "X_");
    fclose(file);
    for (char *p = text; *p; p++) putchar(strchr("{},", *p) ? ' ' : *p);
    return 0;
}
