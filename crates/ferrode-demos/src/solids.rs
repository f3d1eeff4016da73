//! Points and triangles of solids.

use core::f64::consts::TAU;
use ferrode::Vec3;

/// Corners of the five regular solids with a circumscribed sphere of radius 1: 4, 6, 8, 12 and 20 of them.
pub(crate) fn platonic() -> [Vec<Vec3>; 5] {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let signs = [-1.0, 1.0];
    let mut cube = Vec::new();
    let mut octahedron = Vec::new();
    let mut icosahedron = Vec::new();
    let mut dodecahedron = Vec::new();
    for a in signs {
        octahedron.extend([Vec3::X * a, Vec3::Y * a, Vec3::Z * a]);
        for b in signs {
            // The three even permutations of (0, ±1, ±φ), and of (0, ±1/φ, ±φ).
            let cycle = |x: f64, y: f64| [Vec3::new(0.0, x, y), Vec3::new(y, 0.0, x), Vec3::new(x, y, 0.0)];
            icosahedron.extend(cycle(a, b * golden));
            dodecahedron.extend(cycle(a / golden, b * golden));
            for c in signs {
                cube.push(Vec3::new(a, b, c));
            }
        }
    }
    dodecahedron.extend_from_slice(&cube);
    let tetrahedron = cube.iter().copied().filter(|p| p.x * p.y * p.z > 0.0).collect();
    [tetrahedron, octahedron, cube, icosahedron, dodecahedron]
        .map(|points: Vec<Vec3>| points.into_iter().map(|p| p.normalized_or(Vec3::Z)).collect())
}

/// A torus about z, closed and outward: points, and triangles over them.
pub(crate) fn torus(radius: f64, tube: f64, around: u32, across: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..around {
        let (sin, cos) = crate::kit::sin_cos(TAU * f64::from(i) / f64::from(around));
        for j in 0..across {
            let (s, c) = crate::kit::sin_cos(TAU * f64::from(j) / f64::from(across));
            let out = radius + tube * c;
            points.push(Vec3::new(out * cos, out * sin, tube * s));
            let (next_i, next_j) = ((i + 1) % around, (j + 1) % across);
            let (a, b) = (i * across + j, next_i * across + j);
            let (c, d) = (next_i * across + next_j, i * across + next_j);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (points, triangles)
}

#[cfg(test)]
mod tests {
    use super::{platonic, torus};

    #[test]
    fn solids_are_regular() {
        // Euler: V − E + F = 2; faces by corners of each.
        for (points, faces) in platonic().into_iter().zip([4, 8, 6, 20, 12]) {
            let solid = ferrode::Convex::from_points(&points).unwrap();
            assert_eq!(solid.face_count(), faces);
        }
    }

    #[test]
    fn the_torus_is_closed_and_outward() {
        let (points, triangles) = torus(2.0, 0.5, 200, 100);
        let mesh = ferrode::TriMesh::new(points, triangles).unwrap();
        // 2 π² R r², less what chords cut off.
        let exact = 2.0 * std::f64::consts::PI * std::f64::consts::PI * 2.0 * 0.25;
        assert!((mesh.volume() - exact).abs() < 2e-3 * exact, "{} against {exact}", mesh.volume());
    }
}
