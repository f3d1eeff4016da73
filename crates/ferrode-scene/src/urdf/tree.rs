//! A robot is a tree: one root, and one joint above each other link.

use std::collections::BTreeMap;

use super::joint::{Joint, place};
use crate::draft;
use crate::error::{Result, SceneError, did_you_mean};
use crate::xml::Element;

/// Checks that the joints make one tree of the links.
pub(super) fn check(root: Element<'_>, links: &[draft::Link], joints: &[Joint]) -> Result<()> {
    let mut above: BTreeMap<&str, Option<&Joint>> =
        links.iter().map(|link| (link.name.as_str(), None)).collect();
    for (index, link) in links.iter().enumerate() {
        // As many names as links, unless one is taken twice.
        if above.len() < links.len() && links[..index].iter().any(|other| other.name == link.name) {
            let message = format!("the name `{}` is already taken by a link", link.name);
            return Err(SceneError::new(link.origin.clone(), message));
        }
    }
    for joint in joints {
        for end in [&joint.parent, &joint.child] {
            if !above.contains_key(end.name.as_str()) {
                let message =
                    format!("joint `{}` names a link `{}`, which there is not", joint.name, end.name);
                let error = SceneError::new(end.origin.clone(), message);
                return Err(match did_you_mean(&end.name, above.keys().copied()) {
                    Some(help) => error.with_help(help),
                    None => error,
                });
            }
        }
        if joint.parent.name == joint.child.name {
            let message = format!("joint `{}` joins link `{}` to itself", joint.name, joint.child.name);
            return Err(SceneError::new(joint.child.origin.clone(), message));
        }
        if let Some(slot) = above.get_mut(joint.child.name.as_str()) {
            if let Some(other) = slot {
                let message = format!(
                    "link `{}` is the child of joint `{}` and of joint `{}`",
                    joint.child.name, other.name, joint.name
                );
                return Err(SceneError::new(joint.child.origin.clone(), message));
            }
            *slot = Some(joint);
        }
    }
    let mut roots = links.iter().filter(|link| above.get(link.name.as_str()) == Some(&None));
    let (first, second) = (roots.next(), roots.next());
    if let (Some(first), Some(second)) = (first, second) {
        let message = format!(
            "links `{}` and `{}` are both without a parent: one root is allowed",
            first.name, second.name
        );
        return Err(SceneError::new(second.origin.clone(), message));
    }
    for joint in joints {
        let mut at = above.get(joint.parent.name.as_str()).copied().flatten();
        let mut steps = 0;
        while let Some(next) = at {
            steps += 1;
            if next.name == joint.name || steps > joints.len() {
                let message =
                    format!("the joints go round in a circle, by way of link `{}`", joint.child.name);
                return Err(SceneError::new(joint.child.origin.clone(), message));
            }
            at = above.get(next.parent.name.as_str()).copied().flatten();
        }
    }
    if first.is_none() {
        return Err(root.error("the robot has no root: each link is the child of a joint"));
    }
    Ok(())
}

impl PartialEq for Joint {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

/// A root called `world` without mass or collisions is the world itself, by ROS custom.
pub(super) fn take_out_world(links: &mut Vec<draft::Link>, joints: &mut [Joint]) {
    let is_child = joints.iter().any(|joint| joint.child.name == "world");
    let Some(index) = links.iter().position(|link| link.name == "world") else { return };
    let empty = links[index].inertial.mass == 0.0 && links[index].collisions.is_empty();
    if empty && !is_child {
        links.remove(index);
    }
}

/// Puts each link where its joint is.
pub(super) fn place_links(links: &mut [draft::Link], joints: &[Joint]) {
    let above: BTreeMap<&str, &Joint> =
        joints.iter().map(|joint| (joint.child.name.as_str(), joint)).collect();
    for link in links {
        if let Some(joint) = above.get(link.name.as_str()) {
            link.placement = place(joint.pose, &joint.parent);
        }
    }
}
