//! The order of elimination: always an unknown with the fewest neighbours, of equals the one that comes first. Of those with one neighbour, as
//! in trees, it is the one that has had no more for longest: so a chain is eliminated from both ends in turns, and a robot from all limbs.
//! Columns next to each other don't depend on each other then, and a processor works on both at once.
//!
//! Eliminating an unknown joins all its neighbours to each other. Its neighbours at that moment are the rows of its column in the
//! factor, so playing the elimination through gives the order and the shape of the factor at once. In a tree some unknown always
//! has one neighbour, and nothing fills in.
//! (D. Rose, "A graph-theoretic study of the numerical solution of sparse positive definite systems of linear equations", 1972.)

use super::symbolic::NONE;
use core::cmp::Reverse;
use std::collections::BinaryHeap;

/// An unknown to be eliminated: the acceleration of a body, or the forces of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Numbers in it.
    pub size: u8,
    /// If this is a joint all of whose bodies are unknowns too: these. It has to wait until one of them is eliminated. Else `u32::MAX`.
    pub after: [u32; 2],
}

impl Node {
    /// An unknown that need not wait.
    pub fn free(size: u8) -> Self {
        Self { size, after: [NONE; 2] }
    }

    fn waits(&self) -> bool {
        self.after[0] != NONE
    }
}

/// Memory of the elimination.
#[derive(Clone, Debug, Default)]
pub struct Elimination {
    /// Neighbours not yet eliminated, ascending.
    neighbours: Vec<Vec<u32>>,
    merged: Vec<u32>,
    /// Unknowns by size of their neighbours, since when if there is one neighbour, and number; entries whose size is out of date are skipped.
    queue: BinaryHeap<Reverse<(u32, u32, u32)>>,
    degree: Vec<u32>,
    state: Vec<State>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Waiting,
    Ready,
    Eliminated,
}

impl Elimination {
    /// Plays the elimination through, given the pairs of unknowns that share a number of the matrix, each once.
    /// Calls `column(node, neighbours)` for each in the order of elimination.
    pub fn run(&mut self, nodes: &[Node], edges: &[[u32; 2]], mut column: impl FnMut(u32, &[u32])) {
        let n = nodes.len();
        if self.neighbours.len() < n {
            self.neighbours.resize_with(n, Vec::new);
        }
        self.neighbours[..n].iter_mut().for_each(Vec::clear);
        for [a, b] in edges {
            self.neighbours[*a as usize].push(*b);
            self.neighbours[*b as usize].push(*a);
        }
        let size = |list: &[u32]| list.iter().map(|i| u32::from(nodes[*i as usize].size)).sum::<u32>();
        self.queue.clear();
        self.state.clear();
        self.degree.clear();
        for (i, node) in nodes.iter().enumerate() {
            self.neighbours[i].sort_unstable();
            self.degree.push(size(&self.neighbours[i]));
            self.state.push(if node.waits() { State::Waiting } else { State::Ready });
            if !node.waits() {
                self.queue.push(Reverse((self.degree[i], 0, i as u32)));
            }
        }
        let mut time = 0;
        while let Some(Reverse((degree, _, node))) = self.queue.pop() {
            let v = node as usize;
            if self.state[v] == State::Eliminated || self.degree[v] != degree {
                continue;
            }
            self.state[v] = State::Eliminated;
            time += 1;
            let clique = core::mem::take(&mut self.neighbours[v]);
            column(node, &clique);
            for u in clique.iter().map(|u| *u as usize) {
                merge(&self.neighbours[u], &clique, &mut self.merged, [u as u32, node]);
                core::mem::swap(&mut self.neighbours[u], &mut self.merged);
                let is = size(&self.neighbours[u]);
                let freed = self.state[u] == State::Waiting && nodes[u].after.contains(&node);
                if freed {
                    self.state[u] = State::Ready;
                }
                if self.state[u] == State::Ready && (freed || is != self.degree[u]) {
                    // Of meshes, whose unknowns have many neighbours, the number does as well, with a little less fill.
                    let since = if self.neighbours[u].len() == 1 { time } else { 0 };
                    self.queue.push(Reverse((is, since, u as u32)));
                }
                self.degree[u] = is;
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
    use super::{Elimination, Node};

    fn fill(n: usize, edges: &[[u32; 2]]) -> (Vec<u32>, usize) {
        let (mut order, mut blocks) = (Vec::new(), 0);
        Elimination::default().run(&vec![Node::free(6); n], edges, |body, rows| {
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
    fn a_chain_is_eliminated_from_both_ends_in_turns() {
        let edges: Vec<[u32; 2]> = (1..7).map(|i| [i - 1, i]).collect();
        assert_eq!(fill(7, &edges), (vec![0, 6, 1, 5, 2, 4, 3], 6));
    }

    #[test]
    fn a_ring_fills_in_one_chord_per_body() {
        let n = 12;
        let mut edges: Vec<[u32; 2]> = (0..n - 1).map(|i| [i, i + 1]).collect();
        edges.insert(0, [0, n - 1]);
        let (_, blocks) = fill(n as usize, &edges);
        assert_eq!(blocks, 2 * n as usize - 3);
    }

    #[test]
    fn a_joint_waits_for_one_of_its_bodies() {
        // Bodies 0 to 3 in a row, joints 4 to 6 between them: a joint has two neighbours, the inner bodies too.
        let mut nodes = vec![Node::free(6); 4];
        nodes.extend((0..3).map(|i| Node { size: 3, after: [i, i + 1] }));
        let edges: Vec<[u32; 2]> = (0..3).flat_map(|i| [[i, i + 4], [i + 1, i + 4]]).collect();
        let mut order = Vec::new();
        Elimination::default().run(&nodes, &edges, |node, _| order.push(node));
        assert_eq!(order.len(), 7);
        for joint in 4..7 {
            let place = |node: u32| order.iter().position(|o| *o == node).unwrap();
            assert!(place(joint) > place(joint - 4).min(place(joint - 3)));
        }
    }
}
