//! `dWorldExportDIF`: a world as text, in ODE's "Dynamics Interchange Format" 0.1.
//!
//! The text is built whole, then written to the program's file. Oddities of the format are ODE's: thresholds are squared,
//! some lines have no comma, and the numbers of vectors that have a component of zero are left out in places.

use crate::fault::{Fault, Outcome, export};
use crate::geom::GeomId;
use crate::misc::{File, fprintf};
use crate::record::{BodyId, Required, WorldId, WorldRecord, handle_of};
use core::ffi::c_char;
use core::fmt::Write;
use ferrode_dynamics::{AutoDisable, Body, BodyKey, JointKey, JointType, World};
use ferrode_math::Vec3;
use std::ffi::{CStr, CString};

unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> core::ffi::c_int;
}

/// A number with 15 digits, as C prints it.
fn number(x: f64) -> String {
    if x.is_infinite() {
        return if x > 0.0 { "inf" } else { "-inf" }.to_owned();
    }
    let mut buffer = [0_u8; 48];
    // SAFETY: the buffer has the length given; the format takes one number.
    unsafe { snprintf(buffer.as_mut_ptr().cast(), buffer.len(), c"%.15g".as_ptr(), x) };
    CStr::from_bytes_until_nul(&buffer).map(|text| text.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Numbers in braces; one alone without.
fn numbers(values: &[f64]) -> String {
    match values {
        [one] => number(*one),
        _ => format!("{{{}}}", values.iter().map(|x| number(*x)).collect::<Vec<_>>().join(",")),
    }
}

fn vector(v: Vec3) -> String {
    numbers(&v.to_array())
}

/// The text, line by line at its depth.
#[derive(Default)]
struct Text {
    text: String,
    depth: usize,
}

impl Text {
    fn line(&mut self, line: &str) {
        for _ in 0..self.depth {
            self.text.push('\t');
        }
        // Writing to a string can't fail.
        writeln!(self.text, "{line}").ok();
    }

    fn set(&mut self, name: &str, value: &str) {
        self.line(&format!("{name} = {value},"));
    }

    fn block(&mut self, head: &str, tail: &str, inside: impl FnOnce(&mut Self)) {
        self.line(head);
        self.depth += 1;
        inside(self);
        self.depth -= 1;
        self.line(tail);
    }

    fn auto_disable(&mut self, settings: &AutoDisable, left: Option<(i32, f64)>) {
        self.block("auto_disable = {", "},", |text| {
            let squared = |x: f64| number(x * x);
            text.set("linear_threshold", &squared(settings.linear_threshold));
            text.set("angular_threshold", &squared(settings.angular_threshold));
            text.set("average_samples", &settings.average_samples.to_string());
            text.set("idle_time", &number(settings.time));
            text.set("idle_steps", &settings.steps.to_string());
            if let Some((steps, time)) = left {
                text.set("time_left", &number(time));
                text.set("steps_left", &steps.to_string());
            }
        });
    }

    fn world(&mut self, world: &World, prefix: &str) {
        self.line("-- Dynamics Interchange Format v0.1");
        self.line("");
        self.block(&format!("{prefix}world = dynamics.world {{"), "}", |text| {
            text.set("gravity", &vector(world.gravity()));
            text.block("ODE = {", "},", |text| {
                text.set("ERP", &number(world.erp()));
                text.set("CFM", &number(world.cfm()));
                text.auto_disable(world.auto_disable(), None);
            });
        });
    }

    fn body(&mut self, body: &Body, prefix: &str, number_in_world: usize, geoms: &[GeomId]) {
        let head = format!("{prefix}body[{number_in_world}] = dynamics.body {{");
        self.block(&head, "}", |text| {
            let q = body.quaternion();
            text.set("world", &format!("{prefix}world"));
            text.set("pos", &vector(body.position()));
            text.set("q", &numbers(&[q.w, q.x, q.y, q.z]));
            text.set("lvel", &vector(body.linear_velocity()));
            text.set("avel", &vector(body.angular_velocity()));
            text.set("mass", &number(body.mass().mass));
            let rows = body.mass().inertia.rows.map(|row| numbers(&row));
            text.set("I", &format!("{{{}}}", rows.join(",")));
            text.block("ODE = {", "},", |text| text.how_stepped(body));
            if !geoms.is_empty() {
                text.block("geometry = {", "},", |text| {
                    for geom in geoms.iter().filter_map(|geom| geom.live()) {
                        text.block("{", "},", |text| {
                            for line in geom.described() {
                                text.line(&line);
                            }
                        });
                    }
                });
            }
        });
    }

    fn how_stepped(&mut self, body: &Body) {
        let flags = [
            ("finite_rotation", body.finite_rotation_mode()),
            ("disabled", !body.is_enabled()),
            ("no_gravity", !body.gravity_mode()),
        ];
        for (name, _) in flags.iter().filter(|(_, on)| *on) {
            self.set(name, "1");
        }
        if body.auto_disable().enabled {
            self.auto_disable(body.auto_disable(), Some(body.idle_countdowns()));
        }
        for (name, v) in [("facc", body.force()), ("tacc", body.torque())] {
            if v.to_array().iter().all(|x| *x != 0.0) {
                self.set(name, &vector(v));
            }
        }
        if body.finite_rotation_axis() != Vec3::ZERO {
            self.set("finite_rotation_axis", &vector(body.finite_rotation_axis()));
        }
    }

    fn joint(&mut self, world: &World, joint: JointKey, prefix: &str, at: usize, bodies: &[BodyKey]) {
        let Ok(joint_type) = world.joint_type(joint) else { return };
        let (name, axes) = described(joint_type);
        self.block(&format!("{prefix}joint[{at}] = dynamics.{name}_joint {{"), "}", |text| {
            text.set("world", &format!("{prefix}world"));
            let ends = world.joint_bodies(joint).unwrap_or_default().into_iter().flatten();
            let places = ends.filter_map(|end| bodies.iter().position(|body| *body == end));
            let places: Vec<String> = places.map(|place| format!("{prefix}body[{place}]")).collect();
            text.line(&format!("body = {{{}}}", places.join(",")));
            let details = world.joint_details(joint).unwrap_or_default();
            if details.is_empty() {
                text.line("unknown joint");
            }
            // Angles stand after the motors.
            let (late, early): (Vec<_>, Vec<_>) =
                details.iter().partition(|(name, _)| name.starts_with("angle"));
            for (name, values) in early {
                text.set(name, &numbers(values));
            }
            for axis in 0..axes {
                let suffix = if axes > 1 { (axis + 1).to_string() } else { String::new() };
                let param = |n| world.joint_param_number(joint, n + 256 * axis).unwrap_or_default();
                text.limit_and_motor(&suffix, param);
            }
            for (name, values) in late {
                text.set(name, &numbers(values));
            }
        });
    }

    fn limit_and_motor(&mut self, suffix: &str, param: impl Fn(i32) -> f64) {
        self.block(&format!("limit{suffix} = {{"), "},", |text| {
            text.set("low_stop", &number(param(0)));
            text.set("high_stop", &number(param(1)));
            if param(7) != 0.0 {
                text.set("bounce", &number(param(7)));
            }
            text.block("ODE = {", "},", |text| {
                text.set("stop_erp", &number(param(9)));
                text.set("stop_cfm", &number(param(10)));
            });
        });
        self.block(&format!("motor{suffix} = {{"), "},", |text| {
            for (name, value) in [("vel", param(2)), ("fmax", param(5))] {
                if value != 0.0 {
                    text.set(name, &number(value));
                }
            }
            text.block("ODE = {", "},", |text| {
                text.set("fudge_factor", &number(param(6)));
                text.set("normal_cfm", &number(param(8)));
            });
        });
    }
}

/// The format's name of a joint type, and for how many axes limits and motors are written.
fn described(joint_type: JointType) -> (&'static str, i32) {
    match joint_type {
        JointType::Ball => ("ball", 0),
        JointType::Hinge => ("hinge", 1),
        JointType::Slider => ("slider", 1),
        JointType::Contact => ("contact", 0),
        JointType::Universal => ("universal", 2),
        JointType::Hinge2 => ("ODE_hinge2", 2),
        JointType::Fixed => ("fixed", 0),
        JointType::Null => ("null", 0),
        JointType::AMotor => ("ODE_angular_motor", 3),
        JointType::LMotor => ("ODE_linear_motor", 3),
        JointType::PR => ("PR", 2),
        JointType::PU => ("PU", 3),
        JointType::Piston => ("piston", 2),
        _ => ("unknown", 0),
    }
}

fn text_of(world: &'static WorldRecord, prefix: &str) -> String {
    world.take_in_all();
    world.engine(|engine| {
        let mut text = Text::default();
        text.world(engine, prefix);
        text.line(&format!("{prefix}body = {{}}"));
        let keys: Vec<BodyKey> = engine.bodies().map(|(key, _)| key).collect();
        for (i, (_, body)) in engine.bodies().enumerate() {
            let record = handle_of(body.user_data());
            text.body(body, prefix, i, &geoms_of(record));
        }
        text.line(&format!("{prefix}joint = {{}}"));
        for (i, joint) in engine.joints().enumerate() {
            text.joint(engine, joint, prefix, i, &keys);
        }
        text.text
    })
}

fn geoms_of(body: BodyId) -> Vec<GeomId> {
    body.live().map(crate::geom::all_of).unwrap_or_default()
}

fn write(file: *mut File, text: String) -> Outcome<()> {
    let text = CString::new(text).map_err(|_| Fault::ARGUMENT)?;
    // SAFETY: the program's open file; the format takes one text.
    unsafe { fprintf(file, c"%s".as_ptr(), text.as_ptr()) };
    Ok(())
}

export! {
    fn dWorldExportDIF(world: WorldId, file: *mut File, prefix: *const c_char) {
        let world = world.get()?;
        if file.is_null() {
            return Err(Fault::ARGUMENT);
        }
        // SAFETY: null, or a text with a terminating zero (the function's contract).
        let prefix = if prefix.is_null() { c"" } else { unsafe { CStr::from_ptr(prefix) } };
        write(file, text_of(world, &prefix.to_string_lossy()))?
    }
}
