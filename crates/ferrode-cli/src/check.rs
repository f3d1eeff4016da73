//! `ferrode check`: says what is wrong with a file, and prints its tree of links and joints.

use crate::args::FileArgs;
use crate::exit::{Exit, Failure};
use crate::run::print;
use crate::simulation::load_options;
use crate::summary::{round, seconds};
use ferrode_scene::description::{Axis, Body, Joint, JointId, JointKind, Link, LinkId, ModelId, OdeSolver};
use ferrode_scene::{BuildOptions, Loaded, Scene, WarningKind, build, load};
use std::fmt::Write;

/// Does what `ferrode check` is asked for: reads the file, builds its world, and prints.
///
/// # Errors
/// The file is wrong or cannot be simulated, or the tree cannot be written.
pub fn check(args: &FileArgs) -> Result<Exit, Failure> {
    let Loaded { scene, mut warnings } = load(&args.file, &load_options(args)).map_err(Failure::told)?;
    let options = BuildOptions { strict: args.strict, ..BuildOptions::default() };
    let named = build(&scene, &options).map_err(Failure::told)?;
    warnings.extend(named.warnings.iter().cloned());
    for warning in &warnings {
        eprintln!("{warning}");
    }
    let mut text = Tree::new(&scene).print();
    let grave = warnings.iter().filter(|warning| warning.kind() != WarningKind::Ignored).count();
    let _ = writeln!(text, "\n{}: read, {grave} warnings", args.file.display());
    print(&text)?;
    Ok(Exit::Success)
}

/// The links of a scene as joints hang them on each other.
struct Tree<'a> {
    scene: &'a Scene,
    /// Joints by the link they hang on; those on the world last.
    below: Vec<Vec<JointId>>,
    /// By link: the joint that it hangs on.
    hangs_on: Vec<Option<JointId>>,
    seen: Vec<bool>,
    text: String,
}

/// A place still to be printed: kept in a list, not on the call stack, since chains may be of any length.
struct Item {
    joint: JointId,
    prefix: String,
    last: bool,
}

impl<'a> Tree<'a> {
    fn new(scene: &'a Scene) -> Self {
        let mut below = vec![Vec::new(); scene.links.len() + 1];
        let mut hangs_on = vec![None; scene.links.len()];
        for (index, joint) in scene.joints.iter().enumerate() {
            let place = joint.parent.link().map_or(scene.links.len(), |link| link.0);
            if let Some(joints) = below.get_mut(place) {
                joints.push(JointId(index));
            }
            if let Some(link) = joint.child.link() {
                hangs_on[link.0] = Some(JointId(index));
            }
        }
        Self { scene, below, hangs_on, seen: vec![false; scene.links.len()], text: String::new() }
    }

    fn print(mut self) -> String {
        let scene = self.scene;
        let physics = &scene.physics;
        let solver = match physics.ode.solver {
            OdeSolver::World => "direct".to_owned(),
            OdeSolver::Quick => format!("quick, {} iterations", physics.ode.iterations),
        };
        let name =
            scene.name.as_deref().map_or("a model without world".to_owned(), |name| format!("world {name}"));
        let g = scene.gravity;
        self.line(&format!(
            "{name}: gravity {} {} {} m/s², steps of {}, stepper {solver}",
            round(g.x),
            round(g.y),
            round(g.z),
            seconds(physics.max_step_size)
        ));
        self.line(&format!(
            "{} models, {} links, {} joints, {} collisions, {} kg that can move",
            scene.models.len(),
            scene.links.len(),
            scene.joints.len(),
            scene.links.iter().map(|link| link.collisions.len()).sum::<usize>(),
            round(scene.moving_mass())
        ));
        for index in 0..scene.models.len() {
            self.model(ModelId(index));
        }
        // What hangs on the world is part of its model, but for joints that have the world as their child.
        let of_world = std::mem::take(&mut self.below[scene.links.len()]);
        let left: Vec<JointId> =
            of_world.into_iter().filter(|id| !self.is_seen(scene.joints[id.0].child)).collect();
        if !left.is_empty() {
            self.line("joined to the world");
            self.branches(&left);
        }
        // What is left hangs in a ring without a root.
        for index in 0..scene.links.len() {
            if !self.seen[index] {
                self.root(LinkId(index));
            }
        }
        self.text
    }

    fn model(&mut self, id: ModelId) {
        let scene = self.scene;
        let Some(model) = scene.models.get(id.0) else { return };
        let p = model.pose.position;
        let is_static = if model.is_static { ", static" } else { "" };
        self.line(&format!(
            "model {} at {} {} {}{is_static}",
            model.name,
            round(p.x),
            round(p.y),
            round(p.z)
        ));
        for index in 0..scene.links.len() {
            if scene.links[index].model == id && self.hangs_on[index].is_none() {
                self.root(LinkId(index));
            }
        }
        let of_world = self.below[scene.links.len()].clone();
        let here = |joint: &JointId| {
            scene.joints[joint.0].child.link().is_some_and(|link| scene.links[link.0].model == id)
        };
        let here: Vec<JointId> = of_world.into_iter().filter(here).collect();
        if !here.is_empty() {
            self.line("  world");
            self.branches(&here);
        }
    }

    fn is_seen(&self, body: Body) -> bool {
        body.link().is_some_and(|link| self.seen[link.0])
    }

    fn root(&mut self, link: LinkId) {
        let Some(described) = self.scene.links.get(link.0) else { return };
        self.seen[link.0] = true;
        let text = link_text(described);
        self.line(&format!("  {text}"));
        let below = self.below[link.0].clone();
        self.branches(&below);
    }

    fn branches(&mut self, joints: &[JointId]) {
        let mut items = Vec::new();
        push(&mut items, joints, "  ");
        while let Some(Item { joint, prefix, last }) = items.pop() {
            let Some(joint) = self.scene.joints.get(joint.0) else { continue };
            let corner = if last { "└─" } else { "├─" };
            let joint_text = joint_text(joint);
            let Some(child) = joint.child.link() else {
                self.line(&format!("{prefix}{corner} {joint_text} → the world"));
                continue;
            };
            let Some(link) = self.scene.links.get(child.0) else { continue };
            if std::mem::replace(&mut self.seen[child.0], true) {
                self.line(&format!("{prefix}{corner} {joint_text} → {} (see above)", link.name));
                continue;
            }
            self.line(&format!("{prefix}{corner} {joint_text} → {}", link_text(link)));
            let inner = format!("{prefix}{}", if last { "   " } else { "│  " });
            let below = self.below[child.0].clone();
            push(&mut items, &below, &inner);
        }
    }

    fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }
}

/// Puts joints on the stack so that the first comes off first.
fn push(items: &mut Vec<Item>, joints: &[JointId], prefix: &str) {
    for (index, joint) in joints.iter().enumerate().rev() {
        items.push(Item { joint: *joint, prefix: prefix.to_owned(), last: index + 1 == joints.len() });
    }
}

fn link_text(link: &Link) -> String {
    let mut text = format!("{} {} kg", link.name, round(link.inertial.mass));
    let kinds: Vec<&str> = link.collisions.iter().map(|collision| collision.geometry.kind()).collect();
    if !kinds.is_empty() {
        let _ = write!(text, " ({})", counted(&kinds));
    }
    if link.kinematic {
        text += ", kinematic";
    }
    if !link.gravity {
        text += ", without gravity";
    }
    text
}

/// "box, 3 sphere": kinds in the order of their first appearance.
fn counted(kinds: &[&str]) -> String {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for kind in kinds {
        match counts.iter_mut().find(|(known, _)| known == kind) {
            Some((_, count)) => *count += 1,
            None => counts.push((kind, 1)),
        }
    }
    let words = counts
        .iter()
        .map(|(kind, count)| if *count > 1 { format!("{count} {kind}") } else { (*kind).into() });
    words.collect::<Vec<String>>().join(", ")
}

fn joint_text(joint: &Joint) -> String {
    let name = joint.name.rsplit("::").next().unwrap_or(&joint.name);
    let mut text = format!("{name} [{}", joint.kind.name());
    let unit = if matches!(joint.kind, JointKind::Prismatic) { "m" } else { "rad" };
    for axis in [&joint.axis, &joint.axis2].into_iter().flatten() {
        text += &axis_text(axis, unit);
    }
    text + "]"
}

fn axis_text(axis: &Axis, unit: &str) -> String {
    let limits = &axis.limits;
    let mut text = String::new();
    if limits.lower.is_finite() || limits.upper.is_finite() {
        let _ = write!(text, ", {} … {} {unit}", round(limits.lower), round(limits.upper));
    }
    if let Some(mimic) = &axis.mimic {
        let _ = write!(text, ", follows × {}", round(mimic.multiplier));
    }
    text
}
