//! Joint groups. The engine's groups belong to a world; a group of the C interface may hold joints of several.

use super::shared::leave_world;
use crate::fault::export;
use crate::record::{GroupId, GroupRecord, JointRecord, Required};
use crate::slab::Record;
use core::ffi::c_int;

/// So many dead joints a group keeps at least, so that handles of destroyed joints are found out for a while.
const RESERVE: usize = 64;

impl GroupRecord {
    /// A record that an emptied group has kept, as good as new: the contacts of one step become those of the next.
    pub fn reuse(&self) -> Option<&'static JointRecord> {
        let mut spare = self.spare.borrow_mut();
        if spare.len() <= RESERVE {
            return None;
        }
        let record = spare.pop_front()?.dead()?;
        record.renew();
        Some(record)
    }

    /// Destroys the joints, newest first. Their records stay for the next step's contacts.
    fn empty(&self) {
        let mut joints = core::mem::take(&mut *self.joints.borrow_mut());
        for record in joints.iter().rev().filter_map(|joint| joint.live()) {
            leave_world(record);
            JointRecord::retire(record);
        }
        self.spare.borrow_mut().extend(joints.drain(..));
        *self.joints.borrow_mut() = joints;
    }
}

export! {
    fn dJointGroupCreate(_max_size: c_int) -> GroupId { GroupId::of(GroupRecord::pool().create()) }
    fn dJointGroupEmpty(group: GroupId) { group.get()?.empty() }
    fn dJointGroupDestroy(group: GroupId) {
        let group = group.get()?;
        group.empty();
        JointRecord::pool().give_back(group.spare.take().into_iter().filter_map(|joint| joint.dead()));
        *group.joints.borrow_mut() = Vec::new();
        GroupRecord::pool().destroy(group)
    }
}
