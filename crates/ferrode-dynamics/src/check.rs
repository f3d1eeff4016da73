//! Consistency of a world's links (ODE's `dWorldCheck`).

use crate::World;
use crate::arena::NIL;

impl World {
    /// Verifies every internal link: lists, counts, and that each joint stands in the lists of its bodies.
    ///
    /// A fault is a bug of this crate, not of the caller. Debug builds check before each step.
    ///
    /// # Errors
    /// A text that names the first fault found.
    pub fn check(&self) -> Result<(), String> {
        let ensure = |ok: bool, text: &dyn Fn() -> String| if ok { Ok(()) } else { Err(text()) };
        let mut count = 0;
        let mut prev = NIL;
        let mut index = self.body_list.first;
        while index != NIL {
            let body =
                self.bodies.get(index).ok_or_else(|| format!("body list holds the empty slot {index}"))?;
            ensure(body.prev == prev, &|| format!("{} has a wrong back link", self.body_key(index)))?;
            count += 1;
            ensure(count <= self.bodies.len(), &|| "the body list runs in a circle".into())?;
            self.check_links(index)?;
            (prev, index) = (index, body.next);
        }
        ensure(count == self.bodies.len(), &|| {
            format!("the body list holds {count} of {} bodies", self.bodies.len())
        })?;

        let mut attached = 0;
        let (mut count, mut prev, mut index) = (0, NIL, self.joint_list.first);
        while index != NIL {
            let joint =
                self.joints.get(index).ok_or_else(|| format!("joint list holds the empty slot {index}"))?;
            let key = self.joint_key(index);
            ensure(joint.prev == prev, &|| format!("{key} has a wrong back link"))?;
            count += 1;
            ensure(count <= self.joints.len(), &|| "the joint list runs in a circle".into())?;
            let [a, b] = joint.nodes.map(|n| n.body);
            ensure(a != NIL || b == NIL, &|| format!("{key} has a second body but no first"))?;
            ensure(a == NIL || a != b, &|| format!("{key} connects a body with itself"))?;
            attached += joint.nodes.iter().filter(|node| node.body != NIL).count();
            ensure(joint.group == NIL || self.groups.get(joint.group).is_some(), &|| {
                format!("{key} belongs to a group that is gone")
            })?;
            (prev, index) = (index, joint.next);
        }
        ensure(count == self.joints.len(), &|| {
            format!("the joint list holds {count} of {} joints", self.joints.len())
        })?;
        // Every listed end is an end of that body (seen above), so equal numbers mean that none is missing.
        let listed: usize = self.bodies().map(|(_, body)| body.joint_count).sum();
        ensure(attached == listed, &|| {
            format!("bodies list {listed} ends of joints, but joints have {attached}")
        })
    }

    fn check_links(&self, body: u32) -> Result<(), String> {
        let key = self.body_key(body);
        let (mut count, mut prev, mut link) = (0, NIL, self.bodies.at(body).first_joint);
        while link != NIL {
            let joint =
                self.joints.get(link >> 1).ok_or_else(|| format!("{key} lists a joint that is gone"))?;
            let node = &joint.nodes[(link & 1) as usize];
            if node.body != body {
                return Err(format!("{key} lists a joint of another body"));
            }
            if node.prev != prev {
                return Err(format!("a joint of {key} has a wrong back link"));
            }
            count += 1;
            if count > self.bodies.at(body).joint_count {
                return Err(format!("{key} lists more joints than it counts"));
            }
            (prev, link) = (link, node.next);
        }
        if count == self.bodies.at(body).joint_count {
            Ok(())
        } else {
            Err(format!("{key} lists {count} joints but counts {}", self.bodies.at(body).joint_count))
        }
    }
}
