/* C++: geoms and spaces by their classes. */
#include "check.h"

static int pairs;
static void near_pair(void *, dGeomID, dGeomID) { pairs++; }

int main() {
    dInitODE2(0);
    {
        dHashSpace space(0);
        dSphere ball(space, 0.5);
        dBox box(space, 1, 2, 0.5);
        dCapsule capsule(space, 0.2, 1);
        dCylinder cylinder(space, 0.4, 0.6);
        dPlane ground(space, 0, 0, 1, 0.1);
        dRay ray(space, 3);
        ray.set(0, 0, 2, 0, 0.1, -1);
        box.setPosition(0.2, 0.1, 0.4);
        capsule.setPosition(2, 0, 1);
        cylinder.setPosition(0, 2, 0.2);
        dVector3 sides;
        box.getLengths(sides);
        show("sides", sides, 3);
        dReal aabb[6];
        capsule.getAABB(aabb);
        show("aabb", aabb, 6);
        show1("radius", ball.getRadius());
        show1("length", ray.getLength());
        showi("geoms", space.getNumGeoms());
        space.collide(0, near_pair);
        showi("pairs", pairs);
        dWorld world;
        dBody body(world);
        body.setPosition(1, 2, 3);
        ball.setBody(body);
        show("follows", ball.getPosition(), 3);
        body.setLinearVel(1, 0, 0);
        world.step(0.5);
        show("follows", ball.getPosition(), 3);
        ball.setCategoryBits(3);
        ball.setCollideBits(5);
        showi("bits", (long)(ball.getCategoryBits() * 10 + ball.getCollideBits()));
        box.disable();
        showi("enabled", box.isEnabled());
        space.remove(box);
        showi("geoms", space.getNumGeoms());
        ball.setBody(0);
    }
    dCloseODE();
    return 0;
}
