#!/usr/bin/env python3
"""64 robots of 30 hinges with brakes, in MuJoCo and in Ferrode's exact stepper: processor time per step, and how far hinges leave their axes.

    pip install mujoco
    cargo build --release --bin growth
    python3 mujoco_robots.py path/to/growth [--seconds 5] [--runs 5] > results/mujoco-robots.md

Both run the same scene (`robots` in src/bin/growth.rs) on one thread, in alternation; printed are medians of the runs. In MuJoCo a brake is
`frictionloss`, the step 0.01 s, the solver Newton and the integrator implicitfast. Its hinges can't leave their axes: its coordinates are the
angles. Ferrode's bodies are free and held by rows.
"""
import argparse
import statistics
import subprocess
import time

import mujoco

DIRECTIONS = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
AXES = ["1 0 0", "0 1 0", "0 0 1"]


def limb_xml(limb, joint):
    """The limb's body number `joint`, with those that follow."""
    if joint == 6 or limb + 5 * joint > 28:
        return ""
    direction = DIRECTIONS[limb]
    # Relative to the parent's centre: the torso's, or that of the body before, which sits 0.125 behind its far end.
    reach = 0.4 + 0.125 if joint == 0 else 0.25
    position = " ".join(str(reach * d) for d in direction)
    anchor = " ".join(str(-0.125 * d) for d in direction)
    half = " ".join(str(0.5 * (0.08 + 0.17 * abs(d))) for d in direction)
    return f"""<body pos="{position}"><joint type="hinge" pos="{anchor}" axis="{AXES[(limb // 2 + joint + 1) % 3]}" frictionloss="{1 + joint}"/>
<geom type="box" size="{half}" mass="{0.5 + 0.1 * joint}" contype="0" conaffinity="0"/>{limb_xml(limb, joint + 1)}</body>"""


def model(robots, h):
    bodies = ""
    for robot in range(robots):
        base = f"{robot % 8 * 5.0} {robot // 8 * 5.0} 3"
        bodies += f"""<body pos="{base}"><joint type="hinge" axis="0 0 1" frictionloss="5"/>
<geom type="box" size="0.2 0.15 0.3" mass="5" contype="0" conaffinity="0"/>{"".join(limb_xml(limb, 0) for limb in range(5))}</body>"""
    return mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="{h}" integrator="implicitfast" solver="Newton"/>
<worldbody>{bodies}</worldbody></mujoco>""")


def run_mujoco(world, steps):
    data = mujoco.MjData(world)
    start = time.process_time()
    mujoco.mj_step(world, data, nstep=steps)
    return (time.process_time() - start) / steps * 1e3


def run_ferrode(growth, steps):
    words = ["--case", "robots", "--smallest", "1920", "--largest", "1920", "--reps", "1", "--from", "0", "--steps", str(steps), "--ours"]
    lines = subprocess.run([growth, *words], capture_output=True, text=True, check=True).stdout.splitlines()
    return dict(zip(lines[0].split(","), lines[1].split(",")))


def main():
    words = argparse.ArgumentParser()
    words.add_argument("growth")
    words.add_argument("--seconds", type=float, default=5)
    words.add_argument("--runs", type=int, default=5)
    words = words.parse_args()
    h = 0.01
    steps = round(words.seconds / h)
    world = model(64, h)
    assert world.nv == 1920
    theirs, ours = [], []
    for _ in range(words.runs):
        theirs.append(run_mujoco(world, steps))
        result = run_ferrode(words.growth, steps)
        ours.append(float(result["mean_ms"]))
    a, b = statistics.median(ours), statistics.median(theirs)
    print(f"""# 64 robots of 30 hinges with brakes, {words.seconds:g} s at h = {h}

| | ms per step (mean over the run, median of {words.runs} runs) | hinges off their axes | anchors apart |
|---|---|---|---|
| Ferrode, `Direct` | {a:.2f} | {result["axis_error"]} rad | {result["joint_error"]} m |
| MuJoCo {mujoco.__version__}, Newton, implicitfast | {b:.2f} | none by construction | none by construction |

Ratio {a / b:.2f}. Factorisations per step: {result["factorisations"]}, at most {result["most"]}; uncertified solves: {result["uncertified"]}.""")


main()
