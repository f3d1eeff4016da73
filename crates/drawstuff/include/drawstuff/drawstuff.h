/* drawstuff/drawstuff.h: draws bodies in a window, or to a folder of pictures (docs/drawstuff.md).

   Lengths are metres, z is up, the ground is at z = 0. A rotation is three rows of four numbers, the fourth of each row is not
   looked at. Functions whose names end in D take the same in double precision. Draw from the step callback only. */
#ifndef FERRODE_DRAWSTUFF_DRAWSTUFF_H
#define FERRODE_DRAWSTUFF_DRAWSTUFF_H

#include <drawstuff/version.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32) && defined(DS_DLL)
#define DS_API __declspec(dllimport)
#else
#define DS_API
#endif

enum DS_TEXTURE_NUMBER { DS_NONE = 0, DS_WOOD = 1, DS_CHECKERED = 2, DS_GROUND = 3, DS_SKY = 4 };

/* For dsSetDrawMode. */
#define DS_POLYFILL 0
#define DS_WIREFRAME 1

#define DS_SIMULATION_DEFAULT_WIDTH 1280
#define DS_SIMULATION_DEFAULT_HEIGHT 720

/* Each function may be null. */
typedef struct dsFunctions {
    int version;                 /* DS_VERSION */
    void (*start)(void);         /* once, when the window is open */
    void (*step)(int pause);     /* once a frame: simulate unless paused, and draw */
    void (*command)(int cmd);    /* an ordinary key */
    void (*stop)(void);          /* once, after the last frame */
    const char *path_to_textures; /* not needed: textures are computed */
} dsFunctions;

/* The window, until it is closed, or Ctrl-X, or dsStop. */
DS_API void dsSimulationLoop(int argc, char **argv, int window_width, int window_height, struct dsFunctions *fn);
DS_API void dsStop(void);
DS_API void dsInitializeConsole(int argc, char **argv);
DS_API void dsFinalizeConsole(void);

/* As printf: to the error output and exit(1); to the error output and abort(); to the output. */
DS_API void dsError(const char *msg, ...);
DS_API void dsDebug(const char *msg, ...);
DS_API void dsPrint(const char *msg, ...);

/* Seconds since the last call. */
DS_API double dsElapsedTime(void);

/* The camera's place, and heading (0 along x, 90 along y), pitch (0 level, up positive) and roll in degrees. */
DS_API void dsSetViewpoint(const float xyz[3], const float hpr[3]);
DS_API void dsGetViewpoint(float xyz[3], float hpr[3]);

/* How things are drawn from here on, until the end of the frame. Opacity is 1 for what can't be seen through. */
DS_API void dsSetTexture(int texture_number);
DS_API void dsSetColor(float red, float green, float blue);
DS_API void dsSetColorAlpha(float red, float green, float blue, float alpha);
DS_API void dsSetDrawMode(int mode);

/* Sides and lengths are full ones; cylinders and capsules lie along z, a capsule's length leaves out its caps. */
DS_API void dsDrawBox(const float pos[3], const float R[12], const float sides[3]);
DS_API void dsDrawSphere(const float pos[3], const float R[12], float radius);
DS_API void dsDrawCylinder(const float pos[3], const float R[12], float length, float radius);
DS_API void dsDrawCapsule(const float pos[3], const float R[12], float length, float radius);
DS_API void dsDrawTriangle(const float pos[3], const float R[12], const float *v0, const float *v1, const float *v2, int solid);
/* n triangles of nine numbers each. */
DS_API void dsDrawTriangles(const float pos[3], const float R[12], const float *v, int n, int solid);
/* Ends in world coordinates. */
DS_API void dsDrawLine(const float pos1[3], const float pos2[3]);
/* Four numbers a plane; for each plane, the count of its polygon's corners, then their numbers. */
DS_API void dsDrawConvex(const float pos[3], const float R[12], const float *planes, unsigned int plane_count,
                         const float *points, unsigned int point_count, const unsigned int *polygons);

DS_API void dsDrawBoxD(const double pos[3], const double R[12], const double sides[3]);
DS_API void dsDrawSphereD(const double pos[3], const double R[12], float radius);
DS_API void dsDrawCylinderD(const double pos[3], const double R[12], float length, float radius);
DS_API void dsDrawCapsuleD(const double pos[3], const double R[12], float length, float radius);
DS_API void dsDrawTriangleD(const double pos[3], const double R[12], const double *v0, const double *v1, const double *v2, int solid);
DS_API void dsDrawTrianglesD(const double pos[3], const double R[12], const double *v, int n, int solid);
DS_API void dsDrawLineD(const double pos1[3], const double pos2[3]);
DS_API void dsDrawConvexD(const double pos[3], const double R[12], const double *planes, unsigned int plane_count,
                          const double *points, unsigned int point_count, const unsigned int *polygons);

/* How finely round shapes are divided, before the first is drawn: each step up doubles it. */
DS_API void dsSetSphereQuality(int n);
DS_API void dsSetCapsuleQuality(int n);

/* Old names. */
#define dsDrawCappedCylinder dsDrawCapsule
#define dsDrawCappedCylinderD dsDrawCapsuleD
#define dsSetCappedCylinderQuality dsSetCapsuleQuality

#ifdef __cplusplus
}
#endif

#endif
