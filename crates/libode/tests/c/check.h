/* What the test programs share. Each prints what it sees, line by line: a name and numbers. The same program is run on
   libode and on this library, and the numbers are compared. */
#ifndef CHECK_H
#define CHECK_H
#include <math.h>
#include <ode/ode.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline void show(const char *name, const dReal *x, int n) {
    printf("%s", name);
    for (int i = 0; i < n; i++) printf(" %.15g", (double)x[i] + 0.0);
    printf("\n");
}
static inline void show1(const char *name, dReal x) { show(name, &x, 1); }
static inline void showi(const char *name, long x) { printf("%s %ld\n", name, x); }

#define V3(call, ...) do { dVector3 v_ = {0, 0, 0, 0}; call(__VA_ARGS__, v_); show(#call ":", v_, 3); } while (0)
#define R1(call, ...) show1(#call ":", call(__VA_ARGS__))
#define I1(call, ...) showi(#call ":", (long)call(__VA_ARGS__))

/* A line that begins with the name of a function and a colon, and shows what the call led to: a program that prints it
   has to print something else if that function does nothing. */
#define CHECK(f, x, n) do { (void)&f; show(#f ":", x, n); } while (0)
#define CHECK1(f, x) do { (void)&f; show1(#f ":", x); } while (0)
#define CHECKI(f, x) do { (void)&f; showi(#f ":", (long)(x)); } while (0)
#define MOVES(f, b) do { dReal m_[13]; motion(b, m_); CHECK(f, m_, 13); } while (0)

static inline void show_body(const char *name, dBodyID b) {
    char text[64];
    snprintf(text, sizeof text, "%s.position", name); show(text, dBodyGetPosition(b), 3);
    snprintf(text, sizeof text, "%s.quaternion", name); show(text, dBodyGetQuaternion(b), 4);
    snprintf(text, sizeof text, "%s.rotation", name); show(text, dBodyGetRotation(b), 12);
    snprintf(text, sizeof text, "%s.linear", name); show(text, dBodyGetLinearVel(b), 3);
    snprintf(text, sizeof text, "%s.angular", name); show(text, dBodyGetAngularVel(b), 3);
    snprintf(text, sizeof text, "%s.force", name); show(text, dBodyGetForce(b), 3);
    snprintf(text, sizeof text, "%s.torque", name); show(text, dBodyGetTorque(b), 3);
}

/* Position, quaternion, linear and angular velocity. */
static inline void motion(dBodyID b, dReal m[13]) {
    memcpy(m, dBodyGetPosition(b), 3 * sizeof *m);
    memcpy(m + 3, dBodyGetQuaternion(b), 4 * sizeof *m);
    memcpy(m + 7, dBodyGetLinearVel(b), 3 * sizeof *m);
    memcpy(m + 10, dBodyGetAngularVel(b), 3 * sizeof *m);
}

/* Two bodies in general position, with velocities. */
static inline void two_bodies(dWorldID w, dBodyID *a, dBodyID *b) {
    dMass m;
    dMatrix3 r;
    *a = dBodyCreate(w);
    *b = dBodyCreate(w);
    dMassSetBoxTotal(&m, 2, 0.5, 1, 1.5);
    dBodySetMass(*a, &m);
    dMassSetCylinderTotal(&m, 3, 2, 0.4, 1.2);
    dBodySetMass(*b, &m);
    dBodySetPosition(*a, 0.1, 0.2, 1.3);
    dBodySetPosition(*b, 1.4, -0.3, 1.1);
    dRFromAxisAndAngle(r, 1, 2, -1, 0.4);
    dBodySetRotation(*a, r);
    dRFromAxisAndAngle(r, -1, 0.5, 2, 0.7);
    dBodySetRotation(*b, r);
    dBodySetLinearVel(*a, 0.3, -0.2, 0.1);
    dBodySetAngularVel(*a, 0.2, 0.5, -0.4);
    dBodySetLinearVel(*b, -0.1, 0.4, 0.2);
    dBodySetAngularVel(*b, -0.3, 0.1, 0.6);
}
#endif
