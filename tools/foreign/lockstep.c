/* Preloaded into a program that uses libode: time that advances by frames and not by the clock, keys pressed at given frames, and a
 * record of every step's bodies. Two runs of one program are then alike to the last bit, and runs on two libraries can be compared.
 *
 *   LOCKSTEP_LOG=FILE      where the record goes
 *   LOCKSTEP_FRAMES=N      end the program after N frames (or, for a program without a window, N pauses)
 *   LOCKSTEP_STEPS=N       end the program after N steps
 *   LOCKSTEP_KEYS="fN:K …" from frame N on (sN: step N) press key K, or release it for -K: SDL 1.2's number; GLUT: an ASCII code, or
 *                          1000 + a special key
 *   LOCKSTEP_PAIRS=1       record every dCollide too
 *   LOCKSTEP_SHOT=N        stop for a while at step N, for a picture
 *
 * The record: a line "step N bodies B joints J contacts C", then a line for each body, in order of creation: position, rotation (quaternion),
 * velocity and spin. At the end, lines "time NAME CALLS SECONDS" of what steps and spaces, with their callbacks, took.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define NEXT(name) ((__typeof__(&name))next(#name))
#define FRAME_NS 10000000LL

static void *next(const char *name) {
    void *f = dlsym(RTLD_NEXT, name);
    if (!f) {
        fprintf(stderr, "lockstep: no %s\n", name);
        _exit(99);
    }
    return f;
}

static FILE *record;
static int detailed;
static long frame, last_frame, steps, last_step, shot_step = -1;
static long long now_ns = 1000000000LL * 1000000000LL;
static char *begin_of_program, *end_of_program;

/* Time of this thread on the processor, so that other programs count less. */
static double own_seconds(void) {
    struct timespec t;
    syscall(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* ---- what the library took ---- */

enum { STEP, SPACE, PARTS };
static const char *part_names[PARTS] = { "step", "space" };
static double part_seconds[PARTS];
static long part_calls[PARTS];

static void finish(void) {
    if (!record) return;
    for (int i = 0; i < PARTS; i++) fprintf(record, "time %s %ld %.6f\n", part_names[i], part_calls[i], part_seconds[i]);
    fclose(record);
    record = 0;
}

__attribute__((constructor)) static void start(void) {
    char line[4096], self[4096] = "";
    FILE *maps;
    readlink("/proc/self/exe", self, sizeof self - 1);
    if (getenv("LOCKSTEP_FRAMES")) last_frame = atol(getenv("LOCKSTEP_FRAMES"));
    if (getenv("LOCKSTEP_STEPS")) last_step = atol(getenv("LOCKSTEP_STEPS"));
    detailed = getenv("LOCKSTEP_PAIRS") != 0;
    if (getenv("LOCKSTEP_SHOT") && *getenv("LOCKSTEP_SHOT")) shot_step = atol(getenv("LOCKSTEP_SHOT"));
    maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps)) {
        unsigned long a, b;
        char *path = strchr(line, '/');
        if (!path || sscanf(line, "%lx-%lx", &a, &b) != 2) continue;
        path[strcspn(path, "\n")] = 0;
        if (strcmp(path, self) == 0) {
            if (!begin_of_program) begin_of_program = (char *)a;
            end_of_program = (char *)b;
        }
    }
    if (maps) fclose(maps);
}

static int from_program(void *address) { return (char *)address >= begin_of_program && (char *)address < end_of_program; }
#define BY_PROGRAM from_program(__builtin_return_address(0))
static int main_thread(void) { return syscall(SYS_gettid) == getpid(); }

/* ---- time ---- */

static void tick(long long ns) {
    if (main_thread()) now_ns += ns;
}

int clock_gettime(clockid_t id, struct timespec *t) {
    if (!BY_PROGRAM) return syscall(SYS_clock_gettime, id, t);
    tick(1000);
    t->tv_sec = now_ns / 1000000000LL;
    t->tv_nsec = now_ns % 1000000000LL;
    return 0;
}

int gettimeofday(struct timeval *restrict t, void *restrict zone) {
    if (!BY_PROGRAM) return syscall(SYS_gettimeofday, t, zone);
    tick(1000);
    t->tv_sec = now_ns / 1000000000LL;
    t->tv_usec = now_ns % 1000000000LL / 1000;
    return 0;
}

time_t time(time_t *out) {
    time_t t = now_ns / 1000000000LL;
    if (out) *out = t;
    return t;
}

unsigned SDL_GetTicks(void) {
    tick(1000);
    return (unsigned)(now_ns / 1000000 - 1000000000LL * 1000);
}

int glutGet(unsigned what) {
    if (what == 700) { /* GLUT_ELAPSED_TIME */
        tick(1000);
        return (int)(now_ns / 1000000 - 1000000000LL * 1000);
    }
    return ((int (*)(unsigned))next("glutGet"))(what);
}

static void press_keys(void);

static void next_frame(long long ns) {
    if (!main_thread()) return;
    frame++;
    now_ns += ns;
    if (shot_step >= 0 && steps >= shot_step) {
        shot_step = -1;
        fprintf(stderr, "lockstep: picture now\n");
        struct timespec pause = { 4, 0 };
        syscall(SYS_nanosleep, &pause, NULL);
    }
    if (last_frame && frame >= last_frame) {
        finish();
        _exit(0);
    }
    press_keys();
}

static int windowed;

void SDL_Delay(unsigned ms) {
    if (main_thread() && BY_PROGRAM) now_ns += ms * 1000000LL;
    else ((void (*)(unsigned))next("SDL_Delay"))(ms);
}

int select(int n, fd_set *restrict r, fd_set *restrict w, fd_set *restrict e, struct timeval *restrict t) {
    if (main_thread() && BY_PROGRAM && t) {
        long long ns = t->tv_sec * 1000000000LL + t->tv_usec * 1000LL;
        if (!windowed) next_frame(ns);
        else now_ns += ns;
        t->tv_sec = t->tv_usec = 0;
    }
    return syscall(SYS_select, n, r, w, e, t);
}

#define SWAP(name)                       \
    void name(void) {                    \
        ((void (*)(void))next(#name))(); \
        windowed = 1;                    \
        next_frame(FRAME_NS);            \
    }
SWAP(SDL_GL_SwapBuffers)
SWAP(glutSwapBuffers)

void SDL_GL_SwapWindow(void *window) {
    ((void (*)(void *))next("SDL_GL_SwapWindow"))(window);
    windowed = 1;
    next_frame(FRAME_NS);
}

int SDL_Flip(void *screen) {
    int result = ((int (*)(void *))next("SDL_Flip"))(screen);
    windowed = 1;
    next_frame(FRAME_NS);
    return result;
}

void SDL_UpdateRect(void *screen, int x, int y, unsigned w, unsigned h) {
    ((void (*)(void *, int, int, unsigned, unsigned))next("SDL_UpdateRect"))(screen, x, y, w, h);
    windowed = 1;
    if (BY_PROGRAM) next_frame(FRAME_NS);
}

/* ---- keys ---- */

typedef struct { unsigned char scancode; int sym, mod; unsigned short unicode; } Key;
typedef struct { unsigned char type, which, state; Key key; } KeyEvent;

static unsigned char keys[512];
static struct { int number, down; } queue[256];
static int queued, taken;
static void (*glut_key)(unsigned char, int, int), (*glut_key_up)(unsigned char, int, int);
static void (*glut_special)(int, int, int), (*glut_special_up)(int, int, int);

static void press_keys(void) {
    static char *script;
    if (!script && !(script = getenv("LOCKSTEP_KEYS"))) return;
    long at;
    char by;
    int key, length;
    while (sscanf(script, " %c%ld:%d%n", &by, &at, &key, &length) == 3 && at <= (by == 's' ? steps : frame)) {
        int down = key >= 0;
        script += length;
        if (!down) key = -key;
        if (key < 512) keys[key] = down;
        if (queued < 256) queue[queued].number = key, queue[queued++].down = down;
        if (key >= 1000) {
            if (down && glut_special) glut_special(key - 1000, 0, 0);
            if (!down && glut_special_up) glut_special_up(key - 1000, 0, 0);
        } else {
            if (down && glut_key) glut_key(key, 0, 0);
            if (!down && glut_key_up) glut_key_up(key, 0, 0);
        }
    }
}

#define CALLBACK(name, type, kept)                     \
    void name(type f) {                                \
        kept = f;                                      \
        ((void (*)(type))next(#name))(f);              \
    }
typedef void (*AsciiFn)(unsigned char, int, int);
typedef void (*SpecialFn)(int, int, int);
CALLBACK(glutKeyboardFunc, AsciiFn, glut_key)
CALLBACK(glutKeyboardUpFunc, AsciiFn, glut_key_up)
CALLBACK(glutSpecialFunc, SpecialFn, glut_special)
CALLBACK(glutSpecialUpFunc, SpecialFn, glut_special_up)

unsigned char *SDL_GetKeyState(int *count) {
    if (count) *count = 323;
    return keys;
}

/* SDL 1.2's events. Of the window's own only those about its size and redrawing are let through: focus and pointer come when they like. */
int SDL_PollEvent(void *event) {
    static int second = -1;
    if (second < 0) second = dlsym(RTLD_NEXT, "SDL_CreateWindow") != 0;
    if (!second && event && taken < queued) {
        KeyEvent *e = event;
        memset(e, 0, 24);
        e->type = queue[taken].down ? 2 : 3;
        e->state = queue[taken].down;
        e->key.sym = queue[taken].number;
        e->key.unicode = queue[taken].number < 128 ? queue[taken].number : 0;
        taken++;
        return 1;
    }
    int (*real)(void *) = (int (*)(void *))next("SDL_PollEvent");
    if (second || !event) return real(event);
    while (real(event)) {
        int type = *(unsigned char *)event;
        if (type == 16 || type == 17 || type >= 24) return 1;
    }
    return 0;
}

/* ---- bodies ---- */

static dBodyID *bodies;
static dWorldID *worlds_of;
static long body_count, body_room, contacts, joints;

/* The record begins with the first world, for shells and the like pass here too. */
dWorldID dWorldCreate(void) {
    const char *log = getenv("LOCKSTEP_LOG");
    dWorldID w = NEXT(dWorldCreate)();
    Dl_info info;
    if (log && !record && (record = fopen(log, "w")) && dladdr(next("dWorldCreate"), &info)) fprintf(record, "library %s\n", info.dli_fname);
    return w;
}

dBodyID dBodyCreate(dWorldID w) {
    dBodyID b = NEXT(dBodyCreate)(w);
    if (body_count == body_room) {
        body_room = body_room * 2 + 64;
        bodies = realloc(bodies, body_room * sizeof *bodies);
        worlds_of = realloc(worlds_of, body_room * sizeof *worlds_of);
    }
    bodies[body_count] = b;
    worlds_of[body_count++] = w;
    return b;
}

static void forget(dBodyID b, dWorldID w) {
    long kept = 0;
    for (long i = 0; i < body_count; i++)
        if (bodies[i] != b && worlds_of[i] != w) {
            bodies[kept] = bodies[i];
            worlds_of[kept++] = worlds_of[i];
        }
    body_count = kept;
}

void dBodyDestroy(dBodyID b) {
    forget(b, (dWorldID)-1);
    NEXT(dBodyDestroy)(b);
}

void dWorldDestroy(dWorldID w) {
    forget((dBodyID)-1, w);
    NEXT(dWorldDestroy)(w);
}

dJointID dJointCreateContact(dWorldID w, dJointGroupID g, const dContact *c) {
    joints++;
    return NEXT(dJointCreateContact)(w, g, c);
}

static int inside;

/* One line a call: classes and places of both geoms, then each contact. compare.py leaves these out; they show where a difference begins. */
static void write_pair(dGeomID a, dGeomID b, int flags, int n, const dContactGeom *c, int skip) {
    dGeomID both[2] = { a, b };
    fprintf(record, "pair flags %x contacts %d:", flags, n);
    for (int i = 0; i < 2; i++) {
        int class = dGeomGetClass(both[i]);
        fprintf(record, " class %d", class);
        if (class == dPlaneClass || (class >= dFirstSpaceClass && class <= dLastSpaceClass)) continue;
        const dReal *p = dGeomGetPosition(both[i]);
        fprintf(record, " at %.17g %.17g %.17g", p[0], p[1], p[2]);
    }
    for (int i = 0; i < n; i++) {
        const dContactGeom *k = (const dContactGeom *)((const char *)c + i * skip);
        fprintf(record, " | %.17g %.17g %.17g  %.17g %.17g %.17g  %.17g", k->pos[0], k->pos[1], k->pos[2], k->normal[0], k->normal[1], k->normal[2],
                k->depth);
    }
    fprintf(record, "\n");
}

int dCollide(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    static __typeof__(&dCollide) real;
    static int nested; /* libode calls itself by this name for geom transforms */
    if (!real) real = NEXT(dCollide);
    if (nested) return real(a, b, flags, c, skip);
    nested = 1;
    int n = real(a, b, flags, c, skip);
    nested = 0;
    contacts += n;
    if (record && detailed) write_pair(a, b, flags, n, c, skip);
    return n;
}

void dSpaceCollide(dSpaceID s, void *data, dNearCallback *f) {
    double t = own_seconds();
    inside++;
    NEXT(dSpaceCollide)(s, data, f);
    if (--inside == 0) part_seconds[SPACE] += own_seconds() - t;
    part_calls[SPACE]++;
}

void dSpaceCollide2(dGeomID a, dGeomID b, void *data, dNearCallback *f) {
    double t = own_seconds();
    inside++;
    NEXT(dSpaceCollide2)(a, b, data, f);
    if (--inside == 0) part_seconds[SPACE] += own_seconds() - t;
    part_calls[SPACE]++;
}

static void write_bodies(dWorldID w) {
    long here = 0;
    for (long i = 0; i < body_count; i++) here += worlds_of[i] == w;
    fprintf(record, "step %ld frame %ld bodies %ld contacts %ld joints %ld\n", steps, frame, here, contacts, joints);
    for (long i = 0; i < body_count; i++) {
        if (worlds_of[i] != w) continue;
        const dReal *p = dBodyGetPosition(bodies[i]), *q = dBodyGetQuaternion(bodies[i]);
        const dReal *v = dBodyGetLinearVel(bodies[i]), *s = dBodyGetAngularVel(bodies[i]);
        fprintf(record, "%.17g %.17g %.17g  %.17g %.17g %.17g %.17g  %.17g %.17g %.17g  %.17g %.17g %.17g\n", p[0], p[1], p[2], q[0], q[1], q[2],
                q[3], v[0], v[1], v[2], s[0], s[1], s[2]);
    }
}

static void end_of_step(dWorldID w) {
    if (record) write_bodies(w);
    contacts = joints = 0;
    if (++steps == last_step) {
        finish();
        _exit(0);
    }
}

int dWorldQuickStep(dWorldID w, dReal h) {
    double t = own_seconds();
    int ok = NEXT(dWorldQuickStep)(w, h);
    part_seconds[STEP] += own_seconds() - t;
    part_calls[STEP]++;
    end_of_step(w);
    return ok;
}

int dWorldStep(dWorldID w, dReal h) {
    double t = own_seconds();
    int ok = NEXT(dWorldStep)(w, h);
    part_seconds[STEP] += own_seconds() - t;
    part_calls[STEP]++;
    end_of_step(w);
    return ok;
}

/* Ends that pass by no destructor: the record is written all the same. */
void exit(int code) {
    finish();
    ((void (*)(int))next("exit"))(code);
    __builtin_unreachable();
}
