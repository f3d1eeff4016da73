//! The pair matrix.

use super::*;
use crate::{CollideOptions, Contacts, Frame, GeomContact, Shape, ShapeKind};
use ferrode_math::Pose;

type Collider = fn(&Shape, &Frame, &Shape, &Frame, &mut Contacts<'_>);

/// Whether bodies that reach `reach` between them are further apart than that. A hair more, so that rounding here never
/// decides what touches.
#[inline(always)]
pub(super) fn apart(fa: &Frame, fb: &Frame, reach: f64) -> bool {
    (fa.position - fb.position).length_squared() > reach * reach * (1.0 + 1e-9)
}

/// A table entry: as `pair!`, for bodies; does not look at those whose bounding balls are apart.
macro_rules! near {
    ($a:ident, $b:ident, $f:ident) => {{
        fn run(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
            if let (Shape::$a(a), Shape::$b(b)) = (a, b)
                && !apart(fa, fb, a.reach() + b.reach())
            {
                $f(a, fa, b, fb, out);
            }
        }
        Some(run as Collider)
    }};
}

/// A table entry: as `turn!`, for bodies; does not look at those whose bounding balls are apart.
macro_rules! turn_near {
    ($b:ident, $a:ident, $f:ident) => {{
        fn run(b: &Shape, fb: &Frame, a: &Shape, fa: &Frame, out: &mut Contacts<'_>) {
            if let (Shape::$a(a), Shape::$b(b)) = (a, b)
                && !apart(fa, fb, a.reach() + b.reach())
            {
                out.in_other_order(|out| {
                    $f(a, fa, b, fb, out);
                });
            }
        }
        Some(run as Collider)
    }};
}

/// A table entry: calls `$f` with the two shapes unpacked.
macro_rules! pair {
    ($a:ident, $b:ident, $f:ident) => {{
        fn run(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
            if let (Shape::$a(a), Shape::$b(b)) = (a, b) {
                $f(a, fa, b, fb, out);
            }
        }
        Some(run as Collider)
    }};
}

/// A table entry: calls `$f` with the shapes in the other order and turns its contacts round.
macro_rules! swap {
    ($b:ident, $a:ident, $f:ident) => {{
        fn run(b: &Shape, fb: &Frame, a: &Shape, fa: &Frame, out: &mut Contacts<'_>) {
            if let (Shape::$a(a), Shape::$b(b)) = (a, b) {
                $f(a, fa, b, fb, out);
                out.swap();
            }
        }
        Some(run as Collider)
    }};
}

/// As `swap!`, for functions that only add contacts and never look at them: these are turned round as they are added.
macro_rules! turn {
    ($b:ident, $a:ident, $f:ident) => {{
        fn run(b: &Shape, fb: &Frame, a: &Shape, fa: &Frame, out: &mut Contacts<'_>) {
            if let (Shape::$a(a), Shape::$b(b)) = (a, b) {
                out.in_other_order(|out| {
                    $f(a, fa, b, fb, out);
                });
            }
        }
        Some(run as Collider)
    }};
}

fn run_mesh(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if let Shape::TriMesh(mesh) = b {
        body_trimesh::convex_trimesh(a, fa, mesh, fb, out);
    }
}

fn run_mesh_swapped(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    run_mesh(b, fb, a, fa, out);
    out.swap();
}

fn run_plane(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if let Shape::Plane(plane) = b {
        body_plane(a, fa, plane, fb, out);
    }
}

fn run_plane_swapped(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    run_plane(b, fb, a, fa, out);
    out.swap();
}

fn run_field(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if let Shape::Heightfield(field) = a {
        heightfield_shape(field, fa, b, fb, out);
    }
}

fn run_field_swapped(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    run_field(b, fb, a, fa, out);
    out.swap();
}

const NONE: Option<Collider> = None;
/// Convex bodies without a file of their own for the pair.
const BODIES: Option<Collider> = Some(convex_bodies);
/// A convex body and a mesh.
const MESH: Option<Collider> = Some(run_mesh);
const MESH_SWAPPED: Option<Collider> = Some(run_mesh_swapped);
/// A convex body and a half-space.
const PLANE: Option<Collider> = Some(run_plane);
const PLANE_SWAPPED: Option<Collider> = Some(run_plane_swapped);
/// A heightfield and what collides with planes.
const FIELD: Option<Collider> = Some(run_field);
const FIELD_SWAPPED: Option<Collider> = Some(run_field_swapped);
const KINDS: usize = 11;

/// Row: the first shape; column: the second.
#[rustfmt::skip]
const PAIRS: [[Option<Collider>; KINDS]; KINDS] = [
    // Sphere
    [
        pair!(Sphere, Sphere, sphere_sphere),               // Sphere
        near!(Sphere, Cuboid, sphere_cuboid),               // Cuboid
        turn_near!(Sphere, Capsule, capsule_sphere),             // Capsule
        turn_near!(Sphere, Cylinder, cylinder_sphere),           // Cylinder
        pair!(Sphere, Plane, sphere_plane),                 // Plane
        turn!(Sphere, Ray, ray_sphere),                     // Ray
        BODIES,                                             // Convex
        pair!(Sphere, TriMesh, sphere_trimesh),             // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Cuboid
    [
        turn_near!(Cuboid, Sphere, sphere_cuboid),               // Sphere
        near!(Cuboid, Cuboid, cuboid_cuboid),               // Cuboid
        turn_near!(Cuboid, Capsule, capsule_cuboid),             // Capsule
        turn_near!(Cuboid, Cylinder, cylinder_cuboid),           // Cylinder
        pair!(Cuboid, Plane, cuboid_plane),                 // Plane
        turn!(Cuboid, Ray, ray_cuboid),                     // Ray
        BODIES,                                             // Convex
        pair!(Cuboid, TriMesh, cuboid_trimesh),             // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Capsule
    [
        near!(Capsule, Sphere, capsule_sphere),             // Sphere
        near!(Capsule, Cuboid, capsule_cuboid),             // Cuboid
        near!(Capsule, Capsule, capsule_capsule),           // Capsule
        near!(Capsule, Cylinder, capsule_cylinder),         // Cylinder
        pair!(Capsule, Plane, capsule_plane),               // Plane
        turn!(Capsule, Ray, ray_capsule),                   // Ray
        BODIES,                                             // Convex
        pair!(Capsule, TriMesh, capsule_trimesh),           // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Cylinder
    [
        near!(Cylinder, Sphere, cylinder_sphere),           // Sphere
        near!(Cylinder, Cuboid, cylinder_cuboid),           // Cuboid
        turn_near!(Cylinder, Capsule, capsule_cylinder),         // Capsule
        near!(Cylinder, Cylinder, cylinder_cylinder),       // Cylinder
        pair!(Cylinder, Plane, cylinder_plane),             // Plane
        turn!(Cylinder, Ray, ray_cylinder),                 // Ray
        BODIES,                                             // Convex
        pair!(Cylinder, TriMesh, cylinder_trimesh),         // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Plane
    [
        turn!(Plane, Sphere, sphere_plane),                 // Sphere
        turn!(Plane, Cuboid, cuboid_plane),                 // Cuboid
        turn!(Plane, Capsule, capsule_plane),               // Capsule
        turn!(Plane, Cylinder, cylinder_plane),             // Cylinder
        NONE,                                               // Plane
        turn!(Plane, Ray, ray_plane),                       // Ray
        turn!(Plane, Convex, convex_plane),                 // Convex
        swap!(Plane, TriMesh, trimesh_plane),               // TriMesh
        PLANE_SWAPPED,                                      // Ellipsoid
        PLANE_SWAPPED,                                      // Cone
        NONE,                                               // Heightfield
    ],
    // Ray
    [
        pair!(Ray, Sphere, ray_sphere),                     // Sphere
        pair!(Ray, Cuboid, ray_cuboid),                     // Cuboid
        pair!(Ray, Capsule, ray_capsule),                   // Capsule
        pair!(Ray, Cylinder, ray_cylinder),                 // Cylinder
        pair!(Ray, Plane, ray_plane),                       // Plane
        NONE,                                               // Ray
        pair!(Ray, Convex, ray_convex),                     // Convex
        pair!(Ray, TriMesh, ray_trimesh),                   // TriMesh
        pair!(Ray, Ellipsoid, ray_ellipsoid),               // Ellipsoid
        pair!(Ray, Cone, ray_cone),                         // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Convex
    [
        BODIES,                                             // Sphere
        BODIES,                                             // Cuboid
        BODIES,                                             // Capsule
        BODIES,                                             // Cylinder
        pair!(Convex, Plane, convex_plane),                 // Plane
        turn!(Convex, Ray, ray_convex),                     // Ray
        BODIES,                                             // Convex
        MESH,                                               // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // TriMesh
    [
        swap!(TriMesh, Sphere, sphere_trimesh),             // Sphere
        swap!(TriMesh, Cuboid, cuboid_trimesh),             // Cuboid
        swap!(TriMesh, Capsule, capsule_trimesh),           // Capsule
        swap!(TriMesh, Cylinder, cylinder_trimesh),         // Cylinder
        pair!(TriMesh, Plane, trimesh_plane),               // Plane
        swap!(TriMesh, Ray, ray_trimesh),                   // Ray
        MESH_SWAPPED,                                       // Convex
        pair!(TriMesh, TriMesh, trimesh_trimesh),           // TriMesh
        MESH_SWAPPED,                                       // Ellipsoid
        MESH_SWAPPED,                                       // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Ellipsoid
    [
        BODIES,                                             // Sphere
        BODIES,                                             // Cuboid
        BODIES,                                             // Capsule
        BODIES,                                             // Cylinder
        PLANE,                                              // Plane
        turn!(Ellipsoid, Ray, ray_ellipsoid),               // Ray
        BODIES,                                             // Convex
        MESH,                                               // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Cone
    [
        BODIES,                                             // Sphere
        BODIES,                                             // Cuboid
        BODIES,                                             // Capsule
        BODIES,                                             // Cylinder
        PLANE,                                              // Plane
        turn!(Cone, Ray, ray_cone),                         // Ray
        BODIES,                                             // Convex
        MESH,                                               // TriMesh
        BODIES,                                             // Ellipsoid
        BODIES,                                             // Cone
        FIELD_SWAPPED,                                      // Heightfield
    ],
    // Heightfield
    [
        FIELD,                                              // Sphere
        FIELD,                                              // Cuboid
        FIELD,                                              // Capsule
        FIELD,                                              // Cylinder
        NONE,                                               // Plane
        FIELD,                                              // Ray
        FIELD,                                              // Convex
        FIELD,                                              // TriMesh
        FIELD,                                              // Ellipsoid
        FIELD,                                              // Cone
        NONE,                                               // Heightfield
    ],
];

/// The matrix with rows and columns for custom shapes and compounds, in rows of a power of two: it is looked up at every call.
static TABLE: [[Option<Collider>; 16]; 16] = {
    let mut table = [[NONE; 16]; 16];
    let mut i = 0;
    while i <= KINDS + 1 {
        let mut j = 0;
        while j <= KINDS + 1 {
            table[i][j] = if i > KINDS || j > KINDS {
                Some(run_compound as Collider)
            } else if i == KINDS || j == KINDS {
                Some(run_custom as Collider)
            } else {
                PAIRS[i][j]
            };
            j += 1;
        }
        i += 1;
    }
    table
};

const _: () = assert!(ShapeKind::Custom as usize == KINDS && ShapeKind::Compound as usize == KINDS + 1);

#[inline(always)]
fn pair(a: ShapeKind, b: ShapeKind) -> Option<Collider> {
    TABLE[a as usize & 15][b as usize & 15]
}

/// The first custom shape is asked, then the second.
fn run_custom(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if let Shape::Custom(custom) = a
        && custom.get().collide(fa, b, fb, out)
    {
        return;
    }
    if let Shape::Custom(custom) = b
        && custom.get().collide(fb, a, fa, out)
    {
        out.swap();
    }
}

/// The parts of the first compound, then, pair by pair, those of the second.
fn run_compound(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if let Shape::Compound(compound) = a {
        compound_shape(compound, fa, b, fb, out);
    } else if let Shape::Compound(compound) = b {
        compound_shape(compound, fb, a, fa, out);
        out.swap();
    }
}

/// As [`collide_frames`], into a list begun elsewhere.
pub(super) fn collide_in(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if let Some(collider) = pair(a.kind(), b.kind()) {
        collider(a, fa, b, fb, out);
    }
}

/// Whether shapes of these kinds can touch at all: two planes, or two rays, cannot; of custom shapes it is not known.
pub fn collides(a: ShapeKind, b: ShapeKind) -> bool {
    pair(a, b).is_some()
}

/// Finds the contacts of two shapes, adds them to `out` and returns their number.
///
/// Normals point into `a`. `out` keeps what it holds; nothing is allocated if it has room.
pub fn collide(
    a: (&Shape, &Pose),
    b: (&Shape, &Pose),
    options: CollideOptions,
    out: &mut Vec<GeomContact>,
) -> usize {
    collide_frames((a.0, &Frame::from(a.1)), (b.0, &Frame::from(b.1)), options, out)
}

/// As [`collide`], for callers who have the rotation matrices at hand.
#[inline]
pub fn collide_frames(
    a: (&Shape, &Frame),
    b: (&Shape, &Frame),
    options: CollideOptions,
    out: &mut Vec<GeomContact>,
) -> usize {
    let Some(collider) = pair(a.0.kind(), b.0.kind()) else { return 0 };
    if options.max_contacts == 0 {
        return 0;
    }
    let mut contacts = Contacts::new(out, options);
    collider(a.0, a.1, b.0, b.1, &mut contacts);
    contacts.finish();
    contacts.len()
}

/// Whether two shapes touch.
pub fn touches(a: (&Shape, &Frame), b: (&Shape, &Frame)) -> bool {
    pair(a.0.kind(), b.0.kind()).is_some_and(|collider| {
        let mut found = Vec::new();
        // Any contact would do, but boxes that are asked for any report contacts that are none.
        let mut out = Contacts::new(&mut found, CollideOptions::new(1));
        collider(a.0, a.1, b.0, b.1, &mut out);
        !found.is_empty()
    })
}
