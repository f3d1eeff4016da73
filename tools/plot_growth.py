#!/usr/bin/env python3
"""Draws what bench's `growth` printed: plot_growth.py growth.csv > docs/img/direct-growth.svg"""
import math
import sys

COLOURS = {"chain": "#1f77b4", "tree": "#2ca02c", "tower": "#8c564b", "wall": "#ff7f0e", "pyramid": "#9467bd",
           "pile": "#d62728", "heap": "#e377c2", "grid": "#17becf"}
W, H, LEFT, TOP, RIGHT, BOTTOM = 860, 560, 70, 30, 170, 50
X, Y = (1, 4), (-3, 3)  # decades of bodies and of milliseconds


def place(n, ms):
    x = LEFT + (math.log10(n) - X[0]) / (X[1] - X[0]) * (W - LEFT - RIGHT)
    y = H - BOTTOM - (math.log10(ms) - Y[0]) / (Y[1] - Y[0]) * (H - TOP - BOTTOM)
    return x, y


series = {}
for line in open(sys.argv[1]):
    words = line.strip().split(",")
    if words[0] not in COLOURS or len(words) < 13:
        continue
    ours, theirs = series.setdefault(words[0], ([], []))
    ours.append((int(words[1]), float(words[3])))
    if words[12] != "NaN":
        theirs.append((int(words[1]), float(words[12])))

out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {W} {H}" font-family="sans-serif" font-size="13">',
       f'<rect width="{W}" height="{H}" fill="white"/>']
for e in range(X[0], X[1] + 1):
    x, _ = place(10**e, 1)
    out.append(f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{H - BOTTOM}" stroke="#ddd"/>')
    out.append(f'<text x="{x:.1f}" y="{H - BOTTOM + 18}" text-anchor="middle">{10**e:,}</text>')
for e in range(Y[0], Y[1] + 1):
    _, y = place(10, 10**e)
    out.append(f'<line x1="{LEFT}" y1="{y:.1f}" x2="{W - RIGHT}" y2="{y:.1f}" stroke="#ddd"/>')
    out.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{10**e:g}</text>')
out.append(f'<text x="{(LEFT + W - RIGHT) / 2}" y="{H - 10}" text-anchor="middle">bodies</text>')
out.append(f'<text x="16" y="{(TOP + H - BOTTOM) / 2}" text-anchor="middle" transform="rotate(-90 16 {(TOP + H - BOTTOM) / 2})">'
           'one step, ms of processor time</text>')
for i, (name, pair) in enumerate(series.items()):
    for points, dash in zip(pair, ("", ' stroke-dasharray="5 4"')):
        points = [place(*p) for p in points if 10 ** Y[0] <= p[1] <= 10 ** Y[1] * 1.2]
        if not points:
            continue
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="{COLOURS[name]}" stroke-width="2"{dash}/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{COLOURS[name]}"/>' for x, y in points]
    y = TOP + 20 + 20 * i
    out.append(f'<line x1="{W - RIGHT + 15}" y1="{y - 4}" x2="{W - RIGHT + 40}" y2="{y - 4}" stroke="{COLOURS[name]}" '
               'stroke-width="2"/>')
    out.append(f'<text x="{W - RIGHT + 46}" y="{y}">{name}</text>')
y = TOP + 30 + 20 * len(series)
out.append(f'<text x="{W - RIGHT + 15}" y="{y}">solid: Ferrode</text>')
out.append(f'<text x="{W - RIGHT + 15}" y="{y + 18}">dashed: libode 0.16.2</text>')
out.append("</svg>")
print("\n".join(out))
