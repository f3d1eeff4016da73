//! Vectors, rotations, poses and SIMD lanes of the [Ferrode](https://docs.rs/ferrode) rigid-body engine.
//!
//! The types are generic over a [`Scalar`]: `f64`, `f32` or a lane type, so that one source of a kernel serves
//! scalar and wide code. Nearly all code uses the plain `f64` aliases [`Vec3`], [`Mat3`], [`Quat`] and [`Pose`].
//!
//! Conventions are those of the Open Dynamics Engine: quaternions are `(w, x, y, z)` with the real part first, a
//! rotation matrix takes body coordinates to world coordinates, vectors are columns, and angles are radians.
//!
//! ```
//! use ferrode_math::{Pose, Quat, Vec3};
//! let pose = Pose::new(Vec3::new(0.0, 0.0, 1.0), Quat::from_axis_angle(Vec3::Z, std::f64::consts::FRAC_PI_2));
//! let p = pose.transform_point(Vec3::X);
//! assert!((p - Vec3::new(0.0, 1.0, 1.0)).length() < 1e-15);
//! ```
#![deny(unsafe_code)]

mod aabb;
mod contact_point;
mod matrix;
mod pose;
mod quaternion;
pub mod random;
pub mod real;
pub mod rotation;
mod scalar;
pub mod simd;
pub mod stage;
mod vector;

pub use aabb::Aabb;
pub use contact_point::ContactPoint;
pub use matrix::Matrix3;
pub use pose::Transform;
pub use quaternion::Quaternion;
pub use rotation::plane_space;
pub use scalar::Scalar;
pub use vector::Vector3;

/// A vector of three `f64`.
pub type Vec3 = Vector3<f64>;
/// A 3×3 matrix of `f64`, row-major.
pub type Mat3 = Matrix3<f64>;
/// A quaternion of `f64`, real part first.
pub type Quat = Quaternion<f64>;
/// A rigid transform of `f64`: position and unit quaternion.
pub type Pose = Transform<f64>;
