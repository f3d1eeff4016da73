//! MuJoCo from its Python package, loaded when it runs. The scene is written in its own language (MJCF): joints as trees,
//! with equality constraints where they close loops. This file is not safe Rust.

mod library;
mod model;

use crate::engine::Engine;
use crate::scene::Scene;
use core::ffi::{CStr, c_int, c_void};
use ferrode_math::{Pose, Quat, Vec3};
use library::Library;
use std::ffi::CString;
use std::sync::atomic::Ordering;

/// A model, its state, and for each solid its body's number or the place where it stays. They live as long as the program.
pub struct Mujoco {
    library: &'static Library,
    model: *const c_void,
    data: *mut c_void,
    bodies: Vec<Result<c_int, Pose>>,
}

/// Why a scene is not run.
pub fn refuses(scene: &Scene) -> Option<String> {
    if let Err(error) = Library::get() {
        return Some(error.clone());
    }
    model::refuses(scene)
}

fn text(words: &str) -> CString {
    CString::new(words).unwrap_or_default()
}

impl Mujoco {
    /// Panics if MuJoCo does not take the scene.
    pub fn new(scene: &Scene) -> Self {
        let library = Library::get().as_ref().unwrap_or_else(|e| panic!("{e}"));
        let pieces = model::pieces(scene);
        // SAFETY: functions are called as MuJoCo's headers declare them, with handles that it has returned and with text that
        // ends with a zero.
        unsafe {
            let mut error = [0 as core::ffi::c_char; 1000];
            let mut specs = Vec::new();
            for piece in &pieces {
                let xml = text(&piece.xml);
                let null = core::ptr::null();
                let spec = (library.parse)(xml.as_ptr(), null, error.as_mut_ptr(), error.len() as c_int);
                assert!(!spec.is_null(), "{}: {:?}", scene.name, CStr::from_ptr(error.as_ptr()));
                if let Some(i) = piece.root {
                    let (frame, body) = (text(&model::frame_name(i)), text(&model::body_name(i)));
                    let frame = (library.find)(specs[0], library::FRAME, frame.as_ptr());
                    let body = (library.find)(spec, library::BODY, body.as_ptr());
                    let attached = (library.attach)(frame, body, c"".as_ptr(), c"".as_ptr());
                    assert!(!attached.is_null(), "{}: solid {i} is attached", scene.name);
                }
                specs.push(spec);
            }
            let model = (library.compile)(specs[0], core::ptr::null());
            assert!(!model.is_null(), "{}: {:?}", scene.name, CStr::from_ptr((library.error)(specs[0])));
            let data = (library.make_data)(model);
            assert!(!data.is_null(), "{}: no data", scene.name);
            let bodies = scene.solids.iter().enumerate().map(|(i, solid)| {
                let name = text(&model::body_name(i));
                let id = (library.number)(model, library::BODY, name.as_ptr());
                if solid.density.is_some() { Ok(id) } else { Err(solid.pose) }
            });
            let engine = Self { library, model, data, bodies: bodies.collect() };
            engine.launch(scene);
            engine
        }
    }

    /// Gives the joints the velocities whose momentum is that of the solids'.
    ///
    /// # Safety
    /// Model and data live.
    unsafe fn launch(&self, scene: &Scene) {
        if scene.solids.iter().all(|solid| solid.velocity == Vec3::ZERO) {
            return;
        }
        let (library, model, data) = (self.library, self.model, self.data);
        // SAFETY: as the caller says; arrays have as many numbers as the model has velocities, as it tells itself.
        unsafe {
            (library.forward)(model, data);
            let count = (library.state_size)(model, library::VELOCITIES) as usize;
            let (mut momentum, mut velocities) = (vec![0.0; count], vec![0.0; count]);
            for (solid, body) in scene.solids.iter().zip(&self.bodies) {
                let Ok(body) = body else { continue };
                if solid.velocity == Vec3::ZERO {
                    continue;
                }
                let push = (solid.velocity * super::parts::mass(solid).0).to_array();
                let at = solid.pose.position.to_array();
                let (push, at, turn) = (push.as_ptr(), at.as_ptr(), [0.0; 3]);
                (library.apply)(model, data, push, turn.as_ptr(), at, *body, momentum.as_mut_ptr());
            }
            (library.solve)(model, data, velocities.as_mut_ptr(), momentum.as_ptr(), 1);
            (library.set_state)(model, data, velocities.as_ptr(), library::VELOCITIES);
        }
    }
}

impl Engine for Mujoco {
    fn about(&self) -> String {
        // SAFETY: the text lives as long as the library, which is never unloaded.
        let version = unsafe { CStr::from_ptr((self.library.version)()) };
        let version = version.to_string_lossy();
        format!(
            "mujoco {version} (double precision), Newton, implicitfast, its defaults; joints as trees, the mesh as a height field"
        )
    }

    fn step(&mut self) {
        // SAFETY: model and data live.
        unsafe { (self.library.step)(self.model, self.data) };
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        out.clear();
        if library::UNSTABLE.load(Ordering::Relaxed) {
            // What goes on has nothing to do with what came before: all bodies count as lost.
            let nowhere = Pose::new(Vec3::splat(f64::NAN), Quat::IDENTITY);
            out.extend(self.bodies.iter().map(|body| body.err().unwrap_or(nowhere)));
            return;
        }
        // SAFETY: model and data live; arrays have the lengths of the header: three numbers, nine, three and four.
        unsafe {
            (self.library.kinematics)(self.model, self.data);
            out.extend(self.bodies.iter().map(|body| {
                let id = match body {
                    Ok(id) => *id,
                    Err(pose) => return *pose,
                };
                let (mut p, mut matrix, mut q) = ([0.0; 3], [0.0; 9], [0.0; 4]);
                let (origin, unit) = ([0.0; 3], [1.0, 0.0, 0.0, 0.0]);
                (self.library.place)(
                    self.data,
                    p.as_mut_ptr(),
                    matrix.as_mut_ptr(),
                    origin.as_ptr(),
                    unit.as_ptr(),
                    id,
                    0,
                );
                (self.library.to_quaternion)(q.as_mut_ptr(), matrix.as_ptr());
                Pose::new(Vec3::new(p[0], p[1], p[2]), Quat::from_parts(q[0], Vec3::new(q[1], q[2], q[3])))
            }));
        }
    }
}
