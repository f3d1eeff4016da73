//! Values over time, for plots and files.

use crate::overlay::energy_of;
use crate::viewer::playback::Playback;
use ferrode_scene::description::{JointId, LinkId};
use std::collections::VecDeque;
use std::path::Path;

/// What a series shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Kinetic energy of all bodies, J.
    Kinetic,
    /// Potential energy of all bodies in gravity, J.
    Potential,
    /// Both, J.
    Total,
    /// Wall time of a step, ms.
    StepTime,
    /// Contact points.
    Contacts,
    /// Deepest penetration, mm.
    Depth,
    /// Largest residual of the exact solver.
    Residual,
    /// A coordinate of a link's origin (0 to 2), m.
    Position(LinkId, usize),
    /// A link's speed, m/s.
    Speed(LinkId),
    /// A link's angular speed, rad/s.
    Spin(LinkId),
    /// A link's kinetic energy, J.
    LinkEnergy(LinkId),
    /// Position of a joint's axis, rad or m.
    JointPosition(JointId, usize),
    /// Velocity of a joint's axis, rad/s or m/s.
    JointVelocity(JointId, usize),
    /// Size of the force that a joint puts on its first body, N.
    JointForce(JointId),
}

impl Quantity {
    /// What is recorded from the start.
    pub const ALWAYS: [Self; 7] = [
        Self::Kinetic,
        Self::Potential,
        Self::Total,
        Self::StepTime,
        Self::Contacts,
        Self::Depth,
        Self::Residual,
    ];

    /// Its name with its unit.
    pub fn name(self, playback: &Playback) -> String {
        let scene = &playback.named.scene;
        let link = |id: LinkId| scene.links.get(id.0).map_or("?", |link| link.name.as_str());
        let joint = |id: JointId| scene.joints.get(id.0).map_or("?", |joint| joint.name.as_str());
        let unit = |id: JointId, axis: usize| {
            let name = joint(id);
            playback.named.joint(name).and_then(|joint| joint.unit(axis)).unwrap_or("rad")
        };
        match self {
            Self::Kinetic => "kinetic energy [J]".to_owned(),
            Self::Potential => "potential energy [J]".to_owned(),
            Self::Total => "total energy [J]".to_owned(),
            Self::StepTime => "step time [ms]".to_owned(),
            Self::Contacts => "contacts".to_owned(),
            Self::Depth => "deepest penetration [mm]".to_owned(),
            Self::Residual => "solver residual".to_owned(),
            Self::Position(id, axis) => format!("{} {}[m]", link(id), ["x", "y", "z"][axis.min(2)]),
            Self::Speed(id) => format!("{} speed [m/s]", link(id)),
            Self::Spin(id) => format!("{} spin [rad/s]", link(id)),
            Self::LinkEnergy(id) => format!("{} kinetic energy [J]", link(id)),
            Self::JointPosition(id, axis) => format!("{} position{axis} [{}]", joint(id), unit(id, axis)),
            Self::JointVelocity(id, axis) => format!("{} velocity{axis} [{}/s]", joint(id), unit(id, axis)),
            Self::JointForce(id) => format!("{} force [N]", joint(id)),
        }
    }

    /// Its value now; not a number if there is none.
    pub fn value(self, playback: &Playback) -> f64 {
        let (named, facts) = (&playback.named, &playback.facts);
        let world = &named.world;
        match self {
            Self::Kinetic => world.energy().kinetic,
            Self::Potential => world.energy().potential,
            Self::Total => world.energy().total(),
            Self::StepTime => facts.wall * 1e3,
            Self::Contacts => facts.contacts as f64,
            Self::Depth => facts.depth * 1e3,
            Self::Residual => facts.residual,
            Self::Position(id, axis) => named.link_pose(id).position.to_array()[axis.min(2)],
            Self::Speed(id) => named.link_velocity(id).0.length(),
            Self::Spin(id) => named.link_velocity(id).1.length(),
            Self::LinkEnergy(id) => {
                let body = named.link_body(id).and_then(|key| world.body(key).ok());
                body.map_or(f64::NAN, |body| energy_of(world, body)[0])
            }
            Self::JointPosition(id, axis) => named.joint_position(id, axis).unwrap_or(f64::NAN),
            Self::JointVelocity(id, axis) => named.joint_velocity(id, axis).unwrap_or(f64::NAN),
            Self::JointForce(id) => {
                let key = named.joint_key(id);
                let feedback = key.and_then(|key| world.joint_feedback(key).ok().flatten());
                feedback.map_or(f64::NAN, |feedback| feedback.force1.length())
            }
        }
    }
}

/// Values over time: the last of them.
#[derive(Clone, Debug)]
pub struct Series {
    quantities: Vec<Quantity>,
    times: VecDeque<f64>,
    /// By time, then by quantity.
    rows: VecDeque<Vec<f64>>,
}

/// As many rows are kept.
const MOST: usize = 4000;

impl Default for Series {
    fn default() -> Self {
        Self { quantities: Quantity::ALWAYS.to_vec(), times: VecDeque::new(), rows: VecDeque::new() }
    }
}

impl Series {
    /// What is recorded.
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Records one more quantity from now on.
    pub fn add(&mut self, quantity: Quantity) {
        if !self.quantities.contains(&quantity) {
            self.quantities.push(quantity);
        }
    }

    /// Records one less.
    pub fn remove(&mut self, quantity: Quantity) {
        if let Some(at) = self.quantities.iter().position(|known| *known == quantity) {
            self.quantities.remove(at);
            for row in self.rows.iter_mut().filter(|row| row.len() > at) {
                row.remove(at);
            }
        }
    }

    /// Records the present values. What was recorded of a later time is forgotten: time was wound back.
    pub fn record(&mut self, playback: &Playback) {
        let time = playback.time();
        while self.times.back().is_some_and(|last| *last >= time) {
            self.times.pop_back();
            self.rows.pop_back();
        }
        if self.times.len() >= MOST {
            self.times.pop_front();
            self.rows.pop_front();
        }
        self.times.push_back(time);
        self.rows.push_back(self.quantities.iter().map(|quantity| quantity.value(playback)).collect());
    }

    /// Forgets all values.
    pub fn clear(&mut self) {
        self.times.clear();
        self.rows.clear();
    }

    /// Number of recorded times.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether nothing was recorded yet.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Times and values of a quantity, where it has any.
    pub fn points(&self, quantity: Quantity) -> impl Iterator<Item = [f64; 2]> + '_ {
        let at = self.quantities.iter().position(|known| *known == quantity).unwrap_or(usize::MAX);
        let rows = self.times.iter().zip(&self.rows);
        rows.filter_map(move |(time, row)| Some([*time, *row.get(at)?])).filter(|point| point[1].is_finite())
    }

    /// Writes all as comma-separated values.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save_csv(&self, path: &Path, playback: &Playback) -> Result<(), String> {
        use std::fmt::Write;
        let quoted = |name: String| {
            if name.contains([',', '"']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name }
        };
        let mut text = String::from("time[s]");
        for quantity in &self.quantities {
            let _ = write!(text, ",{}", quoted(quantity.name(playback)));
        }
        for (time, row) in self.times.iter().zip(&self.rows) {
            let _ = write!(text, "\n{time}");
            for at in 0..self.quantities.len() {
                let _ = write!(text, ",{}", row.get(at).copied().unwrap_or(f64::NAN));
            }
        }
        text.push('\n');
        std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
    }
}
