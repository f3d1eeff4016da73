//! Surfaces of pairs, each kept once.

use ferrode_dynamics::Surface;
use std::collections::BTreeMap;

/// The surfaces in use, and where to find one like another.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceTable {
    pub list: Vec<Surface>,
    places: BTreeMap<[u64; 20], u32>,
}

impl SurfaceTable {
    pub fn clear(&mut self) {
        self.list.clear();
        self.places.clear();
    }

    /// The place of a surface in the list.
    pub fn place(&mut self, surface: &Surface) -> u32 {
        let next = self.list.len() as u32;
        let place = *self.places.entry(bits(surface)).or_insert(next);
        if place == next {
            self.list.push(*surface);
        }
        place
    }
}

/// All that a surface is made of.
fn bits(s: &Surface) -> [u64; 20] {
    let some = |x: Option<f64>| [u64::from(x.is_some()), x.unwrap_or(0.0).to_bits()];
    let [a, b] = some(s.max_correcting_velocity);
    let [c, d] = some(s.surface_layer);
    let [x, rest @ ..] = [
        s.mu,
        s.mu2,
        s.rho,
        s.rho2,
        s.rho_n,
        s.bounce,
        s.bounce_velocity,
        s.soft_erp,
        s.soft_cfm,
        s.motion1,
        s.motion2,
        s.motion_n,
        s.slip1,
        s.slip2,
    ]
    .map(f64::to_bits);
    let [e, f, g, h, i, j, k, l, m, n, o, p, q] = rest;
    [u64::from(s.mode.0), x, e, f, g, h, i, j, k, l, m, n, o, p, q, a, b, c, d, 0]
}
