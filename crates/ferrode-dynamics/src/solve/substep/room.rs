//! Room in lists that are as long as there are contacts.

/// Makes room for `count` items in all, and an eighth more: doubling would leave up to half of a large list unused.
pub(super) fn make_room<T>(list: &mut Vec<T>, count: usize) {
    if count > list.capacity() {
        list.reserve_exact(count + count / 8 - list.len());
    }
}
