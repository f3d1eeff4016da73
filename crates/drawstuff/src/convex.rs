//! Triangles of a convex polyhedron, given as ODE's `dCreateConvex` takes it.

use crate::fault::{Fault, Outcome};
use crate::numbers::List;
use ferrode_math::Vec3;

/// Corners of the polygons: `polygons` lists, `count` times, how many corners and then which points.
///
/// # Errors
/// A null pointer; a corner that is none of the points.
pub fn polygons(polygons: List<u32>, count: usize, points: usize) -> Outcome<Vec<Vec<u32>>> {
    let mut at = 0;
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        let corners = polygons.get(at)? as usize;
        at += 1;
        let mut polygon = Vec::new();
        for _ in 0..corners {
            let corner = polygons.get(at)?;
            at += 1;
            // Told before more is read: what follows a wrong number is likely to be no list at all.
            if corner as usize >= points {
                return Err(Fault::misuse(format!("a polygon's corner {corner}, of {points} points,")));
            }
            polygon.push(corner);
        }
        all.push(polygon);
    }
    Ok(all)
}

/// Each polygon as triangles round its first corner.
pub fn triangles(polygons: &[Vec<u32>], points: &[Vec3]) -> Vec<[Vec3; 3]> {
    let fan = |polygon: &Vec<u32>| {
        let corners: Vec<Vec3> = polygon.iter().map(|n| points[*n as usize]).collect();
        (2..corners.len()).map(|n| [corners[0], corners[n - 1], corners[n]]).collect::<Vec<_>>()
    };
    polygons.iter().flat_map(fan).collect()
}

#[cfg(test)]
mod tests {
    use super::triangles;
    use ferrode_math::Vec3;

    #[test]
    fn a_square_is_two_triangles() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        let all = triangles(&[vec![0, 1, 2, 3], vec![1, 2]], &points);
        assert_eq!(all, [[points[0], points[1], points[2]], [points[0], points[2], points[3]]]);
    }
}
