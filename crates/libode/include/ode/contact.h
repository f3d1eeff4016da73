/* What two surfaces do where they touch. */
#ifndef FERRODE_ODE_CONTACT_H
#define FERRODE_ODE_CONTACT_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bits of dSurfaceParameters.mode: which members beyond mu count, and which friction bounds are fractions of the normal
   force (dContactApprox...). */
enum {
    dContactMu2 = 0x001,
    dContactAxisDep = 0x001,
    dContactFDir1 = 0x002,
    dContactBounce = 0x004,
    dContactSoftERP = 0x008,
    dContactSoftCFM = 0x010,
    dContactMotion1 = 0x020,
    dContactMotion2 = 0x040,
    dContactMotionN = 0x080,
    dContactSlip1 = 0x100,
    dContactSlip2 = 0x200,
    dContactRolling = 0x400,
    dContactApprox0 = 0x0000,
    dContactApprox1_1 = 0x1000,
    dContactApprox1_2 = 0x2000,
    dContactApprox1_N = 0x4000,
    dContactApprox1 = 0x7000
};

/* The surface: friction, bounce, softness, motion and slip along the two friction directions and the normal. */
typedef struct dSurfaceParameters {
    int mode;
    dReal mu;
    dReal mu2;
    dReal rho;
    dReal rho2;
    dReal rhoN;
    dReal bounce;
    dReal bounce_vel;
    dReal soft_erp;
    dReal soft_cfm;
    dReal motion1;
    dReal motion2;
    dReal motionN;
    dReal slip1;
    dReal slip2;
} dSurfaceParameters;

/* The place: a point, the unit normal that points into g1, the depth along it, and which triangle or part of each geom is
   meant (-1 for none). */
typedef struct dContactGeom {
    dVector3 pos;
    dVector3 normal;
    dReal depth;
    dGeomID g1;
    dGeomID g2;
    int side1;
    int side2;
} dContactGeom;

/* Both, with the first friction direction: what a contact joint is made of. */
typedef struct dContact {
    dSurfaceParameters surface;
    dContactGeom geom;
    dVector3 fdir1;
} dContact;

#ifdef __cplusplus
}
#endif

#endif
