//! Resolves a [`draft::Scene`]: every frame's pose in the world, every reference to the thing it names.
//!
//! The rules are SDF's (pose frame semantics, specification 1.7 and 1.8). A world or model is a *scope*. Within it,
//! each link, joint, frame and nested model is a *vertex* with a pose relative to another vertex of that scope, or
//! of a model nested in it (`arm::hand`), or to the scope's own frame (`__model__`, `world`). Nothing refers out of
//! its scope, so poses are first found relative to the scope's frame, and then carried outwards.

use std::collections::BTreeMap;

use ferrode_math::Pose;

use crate::description::{
    Axis, Body, Frame, Joint, JointId, JointKind, Link, LinkId, Mimic, Model, ModelId, Scene,
};
use crate::draft::{self, Placement, Reference};
use crate::error::{Notes, Result, SceneError, did_you_mean};
use crate::inertia;
use crate::merge;
use crate::source::Origin;

/// Makes a scene of a draft.
pub(crate) fn resolve(draft: draft::Scene, notes: &mut Notes) -> Result<Scene> {
    let mut graph = Graph::default();
    graph.add_world(&draft)?;
    graph.set_references(&draft)?;
    graph.solve()?;
    graph.describe(draft, notes)
}

/// The pose of the frame `name` relative to the frame of `model`, found in the model alone.
pub(crate) fn pose_in_model(model: &draft::Model, name: &Reference) -> Result<Pose> {
    let mut graph = Graph::default();
    let scope = graph.add_scope(None, "");
    graph.add_model(scope, model)?;
    graph.set_model_references(scope, model)?;
    let inner = graph.scopes[scope].models[0];
    let target = graph.find(inner, name)?;
    graph.solve()?;
    Ok(target.map_or(Pose::IDENTITY, |vertex| graph.seen_from(inner, vertex)))
}

type ScopeIndex = usize;
type VertexIndex = usize;

#[derive(Default)]
struct Graph {
    scopes: Vec<Scope>,
    vertices: Vec<Vertex>,
}

/// A world or a model.
struct Scope {
    /// Scoped name with `::` at its end; empty for the world.
    prefix: String,
    /// The vertex of the model whose inside this is, in the scope around it; `None` for the world.
    vertex: Option<VertexIndex>,
    names: BTreeMap<String, VertexIndex>,
    /// Where the vertices of each kind begin: they follow one another in the order of the draft.
    links: Vec<VertexIndex>,
    joints: Vec<VertexIndex>,
    frames: Vec<VertexIndex>,
    /// The scopes of the nested models.
    models: Vec<ScopeIndex>,
    canonical: Canonical,
}

#[derive(Clone, Copy, PartialEq)]
enum Canonical {
    /// Not chosen by the file: the first link, or that of the first nested model that has one.
    First,
    Link(VertexIndex),
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Link,
    Joint,
    Frame,
    /// A model, with its inside.
    Model(ScopeIndex),
}

struct Vertex {
    name: String,
    kind: Kind,
    scope: ScopeIndex,
    origin: Origin,
    /// The frame that `local` is in; `None`: that of the scope.
    base: Option<VertexIndex>,
    local: Pose,
    /// Of a model: the frame in it that `local` places, instead of the model frame.
    placed: Option<VertexIndex>,
    /// What it moves with: of a frame, what it is attached to; of a joint, its child. `None`: with the scope.
    carrier: Option<VertexIndex>,
    state: State,
}

#[derive(Clone, Copy)]
enum State {
    Unknown,
    Pending,
    /// Relative to the frame of its scope.
    Known(Pose),
}

impl Graph {
    fn add_scope(&mut self, vertex: Option<VertexIndex>, prefix: &str) -> ScopeIndex {
        self.scopes.push(Scope {
            prefix: prefix.to_owned(),
            vertex,
            names: BTreeMap::new(),
            links: Vec::new(),
            joints: Vec::new(),
            frames: Vec::new(),
            models: Vec::new(),
            canonical: Canonical::First,
        });
        self.scopes.len() - 1
    }

    fn add_world(&mut self, draft: &draft::Scene) -> Result<()> {
        let world = self.add_scope(None, "");
        for model in &draft.models {
            self.add_model(world, model)?;
        }
        for frame in &draft.frames {
            self.add_vertex(world, &frame.name, Kind::Frame, &frame.origin, &frame.placement, false)?;
        }
        for joint in &draft.joints {
            self.add_vertex(world, &joint.name, Kind::Joint, &joint.origin, &joint.placement, false)?;
        }
        Ok(())
    }

    fn add_model(&mut self, outer: ScopeIndex, model: &draft::Model) -> Result<()> {
        let inner = self.scopes.len();
        let (origin, placement) = (&model.origin, &model.placement);
        let vertex = self.add_vertex(outer, &model.name, Kind::Model(inner), origin, placement, false)?;
        let prefix = format!("{}{}::", self.scopes[outer].prefix, model.name);
        let scope = self.add_scope(Some(vertex), &prefix);
        self.scopes[outer].models.push(scope);
        let shared = model.shared_names;
        for link in &model.links {
            self.add_vertex(scope, &link.name, Kind::Link, &link.origin, &link.placement, shared)?;
        }
        for joint in &model.joints {
            self.add_vertex(scope, &joint.name, Kind::Joint, &joint.origin, &joint.placement, shared)?;
        }
        for frame in &model.frames {
            self.add_vertex(scope, &frame.name, Kind::Frame, &frame.origin, &frame.placement, shared)?;
        }
        for nested in &model.models {
            self.add_model(scope, nested)?;
        }
        Ok(())
    }

    fn add_vertex(
        &mut self,
        scope: ScopeIndex,
        name: &str,
        kind: Kind,
        origin: &Origin,
        placement: &Placement,
        shared: bool,
    ) -> Result<VertexIndex> {
        let index = self.vertices.len();
        match self.scopes[scope].names.get(name) {
            Some(&other) => {
                let other = &self.vertices[other];
                let same_kind = std::mem::discriminant(&other.kind) == std::mem::discriminant(&kind);
                if same_kind || !shared {
                    let message =
                        format!("the name `{name}` is already taken by a {}", Self::kind_name(other.kind));
                    let (line, _) = other.origin.source().line_column(other.origin.span().start);
                    return Err(SceneError::new(origin.clone(), message)
                        .with_help(format!("the other one is at {}:{line}", other.origin.source().name())));
                }
            }
            None => {
                self.scopes[scope].names.insert(name.to_owned(), index);
            }
        }
        match kind {
            Kind::Link => self.scopes[scope].links.push(index),
            Kind::Joint => self.scopes[scope].joints.push(index),
            Kind::Frame => self.scopes[scope].frames.push(index),
            Kind::Model(_) => {}
        }
        self.vertices.push(Vertex {
            name: name.to_owned(),
            kind,
            scope,
            origin: origin.clone(),
            base: None,
            local: placement.pose,
            placed: None,
            carrier: None,
            state: State::Unknown,
        });
        Ok(index)
    }

    fn kind_name(kind: Kind) -> &'static str {
        match kind {
            Kind::Link => "link",
            Kind::Joint => "joint",
            Kind::Frame => "frame",
            Kind::Model(_) => "model",
        }
    }

    /// The vertex that a reference in `scope` names; `None` for the frame of the scope itself.
    fn find(&self, scope: ScopeIndex, reference: &Reference) -> Result<Option<VertexIndex>> {
        let is_world = self.scopes[scope].vertex.is_none();
        let own = if is_world { "world" } else { "__model__" };
        if reference.name == own {
            return Ok(None);
        }
        let mut at = scope;
        let mut rest = reference.name.as_str();
        loop {
            if let Some(&vertex) = self.scopes[at].names.get(rest) {
                return Ok(Some(vertex));
            }
            let inner = rest.split_once("::").and_then(|(first, after)| {
                let &vertex = self.scopes[at].names.get(first)?;
                match self.vertices[vertex].kind {
                    Kind::Model(inner) => Some((inner, after)),
                    _ => None,
                }
            });
            match inner {
                Some((inner, "__model__")) => return Ok(self.scopes[inner].vertex),
                Some((inner, after)) => (at, rest) = (inner, after),
                None => break,
            }
        }
        let whose = match self.scopes[scope].vertex {
            Some(vertex) => format!("model `{}`", self.vertices[vertex].name),
            None => "the world".to_owned(),
        };
        let error = SceneError::new(
            reference.origin.clone(),
            format!("there is no link, joint, frame or model `{}` in {whose}", reference.name),
        );
        Err(match did_you_mean(rest, self.scopes[at].names.keys().map(String::as_str)) {
            Some(help) => error.with_help(help),
            None => error,
        })
    }

    fn set_references(&mut self, draft: &draft::Scene) -> Result<()> {
        for (index, model) in draft.models.iter().enumerate() {
            let inner = self.scopes[0].models[index];
            self.set_model_reference(0, inner, model)?;
        }
        self.set_frame_references(0, &draft.frames)?;
        self.set_joint_references(0, &draft.joints)
    }

    /// For a world that holds this one model.
    fn set_model_references(&mut self, outer: ScopeIndex, model: &draft::Model) -> Result<()> {
        let inner = self.scopes[outer].models[0];
        self.set_model_inside(inner, model)
    }

    fn set_model_reference(
        &mut self,
        outer: ScopeIndex,
        inner: ScopeIndex,
        model: &draft::Model,
    ) -> Result<()> {
        self.set_model_inside(inner, model)?;
        let Some(vertex) = self.scopes[inner].vertex else { return Ok(()) };
        if let Some(reference) = &model.placement.relative_to {
            self.vertices[vertex].base = self.find(outer, reference)?;
        }
        if let Some(reference) = &model.placement_frame {
            self.vertices[vertex].placed = self.find(inner, reference)?;
        }
        Ok(())
    }

    fn set_model_inside(&mut self, scope: ScopeIndex, model: &draft::Model) -> Result<()> {
        for (index, nested) in model.models.iter().enumerate() {
            let inner = self.scopes[scope].models[index];
            self.set_model_reference(scope, inner, nested)?;
        }
        for (index, link) in model.links.iter().enumerate() {
            if let Some(reference) = &link.placement.relative_to {
                let vertex = self.scopes[scope].links[index];
                self.vertices[vertex].base = self.find(scope, reference)?;
            }
        }
        self.set_frame_references(scope, &model.frames)?;
        self.set_joint_references(scope, &model.joints)?;
        if let Some(reference) = &model.canonical_link {
            match self.find(scope, reference)? {
                Some(vertex) if self.vertices[vertex].kind == Kind::Link => {
                    self.scopes[scope].canonical = Canonical::Link(vertex);
                }
                _ => {
                    let message = format!("the canonical link `{}` is not a link", reference.name);
                    return Err(SceneError::new(reference.origin.clone(), message));
                }
            }
        }
        Ok(())
    }

    fn set_frame_references(&mut self, scope: ScopeIndex, frames: &[draft::Frame]) -> Result<()> {
        for (index, frame) in frames.iter().enumerate() {
            let vertex = self.scopes[scope].frames[index];
            let attached =
                frame.attached_to.as_ref().map(|reference| self.find(scope, reference)).transpose()?;
            self.vertices[vertex].carrier = attached.flatten();
            self.vertices[vertex].base = match &frame.placement.relative_to {
                Some(reference) => self.find(scope, reference)?,
                None => attached.flatten(),
            };
        }
        Ok(())
    }

    fn set_joint_references(&mut self, scope: ScopeIndex, joints: &[draft::Joint]) -> Result<()> {
        for (index, joint) in joints.iter().enumerate() {
            let vertex = self.scopes[scope].joints[index];
            if joint.child.name == "world" {
                return Err(SceneError::new(
                    joint.child.origin.clone(),
                    "the child of a joint cannot be the world",
                )
                .with_help("make the world the parent"));
            }
            let child = self.find(scope, &joint.child)?;
            self.vertices[vertex].carrier = child;
            self.vertices[vertex].base = match &joint.placement.relative_to {
                Some(reference) => self.find(scope, reference)?,
                None => child,
            };
        }
        Ok(())
    }

    /// What must be known before a vertex: each vertex on the way from its scope to a frame it refers to.
    fn needs(&self, index: VertexIndex) -> Vec<VertexIndex> {
        let vertex = &self.vertices[index];
        let mut needs = Vec::new();
        let mut way_to = |target: Option<VertexIndex>, scope: ScopeIndex| {
            let mut at = target;
            while let Some(vertex) = at {
                needs.push(vertex);
                let of = self.vertices[vertex].scope;
                at = if of == scope { None } else { self.scopes[of].vertex };
            }
        };
        way_to(vertex.base, vertex.scope);
        if let Kind::Model(inner) = vertex.kind {
            way_to(vertex.placed, inner);
        }
        needs
    }

    /// Finds all poses, each relative to the frame of its scope. Chains may be long, so without recursion.
    fn solve(&mut self) -> Result<()> {
        let mut stack = Vec::new();
        for start in 0..self.vertices.len() {
            stack.push(start);
            while let Some(&index) = stack.last() {
                if let State::Known(_) = self.vertices[index].state {
                    stack.pop();
                    continue;
                }
                self.vertices[index].state = State::Pending;
                let missing = self
                    .needs(index)
                    .into_iter()
                    .find(|&need| !matches!(self.vertices[need].state, State::Known(_)));
                match missing {
                    Some(need) if matches!(self.vertices[need].state, State::Pending) => {
                        return Err(self.cycle(&stack, need));
                    }
                    Some(need) => stack.push(need),
                    None => {
                        let vertex = &self.vertices[index];
                        let base =
                            vertex.base.map_or(Pose::IDENTITY, |base| self.seen_from(vertex.scope, base));
                        let mut pose = base * vertex.local;
                        if let (Kind::Model(inner), Some(placed)) = (vertex.kind, vertex.placed) {
                            pose = pose * self.seen_from(inner, placed).inverse();
                        }
                        self.vertices[index].state = State::Known(pose);
                        stack.pop();
                    }
                }
            }
        }
        Ok(())
    }

    fn cycle(&self, stack: &[VertexIndex], again: VertexIndex) -> SceneError {
        let start = stack.iter().position(|&index| index == again).unwrap_or(0);
        let ring = &stack[start..];
        let names: Vec<String> =
            ring.iter().take(8).map(|&index| format!("`{}`", self.vertices[index].name)).collect();
        let message = match names.as_slice() {
            [alone] => format!("the pose of {alone} is relative to itself"),
            _ => format!("the poses of {} are relative to each other in a circle", names.join(", ")),
        };
        SceneError::new(self.vertices[again].origin.clone(), message)
    }

    /// The pose of a vertex relative to the frame of `scope`, which holds it, maybe in nested models.
    fn seen_from(&self, scope: ScopeIndex, vertex: VertexIndex) -> Pose {
        let mut at = &self.vertices[vertex];
        let mut pose = at.pose();
        while at.scope != scope {
            let Some(outer) = self.scopes[at.scope].vertex else { break };
            at = &self.vertices[outer];
            pose = at.pose() * pose;
        }
        pose
    }

    fn in_world(&self, vertex: VertexIndex) -> Pose {
        self.seen_from(0, vertex)
    }

    fn scope_in_world(&self, scope: ScopeIndex) -> Pose {
        self.scopes[scope].vertex.map_or(Pose::IDENTITY, |vertex| self.in_world(vertex))
    }

    /// The link a vertex moves with; `None` for the world, or a model without links.
    fn carrying_link(&self, mut vertex: VertexIndex) -> Result<Option<VertexIndex>> {
        // Each turn goes to another vertex, so more turns than vertices are a circle.
        for _ in 0..=self.vertices.len() {
            let at = &self.vertices[vertex];
            let next = match at.kind {
                Kind::Link => return Ok(Some(vertex)),
                Kind::Model(inner) => return Ok(self.canonical_link(inner)),
                Kind::Joint | Kind::Frame => at.carrier,
            };
            match next {
                Some(next) => vertex = next,
                None => return Ok(self.canonical_link(at.scope)),
            }
        }
        let at = &self.vertices[vertex];
        let message = format!("`{}` is attached to itself in a circle", at.name);
        Err(SceneError::new(at.origin.clone(), message))
    }

    fn canonical_link(&self, scope: ScopeIndex) -> Option<VertexIndex> {
        let scope = &self.scopes[scope];
        // The world moves with no link.
        scope.vertex?;
        match scope.canonical {
            Canonical::Link(vertex) => Some(vertex),
            Canonical::First => scope
                .links
                .first()
                .copied()
                .or_else(|| scope.models.iter().find_map(|&nested| self.canonical_link(nested))),
        }
    }

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

impl Vertex {
    fn pose(&self) -> Pose {
        match self.state {
            State::Known(pose) => pose,
            State::Unknown | State::Pending => Pose::IDENTITY,
        }
    }
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
