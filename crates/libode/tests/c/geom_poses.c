/* Geoms: poses shared with bodies, offsets, boxes, bits, and each class's own parameters. */
#include "check.h"

static void show_geom(const char *name, dGeomID g) {
    char text[64];
    dReal aabb[6];
    dQuaternion q;
    snprintf(text, sizeof text, "%s.position", name); show(text, dGeomGetPosition(g), 3);
    snprintf(text, sizeof text, "%s.rotation", name); show(text, dGeomGetRotation(g), 12);
    dGeomGetQuaternion(g, q);
    snprintf(text, sizeof text, "%s.quaternion", name); show(text, q, 4);
    dGeomGetAABB(g, aabb);
    snprintf(text, sizeof text, "%s.aabb", name); show(text, aabb, 6);
}

static void show_offset(dGeomID g) {
    dVector3 p = {7, 7, 7, 7};
    dMatrix3 r;
    dQuaternion q;
    for (int i = 0; i < 12; i++) r[i] = 5;
    I1(dGeomIsOffset, g);
    show("offset.position", dGeomGetOffsetPosition(g), 3);
    show("offset.rotation", dGeomGetOffsetRotation(g), 12);
    dGeomGetOffsetQuaternion(g, q);
    show("offset.quaternion", q, 4);
    dGeomCopyOffsetPosition(g, p);
    show("offset.copy", p, 4);
    dGeomCopyOffsetRotation(g, r);
    show("offset.copy", r, 12);
}

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dGeomID s = dCreateSphere(0, 0.7), b = dCreateBox(0, 1, 2, 3), c = dCreateCapsule(0, 0.3, 1.5);
    dGeomID y = dCreateCylinder(0, 0.4, 1.2), p = dCreatePlane(0, 0, 0, 2, 4), q = dCreatePlane(0, 1, 2, -3, 0.5);
    dGeomID r = dCreateRay(0, 5);
    dGeomID all[7] = {s, b, c, y, r, p, q};
    int data;
    for (int i = 0; i < 7; i++) {
        dReal aabb[6];
        I1(dGeomGetClass, all[i]);
        I1(dGeomIsSpace, all[i]);
        I1(dGeomIsEnabled, all[i]);
        showi("bits", dGeomGetCategoryBits(all[i]) == ~0ul && dGeomGetCollideBits(all[i]) == ~0ul);
        dGeomSetCategoryBits(all[i], 0x100000005ul);
        dGeomSetCollideBits(all[i], 6);
        showi("category", dGeomGetCategoryBits(all[i]));
        showi("collide", dGeomGetCollideBits(all[i]));
        dGeomSetData(all[i], &data);
        showi("data", dGeomGetData(all[i]) == &data);
        showi("space", dGeomGetSpace(all[i]) == 0);
        showi("body", dGeomGetBody(all[i]) == 0);
        dGeomDisable(all[i]);
        I1(dGeomIsEnabled, all[i]);
        dGeomEnable(all[i]);
        I1(dGeomIsEnabled, all[i]);
        dGeomGetAABB(all[i], aabb);
        show("aabb", aabb, 6);
    }
    dMatrix3 m;
    dQuaternion turn;
    dRFromAxisAndAngle(m, 1, -2, 0.5, 0.8);
    dQFromAxisAndAngle(turn, 0.3, 1, 2, -1.1);
    for (int i = 0; i < 5; i++) {
        dGeomSetPosition(all[i], 1, 2, i);
        dGeomSetRotation(all[i], m);
        show_geom("free", all[i]);
        V3(dGeomGetRelPointPos, all[i], 0.1, 0.2, 0.3);
        V3(dGeomGetPosRelPoint, all[i], 0.1, 0.2, 0.3);
        V3(dGeomVectorToWorld, all[i], 0.1, 0.2, 0.3);
        V3(dGeomVectorFromWorld, all[i], 0.1, 0.2, 0.3);
        V3(dGeomCopyPosition, all[i]);
        dMatrix3 copy = {9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9};
        dGeomCopyRotation(all[i], copy);
        show("copy", copy, 12);
        dGeomSetQuaternion(all[i], turn);
        show_geom("turned", all[i]);
    }
    V3(dGeomGetRelPointPos, p, 0.1, 0.2, 0.3);
    V3(dGeomVectorFromWorld, p, 0.1, 0.2, 0.3);

    /* parameters */
    dReal x[4];
    R1(dGeomSphereGetRadius, s);
    dGeomSphereSetRadius(s, 0.9);
    R1(dGeomSphereGetRadius, s);
    V3(dGeomBoxGetLengths, b);
    dGeomBoxSetLengths(b, 0.5, 0.7, 0.9);
    V3(dGeomBoxGetLengths, b);
    dGeomCapsuleSetParams(c, 0.25, 1.25);
    dGeomCapsuleGetParams(c, &x[0], &x[1]);
    show("capsule", x, 2);
    dGeomCylinderSetParams(y, 0.35, 1.35);
    dGeomCylinderGetParams(y, &x[0], &x[1]);
    show("cylinder", x, 2);
    dGeomPlaneGetParams(p, x);
    show("plane", x, 4);
    dGeomPlaneSetParams(p, 1, 1, 0, 3);
    dGeomPlaneGetParams(p, x);
    show("plane", x, 4);
    dGeomPlaneSetParams(p, 0, 0, 0, 3);
    dGeomPlaneGetParams(p, x);
    show("plane", x, 4);
    for (int i = 0; i < 5; i++) show_geom("resized", all[i]);
    for (int i = 0; i < 6; i++) {
        dReal u = 1 + 0.1 * i, v = 2 - 0.15 * i, z = 0.05 * i * i;
        R1(dGeomSpherePointDepth, s, u, v, z);
        R1(dGeomCapsulePointDepth, c, u, v, z + 2);
        R1(dGeomPlanePointDepth, q, u, v, z);
    }
    R1(dGeomBoxPointDepth, b, 1.05, 2.1, 1.02);
    R1(dGeomBoxPointDepth, b, 1, 2, 1);
    dGeomSetPosition(b, 0, 0, 0);
    dRSetIdentity(m);
    dGeomSetRotation(b, m);
    dGeomBoxSetLengths(b, 2, 2, 2);
    R1(dGeomBoxPointDepth, b, 3, 0, 0);
    R1(dGeomBoxPointDepth, b, 2, 2, 2);
    R1(dGeomBoxPointDepth, b, 0.5, -1.5, 2);
    R1(dGeomBoxPointDepth, b, 0.5, -1.5, -1.2);
    R1(dGeomRayGetLength, r);
    dGeomRaySetLength(r, 7);
    R1(dGeomRayGetLength, r);
    dGeomRaySet(r, 1, 2, 3, 0, 3, 4);
    dVector3 start, along;
    dGeomRayGet(r, start, along);
    show("ray", start, 3);
    show("ray", along, 3);
    show_geom("ray", r);
    int first = 5, cull = 5;
    dGeomRayGetParams(r, &first, &cull);
    showi("first", first);
    showi("cull", cull);
    dGeomRaySetParams(r, 1, 1);
    I1(dGeomRayGetFirstContact, r);
    I1(dGeomRayGetBackfaceCull, r);
    dGeomRaySetFirstContact(r, 0);
    dGeomRaySetBackfaceCull(r, 0);
    dGeomRaySetClosestHit(r, 1);
    dGeomRaySetLength(r, 3);
    I1(dGeomRayGetFirstContact, r);
    I1(dGeomRayGetBackfaceCull, r);
    I1(dGeomRayGetClosestHit, r);

    /* on bodies */
    dBodyID a, d;
    two_bodies(w, &a, &d);
    for (int i = 0; i < 5; i++) dGeomSetBody(all[i], a);
    int order = 0;
    for (dGeomID g = dBodyGetFirstGeom(a); g; g = dBodyGetNextGeom(g))
        for (int i = 0; i < 7; i++)
            if (all[i] == g) order = 10 * order + i;
    showi("order", order);
    showi("shared", dGeomGetPosition(s) == dBodyGetPosition(a) && dGeomGetRotation(s) == dBodyGetRotation(a));
    showi("body", dGeomGetBody(s) == a);
    show_geom("on body", b);
    dGeomSetPosition(b, 3, 4, 5);
    show_body("moved by geom", a);
    dGeomSetQuaternion(b, turn);
    show_body("turned by geom", a);
    dRFromAxisAndAngle(m, 1, 0.3, -2, 0.6);
    dGeomSetRotation(c, m);
    show_body("turned by geom", a);
    show_offset(b);
    dGeomSetOffsetPosition(b, 0.5, 0.1, -0.3);
    show_offset(b);
    show_geom("offset", b);
    dRFromAxisAndAngle(m, 0, 1, 2, 0.4);
    dGeomSetOffsetRotation(b, m);
    show_offset(b);
    show_geom("offset", b);
    dGeomSetOffsetQuaternion(c, turn);
    show_offset(c);
    show_geom("offset", c);
    dGeomSetOffsetWorldPosition(c, 3.5, 4.5, 5.5);
    show_offset(c);
    dGeomSetOffsetWorldRotation(c, m);
    show_offset(c);
    show_geom("offset", c);
    dGeomSetOffsetWorldQuaternion(c, turn);
    show_offset(c);
    dGeomSetPosition(c, 1, 1, 1);
    show_body("moved by offset geom", a);
    show_geom("c", c);
    dRFromAxisAndAngle(m, 1, 1, 2, -0.4);
    dGeomSetRotation(c, m);
    show_body("turned by offset geom", a);
    show_geom("c", c);
    dGeomSetQuaternion(c, turn);
    show_body("turned by offset geom", a);
    show_geom("c", c);
    dGeomClearOffset(c);
    show_offset(c);
    show_geom("c", c);
    dGeomSetBody(b, a);
    I1(dGeomIsOffset, b);
    dWorldStep(w, 0.05);
    show_geom("stepped", b);
    show_geom("stepped", c);
    dGeomSetBody(b, 0);
    show_geom("off", b);
    I1(dGeomIsOffset, b);
    dBodySetPosition(a, 0, 0, 9);
    show_geom("stays", b);
    show_geom("goes", s);
    dGeomClearOffset(c);
    dGeomSetBody(c, d);
    show_geom("other body", c);
    dBodyDestroy(a);
    showi("left", dGeomGetBody(s) == 0);
    show_geom("left", s);
    dGeomDestroy(c);
    showi("none", dBodyGetFirstGeom(d) == 0);
    dWorldDestroy(w);
    for (int i = 0; i < 7; i++)
        if (all[i] != c) dGeomDestroy(all[i]);
    dReal box[6];
    dInfiniteAABB(0, box);
    show("infinite", box, 6);
    dCloseODE();
    return 0;
}
