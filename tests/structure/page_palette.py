#!/usr/bin/python3
"""Fails if two colours of lines look alike to people who do not see all colours, or one is too near its ground.

    page_palette.py ROOT

Colours are seen as by Machado, Oliveira and Fernandes, "A Physiologically-based Model for Simulation of Color Vision
Deficiency", 2009, at severity 1; distances are those of CIE Lab; contrasts those of WCAG 2.
"""
import itertools
import math
import re
import sys
from pathlib import Path

LINES = ("truth", "fused", "visual", "lidar", "gnss", "ppp", "matched")
TEXTS = ("ink", "soft", "good", "warning", "error")
EYES = {  # rows of the matrix on linear RGB, and the least distance
    "all cones": ((1, 0, 0, 0, 1, 0, 0, 0, 1), 28),
    "no red cones": ((0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998), 28),
    "no green cones": ((0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881), 28),
    "no blue cones": ((1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039), 19)}


def times(matrix, v):
    return [sum(matrix[3 * r + c] * v[c] for c in range(3)) for r in range(3)]


def linear(colour):
    parts = (int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5))
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]


def lab(rgb):
    xyz = times((0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505), [min(1, max(0, c)) for c in rgb])
    x, y, z = (v ** (1 / 3) if v > 0.008856 else 7.787 * v + 16 / 116 for v in (xyz[0] / 0.9505, xyz[1], xyz[2] / 1.089))
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def contrast(a, b):
    light, dark = sorted((0.05 + sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear(x))) for x in (a, b)), reverse=True)
    return light / dark


def main(root):
    text = (root / "tools/web/design/tokens.css").read_text()
    pairs = dict((name, colours) for name, *colours in re.findall(r"--([\w-]+): light-dark\((#\w{6}), (#\w{6})\)", text))
    bad = []
    for theme, page in enumerate(("light", "dark")):
        tokens = {name: colours[theme] for name, colours in pairs.items()}
        for names, least in ((LINES, 3), (TEXTS, 4.5)):
            for name, ground in itertools.product(names, ("surface", "ground") if least == 3 else ("surface", "raised")):
                if contrast(tokens[name], tokens[ground]) < least:
                    bad.append(f"{page}: --{name} has a contrast of less than {least} on --{ground}")
        for eye, (matrix, least) in EYES.items():
            seen = {name: lab(times(matrix, linear(tokens[name]))) for name in LINES}
            for a, b in itertools.combinations(LINES, 2):
                if math.dist(seen[a], seen[b]) < least:
                    bad.append(f"{page}, {eye}: --{a} and --{b} are {math.dist(seen[a], seen[b]):.0f} apart, less than {least}")
    print("\n".join(bad) or "all colours stay apart")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
