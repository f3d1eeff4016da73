/* Rays: start, direction, length, their parameters, and what they hit of five shapes. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dGeomID ray = dCreateRay(0, 3), shapes[] = {dCreateSphere(0, 0.5), dCreateBox(0, 1, 1, 1), dCreateCapsule(0, 0.3, 1),
        dCreateCylinder(0, 0.4, 1), dCreatePlane(0, 0, 0, 1, 0.2)};
    dContactGeom c[4];
    R1(dGeomRayGetLength, ray);
    CHECK1(dCreateRay, dGeomRayGetLength(ray));
    dGeomRaySet(ray, 0.1, 0.05, 2, 0.1, 0.2, -3);
    dVector3 start, direction;
    dGeomRayGet(ray, start, direction);
    CHECK(dGeomRaySet, start, 3);
    CHECK(dGeomRayGet, direction, 3);
    for (int i = 0; i < 5; i++) {
        showi("hits", dCollide(ray, shapes[i], 4, c, sizeof *c));
        CHECK(dCollide, c->pos, 3);
        show("normal", c->normal, 3);
        show1("depth", c->depth);
    }
    dGeomRaySetLength(ray, 1);
    CHECKI(dGeomRaySetLength, dCollide(ray, shapes[0], 4, c, sizeof *c));
    int first = 7, cull = 7;
    dGeomRaySetParams(ray, 1, 0);
    dGeomRayGetParams(ray, &first, &cull);
    CHECKI(dGeomRaySetParams, first * 10 + cull);
    CHECKI(dGeomRayGetParams, first * 10 + cull);
    dGeomRaySetFirstContact(ray, 0);
    CHECKI(dGeomRaySetFirstContact, dGeomRayGetFirstContact(ray));
    dGeomRaySetFirstContact(ray, 1);
    I1(dGeomRayGetFirstContact, ray);
    dGeomRaySetBackfaceCull(ray, 1);
    CHECKI(dGeomRaySetBackfaceCull, dGeomRayGetBackfaceCull(ray));
    I1(dGeomRayGetBackfaceCull, ray);
    dGeomRaySetClosestHit(ray, 1);
    CHECKI(dGeomRaySetClosestHit, dGeomRayGetClosestHit(ray));
    I1(dGeomRayGetClosestHit, ray);
    for (int i = 0; i < 5; i++) dGeomDestroy(shapes[i]);
    dGeomDestroy(ray);
    dCloseODE();
    return 0;
}
