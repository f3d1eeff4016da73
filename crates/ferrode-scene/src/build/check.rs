//! Whether a scene hangs together. One that was read from a file does; one that was made or changed by a program may not.

use crate::description::{Body, JointKind, Scene};
use crate::error::{Result, SceneError};

/// Checks that whatever names a model, link or joint by its place names one that is there, and that models are nested
/// in models before them.
pub(super) fn check(scene: &Scene) -> Result<()> {
    let (models, links, joints) = (scene.models.len(), scene.links.len(), scene.joints.len());
    for (index, model) in scene.models.iter().enumerate() {
        if model.parent.is_some_and(|parent| parent.0 >= index) {
            let message =
                format!("model `{}` is nested in a model that does not stand before it", model.name);
            return Err(SceneError::new(model.origin.clone(), message));
        }
    }
    for link in &scene.links {
        if link.model.0 >= models {
            let message = format!("link `{}` belongs to model {} of {models}", link.name, link.model.0);
            return Err(SceneError::new(link.origin.clone(), message));
        }
    }
    for joint in &scene.joints {
        let reference = match joint.kind {
            JointKind::Gearbox { reference, .. } => reference,
            _ => Body::World,
        };
        for body in [joint.parent, joint.child, reference] {
            if let Some(link) = body.link().filter(|link| link.0 >= links) {
                let message = format!("joint `{}` holds link {} of {links}", joint.name, link.0);
                return Err(SceneError::new(joint.origin.clone(), message));
            }
        }
        if joint.parent == joint.child {
            let message = format!("joint `{}` joins a body to itself", joint.name);
            return Err(SceneError::new(joint.origin.clone(), message));
        }
        for axis in [&joint.axis, &joint.axis2].into_iter().flatten() {
            if let Some(mimic) = axis.mimic.filter(|mimic| mimic.leader.0 >= joints) {
                let message = format!("joint `{}` mimics joint {} of {joints}", joint.name, mimic.leader.0);
                return Err(SceneError::new(joint.origin.clone(), message));
            }
        }
    }
    Ok(())
}
