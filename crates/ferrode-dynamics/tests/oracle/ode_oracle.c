/* Runs a script on the installed libode and prints the state: the other side of the differential tests.
 *
 * A line is an operation, the index of the body or joint that it is for (0 where there is none), and numbers; see
 * `execute`. Bodies and joints are numbered in the order of their creation. Contacts live for one step.
 */
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BODIES = 4096, MAX_JOINTS = 4096, MAX_ARGS = 4096 };

static dWorldID world;
static dJointGroupID contacts;
static dBodyID bodies[MAX_BODIES];
static dJointID joints[MAX_JOINTS];
static dJointFeedback feedback[MAX_JOINTS];
static int nbodies, njoints;
static double a[MAX_ARGS];
static int nargs;

static void fail(const char *op)
{
    fprintf(stderr, "ode_oracle: bad line \"%s\" with %d numbers\n", op, nargs);
    exit(2);
}

static dBodyID body_or_world(double index)
{
    return index < 0 ? NULL : bodies[(int)index];
}

static dJointID create_joint(int type)
{
    switch (type) {
    case dJointTypeBall: return dJointCreateBall(world, 0);
    case dJointTypeHinge: return dJointCreateHinge(world, 0);
    case dJointTypeSlider: return dJointCreateSlider(world, 0);
    case dJointTypeUniversal: return dJointCreateUniversal(world, 0);
    case dJointTypeHinge2: return dJointCreateHinge2(world, 0);
    case dJointTypeFixed: return dJointCreateFixed(world, 0);
    case dJointTypeNull: return dJointCreateNull(world, 0);
    case dJointTypeAMotor: return dJointCreateAMotor(world, 0);
    case dJointTypeLMotor: return dJointCreateLMotor(world, 0);
    case dJointTypePlane2D: return dJointCreatePlane2D(world, 0);
    case dJointTypePR: return dJointCreatePR(world, 0);
    case dJointTypePU: return dJointCreatePU(world, 0);
    case dJointTypePiston: return dJointCreatePiston(world, 0);
    case dJointTypeDBall: return dJointCreateDBall(world, 0);
    case dJointTypeDHinge: return dJointCreateDHinge(world, 0);
    case dJointTypeTransmission: return dJointCreateTransmission(world, 0);
    default: return NULL;
    }
}

static void set_param(dJointID j, int n, double v)
{
    switch (dJointGetType(j)) {
    case dJointTypeBall: dJointSetBallParam(j, n, v); break;
    case dJointTypeHinge: dJointSetHingeParam(j, n, v); break;
    case dJointTypeSlider: dJointSetSliderParam(j, n, v); break;
    case dJointTypeUniversal: dJointSetUniversalParam(j, n, v); break;
    case dJointTypeHinge2: dJointSetHinge2Param(j, n, v); break;
    case dJointTypeFixed: dJointSetFixedParam(j, n, v); break;
    case dJointTypeAMotor: dJointSetAMotorParam(j, n, v); break;
    case dJointTypeLMotor: dJointSetLMotorParam(j, n, v); break;
    case dJointTypePR: dJointSetPRParam(j, n, v); break;
    case dJointTypePU: dJointSetPUParam(j, n, v); break;
    case dJointTypePiston: dJointSetPistonParam(j, n, v); break;
    case dJointTypeDBall: dJointSetDBallParam(j, n, v); break;
    case dJointTypeDHinge: dJointSetDHingeParam(j, n, v); break;
    case dJointTypeTransmission: dJointSetTransmissionParam(j, n, v); break;
    case dJointTypePlane2D:
        if (n < 0x100) dJointSetPlane2DXParam(j, n, v);
        else if (n < 0x200) dJointSetPlane2DYParam(j, n & 0xff, v);
        else dJointSetPlane2DAngleParam(j, n & 0xff, v);
        break;
    default: break;
    }
}

/* Setters of one vector, by the joint function's name without "dJointSet". */
typedef void vector_setter(dJointID, dReal, dReal, dReal);
#define V(name) { #name, dJointSet##name }
static const struct { const char *name; vector_setter *set; } vector_setters[] = {
    V(BallAnchor), V(BallAnchor2), V(HingeAnchor), V(HingeAxis), V(SliderAxis),
    V(UniversalAnchor), V(UniversalAxis1), V(UniversalAxis2), V(Hinge2Anchor),
    V(PRAnchor), V(PRAxis1), V(PRAxis2), V(PUAnchor), V(PUAxis1), V(PUAxis2), V(PUAxis3),
    V(PistonAnchor), V(PistonAxis), V(DBallAnchor1), V(DBallAnchor2),
    V(DHingeAnchor1), V(DHingeAnchor2), V(DHingeAxis),
    V(TransmissionAxis), V(TransmissionAxis1), V(TransmissionAxis2),
    V(TransmissionAnchor1), V(TransmissionAnchor2),
};

static int joint_call(const char *op, dJointID j)
{
    for (size_t i = 0; i < sizeof vector_setters / sizeof *vector_setters; i++) {
        if (!strcmp(op, vector_setters[i].name)) {
            vector_setters[i].set(j, a[1], a[2], a[3]);
            return 1;
        }
    }
#define OP(name) else if (!strcmp(op, name))
    if (!strcmp(op, "Hinge2Axes")) {
        dVector3 x = { a[1], a[2], a[3] }, y = { a[4], a[5], a[6] };
        dJointSetHinge2Axes(j, x, y);
    }
    OP("Fixed") dJointSetFixed(j);
    OP("HingeAnchorDelta") dJointSetHingeAnchorDelta(j, a[1], a[2], a[3], a[4], a[5], a[6]);
    OP("HingeAxisOffset") dJointSetHingeAxisOffset(j, a[1], a[2], a[3], a[4]);
    OP("SliderAxisDelta") dJointSetSliderAxisDelta(j, a[1], a[2], a[3], a[4], a[5], a[6]);
    OP("UniversalAxis1Offset") dJointSetUniversalAxis1Offset(j, a[1], a[2], a[3], a[4], a[5]);
    OP("UniversalAxis2Offset") dJointSetUniversalAxis2Offset(j, a[1], a[2], a[3], a[4], a[5]);
    OP("PUAnchorOffset") dJointSetPUAnchorOffset(j, a[1], a[2], a[3], a[4], a[5], a[6]);
    OP("PistonAnchorOffset") dJointSetPistonAnchorOffset(j, a[1], a[2], a[3], a[4], a[5], a[6]);
    OP("PistonAxisDelta") dJointSetPistonAxisDelta(j, a[1], a[2], a[3], a[4], a[5], a[6]);
    OP("AMotorMode") dJointSetAMotorMode(j, (int)a[1]);
    OP("AMotorNumAxes") dJointSetAMotorNumAxes(j, (int)a[1]);
    OP("AMotorAxis") dJointSetAMotorAxis(j, (int)a[1], (int)a[2], a[3], a[4], a[5]);
    OP("AMotorAngle") dJointSetAMotorAngle(j, (int)a[1], a[2]);
    OP("LMotorNumAxes") dJointSetLMotorNumAxes(j, (int)a[1]);
    OP("LMotorAxis") dJointSetLMotorAxis(j, (int)a[1], (int)a[2], a[3], a[4], a[5]);
    OP("DBallDistance") dJointSetDBallDistance(j, a[1]);
    OP("TransmissionMode") dJointSetTransmissionMode(j, (int)a[1]);
    OP("TransmissionRatio") dJointSetTransmissionRatio(j, a[1]);
    OP("TransmissionRadius1") dJointSetTransmissionRadius1(j, a[1]);
    OP("TransmissionRadius2") dJointSetTransmissionRadius2(j, a[1]);
    OP("TransmissionBacklash") dJointSetTransmissionBacklash(j, a[1]);
    OP("AddHingeTorque") dJointAddHingeTorque(j, a[1]);
    OP("AddSliderForce") dJointAddSliderForce(j, a[1]);
    OP("AddUniversalTorques") dJointAddUniversalTorques(j, a[1], a[2]);
    OP("AddHinge2Torques") dJointAddHinge2Torques(j, a[1], a[2]);
    OP("AddPRTorque") dJointAddPRTorque(j, a[1]);
    OP("AddPistonForce") dJointAddPistonForce(j, a[1]);
    OP("AddAMotorTorques") dJointAddAMotorTorques(j, a[1], a[2], a[3]);
    else return 0;
    return 1;
}

static void contact(void)
{
    dContact c;
    memset(&c, 0, sizeof c);
    const double *p = a + 3;
    dSurfaceParameters *s = &c.surface;
    s->mode = (int)*p++;
    s->mu = *p++; s->mu2 = *p++; s->rho = *p++; s->rho2 = *p++; s->rhoN = *p++;
    s->bounce = *p++; s->bounce_vel = *p++; s->soft_erp = *p++; s->soft_cfm = *p++;
    s->motion1 = *p++; s->motion2 = *p++; s->motionN = *p++; s->slip1 = *p++; s->slip2 = *p++;
    for (int k = 0; k < 3; k++) c.geom.pos[k] = *p++;
    for (int k = 0; k < 3; k++) c.geom.normal[k] = *p++;
    c.geom.depth = *p++;
    for (int k = 0; k < 3; k++) c.fdir1[k] = *p++;
    dJointAttach(dJointCreateContact(world, contacts, &c), body_or_world(a[1]), body_or_world(a[2]));
}

static void vector(const dReal *v, int n)
{
    for (int i = 0; i < n; i++) printf(" %.17g", (double)v[i]);
}

/* What a joint measures: positions, angles and their rates. */
static void print_measures(int index)
{
    dJointID j = joints[index];
    double m[6] = { 0 };
    int n = 0;
#define M(value) m[n++] = (double)(value)
    switch (dJointGetType(j)) {
    case dJointTypeHinge: M(dJointGetHingeAngle(j)); M(dJointGetHingeAngleRate(j)); break;
    case dJointTypeSlider: M(dJointGetSliderPosition(j)); M(dJointGetSliderPositionRate(j)); break;
    case dJointTypeUniversal:
        M(dJointGetUniversalAngle1(j)); M(dJointGetUniversalAngle2(j));
        M(dJointGetUniversalAngle1Rate(j)); M(dJointGetUniversalAngle2Rate(j));
        break;
    case dJointTypeHinge2:
        M(dJointGetHinge2Angle1(j)); M(dJointGetHinge2Angle2(j));
        M(dJointGetHinge2Angle1Rate(j)); M(dJointGetHinge2Angle2Rate(j));
        break;
    case dJointTypePR:
        M(dJointGetPRPosition(j)); M(dJointGetPRPositionRate(j));
        M(dJointGetPRAngle(j)); M(dJointGetPRAngleRate(j));
        break;
    case dJointTypePU:
        M(dJointGetPUPosition(j)); M(dJointGetPUPositionRate(j));
        M(dJointGetPUAngle1(j)); M(dJointGetPUAngle2(j));
        M(dJointGetPUAngle1Rate(j)); M(dJointGetPUAngle2Rate(j));
        break;
    case dJointTypePiston:
        M(dJointGetPistonPosition(j)); M(dJointGetPistonPositionRate(j));
        M(dJointGetPistonAngle(j)); M(dJointGetPistonAngleRate(j));
        break;
    case dJointTypeAMotor:
        for (int k = 0; k < dJointGetAMotorNumAxes(j); k++) {
            M(dJointGetAMotorAngle(j, k)); M(dJointGetAMotorAngleRate(j, k));
        }
        break;
    case dJointTypeTransmission: M(dJointGetTransmissionAngle1(j)); M(dJointGetTransmissionAngle2(j)); break;
    default: return;
    }
    printf("measure %d", index);
    for (int k = 0; k < n; k++) printf(" %.17g", m[k]);
    puts("");
}

static void print_state(void)
{
    for (int i = 0; i < nbodies; i++) {
        dBodyID b = bodies[i];
        printf("body %d %d", i, dBodyIsEnabled(b));
        vector(dBodyGetPosition(b), 3);
        vector(dBodyGetQuaternion(b), 4);
        vector(dBodyGetLinearVel(b), 3);
        vector(dBodyGetAngularVel(b), 3);
        puts("");
    }
    for (int i = 0; i < njoints; i++) {
        print_measures(i);
        if (!dJointGetFeedback(joints[i])) continue;
        printf("feedback %d", i);
        vector(feedback[i].f1, 3);
        vector(feedback[i].t1, 3);
        vector(feedback[i].f2, 3);
        vector(feedback[i].t2, 3);
        puts("");
    }
    printf("seed 0 %lu\n", dRandGetSeed());
    fflush(stdout); /* what comes next may abort */
}

static void print_mass(const dMass *m)
{
    printf("mass 0 %.17g", (double)m->mass);
    vector(m->c, 3);
    for (int i = 0; i < 3; i++) vector(m->I + 4 * i, 3);
    puts("");
}

/* Numbers: density or total, vertices, triangles, their coordinates, their indices. */
static void trimesh_mass(int total)
{
    int nv = (int)a[2], nt = (int)a[3];
    double *vertices = malloc(sizeof(double) * 3 * nv);
    dTriIndex *indices = malloc(sizeof(dTriIndex) * 3 * nt);
    for (int i = 0; i < 3 * nv; i++) vertices[i] = a[4 + i];
    for (int i = 0; i < 3 * nt; i++) indices[i] = (dTriIndex)a[4 + 3 * nv + i];
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data, vertices, 3 * sizeof(double), nv, indices, 3 * nt, 3 * sizeof(dTriIndex));
    dGeomID geom = dCreateTriMesh(0, data, 0, 0, 0);
    dMass m;
    if (total) dMassSetTrimeshTotal(&m, a[1], geom);
    else dMassSetTrimesh(&m, a[1], geom);
    print_mass(&m);
    dGeomDestroy(geom);
    dGeomTriMeshDataDestroy(data);
    free(vertices);
    free(indices);
}

static int mass_call(const char *op)
{
    dMass m;
    if (!strcmp(op, "MassSphere")) dMassSetSphere(&m, a[1], a[2]);
    OP("MassSphereTotal") dMassSetSphereTotal(&m, a[1], a[2]);
    OP("MassBox") dMassSetBox(&m, a[1], a[2], a[3], a[4]);
    OP("MassBoxTotal") dMassSetBoxTotal(&m, a[1], a[2], a[3], a[4]);
    OP("MassCylinder") dMassSetCylinder(&m, a[1], (int)a[2], a[3], a[4]);
    OP("MassCylinderTotal") dMassSetCylinderTotal(&m, a[1], (int)a[2], a[3], a[4]);
    OP("MassCapsule") dMassSetCapsule(&m, a[1], (int)a[2], a[3], a[4]);
    OP("MassCapsuleTotal") dMassSetCapsuleTotal(&m, a[1], (int)a[2], a[3], a[4]);
    OP("MassTrimesh") { trimesh_mass(0); return 1; }
    OP("MassTrimeshTotal") { trimesh_mass(1); return 1; }
    OP("MassChain") { /* box, moved, turned, joined with a sphere, adjusted */
        dMass other;
        dMatrix3 r;
        dMassSetBox(&m, a[1], a[2], a[3], a[4]);
        dMassTranslate(&m, a[5], a[6], a[7]);
        dRFromAxisAndAngle(r, a[8], a[9], a[10], a[11]);
        dMassRotate(&m, r);
        dMassSetSphere(&other, a[12], a[13]);
        dMassAdd(&m, &other);
        dMassAdjust(&m, a[14]);
    }
    else return 0;
    print_mass(&m);
    return 1;
}

static void execute(const char *op)
{
    int i = (int)a[0];
    if (!strcmp(op, "gravity")) dWorldSetGravity(world, a[1], a[2], a[3]);
    OP("erp") dWorldSetERP(world, a[1]);
    OP("cfm") dWorldSetCFM(world, a[1]);
    OP("iterations") dWorldSetQuickStepNumIterations(world, (int)a[1]);
    OP("over_relaxation") dWorldSetQuickStepW(world, a[1]);
    OP("max_correcting_velocity") dWorldSetContactMaxCorrectingVel(world, a[1]);
    OP("surface_layer") dWorldSetContactSurfaceLayer(world, a[1]);
    OP("world_damping") {
        dWorldSetDamping(world, a[1], a[2]);
        dWorldSetLinearDampingThreshold(world, a[3]);
        dWorldSetAngularDampingThreshold(world, a[4]);
    }
    OP("world_max_angular_speed") dWorldSetMaxAngularSpeed(world, a[1]);
    OP("world_auto_disable") {
        dWorldSetAutoDisableFlag(world, (int)a[1]);
        dWorldSetAutoDisableLinearThreshold(world, a[2]);
        dWorldSetAutoDisableAngularThreshold(world, a[3]);
        dWorldSetAutoDisableSteps(world, (int)a[4]);
        dWorldSetAutoDisableTime(world, a[5]);
        dWorldSetAutoDisableAverageSamplesCount(world, (unsigned)a[6]);
    }
    OP("seed") dRandSetSeed((unsigned long)a[1]);
    OP("body") bodies[nbodies++] = dBodyCreate(world);
    OP("mass") {
        dMass m;
        dMassSetParameters(&m, a[1], 0, 0, 0, a[2], a[3], a[4], a[5], a[6], a[7]);
        dBodySetMass(bodies[i], &m);
    }
    OP("position") dBodySetPosition(bodies[i], a[1], a[2], a[3]);
    OP("quaternion") { dQuaternion q = { a[1], a[2], a[3], a[4] }; dBodySetQuaternion(bodies[i], q); }
    OP("linear_velocity") dBodySetLinearVel(bodies[i], a[1], a[2], a[3]);
    OP("angular_velocity") dBodySetAngularVel(bodies[i], a[1], a[2], a[3]);
    OP("kinematic") dBodySetKinematic(bodies[i]);
    OP("gravity_mode") dBodySetGravityMode(bodies[i], (int)a[1]);
    OP("gyroscopic_mode") dBodySetGyroscopicMode(bodies[i], (int)a[1]);
    OP("finite_rotation") {
        dBodySetFiniteRotationMode(bodies[i], (int)a[1]);
        dBodySetFiniteRotationAxis(bodies[i], a[2], a[3], a[4]);
    }
    OP("damping") {
        dBodySetDamping(bodies[i], a[1], a[2]);
        dBodySetLinearDampingThreshold(bodies[i], a[3]);
        dBodySetAngularDampingThreshold(bodies[i], a[4]);
    }
    OP("max_angular_speed") dBodySetMaxAngularSpeed(bodies[i], a[1]);
    OP("auto_disable") {
        dBodySetAutoDisableFlag(bodies[i], (int)a[1]);
        dBodySetAutoDisableLinearThreshold(bodies[i], a[2]);
        dBodySetAutoDisableAngularThreshold(bodies[i], a[3]);
        dBodySetAutoDisableSteps(bodies[i], (int)a[4]);
        dBodySetAutoDisableTime(bodies[i], a[5]);
        dBodySetAutoDisableAverageSamplesCount(bodies[i], (unsigned)a[6]);
    }
    OP("body_enabled") { if (a[1] != 0) dBodyEnable(bodies[i]); else dBodyDisable(bodies[i]); }
    OP("force") { dBodyAddForce(bodies[i], a[1], a[2], a[3]); dBodyAddTorque(bodies[i], a[4], a[5], a[6]); }
    OP("relative_force_at") dBodyAddRelForceAtRelPos(bodies[i], a[1], a[2], a[3], a[4], a[5], a[6]);
    OP("joint") joints[njoints++] = create_joint((int)a[1]);
    OP("attach") dJointAttach(joints[i], body_or_world(a[1]), body_or_world(a[2]));
    OP("feedback") dJointSetFeedback(joints[i], &feedback[i]);
    OP("param") set_param(joints[i], (int)a[1], a[2]);
    OP("joint_enabled") { if (a[1] != 0) dJointEnable(joints[i]); else dJointDisable(joints[i]); }
    OP("contact") contact();
    OP("step") {
        int ok = a[1] == 0 ? dWorldStep(world, a[2]) : dWorldQuickStep(world, a[2]);
        if (!ok) fail("step");
        dJointGroupEmpty(contacts);
    }
    OP("print") print_state();
    else if (!mass_call(op) && !(i < njoints && joint_call(op, joints[i]))) fail(op);
}

/* libode's warnings, as a line of the output: its number tells which. */
static void on_message(int number, const char *format, va_list arguments)
{
    (void)format;
    (void)arguments;
    printf("message %d\n", number);
}

int main(void)
{
    static char line[1 << 20];
    dInitODE2(0);
    dSetMessageHandler(on_message);
    world = dWorldCreate();
    contacts = dJointGroupCreate(0);
    while (fgets(line, sizeof line, stdin)) {
        char *op = strtok(line, " \n");
        if (!op) continue;
        nargs = 0;
        for (char *word; nargs < MAX_ARGS && (word = strtok(NULL, " \n"));) a[nargs++] = strtod(word, NULL);
        execute(op);
    }
    dJointGroupDestroy(contacts);
    dWorldDestroy(world);
    dCloseODE();
    return 0;
}
