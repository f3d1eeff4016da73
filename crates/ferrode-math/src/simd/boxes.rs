//! One box against four, in single precision.

/// Which of four boxes overlap another: bit `l` for the box in lane `l`. `sides` are along each axis the lower sides of the four, then the
/// upper ones. Boxes that only touch overlap; one with a NaN overlaps nothing.
#[inline(always)]
pub fn overlapping(sides: &[[[f32; 4]; 2]; 3], min: &[f32; 3], max: &[f32; 3]) -> u8 {
    #[cfg(target_arch = "x86_64")]
    {
        super::x86::overlapping(sides, min, max)
    }
    #[cfg(not(target_arch = "x86_64"))]
    plain(sides, min, max)
}

/// In plain numbers: the fallback, and what the other kind is tested against.
#[cfg(any(test, not(target_arch = "x86_64")))]
#[inline(always)]
fn plain(sides: &[[[f32; 4]; 2]; 3], min: &[f32; 3], max: &[f32; 3]) -> u8 {
    let mut hit = [true; 4];
    for (k, [low, high]) in sides.iter().enumerate() {
        for (l, hit) in hit.iter_mut().enumerate() {
            *hit &= (low[l] <= max[k]) & (high[l] >= min[k]);
        }
    }
    hit.iter().rev().fold(0, |bits, hit| bits << 1 | u8::from(*hit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_agree() {
        let (nan, far) = (f32::NAN, f32::INFINITY);
        let numbers = [0.0, -0.0, 1.0, 2.0, -3.5, far, -far, nan];
        let mut next = 1u32;
        let mut number = || {
            next = next.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // NaN and infinities are rare.
            numbers[if next >> 29 > 4 && next >> 20 & 7 != 0 { 2 } else { (next >> 29) as usize }]
        };
        let mut seen = [0; 16];
        for _ in 0..5000 {
            let sides = [(); 3].map(|()| [(); 2].map(|()| [(); 4].map(|()| number())));
            let (min, max) = ([(); 3].map(|()| number()), [(); 3].map(|()| number()));
            let bits = overlapping(&sides, &min, &max);
            assert_eq!(bits, plain(&sides, &min, &max), "{sides:?} {min:?} {max:?}");
            seen[usize::from(bits)] += 1;
        }
        assert!(seen.iter().all(|n| *n > 0), "{seen:?}");
    }
}
