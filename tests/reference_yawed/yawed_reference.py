#!/usr/bin/env python3
"""60-digit separations and interpenetration boundaries of yawed and rolled wheels, by three-dimensional geometry.

Independent of the program: no sagitta, no outline, no expansion. The wheel is its axle (a point and a direction in
space) and the surfaces that its profile sweeps about it; the line along zeta through (xi, eta) is intersected with
the cone (quadratic), torus (quartic) or polynomial surface (bracketed root) of every segment.

Conventions (mm, rad): x to the field side, y forward, z up. The wheel is turned by
A = Ry(roll) Rz(yaw), right-handed, yaw first. Contact frame: origin C, xi along the rail profile's tangent, eta = y,
zeta along the common normal from rail to wheel. Segments as in reference.py of the project's reference values:
  {"kind": "line", "x0", "z0", "x1", "z1"}
  {"kind": "arc", "x0", "x1", "a", "b", "r", "sigma"}: z = b + sigma sqrt(r^2 - (x-a)^2)
  {"kind": "poly", "x0", "x1", "c"}: z = sum c[k] x^k

A scene gives the wheel's contact abscissa, yaw and roll. Newton's method in 60 digits finds the angle about the axle
at which the wheel's normal there has no y component, and the point of the rail with the same normal. This gives
chi, the angle from the rail's xi to the wheel's meridian tangent about zeta, and contact_rail_x. Both are then rounded
to binary64, so that a program can be given exactly the same input; the wheel of the values is the one whose contact
frame, at contact_wheel_x, is turned by the rounded chi against the rail's frame at the rounded contact_rail_x. The
script checks that the wheel turned by yaw and roll gives the same separations to what the rounding explains.

Usage: yawed_reference.py SCENE.json > VALUES.json      one scene
       yawed_reference.py --all DIR                     the scenes kept in this script, into DIR
"""
import json
import os
import sys

from mpmath import atan, atan2, cos, findroot, im, mp, mpf, nstr, polyroots, polyval, re, sin, sqrt

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference"))
from closing import closed  # noqa: E402

mp.dps = 60
TINY = mpf(10) ** -40


class Segment:
    """One segment z(x)."""

    def __init__(self, d):
        self.kind, self.x0, self.x1 = d["kind"], mpf(d["x0"]), mpf(d["x1"])
        if self.kind == "line":
            z0, z1 = mpf(d["z0"]), mpf(d["z1"])
            self.m = (z1 - z0) / (self.x1 - self.x0)
            self.k = z0 - self.m * self.x0
        elif self.kind == "poly":
            self.c = [mpf(v) for v in d["c"]]
        else:
            self.a, self.b, self.r, self.sigma = (mpf(d[k]) for k in ("a", "b", "r", "sigma"))

    def holds(self, x, slack=TINY):
        return self.x0 - slack <= x <= self.x1 + slack

    def z(self, x):
        if self.kind == "line":
            return self.m * x + self.k
        if self.kind == "poly":
            return polyval(self.c[::-1], x)
        return self.b + self.sigma * sqrt(self.r**2 - (x - self.a) ** 2)

    def slope(self, x):
        if self.kind == "line":
            return self.m
        if self.kind == "poly":
            return polyval([k * v for k, v in enumerate(self.c)][:0:-1], x)
        return -self.sigma * (x - self.a) / sqrt(self.r**2 - (x - self.a) ** 2)


def at(segments, x):
    for segment in segments:
        if segment.holds(x):
            return segment
    return None


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def turned(v, yaw, roll):
    """Ry(roll) Rz(yaw) v."""
    x, y, z = v
    x, y = x * cos(yaw) - y * sin(yaw), x * sin(yaw) + y * cos(yaw)
    return (x * cos(roll) + z * sin(roll), y, z * cos(roll) - x * sin(roll))


def real(roots):
    return [re(r) for r in roots if abs(im(r)) < mpf(10) ** -25 * (1 + abs(r))]


def square(p):
    out = [mpf(0)] * (2 * len(p) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(p):
            out[i + j] += a * b
    return out


def sign_changes(f, a, b, n):
    """Simple roots of f on [a, b] from the sign changes on n equal pieces, each to 50 digits."""
    xs = [a + (b - a) * k / n for k in range(n + 1)]
    vs = [f(x) for x in xs]
    out = []
    for x0, x1, v0, v1 in zip(xs, xs[1:], vs, vs[1:]):
        if v0 is None or v1 is None or v0 * v1 > 0:
            continue
        out.append(x0 if v0 == 0 else findroot(f, (x0, x1), solver="anderson", tol=mpf(10) ** -100, verify=False))
    return out


class Wheel:
    """A wheel in the rail's contact frame: axle through q along the unit vector a; x_q is q's profile abscissa."""

    def __init__(self, segments, radius, q, a, x_q):
        self.segments, self.radius, self.q, self.a, self.x_q = segments, radius, q, a, x_q

    def abscissa(self, p):
        return self.x_q + dot([u - v for u, v in zip(p, self.q)], self.a)

    def distance(self, p):
        """From the axle."""
        d = [u - v for u, v in zip(p, self.q)]
        return sqrt(dot(d, d) - dot(d, self.a) ** 2)

    def zeta(self, xi, eta):
        """Lowest point of the wheel on the line along zeta through (xi, eta)."""
        a, d = self.a, [xi - self.q[0], eta - self.q[1], -self.q[2]]
        # Polynomials in zeta, low order first: abscissa, squared distance from the axle.
        x = [self.x_q + dot(d, a), a[2]]
        along = square([dot(d, a), a[2]])
        rho2 = [dot(d, d) - along[0], 2 * d[2] - along[1], 1 - along[2]]
        best = None
        for s in self.segments:
            for root in self.hits(s, x, rho2):
                foot = x[0] + x[1] * root
                if not s.holds(foot, mpf(10) ** -25) or root > self.q[2]:
                    continue
                rho = self.radius - s.z(min(max(foot, s.x0), s.x1))
                if abs(polyval(rho2[::-1], root) - rho**2) > mpf(10) ** -20 * self.radius**2:
                    continue
                best = root if best is None or root < best else best
        return best

    def hits(self, s, x, rho2):
        if s.kind == "line":
            rho = square([self.radius - s.k - s.m * x[0], -s.m * x[1]])
            c = [u - v for u, v in zip(rho2, rho)]
            return real(polyroots(c[::-1], maxsteps=300, extraprec=400))
        if s.kind == "poly":
            f = lambda t: self.radius - s.z(x[0] + x[1] * t) - sqrt(polyval(rho2[::-1], t))
            low, high = sorted((v - x[0]) / x[1] for v in (s.x0, s.x1)) if abs(x[1]) > TINY else (-REACH, REACH)
            low, high = max(low, -REACH), min(high, REACH)
            return sign_changes(f, low, high, 24) if low < high else []
        # Torus: (rho^2 + c^2 + (x - a)^2 - r^2)^2 = 4 c^2 rho^2 with c the distance of the centre ring.
        c = self.radius - s.b
        side = square([x[0] - s.a, x[1]])
        k = [u + v for u, v in zip(rho2, side)]
        k[0] += c**2 - s.r**2
        quartic = square(k)
        for i in range(3):
            quartic[i] -= 4 * c**2 * rho2[i]
        return real(polyroots(quartic[::-1], maxsteps=500, extraprec=600))


# Points farther than this along zeta from C are of no interest [mm].
REACH = mpf(15)


class Rail:
    """The rail's profile in its contact frame at abscissa x_c."""

    def __init__(self, segments, x_c):
        s = at(segments, x_c)
        self.segments, self.x_c, self.z_c = segments, x_c, s.z(x_c)
        self.theta = atan(s.slope(x_c))

    def zeta(self, xi):
        """Highest point of the rail at xi."""
        c, s = cos(self.theta), sin(self.theta)
        best = None
        for g in self.segments:
            if g.kind == "line":
                den = c + g.m * s
                roots = [(g.m * (self.x_c + xi * c) + g.k - self.z_c - xi * s) / den]
            elif g.kind == "arc":
                x, z = self.x_c + xi * c - g.a, self.z_c + xi * s - g.b
                half, rest = z * c - x * s, x**2 + z**2 - g.r**2
                root = half**2 - rest
                roots = [] if root < 0 else [-half + sqrt(root), -half - sqrt(root)]
            else:
                f = lambda x: (x - self.x_c) * c + (g.z(x) - self.z_c) * s - xi
                feet = sign_changes(f, g.x0, g.x1, 64)
                roots = [(g.z(x) - self.z_c) * c - (x - self.x_c) * s for x in feet]
            for root in roots:
                x, z = self.x_c + xi * c - root * s, self.z_c + xi * s + root * c
                if g.holds(x) and abs(g.z(x) - z) < mpf(10) ** -25:
                    best = root if best is None or root > best else best
        return best


def contact(rail, wheel, wheel_x, yaw, roll, guess):
    """Angle about the axle, rail abscissa, and the wheel's triad (axle, up, forward) in track axes."""
    segment = at(wheel, wheel_x)
    theta = atan(segment.slope(wheel_x))
    axle, up, forward = (turned(v, yaw, roll) for v in ((1, 0, 0), (0, 0, 1), (0, 1, 0)))

    def normal(omega):
        """Out of the rail, into the wheel, at angle omega from the lowest meridian, forward positive."""
        inward = [cos(omega) * u - sin(omega) * f for u, f in zip(up, forward)]
        return [cos(theta) * i - sin(theta) * a for i, a in zip(inward, axle)]

    def misfit(omega, x):
        slope = at(rail, x).slope(x)
        n = normal(omega)
        return [n[1], n[0] + slope * n[2]]

    omega, rail_x = findroot(misfit, (-yaw * segment.slope(wheel_x), guess), tol=mpf(10) ** -100, verify=False)
    assert max(abs(v) for v in misfit(omega, rail_x)) < mpf(10) ** -50
    return omega, rail_x, (axle, up, forward)


def placed_by_angles(wheel, radius, wheel_x, omega, triad, theta_rail):
    """The wheel turned by yaw and roll, in the rail's contact frame."""
    axle, up, forward = triad
    rho = radius - at(wheel, wheel_x).z(wheel_x)
    inward = [cos(omega) * u - sin(omega) * f for u, f in zip(up, forward)]
    frame = ((cos(theta_rail), 0, sin(theta_rail)), (0, 1, 0), (-sin(theta_rail), 0, cos(theta_rail)))
    seen = lambda v: [dot(v, e) for e in frame]
    return Wheel(wheel, radius, [rho * v for v in seen(inward)], seen(axle), wheel_x)


def placed_by_skew(wheel, radius, wheel_x, chi):
    """The wheel whose contact frame is turned by chi about zeta, in the rail's contact frame."""
    segment = at(wheel, wheel_x)
    theta, rho = atan(segment.slope(wheel_x)), radius - segment.z(wheel_x)
    turn = lambda v: [v[0] * cos(chi), v[0] * sin(chi), v[1]]
    up = turn((sin(theta), cos(theta)))
    return Wheel(wheel, radius, [rho * v for v in up], turn((cos(theta), -sin(theta))), wheel_x)


def boundary(wheel, zeta_rail, xi, delta, reach):
    """All eta with s(xi, eta) = delta: the raised rail point is on the wheel."""

    def inside(eta):
        p = (xi, eta, zeta_rail + delta)
        x = wheel.abscissa(p)
        s = at(wheel.segments, x)
        return None if s is None else wheel.radius - s.z(x) - wheel.distance(p)

    return sign_changes(inside, -mpf(reach), mpf(reach), 4 * int(reach))


def values(scene):
    rail = [Segment(d) for d in closed(scene["rail"])]
    wheel = [Segment(d) for d in closed(scene["wheel"])]
    radius, wheel_x = mpf(scene["wheel_radius"]), mpf(scene["contact_wheel_x"])
    yaw, roll = mpf(scene["yaw"]), mpf(scene["roll"])
    omega, rail_x, triad = contact(rail, wheel, wheel_x, yaw, roll, mpf(scene["guess_rail_x"]))
    theta_rail, theta_wheel = atan(at(rail, rail_x).slope(rail_x)), atan(at(wheel, wheel_x).slope(wheel_x))
    # chi from the meridian tangent itself.
    axle, up, forward = triad
    inward = [cos(omega) * u - sin(omega) * f for u, f in zip(up, forward)]
    meridian = [cos(theta_wheel) * a + sin(theta_wheel) * i for a, i in zip(axle, inward)]
    chi = atan2(meridian[1], dot(meridian, (cos(theta_rail), 0, sin(theta_rail))))
    chi_f, rail_x_f = float(nstr(chi, 25)), float(nstr(rail_x, 25))
    exact_rail = Rail(rail, rail_x)
    by_angles = placed_by_angles(wheel, radius, wheel_x, omega, triad, theta_rail)
    exact_skew = placed_by_skew(wheel, radius, wheel_x, chi)
    given_rail, given = Rail(rail, mpf(rail_x_f)), placed_by_skew(wheel, radius, wheel_x, mpf(chi_f))
    n = lambda v: None if v is None else nstr(v, 25)
    kept = {k: v for k, v in scene.items() if k != "guess_rail_x"}
    kept.update(contact_rail_x=rail_x_f, chi=chi_f)
    out = {
        "scene": kept,
        "theta_rail": n(given_rail.theta),
        "theta_wheel": n(theta_wheel),
        "exact_chi": n(chi),
        "exact_rail_x": n(rail_x),
        "y": n(dot(axle, (0, 1, 0)) * wheel_x - (radius - at(wheel, wheel_x).z(wheel_x)) * inward[1]),
        "separation": [],
        "boundary": [],
    }
    for xi in scene["xi"]:
        for eta in scene["eta"]:
            x, e = mpf(xi), mpf(eta)
            zr, zw = given_rail.zeta(x), given.zeta(x, e)
            s = None if zr is None or zw is None else zw - zr
            out["separation"].append([xi, eta, n(s)])
            check(by_angles.zeta(x, e), exact_skew.zeta(x, e), exact_rail.zeta(x), s)
    for delta in scene["delta"]:
        for xi in scene["xi"]:
            zr = given_rail.zeta(mpf(xi))
            roots = [] if zr is None else boundary(given, zr, mpf(xi), mpf(delta), scene["reach"])
            out["boundary"].append([delta, xi, [n(v) for v in roots]])
    return out


def check(by_angles, by_skew, rail, given):
    """Two ways to the same wheel agree in 40 digits; the rounding of chi and rail_x moves s by roundings."""
    if by_angles is None or rail is None:
        assert given is None and by_skew is None or rail is None
        return
    assert abs(by_angles - by_skew) < TINY, (by_angles, by_skew)
    s = by_angles - rail
    assert given is not None and abs(s - given) < mpf(10) ** -13 * (1 + abs(s)), (s, given)


def scenes(here):
    """The scenes kept with the tests; standard profiles come from files of values made by reference.py."""
    cone = [{"kind": "line", "x0": -40.0, "z0": 2.0, "x1": 40.0, "z1": -2.0}]
    crown = [{"kind": "arc", "x0": -40.0, "x1": 40.0, "a": 0.0, "b": -300.0, "r": 300.0, "sigma": 1}]
    profiles = json.load(open(os.path.join(here, "yawed_profiles.json")))
    deltas = [0.01, 0.05, 0.2]
    return {
        "yawed_crown_on_cone": {
            "title": "crown R300 under a cone 1:20, yawed",
            "why": "one arc and one line: the boundary is nearly an ellipse, turned by the yaw",
            "rail": crown, "wheel": cone, "wheel_radius": 460.0, "contact_wheel_x": 3.0, "yaw": 0.0120,
            "roll": 0.0, "guess_rail_x": -15.0, "xi": [-5.0, -1.0, -1e-3, 0.0, 1e-3, 0.5, 2.0, 5.0],
            "eta": [-12.0, -4.0, -1e-2, 0.0, 1e-2, 1.0, 4.0, 12.0], "delta": deltas, "reach": 20,
        },
        "yawed_60E1_S1002_tread": {
            "title": "60E1 under an S1002 tread, yaw 0.0120 and a little roll",
            "why": "a polynomial tread; joints of the rail inside the window",
            "rail": profiles["60E1"], "wheel": profiles["S1002"], "wheel_radius": 460.0, "contact_wheel_x": 1.0,
            "yaw": 0.0120, "roll": -0.0003554, "guess_rail_x": -8.0, "xi": [-6.0, -2.0, -1e-3, 0.0, 1e-3, 3.0, 8.0],
            "eta": [-12.0, -5.0, -1e-2, 0.0, 1e-2, 5.0, 12.0], "delta": deltas, "reach": 20,
        },
        "yawed_flange": {
            "title": "UIC60 gauge corner under the 70 degree flange of EN 15302 wheel A, yaw 0.0240, roll",
            "why": "steep contact, skew of 4 degrees, contact 30 mm behind the wheel's centre",
            "rail": profiles["UIC60"], "wheel": profiles["EN15302-A"], "wheel_radius": 460.0,
            "contact_wheel_x": -39.0, "yaw": 0.0240, "roll": -0.01126431, "guess_rail_x": -35.2,
            "xi": [-2.5, -0.8, -1e-3, 0.0, 1e-3, 0.4, 1.2],
            "eta": [-8.0, -3.0, -1e-2, 0.0, 1e-2, 3.0, 8.0], "delta": deltas, "reach": 30,
        },
    }


def write(path, out):
    """One line for each value, so that changes can be seen."""
    with open(path, "w") as file:
        head = {k: v for k, v in out.items() if k not in ("separation", "boundary")}
        text = json.dumps(head, indent=1)
        rows = {k: ",\n".join("  " + json.dumps(row) for row in out[k]) for k in ("separation", "boundary")}
        file.write(text[:-2] + "".join(f',\n "{k}": [\n{v}\n ]' for k, v in rows.items()) + "\n}\n")


if __name__ == "__main__":
    if sys.argv[1] == "--all":
        for name, scene in scenes(os.path.dirname(os.path.abspath(__file__))).items():
            write(os.path.join(sys.argv[2], name + ".json"), values(scene))
    else:
        json.dump(values(json.load(open(sys.argv[1]))), sys.stdout, indent=1)
