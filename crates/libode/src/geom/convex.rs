//! Convex polyhedra by the program's arrays, which stay its own: what it changes there counts from the next collision on.

use super::kept::Kept;
use super::{GeomId, GeomRecord, class, of_class};
use crate::fault::{Fault, Outcome, export};
use crate::real::{Real, vec3};
use crate::record::Required;
use crate::slab::Held;
use core::cell::Cell;
use core::ffi::c_uint;
use ferrode_collide::{Convex, Shape};

/// The program's arrays: corners by three numbers, and for each face the number of its corners and these.
#[derive(Clone, Copy)]
struct Arrays {
    points: *const Real,
    point_count: usize,
    polygons: *const c_uint,
    face_count: usize,
}

/// What the arrays held when they were last looked at.
#[derive(Default)]
struct Seen {
    points: Vec<Real>,
    polygons: Vec<c_uint>,
}

/// What only a polyhedron's geom has.
#[derive(Default)]
pub struct ConvexGeom {
    arrays: Cell<Option<Arrays>>,
    seen: Kept<Seen>,
}

impl Arrays {
    fn points(&self) -> &[Real] {
        // SAFETY: not null, and three numbers a point that the program keeps as long as the geom uses them (the exported
        // functions' contract).
        unsafe { core::slice::from_raw_parts(self.points, 3 * self.point_count) }
    }

    /// All faces' numbers, one after the other.
    fn polygons(&self) -> &[c_uint] {
        let mut length = 0;
        for _ in 0..self.face_count {
            // SAFETY: not null, and each face is a number of corners and as many indices (as above).
            length += 1 + unsafe { self.polygons.add(length).read() } as usize;
        }
        // SAFETY: as above.
        unsafe { core::slice::from_raw_parts(self.polygons, length) }
    }

    fn shape(&self) -> Outcome<Shape> {
        let points: Vec<_> = self.points().chunks_exact(3).map(|p| vec3(p[0], p[1], p[2])).collect();
        let (mut faces, mut rest) = (Vec::with_capacity(self.face_count), self.polygons());
        while let Some((count, after)) = rest.split_first() {
            let (face, after) = after.split_at(*count as usize);
            faces.push(face);
            rest = after;
        }
        Convex::from_faces(&points, &faces).map(Shape::from).map_err(|_| Fault::ARGUMENT)
    }

    fn look(&self) -> Seen {
        Seen { points: self.points().to_vec(), polygons: self.polygons().to_vec() }
    }

    fn is_as(&self, seen: &Seen) -> bool {
        let bits = |points: &[Real], others: &[Real]| {
            points.iter().zip(others).all(|(a, b)| a.to_bits() == b.to_bits())
        };
        self.points().len() == seen.points.len()
            && bits(self.points(), &seen.points)
            && self.polygons() == seen.polygons
    }
}

impl GeomRecord {
    /// Looks whether the program has changed its arrays. If they make no polyhedron any more, the last that they made
    /// stays.
    pub fn refresh_convex(&self) {
        let Some(arrays) = self.convex.arrays.get() else { return };
        // The first of several threads that find a change takes it over.
        let _held = Held::content(self);
        if self.convex.seen.with(|seen| arrays.is_as(seen)) {
            return;
        }
        self.convex.seen.set(arrays.look());
        if let Ok(shape) = arrays.shape() {
            self.shape.set(Some(shape));
        }
    }

    /// Lets the program's arrays go.
    pub fn forget_convex(&self) {
        self.convex.arrays.set(None);
        self.convex.seen.set(Seen::default());
    }

    fn keep(&self, arrays: Arrays) {
        self.convex.seen.set(arrays.look());
        self.convex.arrays.set(Some(arrays));
    }
}

fn arrays(
    points: *const Real,
    point_count: c_uint,
    polygons: *const c_uint,
    face_count: c_uint,
) -> Outcome<Arrays> {
    if points.is_null() || polygons.is_null() {
        return Err(Fault::ARGUMENT);
    }
    Ok(Arrays { points, point_count: point_count as usize, polygons, face_count: face_count as usize })
}

export! {
    fn dCreateConvex(
        space: GeomId, _planes: *const Real, plane_count: c_uint, points: *const Real, point_count: c_uint,
        polygons: *const c_uint,
    ) -> GeomId {
        let arrays = arrays(points, point_count, polygons, plane_count)?;
        let geom = GeomRecord::create(class::CONVEX, Some(arrays.shape()?), None, space)?;
        geom.get()?.keep(arrays);
        geom
    }
    fn dGeomSetConvex(
        geom: GeomId, _planes: *const Real, plane_count: c_uint, points: *const Real, point_count: c_uint,
        polygons: *const c_uint,
    ) {
        let geom = of_class(geom, class::CONVEX, "argument not a convex shape")?;
        let arrays = arrays(points, point_count, polygons, plane_count)?;
        super::shapes::reshape_to(geom, arrays.shape()?)?;
        geom.keep(arrays)
    }
}
