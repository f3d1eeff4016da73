//! Merges links that fixed joints hold together into one body, as Gazebo does with a URDF.
//!
//! The parent's link stays; it takes over the child's collisions and mass. The merged link and joint live on as
//! frames of the same names, so that `frame("tool0")` still says where the tool is.

use ferrode_math::Pose;

use crate::description::{Body, Frame, Inertial, JointId, JointKind, LinkId, Scene};
use crate::error::{Notes, Result, SceneError};
use crate::inertia;

/// Merges the links that `joints`, fixed ones, hold together, and deals with links that have no mass.
pub(crate) fn merge_fixed(scene: &mut Scene, joints: &[JointId], notes: &mut Notes) -> Result<()> {
    let mut keeper: Vec<usize> = (0..scene.links.len()).collect();
    let mut drop_joint = vec![false; scene.joints.len()];
    for &JointId(index) in joints {
        let joint = &scene.joints[index];
        // A link that is fixed to the world keeps its joint.
        let (Body::Link(LinkId(parent)), Body::Link(LinkId(child))) = (joint.parent, joint.child) else {
            continue;
        };
        let (parent, child) = (keeper_of(&keeper, parent), keeper_of(&keeper, child));
        drop_joint[index] = true;
        if parent != child {
            keeper[child] = parent;
        }
    }
    let keepers: Vec<usize> = (0..keeper.len()).map(|link| keeper_of(&keeper, link)).collect();
    move_contents(scene, &keepers, notes);
    for (joint, _) in scene.joints.iter().zip(&drop_joint).filter(|(_, dropped)| **dropped) {
        // In a URDF a joint's frame is its child's, and the two may share the name.
        if scene.frames.iter().any(|frame| frame.name == joint.name) {
            continue;
        }
        let attached_to = joint.parent.link().map_or(Body::World, |link| Body::Link(LinkId(keepers[link.0])));
        scene.frames.push(Frame { name: joint.name.clone(), attached_to, pose: joint.pose });
    }
    let mut drop_link: Vec<bool> = keepers.iter().enumerate().map(|(link, &kept)| link != kept).collect();
    drop_massless(scene, &keepers, &mut drop_link, &mut drop_joint, notes)?;
    for joint in &scene.joints {
        let leaders = [&joint.axis, &joint.axis2].into_iter().flatten().filter_map(|axis| axis.mimic);
        for mimic in leaders.filter(|mimic| drop_joint[mimic.leader.0]) {
            let leader = &scene.joints[mimic.leader.0].name;
            let message = format!("joint `{}` mimics nothing: `{leader}` cannot move", joint.name);
            notes.suspicious(joint.origin.clone(), message);
        }
    }
    if drop_link.contains(&true) || drop_joint.contains(&true) {
        renumber(scene, &keepers, &drop_link, &drop_joint);
    }
    Ok(())
}

fn keeper_of(keeper: &[usize], mut link: usize) -> usize {
    while keeper[link] != link {
        link = keeper[link];
    }
    link
}

fn move_contents(scene: &mut Scene, keepers: &[usize], notes: &mut Notes) {
    let mut parts: Vec<Vec<Inertial>> = vec![Vec::new(); scene.links.len()];
    let mut merged_into = vec![false; scene.links.len()];
    for (link, &kept) in keepers.iter().enumerate() {
        let relative = if link == kept {
            Pose::IDENTITY
        } else {
            scene.links[kept].pose.inverse() * scene.links[link].pose
        };
        let inertial = &scene.links[link].inertial;
        if inertial.mass > 0.0 {
            parts[kept].push(Inertial { pose: relative * inertial.pose, ..inertial.clone() });
        }
        if link == kept {
            continue;
        }
        merged_into[kept] = true;
        let collisions = std::mem::take(&mut scene.links[link].collisions);
        for mut collision in collisions {
            collision.pose = relative * collision.pose;
            let taken = |name: &str| scene.links[kept].collisions.iter().any(|other| other.name == name);
            if taken(&collision.name) {
                let bare = scene.links[link].name.rsplit("::").next().unwrap_or_default().to_owned();
                collision.name = format!("{bare}_{}", collision.name);
                while taken(&collision.name) {
                    collision.name.push('_');
                }
            }
            scene.links[kept].collisions.push(collision);
        }
        let (from, to) = (&scene.links[link], &scene.links[kept]);
        let differs = from.gravity != to.gravity
            || from.kinematic != to.kinematic
            || from.linear_damping != to.linear_damping
            || from.angular_damping != to.angular_damping;
        if differs {
            let message = format!(
                "link `{}` is merged into `{}`, whose gravity, damping and kinematic settings hold",
                from.name, to.name
            );
            notes.suspicious(from.origin.clone(), message);
        }
        let self_collide = from.self_collide;
        scene.links[kept].self_collide |= self_collide;
        scene.frames.push(Frame {
            name: scene.links[link].name.clone(),
            attached_to: Body::Link(LinkId(kept)),
            pose: scene.links[link].pose,
        });
    }
    for (link, parts) in parts.into_iter().enumerate() {
        if !merged_into[link] {
            continue;
        }
        // A single mass keeps its axes; several have those of the link.
        let inertial = match <[Inertial; 1]>::try_from(parts) {
            Ok([alone]) => Some(alone),
            Err(parts) => inertia::combine(&parts),
        };
        if let Some(inertial) = inertial {
            scene.links[link].inertial = inertial;
        }
    }
}

/// A link without mass that hangs on a joint moves nothing and touches nothing, and is left out with its joint.
/// Any other link without mass cannot be simulated.
fn drop_massless(
    scene: &Scene,
    keepers: &[usize],
    drop_link: &mut [bool],
    drop_joint: &mut [bool],
    notes: &mut Notes,
) -> Result<()> {
    for (index, link) in scene.links.iter().enumerate() {
        if drop_link[index] || link.inertial.mass > 0.0 || scene.is_static(LinkId(index)) {
            continue;
        }
        let is = |body: Body| body.link().is_some_and(|LinkId(link)| keepers[link] == index);
        let live = |joint: &usize| !drop_joint[*joint];
        let touching: Vec<usize> = (0..scene.joints.len())
            .filter(live)
            .filter(|&joint| is(scene.joints[joint].parent) || is(scene.joints[joint].child))
            .collect();
        match touching.as_slice() {
            [] if link.collisions.is_empty() => {}
            &[joint] if link.collisions.is_empty() && scene.joints[joint].kind != JointKind::Fixed => {
                notes.suspicious(
                    link.origin.clone(),
                    format!(
                        "link `{}` has no mass, no collision and nothing beyond it: it is left out, with joint `{}`",
                        link.name, scene.joints[joint].name
                    ),
                );
                drop_joint[joint] = true;
            }
            &[joint] if link.collisions.is_empty() => drop_joint[joint] = true,
            _ => {
                let message = format!("link `{}` can move but has no mass", link.name);
                return Err(SceneError::new(link.origin.clone(), message)
                    .with_help("give it an <inertial>, or join it to a link that has one by a fixed joint"));
            }
        }
        drop_link[index] = true;
    }
    Ok(())
}

fn renumber(scene: &mut Scene, keepers: &[usize], drop_link: &[bool], drop_joint: &[bool]) {
    let number = |dropped: &[bool]| -> Vec<usize> {
        let mut next = 0;
        dropped
            .iter()
            .map(|&dropped| {
                let own = next;
                next += usize::from(!dropped);
                own
            })
            .collect()
    };
    let (new_link, new_joint) = (number(drop_link), number(drop_joint));
    let link = |LinkId(old): LinkId| {
        let kept = keepers[old];
        (!drop_link[kept]).then(|| LinkId(new_link[kept]))
    };
    let body = |body: Body| body.link().and_then(link).map_or(Body::World, Body::Link);
    for joint in &mut scene.joints {
        joint.parent = body(joint.parent);
        joint.child = body(joint.child);
        if let JointKind::Gearbox { reference, .. } = &mut joint.kind {
            *reference = body(*reference);
        }
        for axis in [&mut joint.axis, &mut joint.axis2].into_iter().flatten() {
            axis.mimic = axis.mimic.filter(|mimic| !drop_joint[mimic.leader.0]);
            if let Some(mimic) = &mut axis.mimic {
                mimic.leader = JointId(new_joint[mimic.leader.0]);
            }
        }
    }
    for frame in &mut scene.frames {
        frame.attached_to = body(frame.attached_to);
    }
    for model in &mut scene.models {
        model.canonical_link = model.canonical_link.and_then(link);
    }
    let mut index = 0;
    scene.links.retain(|_| {
        index += 1;
        !drop_link[index - 1]
    });
    index = 0;
    scene.joints.retain(|_| {
        index += 1;
        !drop_joint[index - 1]
    });
}
