//! The roll: which bodies may be awake, so that a step need not look at those that sleep.

/// A bit for each slot of the bodies' arena. It is set for every body that is enabled or quarantined, and for every one that the
/// caller had in hand since the last step; others are cleared where a step looks at them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Roll {
    bits: Vec<u64>,
    /// Number of bits that are set.
    count: usize,
    /// Number of times that bits were cleared. Who keeps account of bodies by the roll compares it with the last that he saw.
    pub cleared: u64,
}

impl Roll {
    /// Notes that a body may be awake.
    #[inline]
    pub fn call(&mut self, slot: u32) {
        let word = (slot >> 6) as usize;
        if word >= self.bits.len() {
            self.bits.resize(word + 1, 0);
        }
        let bit = 1 << (slot & 63);
        self.count += usize::from(self.bits[word] & bit == 0);
        self.bits[word] |= bit;
    }

    /// The slots, the last first: the order of the bodies' list, where none was destroyed.
    pub fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        self.bits.iter().enumerate().rev().flat_map(|(w, word)| {
            let mut word = *word;
            core::iter::from_fn(move || {
                let bit = 63u32.checked_sub(word.leading_zeros())?;
                word ^= 1 << bit;
                Some(64 * w as u32 + bit)
            })
        })
    }

    /// Number of bits that are set.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Keeps the slots for which `stays` says so.
    pub fn retain(&mut self, mut stays: impl FnMut(u32) -> bool) {
        self.cleared += 1;
        if self.count == 0 {
            return;
        }
        for (w, bits) in self.bits.iter_mut().enumerate() {
            let mut word = *bits;
            while word != 0 {
                let bit = word.trailing_zeros();
                word &= word - 1;
                if !stays(64 * w as u32 + bit) {
                    *bits ^= 1 << bit;
                    self.count -= 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Roll;

    #[test]
    fn tells_who_was_called_and_not_let_go() {
        let mut roll = Roll::default();
        [3, 200, 63, 64, 3].into_iter().for_each(|slot| roll.call(slot));
        assert_eq!(roll.slots().collect::<Vec<_>>(), [200, 64, 63, 3]);
        assert_eq!(roll.count(), 4);
        roll.retain(|slot| slot % 2 == 1);
        assert_eq!(roll.slots().collect::<Vec<_>>(), [63, 3]);
        assert_eq!(Roll::default().slots().count(), 0);
    }
}
