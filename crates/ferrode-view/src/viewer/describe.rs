//! What is known of a body, in lines.

use super::Viewer;
use crate::overlay::energy_of;
use ferrode::{BodyKey, Vec3};
use ferrode_scene::description::JointId;

fn vector(v: Vec3) -> String {
    format!("{:.4}, {:.4}, {:.4}", v.x, v.y, v.z)
}

impl Viewer {
    /// Name and value of each thing known of a body.
    pub fn describe(&self, body: BodyKey) -> Vec<(String, String)> {
        let named = &self.playback.named;
        let Ok(state) = named.world.body(body) else { return Vec::new() };
        let link = self.link_of(body);
        let name = link.map_or("added by hand".to_owned(), |link| named.scene.links[link.0].name.clone());
        let q = state.quaternion();
        let [kinetic, potential] = energy_of(&named.world, state);
        let condition = match (state.is_quarantined(), state.is_kinematic(), state.is_enabled()) {
            (true, ..) => "quarantined",
            (_, true, _) => "kinematic",
            (.., true) => "awake",
            _ => "asleep",
        };
        let mut lines = vec![
            ("name", name),
            ("mass", format!("{:.4} kg", state.mass().mass)),
            ("centre", format!("{} m", vector(state.position()))),
            ("rotation", format!("{:.4}, {:.4}, {:.4}, {:.4}", q.w, q.x, q.y, q.z)),
            ("velocity", format!("{} m/s", vector(state.linear_velocity()))),
            ("spin", format!("{} rad/s", vector(state.angular_velocity()))),
            ("kinetic", format!("{kinetic:.4} J")),
            ("potential", format!("{potential:.4} J")),
            ("state", condition.to_owned()),
        ];
        let force = super::quantity::contact_force(&named.world, body);
        lines.push(("contact force", format!("{} N", vector(force))));
        let mut lines: Vec<(String, String)> = lines.into_iter().map(|(k, v)| (k.to_owned(), v)).collect();
        for (id, joint) in self.joints_of(body) {
            let position = named.joint_position(id, 0).map_or(String::new(), |x| format!(" at {x:.4}"));
            lines.push((joint, format!("{:?}{position}", named.scene.joints[id.0].kind).to_lowercase()));
        }
        lines
    }

    /// The joints of a body that the file names.
    pub(super) fn joints_of(&self, body: BodyKey) -> Vec<(JointId, String)> {
        let named = &self.playback.named;
        let on_body = |id: &JointId| {
            let bodies = named.joint_key(*id).and_then(|key| named.world.joint_bodies(key).ok());
            bodies.is_some_and(|bodies| bodies.contains(&Some(body)))
        };
        let ids = (0..named.scene.joints.len()).map(JointId).filter(on_body);
        ids.map(|id| (id, named.scene.joints[id.0].name.clone())).collect()
    }
}
