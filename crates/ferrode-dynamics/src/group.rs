//! Joint groups: joints that are destroyed together, as contact joints are after every step.

use crate::arena::{RawKey, key_type};
use crate::{Error, JointKey, World};

key_type!(
    /// Names a joint group of a world. A stale key, or a key of another world, finds nothing.
    GroupKey,
    "joint group"
);

/// The joints of a group, oldest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointGroup {
    pub joints: Vec<RawKey>,
}

impl World {
    /// Creates an empty joint group.
    pub fn create_group(&mut self) -> GroupKey {
        GroupKey(self.groups.insert(JointGroup::default()))
    }

    /// Destroys all joints of a group, newest first; the group remains.
    ///
    /// # Errors
    /// [`Error::NoSuchGroup`].
    pub fn empty_group(&mut self, group: GroupKey) -> Result<(), Error> {
        let index = self.group_index(group)?;
        let mut joints = core::mem::take(&mut self.groups.at_mut(index).joints);
        for key in joints.drain(..).rev() {
            if let Some(joint) = self.joints.index_of(key) {
                self.remove_joint(joint);
            }
        }
        // Keep the allocation for the next step's contacts.
        self.groups.at_mut(index).joints = joints;
        Ok(())
    }

    /// Destroys a group and all its joints.
    ///
    /// # Errors
    /// [`Error::NoSuchGroup`].
    pub fn destroy_group(&mut self, group: GroupKey) -> Result<(), Error> {
        self.empty_group(group)?;
        self.groups.remove(group.0.index);
        Ok(())
    }

    /// The joints of a group, oldest first.
    ///
    /// # Errors
    /// [`Error::NoSuchGroup`].
    pub fn group_joints(&self, group: GroupKey) -> Result<impl Iterator<Item = JointKey> + '_, Error> {
        let index = self.group_index(group)?;
        Ok(self.groups.at(index).joints.iter().map(|key| JointKey(*key)))
    }

    pub(crate) fn group_index(&self, group: GroupKey) -> Result<u32, Error> {
        self.groups.index_of(group.0).ok_or(Error::NoSuchGroup(group))
    }
}
