//! Copies of a tree that changes, made when it is asked more often than it changes.

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

/// A copy of a binary tree that is searched faster, made by the first of many searches and dropped with the next change.
#[derive(Debug)]
pub(super) struct Mirror<T> {
    tree: OnceLock<T>,
    /// What was spent since the last change for want of a copy.
    spent: AtomicU32,
}

impl<T> Default for Mirror<T> {
    fn default() -> Self {
        Self { tree: OnceLock::new(), spent: AtomicU32::new(0) }
    }
}

impl<T> Clone for Mirror<T> {
    /// Made anew if it is needed.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<T> Mirror<T> {
    /// For every change of the tree.
    #[inline]
    pub fn drop_copy(&mut self) {
        if *self.spent.get_mut() > 0 {
            *self = Self::default();
        }
    }

    /// The copy, if there is one.
    pub fn copy_mut(&mut self) -> Option<&mut T> {
        self.tree.get_mut()
    }

    /// The copy of a tree of so many leaves, once as much has been spent as it costs.
    #[inline]
    pub fn get(&self, search: Search, leaves: usize, make: impl FnOnce() -> T) -> Option<&T> {
        if let Some(tree) = self.tree.get() {
            return Some(tree);
        }
        // Whether a search takes the copy or not, it finds the same: the count need not be exact.
        let spent = self.spent.load(Ordering::Relaxed);
        if spent as usize <= leaves {
            self.spent.store(spent.saturating_add(search as u32), Ordering::Relaxed);
            return None;
        }
        Some(self.tree.get_or_init(make))
    }
}
