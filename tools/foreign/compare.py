#!/usr/bin/env python3
"""Two records of lockstep.c beside each other: where they part, and what the library took.

compare.py A B [STEPS TOLERANCE]: fails if they part by more than that before that step.
"""
import math
import sys


def read(path):
    steps, times, library = [], {}, "?"
    for line in open(path):
        words = line.split()
        if words[0] == "library":
            library = words[1]
        elif words[0] == "step":
            steps.append((words[4:], []))
        elif words[0] == "time":
            times[words[1]] = (int(words[2]), float(words[3]))
        elif words[0] != "pair":
            steps[-1][1].append([float(w) for w in words])
    return steps, times, library


def distance(a, b):
    """The largest difference of two bodies' numbers, relative to those above 1."""
    if not all(math.isfinite(x) for x in a + b):
        return 0.0 if str(a) == str(b) else math.inf
    return max(abs(x - y) / max(1.0, abs(x)) for x, y in zip(a, b))


def main():
    (a, times_a, library_a), (b, times_b, library_b) = read(sys.argv[1]), read(sys.argv[2])
    until, tolerance = (int(sys.argv[3]), float(sys.argv[4])) if len(sys.argv) > 4 else (0, math.inf)
    print(f"  {library_a}: {len(a)} steps; {library_b}: {len(b)} steps")
    bodies = max((len(states) for _, states in a), default=0)
    print(f"  up to {bodies} bodies; contact joints {sum(int(head[5]) for head, _ in a)} and {sum(int(head[5]) for head, _ in b)}")
    good = min(len(a), len(b)) >= until
    marks = [1e-12, 1e-9, 1e-6, 1e-3, 1.0]
    for step, ((head_a, states_a), (head_b, states_b)) in enumerate(zip(a, b)):
        apart, body = max(((distance(x, y), n) for n, (x, y) in enumerate(zip(states_a, states_b))), default=(0.0, 0))
        if marks and apart > marks[0]:
            print(f"  step {step}: differ by {apart:.1e} (body {body})")
            marks = [mark for mark in marks if mark >= apart]
        # Numbers of bodies, contacts and contact joints.
        same = head_a == head_b and len(states_a) == len(states_b)
        good = good and (step >= until or (same and apart <= tolerance))
        if not same:
            print(f"  step {step}: {' '.join(head_a)} and {' '.join(head_b)}")
            break
    else:
        print("  alike to the end" if len(a) == len(b) else "  alike as far as the shorter goes")
    for name, (calls_a, seconds_a) in times_a.items():
        calls_b, seconds_b = times_b.get(name, (0, 0.0))
        if calls_a and calls_b and seconds_a:
            print(f"  {name}: {calls_a} calls of {1e6 * seconds_a / calls_a:.1f} us, {calls_b} of {1e6 * seconds_b / calls_b:.1f} us")
    sys.exit(0 if good else 1)


main()
