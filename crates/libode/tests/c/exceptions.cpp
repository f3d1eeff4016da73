/* C++: the wrapper classes, and exceptions that leave callbacks and handlers through the library. */
#include <ode/ode.h>
#include <cstdio>
#include <stdexcept>
static void near(void*, dGeomID, dGeomID){ throw std::runtime_error("near"); }
static void moved(dBodyID){ throw std::runtime_error("moved"); }
static void dbg(int, const char*, va_list){ throw std::logic_error("debug"); }
int main(){ dInitODE(); dSpaceID s=dHashSpaceCreate(0); dCreateSphere(s,1); dCreateSphere(s,1);
 for(int i=0;i<3;i++){ try{ dSpaceCollide(s,0,near); puts("no"); }catch(std::exception&e){ puts(e.what()); } }
 dWorldID w=dWorldCreate(); dBodyID b=dBodyCreate(w); dWorldSetGravity(w,0,0,-1); dBodySetMovedCallback(b,moved);
 for(int i=0;i<3;i++){ try{ dWorldStep(w,0.1); puts("no"); }catch(std::exception&e){ puts(e.what()); } }
 dBodySetMovedCallback(b,0); dWorldStep(w,0.1); printf("%g\n", dBodyGetPosition(b)[2]<0?1.0:0.0);
 dSetDebugHandler(dbg); try{ dBodySetPosition(0,1,1,1);}catch(std::exception&e){ puts(e.what()); }
 try{ dWorldStep(w,-1);}catch(std::exception&e){ puts(e.what()); }
 dWorld cw; dBody cb(cw); cb.setPosition(1,2,3); dMass m; m.setBox(1,1,1,1); cb.setMass(m); dHingeJoint h(cw); h.attach(cb,0); h.setAnchor(1,2,3); cw.step(0.1); printf("%g\n",cb.getPosition()[0]);
 dWorldDestroy(w); return 0; }
