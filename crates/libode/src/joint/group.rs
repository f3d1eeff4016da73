//! Joint groups. The engine's groups belong to a world; a group of the C interface may hold joints of several.

use crate::fault::{Outcome, export};
use crate::record::{GroupId, GroupRecord, Required};
use crate::slab::Record;
use core::ffi::c_int;

/// Destroys the joints of a group, newest first. The group keeps its memory for the next step's contacts.
fn empty(group: &'static GroupRecord) -> Outcome<()> {
    let mut joints = core::mem::take(&mut *group.joints.borrow_mut());
    for joint in joints.drain(..).rev() {
        if let Some(joint) = joint.live() {
            super::destroy_record(joint);
        }
    }
    *group.joints.borrow_mut() = joints;
    Ok(())
}

export! {
    fn dJointGroupCreate(_max_size: c_int) -> GroupId { GroupId::of(GroupRecord::pool().create()) }
    fn dJointGroupEmpty(group: GroupId) { empty(group.get()?)? }
    fn dJointGroupDestroy(group: GroupId) {
        let group = group.get()?;
        empty(group)?;
        *group.joints.borrow_mut() = Vec::new();
        GroupRecord::pool().destroy(group)
    }
}
