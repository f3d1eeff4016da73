//! The recorded cases, from the lean file of `tests/data` or the full recording.

use serde_json::Value;

/// A world, bodies, a joint, and what libode answered.
pub struct Case {
    pub id: String,
    pub joint: String,
    pub gravity: [f64; 3],
    pub erp: f64,
    pub cfm: f64,
    /// World values set after the joint is made and before it is attached.
    pub later_erp: Option<f64>,
    pub later_cfm: Option<f64>,
    pub step_size: f64,
    pub bodies: Vec<BodySetup>,
    pub attach: [Option<usize>; 2],
    /// A contact's numbers by name.
    pub contact: Value,
    pub calls: Vec<Call>,
    pub calls_before_each_step: Vec<Call>,
    /// Names of the getters, ODE's, with the argument in brackets.
    pub getters: Vec<String>,
    /// Answers of the getters after the calls.
    pub setup: Vec<Vec<f64>>,
    pub steps: Vec<Step>,
    pub probes: Vec<Probe>,
}

pub struct BodySetup {
    pub mass: f64,
    /// Row-major.
    pub inertia: [f64; 9],
    pub state: State,
}

/// Position, quaternion (w first), linear and angular velocity.
pub type State = [f64; 13];

/// An ODE function, and its arguments without the joint.
pub struct Call {
    pub function: String,
    pub arguments: Vec<f64>,
}

/// What was read after a step.
pub struct Step {
    pub number: u64,
    pub bodies: Vec<State>,
    /// Force and torque on the first body, then on the second.
    pub feedback: [f64; 12],
    pub answers: Vec<Vec<f64>>,
}

/// A pose given to the bodies, and what was read then.
pub struct Probe {
    pub bodies: Vec<State>,
    pub answers: Vec<Vec<f64>>,
}

/// What a joint type makes of its parameters.
pub struct ParamTable {
    pub joint: String,
    pub erp: f64,
    pub cfm: f64,
    /// Number, default, value written, value read after all were written.
    pub rows: Vec<[f64; 4]>,
}

pub struct Golden {
    pub cases: Vec<Case>,
    pub params: Vec<ParamTable>,
}

/// Reads a file of either form.
pub fn read(text: &str) -> Golden {
    let root: Value = serde_json::from_str(text).expect("the recording is JSON");
    if root.get("worlds").is_some() { lean(&root) } else { full(&root) }
}

fn number(v: &Value) -> f64 {
    match v.as_str() {
        Some("inf") => f64::INFINITY,
        Some("-inf") => f64::NEG_INFINITY,
        _ => v.as_f64().unwrap_or_else(|| panic!("{v} is no number")),
    }
}

/// All numbers of a nested value, in order.
fn numbers(v: &Value) -> Vec<f64> {
    match v.as_array() {
        Some(items) => items.iter().flat_map(numbers).collect(),
        None => vec![number(v)],
    }
}

fn array<const N: usize>(numbers: &[f64]) -> [f64; N] {
    numbers.try_into().unwrap_or_else(|_| panic!("{N} numbers expected, not {}", numbers.len()))
}

fn list<T>(v: &Value, f: impl Fn(&Value) -> T) -> Vec<T> {
    v.as_array().map(|items| items.iter().map(f).collect()).unwrap_or_default()
}

fn string(v: &Value) -> String {
    v.as_str().expect("a name").to_owned()
}

fn attach(v: &Value) -> [Option<usize>; 2] {
    [0, 1].map(|i| v[i].as_u64().map(|n| n as usize))
}

fn lean(root: &Value) -> Golden {
    let entry = |table: &str, index: &Value| root[table][index.as_u64().expect("an index") as usize].clone();
    let answers = |v: &Value| list(v, numbers);
    let state = |v: &Value| array(&numbers(v));
    let call = |v: &Value| Call {
        function: string(&v[0]),
        arguments: list(v, Value::clone)[1..].iter().map(number).collect(),
    };
    let case = |c: &Value| {
        let w = entry("worlds", &c["world"]);
        Case {
            id: string(&c["id"]),
            joint: string(&c["joint"]),
            gravity: [0, 1, 2].map(|i| number(&w[i])),
            erp: number(&w[3]),
            cfm: number(&w[4]),
            later_erp: w[5].as_f64(),
            later_cfm: w[6].as_f64(),
            step_size: number(&w[7]),
            bodies: list(&c["bodies"], |i| {
                let b = numbers(&entry("bodies", i));
                BodySetup { mass: b[0], inertia: array(&b[1..10]), state: array(&b[10..]) }
            }),
            attach: attach(&c["attach"]),
            contact: c["contact"].clone(),
            calls: list(&c["calls"], call),
            calls_before_each_step: list(&c["each"], call),
            getters: list(&root["getters"][&string(&c["joint"])], string),
            setup: answers(&c["setup"]),
            steps: list(&c["steps"], |s| Step {
                number: s[0].as_u64().expect("a step number"),
                bodies: list(&s[1], state),
                feedback: array(&numbers(&s[2])),
                answers: answers(&s[3]),
            }),
            probes: list(&c["probes"], |p| Probe {
                bodies: list(&entry("poses", &p[0]), state),
                answers: answers(&p[1]),
            }),
        }
    };
    let table = |t: &Value| ParamTable {
        joint: string(&t[0]),
        erp: number(&t[1]),
        cfm: number(&t[2]),
        rows: list(&t[3], |row| array(&numbers(row))),
    };
    Golden { cases: list(&root["cases"], case), params: list(&root["params"], table) }
}

fn full(root: &Value) -> Golden {
    let state = |b: &Value| -> State {
        let parts = ["position", "quaternion", "linear_velocity", "angular_velocity"];
        array(&parts.iter().flat_map(|part| numbers(&b[*part])).collect::<Vec<_>>())
    };
    let call = |c: &Value| Call { function: string(&c["fn"]), arguments: numbers(&c["args"]) };
    let case = |c: &Value| {
        let w = &c["world"];
        let getters: Vec<String> =
            c["after_setup"].as_object().expect("a map of getters").keys().cloned().collect();
        let answers = |v: &Value| getters.iter().map(|name| numbers(&v[name])).collect();
        Case {
            id: string(&c["id"]),
            joint: string(&c["joint"]),
            gravity: array(&numbers(&w["gravity"])),
            erp: number(&w["erp"]),
            cfm: number(&w["cfm"]),
            later_erp: w["erp_after_joint_creation"].as_f64(),
            later_cfm: w["cfm_after_joint_creation"].as_f64(),
            step_size: number(&w["step_size"]),
            bodies: list(&c["bodies"], |b| BodySetup {
                mass: number(&b["mass"]),
                inertia: array(&numbers(&b["inertia"])),
                state: state(&b["initial"]),
            }),
            attach: attach(&c["attach"]),
            contact: c["contact"].clone(),
            calls: list(&c["calls"], call),
            calls_before_each_step: list(&c["calls_before_each_step"], call),
            setup: answers(&c["after_setup"]),
            steps: list(&c["results"], |s| Step {
                number: s["step"].as_u64().expect("a step number"),
                bodies: list(&s["bodies"], state),
                feedback: array(&["f1", "t1", "f2", "t2"].map(|part| numbers(&s["feedback"][part])).concat()),
                answers: answers(&s["queries"]),
            }),
            probes: list(&c["probes"], |p| Probe {
                bodies: list(&p["bodies"], state),
                answers: answers(&p["queries"]),
            }),
            getters,
        }
    };
    let table = |t: &Value| {
        let defaults = list(&t["defaults"], numbers);
        let written = list(&t["after_setting_all_in_this_order"], numbers);
        ParamTable {
            joint: string(&t["joint"]),
            erp: number(&t["world_erp"]),
            cfm: number(&t["world_cfm"]),
            rows: defaults.iter().zip(&written).map(|(d, w)| [d[0], d[1], w[1], w[2]]).collect(),
        }
    };
    let cases =
        [list(&root["cases"], case), list(&root["probe_cases"], case)].into_iter().flatten().collect();
    Golden { cases, params: list(&root["param_cases"], table) }
}
