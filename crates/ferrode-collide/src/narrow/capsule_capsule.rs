use super::{closest_segment_points, spheres};
use crate::{Capsule, Contacts, Frame};

/// Two capsules: balls at the nearest points of the axes; two contacts where parallel axes run alongside.
pub fn capsule_capsule(a: &Capsule, fa: &Frame, b: &Capsule, fb: &Frame, out: &mut Contacts<'_>) {
    let (ua, ub) = (fa.axis(2), fb.axis(2));
    let (ra, rb) = (a.radius(), b.radius());
    let cosine = ua.dot(ub);
    if 1.0 - cosine * cosine < 1e-5 {
        // On the line of a's axis: a covers ±la, b is centred at `k` and covers ±lb. b's points by their own axis,
        // so that a small angle leaves the distance right.
        let (la, lb) = (0.5 * a.length(), 0.5 * b.length());
        let k = ua.dot(fb.position - fa.position);
        let (lo, hi) = ((-la).max(k - lb), la.min(k + lb));
        if lo <= hi {
            let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
            let at = |x: f64, out: &mut Contacts<'_>| {
                spheres(fa.position + ua * x, ra, fb.position + ub * (sign * (x - k)), rb, out)
            };
            let first_wanted = out.len();
            if lo < hi && out.capacity() >= 2 {
                let (low, high) = (at(lo, out), at(hi, out));
                if low && high {
                    return;
                }
                out.truncate(first_wanted);
            }
            at(0.5 * (lo + hi), out);
            return;
        }
    }
    let (a1, a2) = a.segment(fa);
    let (b1, b2) = b.segment(fb);
    let (pa, pb) = closest_segment_points(a1, a2, b1, b2);
    spheres(pa, ra, pb, rb, out);
}
