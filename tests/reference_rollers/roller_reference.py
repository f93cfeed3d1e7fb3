#!/usr/bin/env python3
"""30-digit separations of wheels on rollers, from the equations of tests/reference/reference.py in 60-digit arithmetic.

A roller is a wheel upside down: its height is that of the wheel with the mirrored profile (z -> -z), mirrored back. The
wheel's directions in the tangent plane are turned by the skew chi.

Usage: roller_reference.py SCENE.json ROLLER_RADIUS CHI > VALUES.json, with a scene of tests/reference/reference.py
"""
import json, os, sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference"))
from reference import M, Frame, Profile, mp, wheel_zeta
from mpmath import cos, sin


def mirrored(segment):
    flipped = dict(segment)
    for key in ("z0", "z1", "b", "sigma"):
        if key in flipped:
            flipped[key] = -flipped[key]
    if "c" in flipped:
        flipped["c"] = [-c for c in flipped["c"]]
    return flipped


scene = json.load(open(sys.argv[1]))
scene = scene.get("scene", scene)
roller, chi = M(float(sys.argv[2])), M(float(sys.argv[3]))
below, wheel = Profile([mirrored(s) for s in scene["rail"]]), Profile(scene["wheel"])
frame_below, frame = Frame(below, scene["contact_rail_x"]), Frame(wheel, scene["contact_wheel_x"])
out = {"scene": {**scene, "roller_radius": float(roller), "chi": float(chi)}, "separation": []}
for xi in map(M, [-8.0, -2.5, -0.5, -1e-3, 0.0, 1e-3, 0.5, 2.5, 8.0]):
    for eta in map(M, [-9.0, -1.0, 0.0, 1e-3, 3.0, 12.0]):
        own = xi * cos(chi) + eta * sin(chi), eta * cos(chi) - xi * sin(chi)
        above = wheel_zeta(wheel, frame, M(scene["wheel_radius"]), *own)
        lower = wheel_zeta(below, frame_below, roller, xi, eta)
        if above is not None and lower is not None:
            # At C the two cancel: what is left is a rounding.
            value = "0.0" if xi == 0 == eta else mp.nstr(above + lower, 30)
            out["separation"].append([float(xi), float(eta), value])
json.dump(out, sys.stdout, indent=0)
