//! A mesh's callbacks: which of its triangles count, and how contacts with a ball are merged.
//!
//! Nothing is borrowed while the program is asked.

use super::heightfield::View;
use super::trimesh::MergeCallback;
use super::{GeomId, GeomRecord, class};
use crate::real::r;
use core::ffi::c_int;
use ferrode_collide::narrow::{ContactMerge, collide_frames, triangle_candidates};
use ferrode_collide::{CollideOptions, Frame, GeomContact, Shape, TriMesh};
use ferrode_math::Vec3;

/// What the program has to say about one collision of a mesh with a ball, box, capsule, cylinder or ray.
pub struct MeshChoice {
    mesh: &'static GeomRecord,
    other: &'static GeomRecord,
    /// The mesh's, and the other's.
    frames: [Frame; 2],
    /// Whether the mesh is the first of the two.
    first: bool,
    /// The triangles that it keeps, if it doesn't keep all: a mesh of these, and their numbers.
    part: Option<(TriMesh, Vec<u32>)>,
    nothing: bool,
}

impl MeshChoice {
    /// Asks about the triangles near the other geom. `None` if there is no mesh with something to say.
    pub fn of(a: &'static GeomRecord, fa: &Frame, b: &'static GeomRecord, fb: &Frame) -> Option<Self> {
        let speaks = |mesh: &GeomRecord, other: &GeomRecord| {
            let m = &mesh.mesh;
            let asks = m.tri.get().is_some() || m.array.get().is_some() || m.ray.get().is_some();
            let kind = other.class.get();
            let asked =
                matches!(kind, class::SPHERE | class::BOX | class::CAPSULE | class::CYLINDER | class::RAY);
            let names = m.names_merged().is_some() && kind == class::SPHERE;
            mesh.class.get() == class::TRIMESH && (asks && asked || names)
        };
        let (mesh, frame, other, other_frame, first) = if speaks(a, b) {
            (a, fa, b, fb, true)
        } else if speaks(b, a) {
            (b, fb, a, fa, false)
        } else {
            return None;
        };
        let frames = [*frame, *other_frame];
        let mut choice = Self { mesh, other, frames, first, part: None, nothing: false };
        if !choice.is_ray() {
            choice.ask(other_frame);
        }
        Some(choice)
    }

    fn is_ray(&self) -> bool {
        self.other.class.get() == class::RAY
    }

    /// Whether hits of a ray are asked about once they are found.
    pub fn asks_hits(&self) -> bool {
        self.is_ray()
    }

    fn whole(&self) -> Option<TriMesh> {
        self.mesh.shape.with(|shape| match shape {
            Some(Shape::TriMesh(mesh)) => Some(mesh.clone()),
            _ => None,
        })
    }

    fn ids(&self) -> (GeomId, GeomId) {
        (GeomId::of(self.mesh), GeomId::of(self.other))
    }

    /// Asks about all candidates at once, then about each.
    fn ask(&mut self, other_frame: &Frame) {
        let (tri, array) = (self.mesh.mesh.tri.get(), self.mesh.mesh.array.get());
        if tri.is_none() && array.is_none() {
            return;
        }
        let (Some(whole), Some(shape)) = (self.whole(), self.other.shape.with(Option::clone)) else { return };
        let candidates = triangle_candidates(&shape, other_frame, &whole, &self.frames[0]);
        let (mesh, other) = self.ids();
        if let Some(array) = array
            && !candidates.is_empty()
        {
            let numbers: Vec<c_int> = candidates.iter().map(|i| *i as c_int).collect();
            // SAFETY: the program's own function, called as its header says.
            unsafe { array(mesh, other, numbers.as_ptr(), numbers.len() as c_int) };
        }
        let Some(tri) = tri else { return };
        let mut kept = candidates.clone();
        // SAFETY: as above.
        kept.retain(|i| unsafe { tri(mesh, other, *i as c_int) } != 0);
        if kept.len() == candidates.len() {
            return;
        }
        let soup: Vec<[Vec3; 3]> = kept.iter().map(|i| whole.corners(*i)).collect();
        match TriMesh::from_triangles(&soup) {
            Ok(part) if !kept.is_empty() => {
                self.part = Some((part.with_sphere_merge(whole.sphere_merge()), kept));
            }
            _ => self.nothing = true,
        }
    }

    /// What of the two geoms counts.
    pub fn views(&self, a: View, b: View) -> (View, View) {
        let view = if self.nothing {
            View::Nothing
        } else if let Some((part, _)) = &self.part {
            View::Part(Box::new(Shape::from(part.clone())), self.frames[0])
        } else {
            View::Whole
        };
        if self.first { (view, b) } else { (a, view) }
    }

    fn side(&self, contact: &GeomContact) -> c_int {
        if self.first { contact.side1 } else { contact.side2 }
    }

    fn set_side(&self, contact: &mut GeomContact, triangle: c_int) {
        *(if self.first { &mut contact.side1 } else { &mut contact.side2 }) = triangle;
    }

    /// Names triangles by their numbers in the whole mesh, drops the hits that the program doesn't want, and merges.
    pub fn finish(&self, found: &mut Vec<GeomContact>) {
        for contact in &mut *found {
            let triangle = self.number(self.side(contact));
            self.set_side(contact, triangle);
        }
        if self.is_ray() {
            self.choose_hits(found);
        } else if let ([contact], Some(merge)) = (&mut found[..], self.mesh.mesh.names_merged())
            && self.side(contact) < 0
        {
            let name = self.merged_name(merge);
            self.set_side(contact, name);
        }
    }

    /// A triangle's number in the whole mesh.
    fn number(&self, triangle: c_int) -> c_int {
        let Some((_, numbers)) = &self.part else { return triangle };
        let number = usize::try_from(triangle).ok().and_then(|i| numbers.get(i));
        number.map_or(triangle, |number| *number as c_int)
    }

    /// What the program calls a contact that several triangles make with a ball.
    fn merged_name(&self, merge: MergeCallback) -> c_int {
        let mesh = self.part.as_ref().map(|(part, _)| part.clone()).or_else(|| self.whole());
        let (Some(mesh), Some(ball)) = (mesh, self.other.shape.with(Option::clone)) else { return -1 };
        let single = Shape::from(mesh.with_sphere_merge(ContactMerge::Normals));
        let [fm, fb] = &self.frames;
        let mut each = Vec::new();
        collide_frames((&single, fm), (&ball, fb), CollideOptions::default(), &mut each);
        let names = each.iter().map(|contact| self.number(contact.side1));
        // SAFETY: the program's own function, called as its header says.
        let two = |a, b| unsafe { merge(GeomId::of(self.mesh), a, b) };
        names.reduce(two).unwrap_or(-1)
    }

    fn choose_hits(&self, found: &mut Vec<GeomContact>) {
        let (mesh, other) = self.ids();
        let (ray, tri) = (self.mesh.mesh.ray.get(), self.mesh.mesh.tri.get());
        let whole = self.whole();
        found.retain(|contact| {
            let triangle = self.side(contact);
            if let (Some(ray), Some(whole)) = (ray, &whole) {
                let point = self.frames[0].point_to_local(contact.point.position);
                let (u, v) = barycentrics(whole, triangle, point);
                // SAFETY: the program's own function, called as its header says.
                if unsafe { ray(mesh, other, triangle, r(u), r(v)) } == 0 {
                    return false;
                }
            }
            // SAFETY: as above.
            tri.is_none_or(|tri| unsafe { tri(mesh, other, triangle) } != 0)
        });
    }
}

/// Where in a triangle a point is: (1 - u - v) v0 + u v1 + v v2.
fn barycentrics(mesh: &TriMesh, triangle: c_int, point: Vec3) -> (f64, f64) {
    if !(0..mesh.triangles().len() as c_int).contains(&triangle) {
        return (0.0, 0.0);
    }
    let [a, b, c] = mesh.corners(triangle.cast_unsigned());
    let (e, f, p) = (b - a, c - a, point - a);
    let (ee, ef, ff) = (e.dot(e), e.dot(f), f.dot(f));
    let (pe, pf) = (p.dot(e), p.dot(f));
    let k = 1.0 / (ee * ff - ef * ef);
    ((ff * pe - ef * pf) * k, (ee * pf - ef * pe) * k)
}
