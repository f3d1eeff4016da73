//! MuJoCo's library: where it is, and the functions that the driver calls.

use core::ffi::{CStr, c_char, c_int, c_void};
use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// `mjOBJ_BODY`.
pub const BODY: c_int = 1;
/// `mjOBJ_FRAME`.
pub const FRAME: c_int = 100;
/// `mjSTATE_QVEL`.
pub const VELOCITIES: c_int = 1 << 2;

type Spec = *mut c_void;
type Element = *mut c_void;
type Model = *const c_void;
type Data = *mut c_void;

macro_rules! functions {
    ($($name:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// Functions of `mujoco.h`, which this program never unloads.
        pub struct Library {
            $(
                #[doc = $symbol]
                pub $name: unsafe extern "C" fn($($argument),*) $(-> $result)?,
            )*
        }

        impl Library {
            /// # Safety
            /// `library` is MuJoCo, 3.3 or later.
            unsafe fn link(library: &libloading::Library) -> Result<Self, libloading::Error> {
                // SAFETY: types are those of the header.
                unsafe { Ok(Self { $($name: *library.get($symbol.as_bytes())?,)* }) }
            }
        }
    };
}

functions! {
    version = "mj_versionString": fn() -> *const c_char;
    parse = "mj_parseXMLString": fn(*const c_char, *const c_void, *mut c_char, c_int) -> Spec;
    find = "mjs_findElement": fn(Spec, c_int, *const c_char) -> Element;
    attach = "mjs_attach": fn(Element, Element, *const c_char, *const c_char) -> Element;
    compile = "mj_compile": fn(Spec, *const c_void) -> Model;
    error = "mjs_getError": fn(Spec) -> *const c_char;
    make_data = "mj_makeData": fn(Model) -> Data;
    number = "mj_name2id": fn(Model, c_int, *const c_char) -> c_int;
    step = "mj_step": fn(Model, Data);
    forward = "mj_forward": fn(Model, Data);
    kinematics = "mj_kinematics": fn(Model, Data);
    state_size = "mj_stateSize": fn(Model, c_int) -> c_int;
    set_state = "mj_setState": fn(Model, Data, *const f64, c_int);
    apply = "mj_applyFT": fn(Model, Data, *const f64, *const f64, *const f64, c_int, *mut f64);
    solve = "mj_solveM": fn(Model, Data, *mut f64, *const f64, c_int);
    place = "mj_local2Global": fn(Data, *mut f64, *mut f64, *const f64, *const f64, c_int, u8);
    to_quaternion = "mju_mat2Quat": fn(*mut f64, *const f64);
}

/// Whether a simulation became unstable, after which MuJoCo starts it again.
pub static UNSTABLE: AtomicBool = AtomicBool::new(false);

extern "C" fn warn(words: *const c_char) {
    // SAFETY: MuJoCo passes text that ends with a zero.
    let words = unsafe { CStr::from_ptr(words) }.to_string_lossy();
    eprintln!("mujoco: {words}");
    if words.contains("unstable") {
        UNSTABLE.store(true, Ordering::Relaxed);
    }
}

/// The path in `MUJOCO_LIBRARY`, or the one in the package of the `python3` (or `PYTHON`) on the path.
fn path() -> Result<PathBuf, String> {
    if let Some(path) = std::env::var_os("MUJOCO_LIBRARY") {
        return Ok(path.into());
    }
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let script = "import glob, importlib.util as u; f = u.find_spec('mujoco').submodule_search_locations[0]; \
                  print(glob.glob(f + '/libmujoco.so*')[0])";
    let output = Command::new(&python).args(["-c", script]).output().map_err(|e| format!("{python}: {e}"))?;
    if !output.status.success() {
        return Err(format!("{python} has no mujoco, and MUJOCO_LIBRARY names none"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().into())
}

impl Library {
    /// The library, loaded once.
    pub fn get() -> &'static Result<Self, String> {
        static LIBRARY: OnceLock<Result<Library, String>> = OnceLock::new();
        LIBRARY.get_or_init(|| {
            let path = path()?;
            let problem = |e| format!("{}: {e}", path.display());
            // SAFETY: the library is MuJoCo, as its name says, and is not unloaded.
            unsafe {
                let library = libloading::Library::new(&path).map_err(problem)?;
                let functions = Self::link(&library).map_err(problem)?;
                // Otherwise warnings go to a file.
                if let Ok(hook) =
                    library.get::<*mut Option<extern "C" fn(*const c_char)>>(b"mju_user_warning")
                {
                    **hook = Some(warn);
                }
                core::mem::forget(library);
                Ok(functions)
            }
        })
    }
}
