/* Masses: every shape, sums, displacements, and what is wrong with bad ones. */
#include "check.h"

static void message(int number, const char *format, va_list ap) {
    char text[256];
    vsnprintf(text, sizeof text, format, ap);
    char *place = strstr(text, " [");
    if (place) *place = 0;
    printf("message %d: %s\n", number, text);
}

static void show_mass(const char *name, const dMass *m) {
    show(name, &m->mass, 1);
    show("  c", m->c, 3);
    show("  I", m->I, 12);
}

int main(void) {
    dMass m, n;
    dSetMessageHandler(message);
    dMassSetZero(&m);
    show_mass("zero", &m);
    dMassSetParameters(&m, 3, 0.1, 0.2, 0.3, 4, 5, 6, 0.1, 0.2, 0.3);
    show_mass("parameters", &m);
    dMassSetSphere(&m, 1000, 0.1);
    show_mass("sphere", &m);
    dMassSetSphereTotal(&m, 2, 0.1);
    show_mass("sphere total", &m);
    dMassSetBox(&m, 500, 1, 2, 3);
    show_mass("box", &m);
    dMassSetBoxTotal(&m, 5, 1, 2, 3);
    show_mass("box total", &m);
    for (int direction = 1; direction <= 3; direction++) {
        dMassSetCapsule(&m, 10, direction, 0.3, 1.2);
        show_mass("capsule", &m);
        dMassSetCapsuleTotal(&m, 2, direction, 0.3, 1.2);
        show_mass("capsule total", &m);
        dMassSetCappedCylinder(&m, 10, direction, 0.3, 1.2);
        show_mass("capped cylinder", &m);
        dMassSetCappedCylinderTotal(&m, 2, direction, 0.3, 1.2);
        show_mass("capped cylinder total", &m);
        dMassSetCylinder(&m, 10, direction, 0.3, 1.2);
        show_mass("cylinder", &m);
        dMassSetCylinderTotal(&m, 2, direction, 0.3, 1.2);
        show_mass("cylinder total", &m);
    }
    dMassSetBox(&m, 1, 1, 2, 3);
    dMassTranslate(&m, 1, 2, 3);
    show_mass("translated", &m);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 1, 1, 0, 0.5);
    dMassRotate(&m, r);
    show_mass("rotated", &m);
    dMassSetSphere(&n, 2, 0.5);
    dMassAdd(&m, &n);
    show_mass("sum", &m);
    dMassAdjust(&m, 10);
    show_mass("adjusted", &m);
    I1(dMassCheck, &m);
    dMassSetZero(&m);
    I1(dMassCheck, &m);
    dMassSetSphere(&m, -1, 1);
    show_mass("negative", &m);
    dMassSetSphereTotal(&m, 1, 1);
    m.I[0] = -1;
    I1(dMassCheck, &m);
    dMassSetSphereTotal(&m, 1, 1);
    m.c[0] = 2;
    I1(dMassCheck, &m);
    return 0;
}
