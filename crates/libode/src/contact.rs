//! Contacts: the records that collision fills and contact joints are made from.

use crate::real::{Real, Real4, f, vector};
use core::ffi::{c_int, c_void};
use ferrode_dynamics::{Contact, SurfaceMode};
use ferrode_math::Vec3;

/// `dSurfaceParameters`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SurfaceRecord {
    mode: c_int,
    mu: Real,
    mu2: Real,
    rho: Real,
    rho2: Real,
    rho_n: Real,
    bounce: Real,
    bounce_velocity: Real,
    soft_erp: Real,
    soft_cfm: Real,
    motion1: Real,
    motion2: Real,
    motion_n: Real,
    slip1: Real,
    slip2: Real,
}

/// `dContactGeom`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ContactGeomRecord {
    pub position: Real4,
    pub normal: Real4,
    pub depth: Real,
    pub geom1: *mut c_void,
    pub geom2: *mut c_void,
    pub side1: c_int,
    pub side2: c_int,
}

/// `dContact`, in the layout of 0.16.2.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ContactRecord {
    surface: SurfaceRecord,
    geom: ContactGeomRecord,
    fdir1: Real4,
}

#[cfg(target_pointer_width = "64")]
const _: () = assert!(size_of::<Real>() != 8 || size_of::<ContactRecord>() == 248);

impl ContactRecord {
    /// Writes down what the engine needs of it. Programs fill in only what the mode asks for; the rest may be whatever was in memory.
    ///
    /// Number by number from where the program wrote it to where the engine keeps it: copies of whole records would wait for each number
    /// to be stored.
    #[inline]
    pub fn write_to(&self, contact: &mut Contact) {
        let s = &self.surface;
        let mode = SurfaceMode(s.mode.cast_unsigned());
        let asked = |by: SurfaceMode, x: Real| if mode.has(by) { f(x) } else { 0.0 };
        // Not asked for without rolling, whatever else is.
        let turning = if mode.has(SurfaceMode::ROLLING) { SurfaceMode::MU2 } else { SurfaceMode::ROLLING };
        let to = &mut contact.surface;
        to.mode = mode;
        to.mu = f(s.mu);
        to.mu2 = asked(SurfaceMode::MU2, s.mu2);
        to.rho = asked(SurfaceMode::ROLLING, s.rho);
        to.rho2 = asked(turning, s.rho2);
        to.rho_n = asked(turning, s.rho_n);
        to.bounce = asked(SurfaceMode::BOUNCE, s.bounce);
        to.bounce_velocity = asked(SurfaceMode::BOUNCE, s.bounce_velocity);
        to.soft_erp = asked(SurfaceMode::SOFT_ERP, s.soft_erp);
        to.soft_cfm = asked(SurfaceMode::SOFT_CFM, s.soft_cfm);
        to.motion1 = asked(SurfaceMode::MOTION1, s.motion1);
        to.motion2 = asked(SurfaceMode::MOTION2, s.motion2);
        to.motion_n = asked(SurfaceMode::MOTION_N, s.motion_n);
        to.slip1 = asked(SurfaceMode::SLIP1, s.slip1);
        to.slip2 = asked(SurfaceMode::SLIP2, s.slip2);
        to.max_correcting_velocity = None;
        to.surface_layer = None;
        let to = &mut contact.point;
        to.position = vector(&self.geom.position);
        to.normal = vector(&self.geom.normal);
        to.depth = f(self.geom.depth);
        contact.fdir1 = if mode.has(SurfaceMode::FDIR1) { vector(&self.fdir1) } else { Vec3::ZERO };
    }
}
