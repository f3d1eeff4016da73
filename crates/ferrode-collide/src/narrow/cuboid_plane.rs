use crate::{Contacts, Cuboid, Frame, Plane};

/// A box and a half-space: up to four contacts at vertices.
///
/// As libode 0.16.2: the deepest vertex, then its two neighbours that are least raised, then the fourth of that
/// parallelogram. Normal: the plane's; depth: of the vertex.
pub fn cuboid_plane(cuboid: &Cuboid, fb: &Frame, plane: &Plane, _: &Frame, out: &mut Contacts<'_>) {
    let n = plane.normal();
    let half = cuboid.half_sides();
    // The three edges, and how much a step along each raises a vertex.
    let edges = [fb.axis(0) * (2.0 * half.x), fb.axis(1) * (2.0 * half.y), fb.axis(2) * (2.0 * half.z)];
    let slope = edges.map(|e| n.dot(e));
    let rise = slope.map(f64::abs);
    let deepest_depth = plane.d() + 0.5 * (rise[0] + rise[1] + rise[2]) - n.dot(fb.position);
    if !(deepest_depth >= 0.0) {
        return;
    }
    let up = |i: usize| edges[i] * if slope[i] > 0.0 { 1.0 } else { -1.0 };
    let steps = [up(0), up(1), up(2)];
    let deepest = fb.position - steps[0] * 0.5 - steps[1] * 0.5 - steps[2] * 0.5;
    out.push_sound(deepest, n, deepest_depth);

    // Least rise first.
    let [x, y, z] = rise;
    let first = if x < y {
        if z < x { 2 } else { 0 }
    } else if z < y {
        2
    } else {
        1
    };
    let second = match first {
        0 => 2 - usize::from(y < z),
        1 => 2 - 2 * usize::from(x < z),
        _ => 1 - usize::from(x < y),
    };
    let depths = [deepest_depth - rise[first], deepest_depth - rise[second]];
    if depths[0] < 0.0 {
        return;
    }
    out.push_sound(deepest + steps[first], n, depths[0]);
    if depths[1] < 0.0 {
        return;
    }
    out.push_sound(deepest + steps[second], n, depths[1]);
    let fourth = depths[0] + depths[1] - deepest_depth;
    if fourth > 0.0 {
        out.push_sound(deepest + steps[first] + steps[second], n, fourth);
    }
}
