//! Makes a [`Scene`] of a [`draft::Scene`] whose frames are known: names become numbers, axes directions, and whatever a
//! joint or frame names becomes the link that it moves with.

use ferrode_math::Pose;

use crate::description::{
    Axis, Body, Frame, Joint, JointId, JointKind, Link, LinkId, Mimic, Model, ModelId, Scene,
};
use crate::draft::{self, Reference};
use crate::error::{Notes, Result, SceneError};
use crate::frames::{Graph, Kind, ScopeIndex, VertexIndex};
use crate::inertia;
use crate::merge;

/// Makes a scene of a draft.
pub(crate) fn resolve(draft: draft::Scene, notes: &mut Notes) -> Result<Scene> {
    let mut graph = Graph::default();
    graph.add_world(&draft)?;
    graph.set_references(&draft)?;
    graph.solve()?;
    graph.describe(draft, notes)
}

impl Graph {
    fn describe(&self, draft: draft::Scene, notes: &mut Notes) -> Result<Scene> {
        let mut builder = Describer {
            graph: self,
            notes,
            merged: Vec::new(),
            link_ids: vec![None; self.vertices.len()],
            joint_ids: vec![None; self.vertices.len()],
            scene: Scene {
                name: draft.name,
                gravity: draft.gravity,
                physics: draft.physics,
                models: Vec::new(),
                links: Vec::new(),
                joints: Vec::new(),
                frames: Vec::new(),
            },
        };
        // Identities first, in the order in which the items will come: joints refer forwards.
        let mut counts = (0, 0);
        for (index, model) in draft.models.iter().enumerate() {
            builder.identify(self.scopes[0].models[index], model, &mut counts);
        }
        for (index, _) in draft.joints.iter().enumerate() {
            builder.joint_ids[self.scopes[0].joints[index]] = Some(JointId(counts.1));
            counts.1 += 1;
        }
        for (index, model) in draft.models.into_iter().enumerate() {
            builder.model(self.scopes[0].models[index], model, None, false)?;
        }
        builder.frames(0, draft.frames)?;
        builder.joints(0, draft.joints, None)?;
        let (mut scene, merged) = (builder.scene, builder.merged);
        check_mimics(&scene)?;
        merge::merge_fixed(&mut scene, &merged, notes)?;
        Ok(scene)
    }
}

/// A joint that follows another must not be followed by it, however far around.
fn check_mimics(scene: &Scene) -> Result<()> {
    let leader = |joint: &Joint| {
        [&joint.axis, &joint.axis2]
            .into_iter()
            .flatten()
            .find_map(|axis| axis.mimic.map(|mimic| mimic.leader))
    };
    for joint in &scene.joints {
        let mut at = leader(joint);
        for _ in 0..=scene.joints.len() {
            if at.is_none() {
                break;
            }
            at = at.and_then(|id| scene.joints.get(id.0)).and_then(leader);
        }
        if at.is_some() {
            let message = format!("joint `{}` mimics itself, by way of others", joint.name);
            return Err(SceneError::new(joint.origin.clone(), message));
        }
    }
    Ok(())
}

struct Describer<'g, 'n> {
    graph: &'g Graph,
    notes: &'n mut Notes,
    /// Fixed joints to merge away.
    merged: Vec<JointId>,
    link_ids: Vec<Option<LinkId>>,
    joint_ids: Vec<Option<JointId>>,
    scene: Scene,
}

impl Describer<'_, '_> {
    fn identify(&mut self, scope: ScopeIndex, model: &draft::Model, counts: &mut (usize, usize)) {
        for &vertex in &self.graph.scopes[scope].links {
            self.link_ids[vertex] = Some(LinkId(counts.0));
            counts.0 += 1;
        }
        for &vertex in &self.graph.scopes[scope].joints {
            self.joint_ids[vertex] = Some(JointId(counts.1));
            counts.1 += 1;
        }
        for (index, nested) in model.models.iter().enumerate() {
            self.identify(self.graph.scopes[scope].models[index], nested, counts);
        }
    }

    fn link_id(&self, vertex: Option<VertexIndex>) -> Option<LinkId> {
        vertex.and_then(|vertex| self.link_ids[vertex])
    }

    fn scoped(&self, scope: ScopeIndex, name: &str) -> String {
        format!("{}{name}", self.graph.scopes[scope].prefix)
    }

    fn model(
        &mut self,
        scope: ScopeIndex,
        model: draft::Model,
        parent: Option<ModelId>,
        in_static: bool,
    ) -> Result<()> {
        let id = ModelId(self.scene.models.len());
        let is_static = model.is_static || in_static;
        let prefix = &self.graph.scopes[scope].prefix;
        self.scene.models.push(Model {
            name: prefix.strip_suffix("::").unwrap_or(prefix).to_owned(),
            parent,
            pose: self.graph.scope_in_world(scope),
            is_static,
            allow_auto_disable: model.allow_auto_disable,
            canonical_link: self.link_id(self.graph.canonical_link(scope)),
            origin: model.origin.clone(),
        });
        for (index, link) in model.links.into_iter().enumerate() {
            let vertex = self.graph.scopes[scope].links[index];
            self.link(scope, vertex, link, id, model.self_collide)?;
        }
        let first_joint = self.scene.joints.len();
        self.joints(scope, model.joints, Some(id))?;
        if let Some(kept) = &model.lump_fixed {
            let prefix = &self.graph.scopes[scope].prefix;
            for (index, joint) in self.scene.joints.iter().enumerate().skip(first_joint) {
                let bare = joint.name.strip_prefix(prefix.as_str()).unwrap_or(&joint.name);
                if joint.kind == JointKind::Fixed && !kept.iter().any(|name| name == bare) {
                    self.merged.push(JointId(index));
                }
            }
        }
        self.frames(scope, model.frames)?;
        for (index, nested) in model.models.into_iter().enumerate() {
            self.model(self.graph.scopes[scope].models[index], nested, Some(id), is_static)?;
        }
        Ok(())
    }

    fn link(
        &mut self,
        scope: ScopeIndex,
        vertex: VertexIndex,
        link: draft::Link,
        model: ModelId,
        model_self_collide: bool,
    ) -> Result<()> {
        let from_scope = self.graph.seen_from(scope, vertex).inverse();
        let mut collisions = Vec::with_capacity(link.collisions.len());
        for placed in link.collisions {
            let mut collision = placed.collision;
            collision.pose = match &placed.placement.relative_to {
                None => placed.placement.pose,
                Some(reference) => {
                    let base = self.graph.find(scope, reference)?;
                    let base = base.map_or(Pose::IDENTITY, |base| self.graph.seen_from(scope, base));
                    from_scope * base * placed.placement.pose
                }
            };
            collisions.push(collision);
        }
        let mut inertial = link.inertial;
        if let Some(automatic) = link.automatic {
            let mut skipped = Vec::new();
            let found =
                inertia::from_collisions(collisions.iter(), automatic.density, |collision, reason| {
                    skipped.push((collision, reason));
                });
            for (collision, reason) in skipped {
                self.notes.not_supported(
                    collision.origin.clone(),
                    format!("collision `{}` adds nothing to the automatic inertia: {reason}", collision.name),
                );
            }
            inertial = found.ok_or_else(|| {
                SceneError::new(
                    automatic.origin.clone(),
                    format!(
                        "the inertial of link `{}` is automatic, but no collision gives it a volume",
                        link.name
                    ),
                )
            })?;
            if let Some(mass) = automatic.mass {
                inertial.inertia = inertial.inertia * (mass / inertial.mass);
                inertial.mass = mass;
            }
        }
        self.scene.links.push(Link {
            name: self.scoped(scope, &link.name),
            model,
            pose: self.graph.in_world(vertex),
            inertial,
            collisions,
            gravity: link.gravity,
            kinematic: link.kinematic,
            self_collide: link.self_collide.unwrap_or(model_self_collide),
            linear_damping: link.linear_damping,
            angular_damping: link.angular_damping,
            origin: link.origin,
        });
        Ok(())
    }

    fn frames(&mut self, scope: ScopeIndex, frames: Vec<draft::Frame>) -> Result<()> {
        for (index, frame) in frames.into_iter().enumerate() {
            let vertex = self.graph.scopes[scope].frames[index];
            let carrier = self.graph.carrying_link(vertex)?;
            if frame.proxy {
                continue;
            }
            self.scene.frames.push(Frame {
                name: self.scoped(scope, &frame.name),
                attached_to: self.link_id(carrier).map_or(Body::World, Body::Link),
                pose: self.graph.in_world(vertex),
            });
        }
        Ok(())
    }

    /// The body a joint holds on to.
    fn body(&self, scope: ScopeIndex, reference: &Reference) -> Result<Body> {
        if reference.name == "world" {
            return Ok(Body::World);
        }
        let carrier = match self.graph.find(scope, reference)? {
            Some(vertex) => {
                let link = self.graph.carrying_link(vertex)?;
                let in_world_scope = self.graph.vertices[vertex].scope == 0;
                if link.is_none() && in_world_scope && self.graph.vertices[vertex].kind == Kind::Frame {
                    return Ok(Body::World);
                }
                link
            }
            None => self.graph.canonical_link(scope),
        };
        self.link_id(carrier).map(Body::Link).ok_or_else(|| {
            let message = format!("`{}` is no link and moves with none", reference.name);
            SceneError::new(reference.origin.clone(), message)
        })
    }

    fn joints(&mut self, scope: ScopeIndex, joints: Vec<draft::Joint>, model: Option<ModelId>) -> Result<()> {
        for (index, joint) in joints.into_iter().enumerate() {
            let vertex = self.graph.scopes[scope].joints[index];
            let pose = self.graph.in_world(vertex);
            let parent = self.body(scope, &joint.parent)?;
            let child = self.body(scope, &joint.child)?;
            if parent == child {
                let message = format!(
                    "joint `{}` joins `{}` to `{}`, which is the same body",
                    joint.name, joint.parent.name, joint.child.name
                );
                return Err(SceneError::new(joint.child.origin, message));
            }
            let kind = match joint.kind {
                draft::JointKind::Revolute => JointKind::Revolute,
                draft::JointKind::Prismatic => JointKind::Prismatic,
                draft::JointKind::Ball => JointKind::Ball,
                draft::JointKind::Universal => JointKind::Universal,
                draft::JointKind::Revolute2 => JointKind::Revolute2,
                draft::JointKind::Fixed => JointKind::Fixed,
                draft::JointKind::Planar => JointKind::Planar,
                draft::JointKind::Screw { pitch } => JointKind::Screw { pitch },
                draft::JointKind::Gearbox { ratio, reference } => {
                    JointKind::Gearbox { ratio, reference: self.body(scope, &reference)? }
                }
            };
            let axis = joint.axis.map(|axis| self.axis(scope, &pose, vertex, axis)).transpose()?;
            let axis2 = joint.axis2.map(|axis| self.axis(scope, &pose, vertex, axis)).transpose()?;
            self.scene.joints.push(Joint {
                name: self.scoped(scope, &joint.name),
                model,
                kind,
                parent,
                child,
                pose,
                axis,
                axis2,
                advanced: joint.advanced,
                origin: joint.origin,
            });
        }
        Ok(())
    }

    fn axis(&self, scope: ScopeIndex, joint: &Pose, own: VertexIndex, axis: draft::Axis) -> Result<Axis> {
        let rotation = match &axis.expressed_in {
            None => joint.rotation,
            Some(reference) => match self.graph.find(scope, reference)? {
                Some(vertex) => self.graph.in_world(vertex).rotation,
                None => self.graph.scope_in_world(scope).rotation,
            },
        };
        let mimic = match axis.mimic {
            None => None,
            Some(mimic) => {
                // In a URDF a link may have the joint's name, and would be found first.
                let namesake = self.graph.scopes[scope]
                    .joints
                    .iter()
                    .copied()
                    .find(|&joint| self.graph.vertices[joint].name == mimic.leader.name);
                let found = match namesake {
                    Some(joint) => Some(joint),
                    None => self.graph.find(scope, &mimic.leader)?,
                };
                let leader = found.and_then(|vertex| self.joint_ids[vertex]).ok_or_else(|| {
                    let message = format!("`{}` cannot be mimicked: it is not a joint", mimic.leader.name);
                    SceneError::new(mimic.leader.origin.clone(), message)
                })?;
                if found == Some(own) {
                    return Err(SceneError::new(mimic.leader.origin, "a joint cannot mimic itself"));
                }
                Some(Mimic {
                    leader,
                    second_axis: mimic.second_axis,
                    multiplier: mimic.multiplier,
                    offset: mimic.offset,
                    reference: mimic.reference,
                })
            }
        };
        Ok(Axis {
            direction: rotation.rotate(axis.xyz),
            limits: axis.limits,
            damping: axis.damping,
            friction: axis.friction,
            spring: axis.spring,
            mimic,
        })
    }
}
