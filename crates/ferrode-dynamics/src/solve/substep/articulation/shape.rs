//! The shape of an articulation: which joints share bodies, in which order they are eliminated, and what fills in.
//!
//! The unknowns are the impulses of the joints, a block each; two blocks are coupled where the joints share a body, so the matrix
//! J̃ J̃ᵀ is as sparse as the graph of joints, and on a tree, joints with the fewest neighbours first, it hardly fills in. Shapes depend on the topology alone: robots
//! that are built alike share one, and it is kept from step to step.

use crate::arena::NIL;
use ferrode_lcp::sparse::ordering::{Elimination, Node};

/// The bodies at a joint's ends, numbered within the articulation; `NIL` for what no force moves.
pub(super) type JointEnds = [u32; 2];

/// A shape.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Number of bodies.
    pub bodies: usize,
    /// Joints in the order of elimination: their number as they came.
    pub order: Vec<u32>,
    /// Their ends, in that order; `bodies` for what no force moves.
    pub ends: Vec<JointEnds>,
    /// Where the blocks below the diagonal of each column begin in `rows`.
    pub start: Vec<u32>,
    /// Rows of these blocks, ascending within a column.
    pub rows: Vec<u32>,
    /// Blocks off the diagonal that the matrix itself has.
    pub products: Vec<Product>,
}

/// Two joints that share a body, the one of the later row first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Product {
    /// Joint in the order of elimination, and which of its ends.
    pub a: (u32, u8),
    pub b: (u32, u8),
}

impl Shape {
    /// The shape of joints between `bodies` bodies; `None` if a step with it takes more than `most` products of blocks per joint.
    pub fn new(bodies: usize, joints: &[JointEnds], most: f64) -> Option<Self> {
        let mut at = vec![Vec::new(); bodies];
        for (joint, ends) in joints.iter().enumerate() {
            for (side, body) in ends.iter().enumerate() {
                if *body != NIL {
                    at[*body as usize].push((joint as u32, side as u8));
                }
            }
        }
        let count = joints.len() as f64;
        if at.iter().map(|list| (list.len() * list.len()) as f64).sum::<f64>() > (most + 8.0) * count * 4.0 {
            return None;
        }
        let pairs = |list: &Vec<(u32, u8)>| {
            let list = list.clone();
            (0..list.len()).flat_map(move |i| {
                let list = list.clone();
                (0..i).map(move |j| (list[j], list[i]))
            })
        };
        let mut edges: Vec<[u32; 2]> =
            at.iter().flat_map(pairs).filter(|(a, b)| a.0 != b.0).map(|(a, b)| [a.0, b.0]).collect();
        edges.sort_unstable();
        edges.dedup();
        let nodes = vec![Node::free(6); joints.len()];
        let (mut order, mut below) = (Vec::new(), Vec::new());
        Elimination::default().run(&nodes, &edges, |node, neighbours| {
            order.push(node);
            below.push(neighbours.to_vec());
        });
        let cost: f64 = below.iter().map(|b| ((b.len() + 1) * (b.len() + 2)) as f64 * 0.5).sum();
        if cost > most * count {
            return None;
        }
        let mut place = vec![0u32; joints.len()];
        for (position, joint) in order.iter().enumerate() {
            place[*joint as usize] = position as u32;
        }
        let mut shape = Self {
            bodies,
            ends: order
                .iter()
                .map(|joint| joints[*joint as usize].map(|body| body.min(bodies as u32)))
                .collect(),
            order,
            start: vec![0],
            rows: Vec::new(),
            products: Vec::new(),
        };
        for column in below {
            let first = shape.rows.len();
            shape.rows.extend(column.iter().map(|joint| place[*joint as usize]));
            shape.rows[first..].sort_unstable();
            shape.start.push(shape.rows.len() as u32);
        }
        for (a, b) in at.iter().flat_map(pairs) {
            let placed = |x: (u32, u8)| (place[x.0 as usize], x.1);
            let (a, b) = (placed(a), placed(b));
            let (low, high) = if a.0 <= b.0 { (a, b) } else { (b, a) };
            if low.0 != high.0 {
                shape.products.push(Product { a: high, b: low });
            }
        }
        Some(shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees_hardly_fill_in() {
        // A chain; and a body that hangs from the world with others below it, three to each. Ties of least degree cost four blocks.
        for (bodies, branches, fill) in [(200, 1, 0), (40, 3, 4), (41, 3, 4)] {
            let mut joints = vec![[0, NIL]];
            joints.extend((1..bodies).map(|i| [i, (i - 1) / branches]));
            let shape = Shape::new(bodies as usize, &joints, f64::INFINITY).unwrap();
            let at = |body: u32| joints.iter().filter(|ends| ends.contains(&body)).count();
            let pairs: usize = (0..bodies).map(at).map(|k| k * (k - 1) / 2).sum();
            assert_eq!(shape.products.len(), pairs);
            assert_eq!(shape.rows.len(), pairs + fill, "{bodies} bodies");
        }
    }

    #[test]
    fn a_grid_costs_too_much() {
        let n = 30;
        let mut joints = Vec::new();
        for i in 0..n * n {
            if i % n + 1 < n {
                joints.push([i, i + 1]);
            }
            if i + n < n * n {
                joints.push([i, i + n]);
            }
        }
        assert!(Shape::new((n * n) as usize, &joints, 24.0).is_none());
        assert!(Shape::new((n * n) as usize, &joints, f64::INFINITY).is_some());
    }
}
