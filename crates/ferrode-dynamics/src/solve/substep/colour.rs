//! Graph colouring: which constraints may be solved side by side.
//!
//! Constraints of one colour share no movable body, so the order in which they are solved, in lanes or in threads, does
//! not matter. Each takes the first colour that neither of its bodies has yet, in the order in which they come; what
//! finds none goes into the overflow, which is solved one after the other in that order. So the colours depend on the
//! scene alone.

/// Colours; a body has a bit for each.
pub(super) const COLOURS: usize = 30;
/// The colour of what fits none.
pub(super) const OVERFLOW: usize = COLOURS;

/// Hands out colours.
#[derive(Clone, Debug, Default)]
pub(super) struct Colouring {
    /// Of each body, within its part and between parts.
    used: Vec<[u32; 2]>,
}

impl Colouring {
    /// Starts anew, for `bodies` bodies.
    pub fn begin(&mut self, bodies: usize) {
        self.used.clear();
        self.used.resize(bodies, [0; 2]);
    }

    /// The colour of a constraint between two bodies, `None` for one that nothing moves: among those within parts, or among those between.
    #[inline]
    pub fn colour(&mut self, bodies: [Option<u32>; 2], between: bool) -> usize {
        let set = usize::from(between);
        let used = |body: Option<u32>| body.map_or(0, |body| self.used[body as usize][set]);
        let free = !(used(bodies[0]) | used(bodies[1]));
        let colour = free.trailing_zeros() as usize;
        if colour >= COLOURS {
            return OVERFLOW;
        }
        for body in bodies.into_iter().flatten() {
            self.used[body as usize][set] |= 1 << colour;
        }
        colour
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_colour_has_a_body_twice() {
        let mut random = ferrode_math::random::OdeRandom::new(5);
        let mut colouring = Colouring::default();
        colouring.begin(50);
        let mut seen = [[false; 50]; COLOURS];
        let mut overflowed = 0;
        for _ in 0..1500 {
            let pair = [random.next_below(50), random.next_below(50)].map(|b| (b > 4).then_some(b));
            if pair[0] == pair[1] {
                continue;
            }
            let colour = colouring.colour(pair, false);
            if colour == OVERFLOW {
                overflowed += 1;
                continue;
            }
            for body in pair.into_iter().flatten() {
                assert!(!core::mem::replace(&mut seen[colour][body as usize], true));
            }
        }
        assert!(overflowed > 0);
    }
}
