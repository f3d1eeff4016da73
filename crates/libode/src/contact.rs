//! Contacts: the records that collision fills and contact joints are made from.

use crate::real::{Real, Real4, f, vector};
use core::ffi::{c_int, c_void};
use ferrode_dynamics::{Contact, Surface, SurfaceMode};
use ferrode_math::ContactPoint;

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
    pub fn to_engine(self) -> Contact {
        let s = self.surface;
        Contact {
            surface: Surface {
                mode: SurfaceMode(s.mode.cast_unsigned()),
                mu: f(s.mu),
                mu2: f(s.mu2),
                rho: f(s.rho),
                rho2: f(s.rho2),
                rho_n: f(s.rho_n),
                bounce: f(s.bounce),
                bounce_velocity: f(s.bounce_velocity),
                soft_erp: f(s.soft_erp),
                soft_cfm: f(s.soft_cfm),
                motion1: f(s.motion1),
                motion2: f(s.motion2),
                motion_n: f(s.motion_n),
                slip1: f(s.slip1),
                slip2: f(s.slip2),
                ..Surface::default()
            },
            point: ContactPoint {
                position: vector(&self.geom.position),
                normal: vector(&self.geom.normal),
                depth: f(self.geom.depth),
            },
            fdir1: vector(&self.fdir1),
        }
    }
}
