//! The search of a packed tree.

use super::node::{LANES, Seven, Spread};
use crate::space::probe::Bundle;
use ferrode_math::simd::{Octet, OctetKernel};

pub(super) struct Seek<'a, const BOXES: bool, F> {
    pub(super) nodes: &'a [Seven],
    pub(super) bundle: &'a Bundle,
    pub(super) limit: &'a mut f64,
    /// Is told where a leaf is: its place among the nodes where leaves have boxes, else the number of the node and, in the last
    /// three bits, the lane.
    pub(super) tell: F,
}

/// What has yet to be visited: where it is met in the upper half (as the bits of a positive number, whose order is that of
/// the numbers), in the lower half the number of a node, or with `LEAF` where a leaf is found.
type Target = u64;
const LEAF: u32 = 1 << 31;

impl<const BOXES: bool, F: FnMut(u32, &mut f64)> OctetKernel for Seek<'_, BOXES, F> {
    type Out = ();

    #[inline(always)]
    fn run<O: Octet>(self) {
        let Self { nodes, bundle, limit, mut tell } = self;
        let spread = Spread::<O>::new(bundle);
        let mut near = Bundle::limit(*limit);
        // What waits, the nearest last. By itself, not in a structure with `spilled`: so the length stays in a register.
        let (mut waiting, mut len) = ([0; ROOM], 0);
        let mut spilled: Vec<Target> = Vec::new();
        let mut i = 0u32;
        loop {
            if len > ROOM - LANES {
                spill(&mut spilled, waiting, len);
                len = 0;
            }
            let Some(node) = nodes.get(i as usize) else { return };
            let (met, at) = node.enter(&spread, near);
            let (inner, child) = (u32::from(node.inner()), node.child);
            let place = |met: u8| -> u32 {
                let lane = u32::from(met).trailing_zeros() & 7;
                let leaf = lane >= inner;
                if BOXES {
                    (child + lane) | u32::from(leaf) << 31
                } else if leaf {
                    LEAF | i << 3 | lane
                } else {
                    child + lane
                }
            };
            let rest = met & met.wrapping_sub(1);
            // Where only one is met it does not matter how far away: the next node can be fetched before that is known.
            let mut next = (met != 0).then(|| place(met));
            if rest != 0 {
                let at = at.store();
                let target = |met: u8| -> Target {
                    let at = at[(met.trailing_zeros() & 7) as usize];
                    u64::from(at.to_bits()) << 32 | u64::from(place(met))
                };
                let (one, other) = (target(met), target(rest));
                let mut first = one.min(other);
                let bottom = len;
                waiting[len & (ROOM - 1)] = one.max(other);
                len += 1;
                let mut more = rest & rest.wrapping_sub(1);
                while more != 0 {
                    let another = target(more);
                    let mut k = len;
                    let later = first.max(another);
                    first = first.min(another);
                    while k > bottom && waiting[(k - 1) & (ROOM - 1)] < later {
                        waiting[k & (ROOM - 1)] = waiting[(k - 1) & (ROOM - 1)];
                        k -= 1;
                    }
                    waiting[k & (ROOM - 1)] = later;
                    len += 1;
                    more &= more - 1;
                }
                next = Some(first as u32);
            }
            loop {
                let of = match next.take() {
                    Some(of) => of,
                    None => {
                        if len == 0 {
                            if spilled.is_empty() {
                                return;
                            }
                            (waiting, len) = unspill(&mut spilled);
                        }
                        len -= 1;
                        let target = waiting[len & (ROOM - 1)];
                        if f32::from_bits((target >> 32) as u32) > near {
                            continue;
                        }
                        target as u32
                    }
                };
                if of & LEAF == 0 {
                    i = of;
                    break;
                }
                tell(of & !LEAF, limit);
                near = Bundle::limit(*limit);
            }
        }
    }
}

/// As many as wait in trees of any depth but the strangest; a power of two.
const ROOM: usize = 32;

#[cold]
#[inline(never)]
fn spill(spilled: &mut Vec<Target>, waiting: [Target; ROOM], len: usize) {
    spilled.extend_from_slice(&waiting[..len]);
}

/// The last that were spilled.
#[cold]
#[inline(never)]
fn unspill(spilled: &mut Vec<Target>) -> ([Target; ROOM], usize) {
    let rest = spilled.len().saturating_sub(ROOM - LANES);
    let mut waiting = [0; ROOM];
    let len = spilled.len() - rest;
    waiting[..len].copy_from_slice(&spilled[rest..]);
    spilled.truncate(rest);
    (waiting, len)
}
