//! What is told after a run: as text for people, as JSON for programs.

use crate::json::Object;
use crate::simulation::Simulation;
use crate::stats::{Largest, Stats};
use std::fmt;
use std::path::Path;

/// A run's figures.
pub struct Summary<'a> {
    file: String,
    stepper: &'static str,
    h: f64,
    bodies: usize,
    static_links: usize,
    joints: usize,
    geoms: usize,
    warnings: usize,
    quarantined: Vec<String>,
    joint_of_position: Option<&'a str>,
    joint_of_angle: Option<&'a str>,
    stats: &'a Stats,
}

impl<'a> Summary<'a> {
    /// The figures of a run that is over.
    pub fn new(file: &Path, simulation: &'a Simulation, stats: &'a Stats, stepper: &'static str) -> Self {
        let scene = simulation.scene();
        let joint = |worst: &Largest| {
            scene.joints.get(worst.index).filter(|_| worst.value > 0.0).map(|joint| joint.name.as_str())
        };
        let bodies = simulation.world().body_count();
        Self {
            file: file.display().to_string(),
            stepper,
            h: simulation.step_size(),
            bodies,
            static_links: scene.links.len().saturating_sub(bodies),
            joints: simulation.joint_count(),
            geoms: simulation.world().geom_count(),
            warnings: simulation.warning_count(),
            quarantined: simulation.quarantined(),
            joint_of_position: joint(&stats.joint_position_error),
            joint_of_angle: joint(&stats.joint_angle_error),
            stats,
        }
    }

    /// As one JSON object; units stand in the names.
    pub fn to_json(&self) -> String {
        let stats = self.stats;
        Object::default()
            .with("file", self.file.as_str())
            .with("stepper", self.stepper)
            .with("step_size_s", self.h)
            .with("steps", stats.steps)
            .with("simulated_s", stats.time)
            .with("finite", stats.is_finite())
            .with("bodies", self.bodies)
            .with("static_links", self.static_links)
            .with("joints", self.joints)
            .with("geoms", self.geoms)
            .with("contacts_mean", stats.contacts_mean())
            .with("contacts_max", stats.contacts_max)
            .with("step_time_median_s", stats.step_time_quantile(0.5))
            .with("step_time_p99_s", stats.step_time_quantile(0.99))
            .with("wall_s", stats.wall())
            .with("real_time_factor", stats.real_time_factor())
            .with("energy_start_J", stats.energy_start.total())
            .with("energy_end_J", stats.energy_end.total())
            .with("kinetic_energy_max_J", stats.max_kinetic)
            .with("energy_error_max_J", stats.energy_error.value)
            .with("penetration_max_m", stats.penetration.value)
            .with("penetration_max_time_s", stats.penetration.time)
            .with("penetration_max_links", stats.penetration_between.as_ref().map(|links| links.to_vec()))
            .with("joint_error_max_m", stats.joint_position_error.value)
            .with("joint_error_max_m_joint", self.joint_of_position)
            .with("joint_error_max_rad", stats.joint_angle_error.value)
            .with("joint_error_max_rad_joint", self.joint_of_angle)
            .with("sleeping", stats.sleeping)
            .with("quarantined", stats.quarantined)
            .with("quarantined_links", self.quarantined.as_slice())
            .with("solver_failures", stats.solver_failures)
            .with("warnings", self.warnings)
            .to_string()
    }
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let stats = self.stats;
        writeln!(
            f,
            "{}: {} s in {} steps of {}, stepper {}\n",
            self.file,
            round(stats.time),
            stats.steps,
            seconds(self.h),
            self.stepper
        )?;
        let mut line = |name: &str, text: String| writeln!(f, "  {name:<18}{text}");
        line("bodies", format!("{} that move, {} static", self.bodies, self.static_links))?;
        line("joints", self.joints.to_string())?;
        line("geoms", self.geoms.to_string())?;
        line("contacts", format!("{:.1} mean, {} max", stats.contacts_mean(), stats.contacts_max))?;
        line(
            "step time",
            format!(
                "{} median, {} 99th percentile",
                seconds(stats.step_time_quantile(0.5)),
                seconds(stats.step_time_quantile(0.99))
            ),
        )?;
        line(
            "real-time factor",
            format!("{} ({} in all)", round(stats.real_time_factor()), seconds(stats.wall())),
        )?;
        line(
            "energy",
            format!(
                "{} J at start, {} J at end (change {} J; largest kinetic {} J)",
                round(stats.energy_start.total()),
                round(stats.energy_end.total()),
                round(stats.energy_change()),
                round(stats.max_kinetic)
            ),
        )?;
        line("penetration", self.penetration())?;
        line("joint error", self.joint_error())?;
        line("sleeping", bodies(stats.sleeping))?;
        let names = if self.quarantined.is_empty() {
            String::new()
        } else {
            format!(": {}", self.quarantined.join(", "))
        };
        line("quarantined", format!("{}{names}", bodies(stats.quarantined)))?;
        if stats.solver_failures > 0 {
            line("solver failures", format!("{} islands solved in part only", stats.solver_failures))?;
        }
        line("warnings", self.warnings.to_string())
    }
}

impl Summary<'_> {
    fn penetration(&self) -> String {
        let worst = &self.stats.penetration;
        if worst.value == 0.0 {
            return "none".into();
        }
        let between = match &self.stats.penetration_between {
            Some([a, b]) => format!("{a} and {b}, "),
            None => String::new(),
        };
        format!("{} at most ({between}at {} s)", metres(worst.value), round(worst.time))
    }

    fn joint_error(&self) -> String {
        if self.joints == 0 {
            return "no joints".into();
        }
        let (position, angle) = (&self.stats.joint_position_error, &self.stats.joint_angle_error);
        let mut text = format!("{} at most", metres(position.value));
        if let Some(joint) = self.joint_of_position {
            text += &format!(" ({joint}, at {} s)", round(position.time));
        }
        text += &format!("; {} rad at most", round(angle.value));
        if let Some(joint) = self.joint_of_angle {
            text += &format!(" ({joint}, at {} s)", round(angle.time));
        }
        text
    }
}

/// "1 body", "2 bodies".
fn bodies(count: usize) -> String {
    format!("{count} {}", if count == 1 { "body" } else { "bodies" })
}

/// Four digits, with an exponent only where zeros would fill the line.
pub fn round(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        // Not "-0".
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    if !(1e-4..1e7).contains(&size) {
        return format!("{value:.3e}");
    }
    // Digits after the point so that four count, and no zeros at the end.
    let mut decimals = 3;
    let mut limit = 1.0;
    while size >= 10.0 * limit && decimals > 0 {
        (decimals, limit) = (decimals - 1, limit * 10.0);
    }
    while size < limit {
        (decimals, limit) = (decimals + 1, limit / 10.0);
    }
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A duration with a unit that suits it.
pub fn seconds(value: f64) -> String {
    match value.abs() {
        size if size < 1e-3 && size > 0.0 => format!("{} µs", round(value * 1e6)),
        size if size < 1.0 && size > 0.0 => format!("{} ms", round(value * 1e3)),
        _ => format!("{} s", round(value)),
    }
}

/// A small length with a unit that suits it.
pub fn metres(value: f64) -> String {
    match value.abs() {
        size if size < 1e-9 && size > 0.0 => "under 1 nm".to_owned(),
        size if size < 1e-3 && size > 0.0 => format!("{} µm", round(value * 1e6)),
        size if size < 1.0 && size > 0.0 => format!("{} mm", round(value * 1e3)),
        _ => format!("{} m", round(value)),
    }
}

#[cfg(test)]
mod tests {
    use super::{metres, round, seconds};

    #[test]
    fn four_digits_count() {
        let expected = [
            (0.0, "0"),
            (-0.0, "0"),
            (5.0, "5"),
            (12.3456, "12.35"),
            (-0.0123456, "-0.01235"),
            (123456.7, "123457"),
            (1e-9, "1.000e-9"),
            (2.5e8, "2.500e8"),
            (f64::NAN, "NaN"),
        ];
        for (value, text) in expected {
            assert_eq!(round(value), text);
        }
    }

    #[test]
    fn units_suit_sizes() {
        assert_eq!(seconds(0.001), "1 ms");
        assert_eq!(seconds(0.0000125), "12.5 µs");
        assert_eq!(seconds(0.0), "0 s");
        assert_eq!(metres(0.00025), "250 µm");
        assert_eq!(metres(1.5), "1.5 m");
        assert_eq!(metres(2e-12), "under 1 nm");
    }
}
