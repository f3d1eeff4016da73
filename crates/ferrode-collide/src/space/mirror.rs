//! A wide copy of a tree that changes, made when it is asked more often than it changes.

use super::wide::{Part, WideTree};
use core::sync::atomic::{AtomicU32, Ordering};
use std::sync::OnceLock;

/// What a search of a binary tree costs more than one of the copy, where the copy costs one a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Search {
    /// For what overlaps a box.
    Query = 1,
    /// For what a probe meets.
    Seek = 4,
}

/// A wide copy of a binary tree, made by the first of many searches and dropped with the next change.
#[derive(Debug, Default)]
pub(super) struct Mirror {
    tree: OnceLock<WideTree>,
    /// What was spent since the last change for want of a copy.
    spent: AtomicU32,
}

impl Clone for Mirror {
    /// Made anew if it is needed.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Mirror {
    /// For every change of the tree.
    #[inline]
    pub fn drop_copy(&mut self) {
        if *self.spent.get_mut() > 0 {
            *self = Self::default();
        }
    }

    /// The copy of a tree of so many leaves, once as much has been spent as it costs. `root` and `open` are for
    /// [`WideTree::build`].
    #[inline]
    pub fn get<T: Copy>(
        &self,
        search: Search,
        leaves: usize,
        root: impl FnOnce() -> Part<T>,
        open: impl FnMut(T) -> [Part<T>; 2],
    ) -> Option<&WideTree> {
        if let Some(tree) = self.tree.get() {
            return Some(tree);
        }
        // Whether a search takes the copy or not, it finds the same: the count need not be exact.
        let spent = self.spent.load(Ordering::Relaxed);
        if spent as usize <= leaves {
            self.spent.store(spent.saturating_add(search as u32), Ordering::Relaxed);
            return None;
        }
        Some(self.tree.get_or_init(|| {
            let mut tree = WideTree::default();
            tree.build(root(), open);
            tree
        }))
    }
}
