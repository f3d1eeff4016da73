// A chain of links hangs from the ceiling by ball joints, let go from the side: bodies and joints by the C++ classes.
//
// g++ swinging_chain.cpp -o swinging_chain `pkg-config ode --cflags --libs`
// ./swinging_chain
#include <ode/ode.h>

#include <cmath>
#include <cstdio>

int main() {
    const int links = 5;
    const dReal length = REAL(0.4), stepsize = REAL(0.005);

    dInitODE2(0);
    {
        // The classes own what they make: all of it goes at the end of this block, before the library is closed.
        dWorld world;
        world.setGravity(0, 0, REAL(-9.81));

        dBody link[links];
        dBallJoint joint[links];
        dMass mass;
        mass.setCapsuleTotal(REAL(0.2), 1, REAL(0.02), length);
        for (int i = 0; i < links; i++) {
            link[i].create(world);
            link[i].setMass(mass);
            link[i].setPosition((i + REAL(0.5)) * length, 0, 2);
            joint[i].create(world);
            // The first link hangs from the world, which is no body.
            joint[i].attach(link[i], i == 0 ? dBodyID(0) : link[i - 1].id());
            joint[i].setAnchor(i * length, 0, 2);
        }

        for (int i = 0; i <= 400; i++) {
            if (i % 40 == 0) {
                dVector3 tip;
                link[links - 1].getRelPointPos(length / 2, 0, 0, tip);
                std::printf("%4.2f s  tip at (%6.3f, %6.3f) m, %.3f m from the hook\n", i * stepsize, tip[0], tip[2],
                            std::sqrt(tip[0] * tip[0] + (tip[2] - 2) * (tip[2] - 2)));
            }
            world.step(stepsize);
        }
    }
    dCloseODE();
}
