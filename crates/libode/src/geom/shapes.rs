//! Geoms by shape: making them, their sizes, depths of points.

use super::{GeomId, GeomRecord, class, of_class};
use crate::fault::{Fault, Outcome, export};
use crate::real::{Out, OutVector, Real, f, r, vec3, vector3};
use core::ffi::c_int;
use ferrode_collide::{Capsule, Cuboid, Cylinder, Plane, Ray, Shape, ShapeError, Sphere, point_depth};
use ferrode_math::Vec3;

fn made<S: Into<Shape>>(shape: Result<S, ShapeError>) -> Outcome<Shape> {
    shape.map(Into::into).map_err(|_| Fault::ARGUMENT)
}

fn create<S: Into<Shape>>(class: c_int, space: GeomId, shape: Result<S, ShapeError>) -> Outcome<GeomId> {
    GeomRecord::create(class, Some(made(shape)?), None, space)
}

/// Gives a geom another shape of its class.
fn reshape<S: Into<Shape>>(geom: &GeomRecord, shape: Result<S, ShapeError>) -> Outcome<()> {
    reshape_to(geom, made(shape)?)
}

/// As [`reshape`], with a shape that is known to be one.
pub fn reshape_to(geom: &GeomRecord, shape: Shape) -> Outcome<()> {
    if let Some(parent) = geom.parent() {
        parent.require_unlocked()?;
    }
    geom.shape.set(Some(shape));
    geom.tell_space();
    geom.moved()
}

/// Reads a geom's shape, which is of the kind that its class says.
macro_rules! shape_of {
    ($geom:ident, $kind:ident) => {
        $geom.shape.with(|shape| match shape {
            Some(Shape::$kind(shape)) => Ok(shape.clone()),
            _ => Err(Fault::ARGUMENT),
        })?
    };
}

fn sphere(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::SPHERE, "argument not a sphere")
}

fn cuboid(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::BOX, "argument not a box")
}

fn capsule(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::CAPSULE, "argument not a ccylinder")
}

fn cylinder(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::CYLINDER, "argument not a ccylinder")
}

fn plane(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::PLANE, "argument not a plane")
}

fn ray(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::RAY, "argument not a ray")
}

/// A plane by its equation; one without a normal faces along x, as in ODE.
fn plane_by(a: Real, b: Real, c: Real, d: Real) -> Result<Plane, ShapeError> {
    let normal = vec3(a, b, c);
    if normal == Vec3::ZERO { Plane::new(Vec3::X, 0.0) } else { Plane::new(normal, f(d)) }
}

fn depth(geom: &GeomRecord, x: Real, y: Real, z: Real) -> Outcome<Real> {
    let frame = geom.frame();
    let depth =
        geom.shape.with(|shape| shape.as_ref().and_then(|shape| point_depth(shape, &frame, vec3(x, y, z))));
    Ok(r(depth.ok_or(Fault::ARGUMENT)?))
}

/// The depth of a point in a box as 0.16.2 counts it: outside, minus the distance to the farthest of the six faces.
fn box_depth(geom: &GeomRecord, x: Real, y: Real, z: Real) -> Outcome<Real> {
    let local = geom.frame().point_to_local(vec3(x, y, z)).abs();
    let half = shape_of!(geom, Cuboid).half_sides();
    let (inside, far) = (half - local, half + local);
    let least = inside.x.min(inside.y).min(inside.z);
    Ok(r(if least >= 0.0 { least } else { -far.x.max(far.y).max(far.z) }))
}

/// A size as the engine takes it: infinity, which programs give to rays, counts as the largest.
fn size(x: Real) -> f64 {
    let x = f(x);
    if x > 1e150 { 1e150 } else { x }
}

/// Changes a ray's options.
fn ray_options(geom: GeomId, change: impl FnOnce(&mut Ray)) -> Outcome<()> {
    ray(geom)?.shape.change(|shape| {
        if let Some(Shape::Ray(shape)) = shape {
            change(shape);
        }
    });
    Ok(())
}

fn ray_option(geom: GeomId, option: impl FnOnce(&Ray) -> bool) -> Outcome<c_int> {
    let geom = ray(geom)?;
    Ok(option(&shape_of!(geom, Ray)).into())
}

export! {
    fn dCreateSphere(space: GeomId, radius: Real) -> GeomId { create(class::SPHERE, space, Sphere::new(size(radius)))? }
    fn dGeomSphereSetRadius(geom: GeomId, radius: Real) { reshape(sphere(geom)?, Sphere::new(size(radius)))? }
    fn dGeomSphereGetRadius(geom: GeomId) -> Real {
        let geom = sphere(geom)?;
        r(shape_of!(geom, Sphere).radius())
    }
    fn dGeomSpherePointDepth(geom: GeomId, x: Real, y: Real, z: Real) -> Real { depth(sphere(geom)?, x, y, z)? }

    fn dCreateBox(space: GeomId, lx: Real, ly: Real, lz: Real) -> GeomId {
        create(class::BOX, space, Cuboid::new(Vec3::new(size(lx), size(ly), size(lz))))?
    }
    fn dGeomBoxSetLengths(geom: GeomId, lx: Real, ly: Real, lz: Real) {
        reshape(cuboid(geom)?, Cuboid::new(Vec3::new(size(lx), size(ly), size(lz))))?
    }
    fn dGeomBoxGetLengths(geom: GeomId, lengths: OutVector) {
        let geom = cuboid(geom)?;
        lengths.set(vector3(shape_of!(geom, Cuboid).sides()))?
    }
    fn dGeomBoxPointDepth(geom: GeomId, x: Real, y: Real, z: Real) -> Real { box_depth(cuboid(geom)?, x, y, z)? }

    fn dCreateCapsule(space: GeomId, radius: Real, length: Real) -> GeomId {
        create(class::CAPSULE, space, Capsule::new(size(radius), size(length)))?
    }
    fn dGeomCapsuleSetParams(geom: GeomId, radius: Real, length: Real) {
        reshape(capsule(geom)?, Capsule::new(size(radius), size(length)))?
    }
    fn dGeomCapsuleGetParams(geom: GeomId, radius: Out<Real>, length: Out<Real>) {
        let geom = capsule(geom)?;
        let shape = shape_of!(geom, Capsule);
        radius.set_if_wanted([r(shape.radius())]);
        length.set_if_wanted([r(shape.length())])
    }
    fn dGeomCapsulePointDepth(geom: GeomId, x: Real, y: Real, z: Real) -> Real { depth(capsule(geom)?, x, y, z)? }

    fn dCreateCylinder(space: GeomId, radius: Real, length: Real) -> GeomId {
        create(class::CYLINDER, space, Cylinder::new(size(radius), size(length)))?
    }
    fn dGeomCylinderSetParams(geom: GeomId, radius: Real, length: Real) {
        reshape(cylinder(geom)?, Cylinder::new(size(radius), size(length)))?
    }
    fn dGeomCylinderGetParams(geom: GeomId, radius: Out<Real>, length: Out<Real>) {
        let geom = cylinder(geom)?;
        let shape = shape_of!(geom, Cylinder);
        radius.set_if_wanted([r(shape.radius())]);
        length.set_if_wanted([r(shape.length())])
    }

    fn dCreatePlane(space: GeomId, a: Real, b: Real, c: Real, d: Real) -> GeomId {
        create(class::PLANE, space, plane_by(a, b, c, d))?
    }
    fn dGeomPlaneSetParams(geom: GeomId, a: Real, b: Real, c: Real, d: Real) {
        reshape(plane(geom)?, plane_by(a, b, c, d))?
    }
    fn dGeomPlaneGetParams(geom: GeomId, params: Out<Real, 4>) {
        let geom = plane(geom)?;
        let shape = shape_of!(geom, Plane);
        let [x, y, z] = vector3(shape.normal());
        params.set([x, y, z, r(shape.d())])?
    }
    fn dGeomPlanePointDepth(geom: GeomId, x: Real, y: Real, z: Real) -> Real { depth(plane(geom)?, x, y, z)? }

    fn dCreateRay(space: GeomId, length: Real) -> GeomId { create(class::RAY, space, Ray::new(size(length).max(0.0)))? }
    fn dGeomRaySetLength(geom: GeomId, length: Real) {
        let geom = ray(geom)?;
        let old = shape_of!(geom, Ray);
        let ray = Ray::new(size(length).max(0.0)).map(|mut new| {
            new.first_contact = old.first_contact;
            new.backface_cull = old.backface_cull;
            new.closest_hit = old.closest_hit;
            new
        });
        reshape(geom, ray)?
    }
    fn dGeomRayGetLength(geom: GeomId) -> Real {
        let geom = ray(geom)?;
        r(shape_of!(geom, Ray).length())
    }
    /// The rotation's first two columns are filled in at right angles; ODE leaves what was there.
    fn dGeomRaySet(geom: GeomId, px: Real, py: Real, pz: Real, dx: Real, dy: Real, dz: Real) {
        let geom = ray(geom)?;
        let direction = vec3(dx, dy, dz).normalized();
        let direction = direction.ok_or(Fault::internal("assertion \"!bSafeNormalize3Fault\" failed"))?;
        if let Some(parent) = geom.parent() {
            parent.require_unlocked()?;
        }
        // As in ODE only the direction's column changes, on a body too, whose quaternion stays.
        let body = geom.on_body().filter(|_| !geom.has_offset.get()).map(crate::record::BodyRecord::current);
        let mut m = body.map_or_else(|| geom.rotation.get(), |body| body.rotation.get());
        (m[2], m[6], m[10]) = (r(direction.x), r(direction.y), r(direction.z));
        if let Some(body) = body {
            body.position.set([px, py, pz, 0.0]);
            body.rotation.set(m);
        } else {
            geom.position.set([px, py, pz, 0.0]);
            geom.rotation.set(m);
        }
        geom.moved()?
    }
    fn dGeomRayGet(geom: GeomId, start: OutVector, direction: OutVector) {
        let frame = ray(geom)?.frame();
        start.set(vector3(frame.position))?;
        direction.set(vector3(frame.axis(2)))?
    }
    fn dGeomRaySetParams(geom: GeomId, first_contact: c_int, backface_cull: c_int) {
        ray_options(geom, |ray| {
            ray.first_contact = first_contact != 0;
            ray.backface_cull = backface_cull != 0;
        })?
    }
    fn dGeomRayGetParams(geom: GeomId, first_contact: Out<c_int>, backface_cull: Out<c_int>) {
        first_contact.set_if_wanted([ray_option(geom, |ray| ray.first_contact)?]);
        backface_cull.set_if_wanted([ray_option(geom, |ray| ray.backface_cull)?])
    }
    fn dGeomRaySetFirstContact(geom: GeomId, on: c_int) { ray_options(geom, |ray| ray.first_contact = on != 0)? }
    fn dGeomRayGetFirstContact(geom: GeomId) -> c_int { ray_option(geom, |ray| ray.first_contact)? }
    fn dGeomRaySetBackfaceCull(geom: GeomId, on: c_int) { ray_options(geom, |ray| ray.backface_cull = on != 0)? }
    fn dGeomRayGetBackfaceCull(geom: GeomId) -> c_int { ray_option(geom, |ray| ray.backface_cull)? }
    fn dGeomRaySetClosestHit(geom: GeomId, on: c_int) { ray_options(geom, |ray| ray.closest_hit = on != 0)? }
    fn dGeomRayGetClosestHit(geom: GeomId) -> c_int { ray_option(geom, |ray| ray.closest_hit)? }
}
