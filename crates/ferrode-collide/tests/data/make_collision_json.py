"""Makes collision.json and spaces.json, the recorded cases that the tests replay, from the full record of libode 0.16.2.

usage: make_collision_json.py collision_golden.json

Both hold one item a line. Of each ordered pair of the classes named below it keeps some cases of each kind (see "doc" in the full record), and the
special lists as they are. The tests replay the full record instead if FERRODE_SPEC names its folder.
"""
import json
import sys

CLASSES = ["sphere", "box", "capsule", "cylinder", "plane", "ray"]
KEEP = {"generic": 5, "aligned": 3, "resting": 3, "concentric": 1, "unimportant": 1}

full = json.load(open(sys.argv[1]))
seen = {}
cases = []
for case in full["cases"]:
    classes = (case["a"]["class"], case["b"]["class"])
    if not set(classes) <= set(CLASSES):
        continue
    # Most generic cases should touch.
    key = classes + (case["kind"], case["n"] > 0)
    seen[key] = seen.get(key, 0) + 1
    if seen[key] <= (KEEP[case["kind"]] if case["n"] > 0 else 1):
        cases.append(case)


def write(path, lists):
    """One item a line."""
    with open(path, "w") as out:
        out.write("{\n")
        for i, (key, value) in enumerate(lists.items()):
            items = ",\n".join("  " + json.dumps(item, separators=(",", ":")) for item in value)
            out.write(f' "{key}": [\n{items}\n ]' + ("\n" if i == len(lists) - 1 else ",\n"))
        out.write("}\n")


write("collision.json", {"cases": cases, **{key: full[key] for key in ("box_box", "closest_line_segment_points")}})
write("spaces.json", {"broadphase": full["broadphase"]})
