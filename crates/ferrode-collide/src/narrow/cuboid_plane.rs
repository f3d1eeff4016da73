use crate::{Contacts, Cuboid, Frame, Plane};

/// A box and a half-space: up to four contacts at vertices.
///
/// As libode 0.16.2: the deepest vertex, then its two neighbours that are least raised, then the fourth of that
/// parallelogram. Normal: the plane's; depth: of the vertex.
pub fn cuboid_plane(cuboid: &Cuboid, fb: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let n = plane.normal();
    let half = cuboid.half_sides();
    let slope = fb.rotation.transpose_mul(n).component_mul(half) * 2.0;
    // How much a step along each edge raises a vertex.
    let rise = slope.abs();
    let deepest_depth = plane.d() + 0.5 * (rise.x + rise.y + rise.z) - n.dot(fb.position);
    if !(deepest_depth >= 0.0) {
        return;
    }
    let step = |i: usize| {
        let edge = fb.axis(i) * (2.0 * half[i]);
        if slope[i] > 0.0 { edge } else { -edge }
    };
    let mut deepest = fb.position;
    for i in 0..3 {
        deepest -= step(i) * 0.5;
    }
    out.push(deepest, n, deepest_depth);

    // Least rise first; of equals the later axis.
    let first = if rise.x < rise.y {
        if rise.z < rise.x { 2 } else { 0 }
    } else if rise.z < rise.y {
        2
    } else {
        1
    };
    let second = match first {
        0 => {
            if rise.y < rise.z {
                1
            } else {
                2
            }
        }
        1 => {
            if rise.x < rise.z {
                0
            } else {
                2
            }
        }
        _ => {
            if rise.x < rise.y {
                0
            } else {
                1
            }
        }
    };
    let depths = [deepest_depth - rise[first], deepest_depth - rise[second]];
    if out.is_full() || depths[0] < 0.0 {
        return;
    }
    out.push(deepest + step(first), n, depths[0]);
    if out.is_full() || depths[1] < 0.0 {
        return;
    }
    out.push(deepest + step(second), n, depths[1]);
    let fourth = depths[0] + depths[1] - deepest_depth;
    if fourth > 0.0 {
        out.push(deepest + step(first) + step(second), n, fourth);
    }
}
