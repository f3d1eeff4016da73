/* Mass, centre of mass and inertia of a body. */
#ifndef FERRODE_ODE_MASS_H
#define FERRODE_ODE_MASS_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dMass dMass;

/* 1 if it can be a body's: positive, and the inertia positive definite. */
ODE_API int dMassCheck(const dMass *m);

/* From numbers; inertia about the centre. */
ODE_API void dMassSetZero(dMass *mass);
ODE_API void dMassSetParameters(dMass *mass, dReal mass2, dReal cgx, dReal cgy, dReal cgz, dReal I11, dReal I22,
        dReal I33, dReal I12, dReal I13, dReal I23);

/* From solid shapes, by density or by total mass. Directions 1, 2 and 3 are x, y and z. */
ODE_API void dMassSetBox(dMass *mass, dReal density, dReal lx, dReal ly, dReal lz);
ODE_API void dMassSetBoxTotal(dMass *mass, dReal total, dReal lx, dReal ly, dReal lz);
ODE_API void dMassSetCapsule(dMass *mass, dReal density, int direction, dReal radius, dReal length);
ODE_API void dMassSetCapsuleTotal(dMass *mass, dReal total, int direction, dReal radius, dReal length);
ODE_API void dMassSetCylinder(dMass *mass, dReal density, int direction, dReal radius, dReal length);
ODE_API void dMassSetCylinderTotal(dMass *mass, dReal total, int direction, dReal radius, dReal length);
ODE_API void dMassSetSphere(dMass *mass, dReal density, dReal radius);
ODE_API void dMassSetSphereTotal(dMass *mass, dReal total, dReal radius);
ODE_API void dMassSetTrimesh(dMass *mass, dReal density, dGeomID g);
ODE_API void dMassSetTrimeshTotal(dMass *mass, dReal total, dGeomID g);

/* Old names of capsules. */
ODE_API ODE_API_DEPRECATED void dMassSetCappedCylinder(dMass *mass, dReal b, int c, dReal d, dReal e);
ODE_API ODE_API_DEPRECATED void dMassSetCappedCylinderTotal(dMass *mass, dReal b, int c, dReal d, dReal e);

/* Changed: scaled to another mass, moved, turned, joined by another. */
ODE_API void dMassAdd(dMass *mass, const dMass *b);
ODE_API void dMassAdjust(dMass *mass, dReal new_mass);
ODE_API void dMassRotate(dMass *mass, const dMatrix3 R);
ODE_API void dMassTranslate(dMass *mass, dReal x, dReal y, dReal z);

struct dMass {
    dReal mass;
    dVector3 c;
    dMatrix3 I;

#ifdef __cplusplus
    dMass() { dMassSetZero(this); }
    void setZero() { dMassSetZero(this); }
    void setParameters(dReal total, dReal cgx, dReal cgy, dReal cgz, dReal I11, dReal I22, dReal I33, dReal I12, dReal I13,
            dReal I23) {
        dMassSetParameters(this, total, cgx, cgy, cgz, I11, I22, I33, I12, I13, I23);
    }
    void setSphere(dReal density, dReal radius) { dMassSetSphere(this, density, radius); }
    void setSphereTotal(dReal total, dReal radius) { dMassSetSphereTotal(this, total, radius); }
    void setBox(dReal density, dReal lx, dReal ly, dReal lz) { dMassSetBox(this, density, lx, ly, lz); }
    void setBoxTotal(dReal total, dReal lx, dReal ly, dReal lz) { dMassSetBoxTotal(this, total, lx, ly, lz); }
    void setCapsule(dReal density, int direction, dReal radius, dReal length) {
        dMassSetCapsule(this, density, direction, radius, length);
    }
    void setCapsuleTotal(dReal total, int direction, dReal radius, dReal length) {
        dMassSetCapsuleTotal(this, total, direction, radius, length);
    }
    void setCylinder(dReal density, int direction, dReal radius, dReal length) {
        dMassSetCylinder(this, density, direction, radius, length);
    }
    void setCylinderTotal(dReal total, int direction, dReal radius, dReal length) {
        dMassSetCylinderTotal(this, total, direction, radius, length);
    }
    void setTrimesh(dReal density, dGeomID mesh) { dMassSetTrimesh(this, density, mesh); }
    void setTrimeshTotal(dReal total, dGeomID mesh) { dMassSetTrimeshTotal(this, total, mesh); }
    void adjust(dReal total) { dMassAdjust(this, total); }
    void translate(dReal x, dReal y, dReal z) { dMassTranslate(this, x, y, z); }
    void rotate(const dMatrix3 R) { dMassRotate(this, R); }
    void add(const dMass *other) { dMassAdd(this, other); }
#endif
};

#ifdef __cplusplus
}
#endif

#endif
