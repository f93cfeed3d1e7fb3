#!/usr/bin/env python3
"""60-digit normal gaps t(sigma, eta), by three-dimensional geometry.

Independent of the program: no sagitta, no chord, no meridian plane of the ray. The rail's point is found by its arc length
from C (angles about the centres of arcs, quadrature on curves). The wheel is its axle, a point and a direction in space; a
point p is inside its material exactly when its distance from the axle is less than R - z(x), x its abscissa along the axle.
The line p = P + t n_R is followed from P in small steps, outwards where P is outside of the wheel and backwards where it is
inside, up to the first place where it crosses the surface; there t is bisected in 70 digits.

Conventions, frame and segments as in ../reference_yawed/yawed_reference.py, and
  {"kind": "spline", "t1", "cx", "cz"}: x = sum cx[k] t^k, z = sum cz[k] t^k over 0 <= t <= t1, x ascending with t.
Drawings are closed by ../reference/closing.py; the joints of splines are closed to rounding only, and no point lies on one.

A row is [sigma, eta, t, alpha, xi, zeta]; t is null where the line misses the wheel.

Usage: conformal_reference.py DIR [NAME ...]      writes the scenes kept in this script
"""
import json
import os
import sys

from mpmath import asin, atan2, cos, mp, mpf, nstr, polyval, quad, sin, sqrt

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "reference"))
from closing import closed  # noqa: E402

mp.dps = 70
HAIR = mpf(10) ** -62
# How far the line is followed [mm], and in which steps. No wheel of these scenes is crossed twice within a step.
REACH, STEP = mpf(6), mpf("0.05")


def derivative(c):
    return [k * v for k, v in enumerate(c)][1:] or [mpf(0)]


def value(c, t):
    return polyval(c[::-1], t)


class Curve:
    """A segment by a parameter u that ascends with x."""

    def __init__(self, d):
        self.kind = d["kind"]
        if self.kind == "arc":
            self.a, self.b, self.r, self.sigma = (mpf(d[k]) for k in ("a", "b", "r", "sigma"))
            self.u = [asin((mpf(d[k]) - self.a) / self.r) for k in ("x0", "x1")]
        elif self.kind == "spline":
            self.cx, self.cz = ([mpf(v) for v in d[k]] for k in ("cx", "cz"))
            self.u = [mpf(0), mpf(d["t1"])]
        else:
            self.u = [mpf(d["x0"]), mpf(d["x1"])]
            self.cx = [mpf(0), mpf(1)]
            if self.kind == "line":
                slope = (mpf(d["z1"]) - mpf(d["z0"])) / (self.u[1] - self.u[0])
                self.cz = [mpf(d["z0"]) - slope * self.u[0], slope]
            else:
                self.cz = [mpf(v) for v in d["c"]]
        self.ends = [self.point(u) for u in self.u]

    def point(self, u):
        if self.kind == "arc":
            return self.a + self.r * sin(u), self.b + self.sigma * self.r * cos(u)
        return value(self.cx, u), value(self.cz, u)

    def angle(self, u):
        if self.kind == "arc":
            return -self.sigma * u
        return atan2(value(derivative(self.cz), u), value(derivative(self.cx), u))

    def length(self, u, v):
        """From u to v, negative if v is the smaller."""
        if self.kind == "arc":
            return self.r * (v - u)
        speed = lambda t: sqrt(value(derivative(self.cx), t) ** 2 + value(derivative(self.cz), t) ** 2)
        if self.kind == "line":
            return (v - u) * speed(u)
        return quad(speed, [u + (v - u) * k / 4 for k in range(5)])

    def holds(self, x):
        return self.ends[0][0] <= x <= self.ends[1][0]

    def at(self, x):
        """The parameter of abscissa x."""
        if self.kind == "arc":
            return asin((x - self.a) / self.r)
        if self.kind != "spline":
            return x
        return root(lambda t: value(self.cx, t) - x, *self.u)


def root(f, low, high):
    """The zero between low and high, by bisection and secant in turn."""
    f_low, f_high = f(low), f(high)
    assert f_low * f_high <= 0, (f_low, f_high)
    while abs(high - low) > HAIR:
        secant = low - f_low * (high - low) / (f_high - f_low)
        for middle in (secant, (low + high) / 2):
            for x in (middle - HAIR / 4, middle + HAIR / 4) if middle is secant else (middle,):
                if not low < x < high:
                    continue
                v = f(x)
                if v == 0:
                    return x
                if (v > 0) == (f_low > 0):
                    low, f_low = x, v
                else:
                    high, f_high = x, v
    return (low + high) / 2


def at(curves, x):
    """The curve at abscissa x and its parameter there; a joint belongs to the left one."""
    for curve in curves:
        if curve.holds(x):
            return curve, curve.at(x)
    return None


class Rail:
    def __init__(self, curves, x_c):
        self.curves = curves
        curve, self.u_c = at(curves, x_c)
        self.index = curves.index(curve)
        self.theta, self.c = curve.angle(self.u_c), curve.point(self.u_c)

    def station(self, sigma):
        """Point and tangent angle in the contact frame, at an arc length from C."""
        index, u, rest = self.index, self.u_c, mpf(sigma)
        side = 1 if rest > 0 else 0
        while True:
            curve = self.curves[index]
            whole = curve.length(u, curve.u[side])
            if abs(whole) >= abs(rest):
                break
            rest -= whole
            index += 1 if side else -1
            if not 0 <= index < len(self.curves):
                return None
            u = self.curves[index].u[1 - side]
        if curve.kind == "arc":
            v = u + rest / curve.r
        elif curve.kind == "line":
            v = u + rest * (curve.u[1] - curve.u[0]) / curve.length(*curve.u)
        elif rest == 0:
            v = u
        else:
            v = root(lambda v: curve.length(u, v) - rest, *sorted((u, curve.u[side])))
        x, z = (p - q for p, q in zip(curve.point(v), self.c))
        c, s = cos(self.theta), sin(self.theta)
        return x * c + z * s, z * c - x * s, curve.angle(v) - self.theta


class Wheel:
    """A wheel in the contact frame; its meridian through C is turned by chi about zeta."""

    def __init__(self, curves, radius, x_c, chi):
        curve, u = at(curves, x_c)
        self.curves, self.radius, self.x_c = curves, radius, x_c
        theta, (_, z_c) = curve.angle(u), curve.point(u)
        meridian = [cos(chi), sin(chi), mpf(0)]
        self.axle = [cos(theta) * m for m in meridian]
        self.axle[2] = -sin(theta)
        up = [sin(theta) * m for m in meridian]
        up[2] = cos(theta)
        self.foot = [(radius - z_c) * v for v in up]

    def depth(self, p):
        """Positive inside of the material; None beyond the ends of the profile."""
        d = [u - v for u, v in zip(p, self.foot)]
        along = sum(u * v for u, v in zip(d, self.axle))
        here = at(self.curves, self.x_c + along)
        if here is None:
            return None
        curve, u = here
        return self.radius - curve.point(u)[1] - sqrt(sum(v * v for v in d) - along**2)


def gap(wheel, p, n):
    """t of the first crossing, or None."""
    depth = lambda t: wheel.depth([u + t * v for u, v in zip(p, n)])
    here, t = depth(mpf(0)), mpf(0)
    if here is None:
        return None
    if here == 0:
        return t
    sign = 1 if here < 0 else -1
    # The first step is divided, so that a gap of nanometres has a bracket of its own size.
    steps = [mpf(10) ** -k for k in range(30, 2, -1)] + [STEP] * int(REACH / STEP)
    for step in steps:
        following = t + sign * step
        there = depth(following)
        if there is None:
            return None
        if here * there <= 0:
            return root(depth, *sorted((t, following)))
        here, t = there, following
    return None


def values(scene):
    splined = any(d["kind"] == "spline" for d in scene["rail"] + scene["wheel"])
    rail, wheel = ([Curve(d) for d in (scene[k] if splined else closed(scene[k]))] for k in ("rail", "wheel"))
    rail = Rail(rail, mpf(scene["contact_rail_x"]))
    wheel = Wheel(wheel, mpf(scene["wheel_radius"]), mpf(scene["contact_wheel_x"]), mpf(scene["chi"]))
    n = lambda v: None if v is None else nstr(v, 25)
    rows = []
    for sigma in scene["xi"]:
        station = rail.station(sigma)
        for eta in scene["eta"]:
            if station is None:
                rows.append([sigma, eta, None, None, None, None])
                continue
            xi, zeta, alpha = station
            t = gap(wheel, (xi, mpf(eta), zeta), (-sin(alpha), mpf(0), cos(alpha)))
            if sigma == 0 and eta == 0:
                t = mpf(0)
            rows.append([sigma, eta, n(t), n(alpha), n(xi), n(zeta)])
    return {"scene": scene, "theta_rail": n(rail.theta), "normal_gap": rows}


def corner():
    """A gauge corner of 13 mm between a crown of 80 mm and a face, in binary numbers near a smooth drawing."""
    return [
        {"kind": "line", "x0": -15.0, "z0": -15.2, "x1": -12.0, "z1": -8.0},
        {"kind": "arc", "x0": -12.0, "x1": 5.0, "a": 0.0, "b": -13.0, "r": 13.0, "sigma": 1},
        {"kind": "arc", "x0": 5.0, "x1": 20.0, "a": -25.76923076923077, "b": -74.84615384615384, "r": 80.0, "sigma": 1},
    ]


def root_of(r, tread=None):
    """A flange root of radius r between a flange of slope 12/5 and a tread of slope -5/12, or an arc of 330 mm."""
    x0, x1, z0, z1 = -r * 12 / 13, r * 5 / 13, r * 5 / 13 - r, r * 12 / 13 - r
    last = {"kind": "line", "x0": x1, "z0": z1, "x1": x1 + 24.0, "z1": z1 - 10.0}
    if tread:
        last = {"kind": "arc", "x0": x1, "x1": x1 + 24.0, "a": x1 - tread * 5 / 13, "b": z1 - tread * 12 / 13,
                "r": tread, "sigma": 1}
    return [
        {"kind": "line", "x0": x0 - 4.0, "z0": z0 - 9.6, "x1": x0, "z1": z0},
        {"kind": "arc", "x0": x0, "x1": x1, "a": 0.0, "b": -r, "r": r, "sigma": 1},
        last,
    ]


def scenes():
    profiles = json.load(open(os.path.join(HERE, "..", "reference_yawed", "yawed_profiles.json")))
    spline = json.load(open(os.path.join(HERE, "..", "reference_spline", "gauge_corner.json")))["scene"]
    eta = [-8.0, -1e-2, 0.0, 1e-3, 3.0, 9.0]
    out = {}

    def add(name, title, rail, wheel, points, sigma, eta=eta, radius=460.0, chi=0.0):
        out[name] = {
            "title": title, "rail": rail, "wheel": wheel, "wheel_radius": radius, "contact_rail_x": points[0],
            "contact_wheel_x": points[1], "chi": chi, "xi": sigma, "eta": eta, "delta": [],
        }

    near = [-3.0, -0.6, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 0.5, 4.0]
    for r in (13.5, 14.0, 15.0):
        add(f"corner_13_root_{r:g}", f"gauge corner of 13 mm in a flange root of {r:g} mm, contact at 30 degrees",
            corner(), root_of(r), [-6.5, -r / 2], near + [-6.0, -8.5, 9.0, 11.0, 14.0, 20.0])
    add("corner_at_45", "concave wheel over a convex rail at 45 degrees", corner(), root_of(14.0, 330.0),
        [-9.25, -9.9375], near + [-4.5, -5.0, 8.0, 12.0, 18.0])
    add("equal_to_1e-9", "arcs equal to 1e-9", corner(), root_of(13.0 * (1 + 1e-9)), [-6.5, -6.5], near + [-5.0, 9.0])
    add("two_joints", "60E1 under the root of S1002, contact beside a joint: the patch lies over two joints",
        profiles["60E1"], profiles["S1002"], [-26.25, -33.5],
        near + [-8.0, -6.0, 0.25, 1.5, 2.5, 8.0, 12.0])
    add("60E1_S1002_root", "60E1 gauge corner in the flange root of S1002", profiles["60E1"], profiles["S1002"],
        [-32.5, -36.5], near + [-5.0, -1.5, 1.75, 2.5, 9.5, 14.0])
    add("yawed_corner_13_root_14", "gauge corner of 13 mm in a flange root of 14 mm, skew 0.02", corner(), root_of(14.0),
        [-6.5, -7.0], near + [-6.0, 9.0, 11.0, 14.0], chi=0.02)
    add("yawed_60E1_S1002_root", "60E1 gauge corner in the flange root of S1002, skew 0.02", profiles["60E1"],
        profiles["S1002"], [-32.5, -36.5], near + [-1.5, 1.75, 9.5], chi=0.02)
    points = [spline["contact_rail_x"], spline["contact_wheel_x"]]
    add("measured_corner", "gauge corner and flange root as cubic splines, as fitted to measured points", spline["rail"],
        spline["wheel"], points, [-1.7, -0.31, -1e-3, 1e-4, 0.013, 0.27, 0.9, 2.3, 4.6], [-6.0, 1e-3, 0.0, 4.0],
        radius=spline["wheel_radius"])
    add("yawed_measured_corner", "the same, skew 0.02", spline["rail"], spline["wheel"], points,
        [-1.7, -1e-3, 1e-4, 0.27, 2.3], [-6.0, 1e-3, 4.0], radius=spline["wheel_radius"], chi=0.02)
    return out


def write(path, out):
    """One line for each value, so that changes can be seen."""
    with open(path, "w") as file:
        head = {k: v for k, v in out.items() if k != "normal_gap"}
        rows = ",\n".join("  " + json.dumps(row) for row in out["normal_gap"])
        file.write(json.dumps(head, indent=1)[:-2] + f',\n "normal_gap": [\n{rows}\n ]\n}}\n')


if __name__ == "__main__":
    for name, scene in scenes().items():
        if len(sys.argv) < 3 or name in sys.argv[2:]:
            write(os.path.join(sys.argv[1], name + ".json"), values(scene))
