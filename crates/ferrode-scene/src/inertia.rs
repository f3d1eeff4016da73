//! Mass and inertia: from shapes and densities, of bodies put together, and whether they can exist.

use ferrode_math::{Mat3, Pose, Quat, Vec3, real};

use crate::description::{Collision, Geometry, Inertial};

/// Mass, centre and inertia (about the centre, along the shape's axes) of a solid shape of unit density.
///
/// Textbook integrals over the solid; for the capsule the half-spheres are carried to the ends of the cylinder by
/// the parallel axis theorem, their own centres being 3/8 r above their flat sides. Meshes and polylines are
/// integrated triangle by triangle.
///
/// # Errors
/// Why the shape has no volume.
pub(crate) fn solid(geometry: &Geometry) -> std::result::Result<Inertial, String> {
    let pi = std::f64::consts::PI;
    let (volume, moments, centre) = match *geometry {
        Geometry::Cuboid { size } => {
            let volume = size.x * size.y * size.z;
            let (xx, yy, zz) = (size.x * size.x, size.y * size.y, size.z * size.z);
            (volume, Vec3::new(yy + zz, xx + zz, xx + yy) * (volume / 12.0), Vec3::ZERO)
        }
        Geometry::Sphere { radius } => {
            let volume = 4.0 / 3.0 * pi * radius * radius * radius;
            (volume, Vec3::splat(0.4 * volume * radius * radius), Vec3::ZERO)
        }
        Geometry::Cylinder { radius, length } => {
            let (rr, ll) = (radius * radius, length * length);
            let volume = pi * rr * length;
            let across = volume * (3.0 * rr + ll) / 12.0;
            (volume, Vec3::new(across, across, 0.5 * volume * rr), Vec3::ZERO)
        }
        Geometry::Capsule { radius, length } => {
            let (rr, ll) = (radius * radius, length * length);
            let cylinder = pi * rr * length;
            let ball = 4.0 / 3.0 * pi * rr * radius;
            let across =
                cylinder * (3.0 * rr + ll) / 12.0 + ball * (0.4 * rr + 0.25 * ll + 0.375 * length * radius);
            (cylinder + ball, Vec3::new(across, across, 0.5 * cylinder * rr + 0.4 * ball * rr), Vec3::ZERO)
        }
        Geometry::Ellipsoid { radii } => {
            let volume = 4.0 / 3.0 * pi * radii.x * radii.y * radii.z;
            let (xx, yy, zz) = (radii.x * radii.x, radii.y * radii.y, radii.z * radii.z);
            (volume, Vec3::new(yy + zz, xx + zz, xx + yy) * (0.2 * volume), Vec3::ZERO)
        }
        Geometry::Cone { radius, length } => {
            let (rr, ll) = (radius * radius, length * length);
            let volume = pi * rr * length / 3.0;
            let across = volume * (0.15 * rr + 0.0375 * ll);
            // The centre of mass is a quarter of the height above the base.
            (volume, Vec3::new(across, across, 0.3 * volume * rr), Vec3::new(0.0, 0.0, -0.25 * length))
        }
        _ => return solid_of_triangles(geometry),
    };
    Ok(Inertial { mass: volume, pose: Pose::from_position(centre), inertia: Mat3::from_diagonal(moments) })
}

fn solid_of_triangles(geometry: &Geometry) -> std::result::Result<Inertial, String> {
    let Some(triangles) = geometry.triangles() else {
        return Err(format!("a {} has no volume", geometry.kind()));
    };
    let triangles = triangles?;
    let mass = ferrode::Mass::trimesh(1.0, &triangles.vertices, &triangles.triangles)
        .map_err(|error| error.to_string())?;
    Ok(Inertial { mass: mass.mass, pose: Pose::from_position(mass.centre), inertia: mass.about_centre() })
}

/// The inertial of a link from its collisions, in the link frame. Collisions whose shape has no volume of its own
/// are handed to `skipped`, with the reason. `None` if nothing with a volume is left.
pub(crate) fn from_collisions<'a>(
    collisions: impl Iterator<Item = &'a Collision>,
    density: f64,
    mut skipped: impl FnMut(&'a Collision, String),
) -> Option<Inertial> {
    let mut parts = Vec::new();
    for collision in collisions {
        match solid(&collision.geometry) {
            Ok(part) => {
                let density = collision.density.unwrap_or(density);
                parts.push(Inertial {
                    mass: part.mass * density,
                    pose: collision.pose * part.pose,
                    inertia: part.inertia * density,
                });
            }
            Err(reason) => skipped(collision, reason),
        }
    }
    combine(&parts)
}

/// The inertial of several rigid parts held together, with the axes of the frame their poses are in.
/// `None` if they have no mass.
pub(crate) fn combine(parts: &[Inertial]) -> Option<Inertial> {
    let mass: f64 = parts.iter().map(|part| part.mass).sum();
    if mass <= 0.0 {
        return None;
    }
    let moment = parts.iter().fold(Vec3::ZERO, |sum, part| sum + part.pose.position * part.mass);
    let centre = moment / mass;
    let mut inertia = Mat3::ZERO;
    for part in parts {
        let rotation = part.pose.rotation.to_matrix();
        let arm = part.pose.position - centre;
        let steiner = Mat3::IDENTITY * arm.length_squared() - Mat3::outer(arm, arm);
        inertia += rotation * part.inertia * rotation.transpose() + steiner * part.mass;
    }
    Some(Inertial { mass, pose: Pose::new(centre, Quat::IDENTITY), inertia: symmetric(&inertia) })
}

fn symmetric(m: &Mat3) -> Mat3 {
    (*m + m.transpose()) * 0.5
}

/// Why an inertia tensor cannot belong to a rigid body; `None` if it can.
///
/// The principal moments λ₁ ≤ λ₂ ≤ λ₃ of a body are positive and λ₁ + λ₂ ≥ λ₃ (the moments are sums over m(y² + z²)
/// and so on). Files give them rounded, mostly to four digits or more, so a violation below 1e-4 of the largest
/// is taken for rounding.
pub(crate) fn impossible(inertia: &Mat3) -> Option<String> {
    let [low, middle, high] = principal_moments(inertia);
    if low <= 0.0 {
        return Some(format!(
            "the inertia is not positive definite: its principal moments are {}, {} and {}",
            short(low),
            short(middle),
            short(high)
        ));
    }
    if low + middle < high * (1.0 - 1e-4) {
        return Some(format!(
            "the inertia violates the triangle inequality: its principal moments are {}, {} and {}, but no \
             moment of a rigid body exceeds the sum of the others",
            short(low),
            short(middle),
            short(high)
        ));
    }
    None
}

fn short(x: f64) -> String {
    let text = format!("{x:.4e}");
    let rounded: f64 = text.parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) { format!("{rounded}") } else { text }
}

/// The eigenvalues of a symmetric matrix in ascending order, by the trigonometric solution of its characteristic
/// polynomial (Smith, Eigenvalues of a symmetric 3 × 3 matrix, CACM 4, 1961).
pub(crate) fn principal_moments(m: &Mat3) -> [f64; 3] {
    let a = &m.rows;
    let off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    if off == 0.0 {
        let mut moments = [a[0][0], a[1][1], a[2][2]];
        moments.sort_by(f64::total_cmp);
        return moments;
    }
    let mean = m.trace() / 3.0;
    let (x, y, z) = (a[0][0] - mean, a[1][1] - mean, a[2][2] - mean);
    let spread = ((x * x + y * y + z * z + 2.0 * off) / 6.0).sqrt();
    let scaled = (*m - Mat3::IDENTITY * mean) * (1.0 / spread);
    let angle = real::acos((0.5 * scaled.determinant()).clamp(-1.0, 1.0)) / 3.0;
    let third = 2.0 * std::f64::consts::PI / 3.0;
    let high = mean + 2.0 * spread * real::cos(angle);
    let low = mean + 2.0 * spread * real::cos(angle + third);
    [low, 3.0 * mean - high - low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mass, centre and inertia by sampling the middle points of a grid of cells.
    fn sampled(inside: impl Fn(Vec3) -> bool, half: Vec3, cells: usize) -> Inertial {
        let step = half * (2.0 / cells as f64);
        let cell = step.x * step.y * step.z;
        let (mut mass, mut first, mut second) = (0.0, Vec3::ZERO, Mat3::ZERO);
        for i in 0..cells {
            for j in 0..cells {
                for k in 0..cells {
                    let at = |n: usize| n as f64 + 0.5;
                    let p = Vec3::new(at(i), at(j), at(k)).component_mul(step) - half;
                    if inside(p) {
                        mass += cell;
                        first += p * cell;
                        second += (Mat3::IDENTITY * p.length_squared() - Mat3::outer(p, p)) * cell;
                    }
                }
            }
        }
        let centre = first / mass;
        let steiner = (Mat3::IDENTITY * centre.length_squared() - Mat3::outer(centre, centre)) * mass;
        Inertial { mass, pose: Pose::from_position(centre), inertia: second - steiner }
    }

    fn assert_close(geometry: &Geometry, inside: impl Fn(Vec3) -> bool, half: Vec3) {
        let exact = solid(geometry).expect("a solid");
        let sample = sampled(inside, half, 120);
        assert!(
            (exact.mass / sample.mass - 1.0).abs() < 5e-3,
            "{geometry:?}: {} {}",
            exact.mass,
            sample.mass
        );
        assert!((exact.pose.position - sample.pose.position).length() < 5e-3, "{geometry:?}");
        for axis in 0..3 {
            let (e, s) = (exact.inertia.rows[axis][axis], sample.inertia.rows[axis][axis]);
            assert!((e / s - 1.0).abs() < 1e-2, "{geometry:?} axis {axis}: {e} against {s}");
        }
    }

    #[test]
    fn solids_agree_with_sampling() {
        // Flat faces lie on the borders of cells.
        let half = Vec3::new(0.6, 0.6, 1.6);
        assert_close(
            &Geometry::Cuboid { size: Vec3::new(0.5, 0.8, 1.6) },
            |p| p.x.abs() < 0.25 && p.y.abs() < 0.4 && p.z.abs() < 0.8,
            half,
        );
        assert_close(&Geometry::Sphere { radius: 0.55 }, |p| p.length() < 0.55, half);
        assert_close(
            &Geometry::Cylinder { radius: 0.5, length: 2.4 },
            |p| p.x * p.x + p.y * p.y < 0.25 && p.z.abs() < 1.2,
            half,
        );
        assert_close(
            &Geometry::Capsule { radius: 0.5, length: 2.0 },
            |p| {
                let z = (p.z.abs() - 1.0).max(0.0);
                p.x * p.x + p.y * p.y + z * z < 0.25
            },
            half,
        );
        assert_close(
            &Geometry::Ellipsoid { radii: Vec3::new(0.3, 0.5, 1.5) },
            |p| Vec3::new(p.x / 0.3, p.y / 0.5, p.z / 1.5).length() < 1.0,
            half,
        );
        assert_close(
            &Geometry::Cone { radius: 0.5, length: 2.4 },
            |p| {
                let r = 0.5 * (1.2 - p.z) / 2.4;
                p.z.abs() < 1.2 && p.x * p.x + p.y * p.y < r * r
            },
            half,
        );
    }

    #[test]
    fn two_halves_of_a_box_make_the_box() {
        let half = solid(&Geometry::Cuboid { size: Vec3::new(1.0, 2.0, 3.0) }).unwrap();
        // The second half is turned by 180° about x, which changes nothing of a box.
        let turned = Quat::new(0.0, 1.0, 0.0, 0.0);
        let left = Inertial { pose: Pose::from_position(Vec3::new(-0.5, 0.0, 7.0)), ..half.clone() };
        let right = Inertial { pose: Pose::new(Vec3::new(0.5, 0.0, 7.0), turned), ..half };
        let both = combine(&[left, right]).unwrap();
        let whole = solid(&Geometry::Cuboid { size: Vec3::new(2.0, 2.0, 3.0) }).unwrap();
        assert!((both.mass - whole.mass).abs() < 1e-12);
        assert!((both.pose.position - Vec3::new(0.0, 0.0, 7.0)).length() < 1e-12);
        for (a, b) in both.inertia.rows.iter().flatten().zip(whole.inertia.rows.iter().flatten()) {
            assert!((a - b).abs() < 1e-11);
        }
        assert!(combine(&[]).is_none());
    }

    #[test]
    fn principal_moments_do_not_depend_on_the_axes() {
        let rotation = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -0.5), 0.7).to_matrix();
        let turned = rotation * Mat3::from_diagonal(Vec3::new(3.0, 1.0, 2.5)) * rotation.transpose();
        let moments = principal_moments(&turned);
        for (found, expected) in moments.iter().zip([1.0, 2.5, 3.0]) {
            assert!((found - expected).abs() < 1e-12, "{moments:?}");
        }
    }

    #[test]
    fn impossible_tensors_are_told_from_possible_ones() {
        let tensor = |x, y, z| Mat3::from_diagonal(Vec3::new(x, y, z));
        assert_eq!(impossible(&tensor(1.0, 1.0, 1.0)), None);
        assert_eq!(impossible(&tensor(1.0, 1.0, 2.0)), None);
        assert!(impossible(&tensor(1.0, 1.0, 2.1)).unwrap().contains("triangle"));
        assert!(impossible(&tensor(1.0, 0.0, 1.0)).unwrap().contains("positive definite"));
        let mut sheared = tensor(1.0, 1.0, 1.0);
        sheared.rows[0][1] = 1.5;
        sheared.rows[1][0] = 1.5;
        assert!(impossible(&sheared).unwrap().contains("positive definite"));
    }
}
