//! What can be recorded of a world: values of the whole, of a body, of a joint.

use crate::overlay::energy_of;
use crate::viewer::playback::Playback;
use ferrode::{BodyKey, JointFeedback, Vec3, World};
use ferrode_scene::description::{JointId, LinkId};

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
    /// Part of it: collision (0), islands and rows (1), solve (2), integration (3), ms.
    Phase(usize),
    /// Contact points.
    Contacts,
    /// Deepest penetration, mm.
    Depth,
    /// Largest residual of the exact solver.
    Residual,
    /// Of a link.
    Link(LinkId, LinkValue),
    /// Of a joint.
    Joint(JointId, JointValue),
}

/// A value of a link. Coordinates (0 to 2) are the world's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkValue {
    /// Of the link's origin, m.
    Position(usize),
    /// Part of the unit quaternion from link to world: w, x, y, z.
    Rotation(usize),
    /// Of the link's origin, m/s.
    Velocity(usize),
    /// rad/s.
    AngularVelocity(usize),
    /// m/s.
    Speed,
    /// rad/s.
    Spin,
    /// Kinetic energy, J.
    Energy,
    /// Size of the sum of the forces of contacts, N.
    ContactForce,
}

/// A value of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointValue {
    /// Of an axis (0 or 1), rad or m.
    Position(usize),
    /// Of an axis, rad/s or m/s.
    Velocity(usize),
    /// Size of the force on the first body, N.
    Force,
    /// Size of the torque on the first body, N·m.
    Torque,
    /// How far its bodies are from where it wants them, m.
    Error,
}

const PHASES: [&str; 4] = ["collision", "islands and rows", "solve", "integration"];

/// Values of links and how the command line calls them.
const LINK_VALUES: [(LinkValue, &str, &str); 17] = [
    (LinkValue::Position(0), "x", "m"),
    (LinkValue::Position(1), "y", "m"),
    (LinkValue::Position(2), "z", "m"),
    (LinkValue::Rotation(0), "qw", ""),
    (LinkValue::Rotation(1), "qx", ""),
    (LinkValue::Rotation(2), "qy", ""),
    (LinkValue::Rotation(3), "qz", ""),
    (LinkValue::Velocity(0), "vx", "m/s"),
    (LinkValue::Velocity(1), "vy", "m/s"),
    (LinkValue::Velocity(2), "vz", "m/s"),
    (LinkValue::AngularVelocity(0), "wx", "rad/s"),
    (LinkValue::AngularVelocity(1), "wy", "rad/s"),
    (LinkValue::AngularVelocity(2), "wz", "rad/s"),
    (LinkValue::Speed, "speed", "m/s"),
    (LinkValue::Spin, "spin", "rad/s"),
    (LinkValue::Energy, "energy", "J"),
    (LinkValue::ContactForce, "contact-force", "N"),
];

const JOINT_VALUES: [(JointValue, &str); 7] = [
    (JointValue::Position(0), "position"),
    (JointValue::Position(1), "position2"),
    (JointValue::Velocity(0), "velocity"),
    (JointValue::Velocity(1), "velocity2"),
    (JointValue::Force, "force"),
    (JointValue::Torque, "torque"),
    (JointValue::Error, "error"),
];

impl LinkValue {
    /// All, in the order in which they are offered, with their names.
    pub fn all() -> impl Iterator<Item = (Self, &'static str)> {
        LINK_VALUES.into_iter().map(|(value, name, _)| (value, name))
    }
}

impl JointValue {
    /// All, in the order in which they are offered, with their names.
    pub fn all() -> impl Iterator<Item = (Self, &'static str)> {
        JOINT_VALUES.into_iter()
    }
}

impl Quantity {
    /// What is recorded from the start.
    pub const ALWAYS: [Self; 11] = [
        Self::Kinetic,
        Self::Potential,
        Self::Total,
        Self::StepTime,
        Self::Phase(0),
        Self::Phase(1),
        Self::Phase(2),
        Self::Phase(3),
        Self::Contacts,
        Self::Depth,
        Self::Residual,
    ];

    /// The value that a text asks for: `link.NAME.VALUE` or `joint.NAME.VALUE`.
    ///
    /// # Errors
    /// There is no such link, joint or value: what there is.
    pub fn parse(text: &str, playback: &Playback) -> Result<Self, String> {
        let (kind, rest) = text.split_once('.').unwrap_or((text, ""));
        let (name, value) = rest.rsplit_once('.').unwrap_or((rest, ""));
        let scene = &playback.named.scene;
        let list = |names: Vec<&str>| names.join(", ");
        match kind {
            "link" => {
                let at = scene.links.iter().position(|link| link.name == name);
                let at = at.ok_or_else(|| format!("{text}: no link is called {name:?}"))?;
                let found = LINK_VALUES.into_iter().find(|(_, known, _)| *known == value);
                found.map(|(found, ..)| Self::Link(LinkId(at), found)).ok_or_else(|| {
                    format!("{text}: of a link there are {}", list(LinkValue::all().map(|v| v.1).collect()))
                })
            }
            "joint" => {
                let at = scene.joints.iter().position(|joint| joint.name == name);
                let at = at.ok_or_else(|| format!("{text}: no joint is called {name:?}"))?;
                let found = JOINT_VALUES.into_iter().find(|(_, known)| *known == value);
                found.map(|(found, _)| Self::Joint(JointId(at), found)).ok_or_else(|| {
                    format!("{text}: of a joint there are {}", list(JointValue::all().map(|v| v.1).collect()))
                })
            }
            _ => Err(format!("{text}: expected link.NAME.VALUE or joint.NAME.VALUE")),
        }
    }

    /// Its name with its unit.
    pub fn name(self, playback: &Playback) -> String {
        let scene = &playback.named.scene;
        match self {
            Self::Kinetic => "kinetic energy [J]".to_owned(),
            Self::Potential => "potential energy [J]".to_owned(),
            Self::Total => "total energy [J]".to_owned(),
            Self::StepTime => "step [ms]".to_owned(),
            Self::Phase(n) => format!("{} [ms]", PHASES[n.min(3)]),
            Self::Contacts => "contacts".to_owned(),
            Self::Depth => "deepest penetration [mm]".to_owned(),
            Self::Residual => "solver residual".to_owned(),
            Self::Link(id, value) => {
                let link = scene.links.get(id.0).map_or("?", |link| link.name.as_str());
                let known = LINK_VALUES.into_iter().find(|(known, ..)| *known == value);
                let (name, unit) = known.map_or(("?", ""), |(_, name, unit)| (name, unit));
                if unit.is_empty() { format!("{link} {name}") } else { format!("{link} {name} [{unit}]") }
            }
            Self::Joint(id, value) => {
                let joint = scene.joints.get(id.0).map_or("?", |joint| joint.name.as_str());
                let known = JOINT_VALUES.into_iter().find(|(known, _)| *known == value);
                let name = known.map_or("?", |(_, name)| name);
                let axis =
                    |axis| playback.named.joint(joint).and_then(|joint| joint.unit(axis)).unwrap_or("rad");
                let unit = match value {
                    JointValue::Position(n) => axis(n).to_owned(),
                    JointValue::Velocity(n) => format!("{}/s", axis(n)),
                    JointValue::Force => "N".to_owned(),
                    JointValue::Torque => "N·m".to_owned(),
                    JointValue::Error => "m".to_owned(),
                };
                format!("{joint} {name} [{unit}]")
            }
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
            Self::Phase(n) => {
                let p = &facts.phases;
                [p.collision, p.assembly, p.solve, p.integrate][n.min(3)] * 1e3
            }
            Self::Contacts => facts.contacts as f64,
            Self::Depth => facts.depth * 1e3,
            Self::Residual => facts.residual,
            Self::Link(id, value) => value.of(playback, id),
            Self::Joint(id, value) => value.of(playback, id).unwrap_or(f64::NAN),
        }
    }
}

/// The sum of the forces of contacts on a body, N.
pub fn contact_force(world: &World, body: BodyKey) -> Vec3 {
    world.contacts().iter().fold(Vec3::ZERO, |sum, contact| {
        let (first, second) = (contact.first.body == Some(body), contact.second.body == Some(body));
        sum + contact.force * (f64::from(u8::from(first)) - f64::from(u8::from(second)))
    })
}

impl LinkValue {
    fn of(self, playback: &Playback, id: LinkId) -> f64 {
        let named = &playback.named;
        let coordinate = |v: Vec3, n: usize| v.to_array()[n.min(2)];
        match self {
            Self::Position(n) => coordinate(named.link_pose(id).position, n),
            Self::Rotation(n) => {
                let q = named.link_pose(id).rotation;
                [q.w, q.x, q.y, q.z][n.min(3)]
            }
            Self::Velocity(n) => coordinate(named.link_velocity(id).0, n),
            Self::AngularVelocity(n) => coordinate(named.link_velocity(id).1, n),
            Self::Speed => named.link_velocity(id).0.length(),
            Self::Spin => named.link_velocity(id).1.length(),
            Self::Energy => {
                let body = named.link_body(id).and_then(|key| named.world.body(key).ok());
                body.map_or(f64::NAN, |body| energy_of(&named.world, body)[0])
            }
            Self::ContactForce => {
                named.link_body(id).map_or(f64::NAN, |body| contact_force(&named.world, body).length())
            }
        }
    }
}

impl JointValue {
    fn of(self, playback: &Playback, id: JointId) -> Option<f64> {
        let named = &playback.named;
        let feedback =
            || -> Option<JointFeedback> { named.world.joint_feedback(named.joint_key(id)?).ok()?.copied() };
        match self {
            Self::Position(axis) => named.joint_position(id, axis),
            Self::Velocity(axis) => named.joint_velocity(id, axis),
            Self::Force => Some(feedback()?.force1.length()),
            Self::Torque => Some(feedback()?.torque1.length()),
            Self::Error => Some(named.world.joint_error(named.joint_key(id)?).ok()?.position),
        }
    }
}
