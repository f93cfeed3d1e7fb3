#!/usr/bin/env python3
"""60-digit separations and interpenetration boundaries of profiles made of parametric cubic spans.

In the spirit of ../reference/reference.py and independent of the program: at parameter t of a wheel's span the ring
of radius R - z(t) meets the plane y = eta at height R - sqrt((R - z(t))^2 - eta^2); the t whose point lies over xi is
bracketed and bisected in 60 digits. Conventions, frame and output as there. Segment:
  {"kind": "spline", "t1", "cx", "cz"}: x = sum cx[k] t^k, z = sum cz[k] t^k over 0 <= t <= t1, x ascending with t.
The coefficients are binary64 numbers and taken as exact; joints are then closed to rounding only, and no xi lies on
one.

Usage: spline_reference.py DIR      writes the scenes kept in this script
"""
import json
import math
import os
import sys

from mpmath import cos, atan2, mp, mpf, nstr, polyval, sin, sqrt

mp.dps = 60
HAIR = mpf(10) ** -45


class Span:
    def __init__(self, d):
        self.t1 = mpf(d["t1"])
        self.cx, self.cz = ([mpf(v) for v in d[k]] for k in ("cx", "cz"))

    def x(self, t):
        return polyval(self.cx[::-1], t)

    def z(self, t):
        return polyval(self.cz[::-1], t)

    def angle(self, t):
        slope = lambda c: polyval([k * v for k, v in enumerate(c)][:0:-1], t)
        return atan2(slope(self.cz), slope(self.cx))

    def where(self, g, pieces=8):
        """Every t with g(t) = 0, from sign changes over equal pieces."""
        found = []
        ts = [self.t1 * k / pieces for k in range(pieces + 1)]
        for low, high in zip(ts, ts[1:]):
            a, b = g(low), g(high)
            if a * b > 0:
                continue
            while high - low > HAIR:
                middle = (low + high) / 2
                if (g(middle) > 0) == (a > 0):
                    low = middle
                else:
                    high = middle
            found.append((low + high) / 2)
        return found


def foot(spans, g):
    """(span, t) of all zeros of g(span, t)."""
    return [(s, t) for s in spans for t in s.where(lambda t: g(s, t))]


class Frame:
    def __init__(self, spans, xc):
        self.xc = mpf(xc)
        (span, t), *_ = foot(spans, lambda s, t: s.x(t) - self.xc)
        self.zc, theta = span.z(t), span.angle(t)
        self.c, self.s = cos(theta), sin(theta)

    def xi(self, x, z):
        return (x - self.xc) * self.c + (z - self.zc) * self.s

    def zeta(self, x, z):
        return (z - self.zc) * self.c - (x - self.xc) * self.s


def values(scene):
    rail, wheel = ([Span(d) for d in scene[k]] for k in ("rail", "wheel"))
    radius = mpf(scene["wheel_radius"])
    fr, fw = Frame(rail, scene["contact_rail_x"]), Frame(wheel, scene["contact_wheel_x"])

    def rail_zeta(xi):
        all_ = [fr.zeta(s.x(t), s.z(t)) for s, t in foot(rail, lambda s, t: fr.xi(s.x(t), s.z(t)) - xi)]
        return max(all_, default=None)

    def wheel_zeta(xi, eta):
        lift = lambda s, t: radius - sqrt((radius - s.z(t)) ** 2 - eta**2)
        all_ = foot(wheel, lambda s, t: fw.xi(s.x(t), lift(s, t)) - xi)
        return min((fw.zeta(s.x(t), lift(s, t)) for s, t in all_), default=None)

    def half_width(xi, delta):
        zeta = rail_zeta(xi) + delta
        x, z = fw.xc + xi * fw.c - zeta * fw.s, fw.zc + xi * fw.s + zeta * fw.c
        (s, t), *_ = foot(wheel, lambda s, t: s.x(t) - x)
        square = (radius - s.z(t)) ** 2 - (radius - z) ** 2
        return sqrt(square) if square >= 0 else None

    n = lambda v: None if v is None else nstr(v, 25)
    out = {"scene": scene, "separation": [], "boundary": []}
    for xi in scene["xi"]:
        zr = rail_zeta(mpf(xi))
        for eta in scene["eta"]:
            zw = wheel_zeta(mpf(xi), mpf(eta))
            out["separation"].append([xi, eta, n(None if zw is None or zr is None else zw - zr)])
    for delta in scene["delta"]:
        out["boundary"] += [[delta, xi, n(half_width(mpf(xi), mpf(delta)))] for xi in scene["xi"]]
    return out


def natural(s, y):
    """Coefficients of the natural cubic spline over s, span by span, about each span's beginning."""
    n = len(s) - 1
    h = [s[k + 1] - s[k] for k in range(n)]
    a = [[mpf(0)] * 4 for _ in range(n + 1)]  # lower, diagonal, upper, right side
    a[0][1] = a[n][1] = mpf(1)
    for k in range(1, n):
        rise = (y[k + 1] - y[k]) / h[k] - (y[k] - y[k - 1]) / h[k - 1]
        a[k] = [h[k - 1] / 6, (h[k - 1] + h[k]) / 3, h[k] / 6, rise]
    for k in range(1, n + 1):
        f = a[k][0] / a[k - 1][1]
        a[k][1] -= f * a[k - 1][2]
        a[k][3] -= f * a[k - 1][3]
    g = [mpf(0)] * (n + 1)
    for k in range(n - 1, 0, -1):
        g[k] = (a[k][3] - a[k][2] * g[k + 1]) / a[k][1]
    return [
        [y[k], (y[k + 1] - y[k]) / h[k] - (2 * g[k] + g[k + 1]) * h[k] / 6, g[k] / 2, (g[k + 1] - g[k]) / 6 / h[k]]
        for k in range(n)
    ]


def spline(points):
    points = [(mpf(x), mpf(z)) for x, z in points]
    s = [mpf(0)]
    for (x0, z0), (x1, z1) in zip(points, points[1:]):
        s.append(mpf(float(s[-1] + sqrt((x1 - x0) ** 2 + (z1 - z0) ** 2))))
    x, z = natural(s, [p[0] for p in points]), natural(s, [p[1] for p in points])
    pieces = zip(x, z, s, s[1:])
    flat = lambda c: [float(v) for v in c]
    return [{"kind": "spline", "t1": float(b - a), "cx": flat(cx), "cz": flat(cz)} for cx, cz, a, b in pieces]


def circle(radius, centre, angles, n):
    a, b = angles
    turn = [a + (b - a) * k / n for k in range(n + 1)]
    return [(centre[0] + radius * math.sin(t), centre[1] + radius * math.cos(t)) for t in turn]


def curve(f, a, b, n):
    return [(a + (b - a) * k / n, f(a + (b - a) * k / n)) for k in range(n + 1)]


SCENES = {
    # A worn head under a hollow tread: spans of 1 to 2 mm, columns over several of them.
    "worn_tread": {
        "rail": spline(curve(lambda x: -x * x / 600 - (x / 30) ** 6 + 2e-3 * math.sin(x / 3), -30, 30, 47)),
        "wheel": spline(curve(lambda x: -x / 25 + x * x / 900 + 1e-5 * x**3 + 1e-3 * math.cos(x / 2), -28, 28, 31)),
        "wheel_radius": 460.0, "contact_rail_x": -4.0, "contact_wheel_x": -3.0,
        "xi": [-9.1, -3.3, -0.37, -0.01, 1e-4, 0.2, 1.9, 4.7, 8.3],
        "eta": [0.0, 0.001, 0.5, 3.0, 9.0, 14.0], "delta": [0.05, 0.2],
    },
    # A gauge corner of about 13 mm in a flange root of about 14.5 mm, 60 degrees up: columns move along the profile.
    "gauge_corner": {
        "rail": spline(circle(13.0, (0.0, -13.0), (-1.45, 0.2), 40)),
        "wheel": spline(circle(14.5, (0.4, -14.1), (-1.5, 0.3), 37)),
        "wheel_radius": 420.0, "contact_rail_x": -11.0, "contact_wheel_x": -12.0,
        "xi": [-2.1, -0.6, -0.02, 1e-3, 0.33, 1.7, 4.1],
        "eta": [0.0, 0.01, 1.0, 4.0, 8.0], "delta": [0.03, 0.1],
    },
    # Measured spacing, 0.1 mm: joints everywhere.
    "dense": {
        "rail": spline(curve(lambda x: -x * x / 600, -6, 6, 120)),
        "wheel": spline(curve(lambda x: x / 20 + x * x / 1000, -6, 6, 113)),
        "wheel_radius": 460.0, "contact_rail_x": 0.33, "contact_wheel_x": 0.21,
        "xi": [-4.03, -0.11, -0.003, 0.0217, 0.77, 3.91],
        "eta": [0.0, 0.02, 2.0, 6.0], "delta": [0.02],
    },
}


if __name__ == "__main__":
    for name, scene in SCENES.items():
        with open(os.path.join(sys.argv[1], name + ".json"), "w") as file:
            json.dump(values(scene), file, indent=1)
