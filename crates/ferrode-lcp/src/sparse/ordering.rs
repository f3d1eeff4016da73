//! The order of elimination: always a body with the fewest neighbours, of equals the one that comes first.
//!
//! Eliminating a body joins all its neighbours to each other. Its neighbours at that moment are the rows of its column in the
//! factor, so playing the elimination through gives the order and the shape of the factor at once. In a tree some body always
//! has one neighbour, and nothing fills in.
//! (D. Rose, "A graph-theoretic study of the numerical solution of sparse positive definite systems of linear equations", 1972.)

use core::cmp::Reverse;
use std::collections::BinaryHeap;

/// Memory of the elimination.
#[derive(Clone, Debug, Default)]
pub(crate) struct Elimination {
    /// Neighbours not yet eliminated, ascending.
    neighbours: Vec<Vec<u32>>,
    merged: Vec<u32>,
    /// Bodies by number of neighbours and number; entries whose number is out of date are skipped.
    queue: BinaryHeap<Reverse<(u32, u32)>>,
    eliminated: Vec<bool>,
}

impl Elimination {
    /// Plays the elimination of `n` bodies through, given the pairs that share rows, each once, ascending.
    /// Calls `column(body, neighbours)` for each body in the order of elimination.
    pub fn run(&mut self, n: usize, edges: &[[u32; 2]], mut column: impl FnMut(u32, &[u32])) {
        if self.neighbours.len() < n {
            self.neighbours.resize_with(n, Vec::new);
        }
        self.neighbours[..n].iter_mut().for_each(Vec::clear);
        for [a, b] in edges {
            self.neighbours[*a as usize].push(*b);
            self.neighbours[*b as usize].push(*a);
        }
        self.queue.clear();
        for body in 0..n {
            self.neighbours[body].sort_unstable();
            self.queue.push(Reverse((self.neighbours[body].len() as u32, body as u32)));
        }
        self.eliminated.clear();
        self.eliminated.resize(n, false);
        while let Some(Reverse((degree, body))) = self.queue.pop() {
            let v = body as usize;
            if self.eliminated[v] || self.neighbours[v].len() != degree as usize {
                continue;
            }
            self.eliminated[v] = true;
            let clique = core::mem::take(&mut self.neighbours[v]);
            column(body, &clique);
            for u in &clique {
                let was = self.neighbours[*u as usize].len();
                merge(&self.neighbours[*u as usize], &clique, &mut self.merged, [*u, body]);
                core::mem::swap(&mut self.neighbours[*u as usize], &mut self.merged);
                let is = self.neighbours[*u as usize].len();
                if is != was {
                    self.queue.push(Reverse((is as u32, *u)));
                }
            }
            self.neighbours[v] = clique;
        }
    }
}

/// The union of two ascending lists, without two numbers.
fn merge(a: &[u32], b: &[u32], out: &mut Vec<u32>, without: [u32; 2]) {
    out.clear();
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let take_a = j == b.len() || (i < a.len() && a[i] <= b[j]);
        let next = if take_a { a[i] } else { b[j] };
        i += usize::from(i < a.len() && a[i] == next);
        j += usize::from(j < b.len() && b[j] == next);
        if next != without[0] && next != without[1] {
            out.push(next);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Elimination;

    fn fill(n: usize, edges: &[[u32; 2]]) -> (Vec<u32>, usize) {
        let (mut order, mut blocks) = (Vec::new(), 0);
        Elimination::default().run(n, edges, |body, rows| {
            order.push(body);
            blocks += rows.len();
        });
        (order, blocks)
    }

    #[test]
    fn trees_do_not_fill_in() {
        // A star of chains, numbered badly.
        let edges: Vec<[u32; 2]> = (1..40).map(|i| [(i - 1) / 3, i]).collect();
        let (order, blocks) = fill(40, &edges);
        assert_eq!(blocks, edges.len());
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..40).collect::<Vec<_>>());
    }

    #[test]
    fn a_ring_fills_in_one_chord_per_body() {
        let n = 12;
        let mut edges: Vec<[u32; 2]> = (0..n - 1).map(|i| [i, i + 1]).collect();
        edges.insert(0, [0, n - 1]);
        let (_, blocks) = fill(n as usize, &edges);
        assert_eq!(blocks, 2 * n as usize - 3);
    }
}
