//! ODE's order of joints for `Direct`.

use crate::rows::RowCount;
use crate::step::JointSpan;
use std::collections::VecDeque;

/// The three classes, empty between calls.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    unbounded: VecDeque<JointSpan>,
    mixed: VecDeque<JointSpan>,
    bounded: VecDeque<JointSpan>,
}

/// Puts an island's joints into ODE's order: those without bounds, mixed ones, bounded ones.
///
/// Within the classes ODE's two-ended scheme decides; only rounding, and the choice among equal solutions, depends on
/// it.
pub(super) fn arrange(spans: &mut Vec<JointSpan>, memory: &mut Memory) {
    let Memory { unbounded, mixed, bounded } = memory;
    let mut forward = true;
    for span in spans.drain(..) {
        match class(span.count) {
            Class::Unbounded => {
                unbounded.push_front(span);
                forward = false;
            }
            Class::Bounded => {
                bounded.push_back(span);
                forward = true;
            }
            Class::Mixed if forward => {
                if unbounded.is_empty() {
                    mixed.push_front(span);
                } else {
                    if !bounded.is_empty() {
                        bounded.rotate_left(1);
                    }
                    mixed.push_back(span);
                }
            }
            Class::Mixed => {
                if bounded.is_empty() {
                    mixed.push_back(span);
                } else {
                    if !unbounded.is_empty() {
                        unbounded.rotate_right(1);
                    }
                    mixed.push_front(span);
                }
            }
        }
    }
    spans.extend(unbounded.drain(..).chain(mixed.drain(..)).chain(bounded.drain(..)));
}

enum Class {
    Unbounded,
    Mixed,
    Bounded,
}

fn class(count: RowCount) -> Class {
    match count.unbounded {
        0 => Class::Bounded,
        n if n == count.rows => Class::Unbounded,
        _ => Class::Mixed,
    }
}

#[cfg(test)]
mod tests {
    use super::arrange;
    use crate::rows::RowCount;
    use crate::step::JointSpan;

    #[test]
    fn joints_are_arranged_as_in_ode() {
        // dynamics.md 7.1: l1 m1 l2 u1 m2 u2 l3 m3 → u2 u1 | m2 m1 m3 | l2 l3 l1.
        let (l, m, u) = (RowCount::new(3, 0), RowCount::new(3, 2), RowCount::new(3, 3));
        let counts = [l, m, l, u, m, u, l, m];
        let mut spans: Vec<JointSpan> = counts
            .into_iter()
            .enumerate()
            .map(|(i, count)| JointSpan { joint: i as u32, bodies: [0; 2], first: 0, count })
            .collect();
        arrange(&mut spans, &mut super::Memory::default());
        let order: Vec<u32> = spans.iter().map(|s| s.joint).collect();
        assert_eq!(order, [5, 3, 4, 1, 7, 2, 6, 0]);
    }
}
