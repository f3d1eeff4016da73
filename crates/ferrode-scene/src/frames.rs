//! The frames of a [`draft::Scene`]: what each is relative to, and its pose in the world.
//!
//! The rules are SDF's (pose frame semantics, specification 1.7 and 1.8). A world or model is a *scope*. Within it,
//! each link, joint, frame and nested model is a *vertex* with a pose relative to another vertex of that scope, or
//! of a model nested in it (`arm::hand`), or to the scope's own frame (`__model__`, `world`). Nothing refers out of
//! its scope, so poses are first found relative to the scope's frame, and then carried outwards.

use std::collections::BTreeMap;

use ferrode_math::Pose;

use crate::draft::{self, Placement, Reference};
use crate::error::{Result, SceneError, did_you_mean};
use crate::source::Origin;

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

pub(crate) type ScopeIndex = usize;
pub(crate) type VertexIndex = usize;

/// The frames of a draft, and how they hang together.
#[derive(Default)]
pub(crate) struct Graph {
    pub(crate) scopes: Vec<Scope>,
    pub(crate) vertices: Vec<Vertex>,
}

/// A world or a model.
pub(crate) struct Scope {
    /// Scoped name with `::` at its end; empty for the world.
    pub(crate) prefix: String,
    /// The vertex of the model whose inside this is, in the scope around it; `None` for the world.
    pub(crate) vertex: Option<VertexIndex>,
    names: BTreeMap<String, VertexIndex>,
    /// Where the vertices of each kind begin: they follow one another in the order of the draft.
    pub(crate) links: Vec<VertexIndex>,
    pub(crate) joints: Vec<VertexIndex>,
    pub(crate) frames: Vec<VertexIndex>,
    /// The scopes of the nested models.
    pub(crate) models: Vec<ScopeIndex>,
    canonical: Canonical,
}

#[derive(Clone, Copy, PartialEq)]
enum Canonical {
    /// Not chosen by the file: the first link, or that of the first nested model that has one.
    First,
    Link(VertexIndex),
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Link,
    Joint,
    Frame,
    /// A model, with its inside.
    Model(ScopeIndex),
}

pub(crate) struct Vertex {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    pub(crate) scope: ScopeIndex,
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

    pub(crate) fn add_world(&mut self, draft: &draft::Scene) -> Result<()> {
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
    pub(crate) fn find(&self, scope: ScopeIndex, reference: &Reference) -> Result<Option<VertexIndex>> {
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

    pub(crate) fn set_references(&mut self, draft: &draft::Scene) -> Result<()> {
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
    pub(crate) fn solve(&mut self) -> Result<()> {
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
    pub(crate) fn seen_from(&self, scope: ScopeIndex, vertex: VertexIndex) -> Pose {
        let mut at = &self.vertices[vertex];
        let mut pose = at.pose();
        while at.scope != scope {
            let Some(outer) = self.scopes[at.scope].vertex else { break };
            at = &self.vertices[outer];
            pose = at.pose() * pose;
        }
        pose
    }

    pub(crate) fn in_world(&self, vertex: VertexIndex) -> Pose {
        self.seen_from(0, vertex)
    }

    pub(crate) fn scope_in_world(&self, scope: ScopeIndex) -> Pose {
        self.scopes[scope].vertex.map_or(Pose::IDENTITY, |vertex| self.in_world(vertex))
    }

    /// The link a vertex moves with; `None` for the world, or a model without links.
    pub(crate) fn carrying_link(&self, mut vertex: VertexIndex) -> Result<Option<VertexIndex>> {
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

    pub(crate) fn canonical_link(&self, scope: ScopeIndex) -> Option<VertexIndex> {
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
}

impl Vertex {
    fn pose(&self) -> Pose {
        match self.state {
            State::Known(pose) => pose,
            State::Unknown | State::Pending => Pose::IDENTITY,
        }
    }
}
