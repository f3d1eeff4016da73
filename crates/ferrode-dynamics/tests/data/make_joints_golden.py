#!/usr/bin/env python3
"""Makes joints_golden.json, lean, from the full recording: make_joints_golden.py FULL.json > joints_golden.json

What repeats (worlds, bodies, poses of the probes, names of getters) is listed once and named by its index. Numbers are
kept to the last bit.
"""
import json
import sys

full = json.load(open(sys.argv[1]))


def numbers(x):
    """All numbers of a nested value, in order."""
    if isinstance(x, list):
        return [n for item in x for n in numbers(item)]
    return [x]


def lean(x):
    """The same value, whole numbers without ".0"."""
    if isinstance(x, list):
        return [lean(item) for item in x]
    if isinstance(x, float) and x == int(x) and abs(x) < 1e15:
        return int(x)
    return x


def state(body):
    return numbers([body[k] for k in ("position", "quaternion", "linear_velocity", "angular_velocity")])


def index(table, item):
    item = lean(item)
    if item not in table:
        table.append(item)
    return table.index(item)


worlds, bodies, poses, getters = [], [], [], {}


def call(c):
    return [c["fn"], *numbers(c["args"])]


def answers(joint, values):
    return [lean(values[name]) for name in getters[joint]]


def case(c):
    w = c["world"]
    getters.setdefault(c["joint"], list(c["after_setup"]))
    world = [*w["gravity"], w["erp"], w["cfm"], w["erp_after_joint_creation"], w["cfm_after_joint_creation"]]
    return {
        "id": c["id"],
        "joint": c["joint"],
        "world": index(worlds, [*world, w["step_size"]]),
        "bodies": [index(bodies, [b["mass"], *b["inertia"], *state(b["initial"])]) for b in c["bodies"]],
        "attach": c["attach"],
        "contact": {k: lean(v) for k, v in c["contact"].items()} if "contact" in c else None,
        "calls": lean([call(x) for x in c["calls"]]),
        "each": lean([call(x) for x in c["calls_before_each_step"]]),
        "setup": answers(c["joint"], c["after_setup"]),
        "steps": [
            [
                r["step"],
                [lean(state(b)) for b in r["bodies"]],
                lean(numbers([r["feedback"][k] for k in ("f1", "t1", "f2", "t2")])),
                answers(c["joint"], r["queries"]),
            ]
            for r in c.get("results", [])
        ],
        "probes": [
            [index(poses, [state(b) for b in p["bodies"]]), answers(c["joint"], p["queries"])]
            for p in c.get("probes", [])
        ],
    }


def params(p):
    defaults, written = p["defaults"], p["after_setting_all_in_this_order"]
    assert [n for n, _ in defaults] == [n for n, _, _ in written]
    rows = [[n, default, value, read] for (n, default), (_, value, read) in zip(defaults, written)]
    return [p["joint"], p["world_erp"], p["world_cfm"], lean(rows)]


def text(x):
    return json.dumps(x, separators=(",", ":"))


def lines(items):
    return "[\n" + ",\n".join(text(item) for item in items) + "\n]"


cases = [case(c) for c in full["cases"] + full["probe_cases"]]
parts = {
    "source": text(full["library"]),
    "cases": lines(cases),
    "params": lines([params(p) for p in full["param_cases"]]),
    "worlds": lines(worlds),
    "bodies": lines(bodies),
    "poses": lines(poses),
    "getters": text(getters),
}
print("{\n" + ",\n".join(f'"{k}": {v}' for k, v in parts.items()) + "\n}")
