#!/usr/bin/env python3
"""Writes the hard cases of this folder: scenes and their 60-digit values.

Separation and boundary come from ../reference/reference.py, which shares no formula with the program. Added
here, also in 60 digits: the parts of the patch with their tips, from the midplane gap alone.

Each case has
  title, provenance  what it is and where it comes from
  status             "holds", or "expected-failure": all checks fail or some do, and the suite tells when none does
  unit               length that absolute bounds are multiplied by (4^k of a scaled case)
  report_newton      what the Report's own iteration gives at these points: `undefined` points without a value,
                     largest errors as bounds that hold and are not slack, and a remark
  relation           the case that this one must agree with, and how
  scene, separation, boundary
                     as in ../reference; null where there is no surface, or no boundary
  patches            per approach and window: parts with extent in xi, kind of their ends, |ds/dxi| there
                     (null where the end is not a tip), whether the window cuts them

Usage: generate.py [CASE ...]   (not needed to run the tests; needs mpmath)
"""
import json, pathlib, sys
from math import sqrt as fsqrt, sin as fsin, cos as fcos, tan as ftan, radians

HERE = pathlib.Path(__file__).parent
FOLDER = HERE.parents[1] / "crates/report/src/hard_cases"
sys.path.insert(0, str(HERE.parent / "reference"))
from reference import M, boundary_eta, mp, mpf, separation, sqrt

SCAN = 240  # intervals in which tips are looked for; every case keeps its tips farther apart than one


def line(x0, z0, x1, z1):
    return {"kind": "line", "x0": x0, "z0": z0, "x1": x1, "z1": z1}


def arc(x0, x1, a, b, r, sigma=1):
    return {"kind": "arc", "x0": x0, "x1": x1, "a": a, "b": b, "r": r, "sigma": sigma}


def through(x, z, slope, x0, x1):
    """The line through a point."""
    return line(x0, z + slope * (x0 - x), x1, z + slope * (x1 - x))


def standard(body):
    """UIC60 rail or EN 15302 wheel A, as in the reference scene."""
    path = HERE.parents[1] / "crates/report/src/reference/UIC60_EN15302A_root.json"
    return json.loads(path.read_text())["scene"][body]


def scene(rail, wheel, radius, rail_x, wheel_x, xi, eta, delta):
    return {"rail": rail, "wheel": wheel, "wheel_radius": radius, "contact_rail_x": rail_x,
            "contact_wheel_x": wheel_x, "xi": xi, "eta": eta, "delta": delta}


CROWN = [arc(-40, 40, 0, -300, 300)]
HOLLOW = [arc(-40, 40, 0, -330, 330)]
CORNER = [arc(-12.99, 12, 0, 0, 13)]


def hollow(xi, eta, delta):
    return scene(CROWN, HOLLOW, 460.0, 10.0, 11.0, xi, eta, delta)


def one_joint(radius=200.0):
    """A 14 mm throat that goes over into a line at 70 degrees, smoothly."""
    s, c = fsin(radians(70)), fcos(radians(70))
    wheel = [through(-14 * s, 14 * c, s / c, -18.0, -14 * s), arc(-14 * s, 0, 0, 0, 14)]
    return scene(CORNER, wheel, radius, -11.5, -12.5, [-1.5, -1.2, -1.0, -0.8, 0.0, 1.0],
                 [0, 5, 10, 15, 20], [0.05])


def two_joints():
    """70 degree line, 0.6 mm of a 14 mm arc, line of the arc's last tangent: contact on the latter."""
    s, c = fsin(radians(70)), fcos(radians(70))
    t, d = fsin(radians(67.5)), fcos(radians(67.5))
    wheel = [through(-14 * s, 14 * c, s / c, -18.0, -14 * s), arc(-14 * s, -14 * t, 0, 0, 14),
             through(-14 * t, 14 * d, t / d, -14 * t, -8.0)]
    return scene(CORNER, wheel, 200.0, -12.0, -12.8, [-0.8, -0.2, 0.0, 0.5, 1.0], [0, 6, 12, 20, 30], [0.05])


def two_bumps(second):
    """Two 60 mm crowns 12 mm apart, the right one's centre at height `second`, with the valley's kink between."""
    lo, hi = -1.0, 1.0
    f = lambda x: (-60 + fsqrt(3600 - (x + 6) ** 2)) - (second + fsqrt(3600 - (x - 6) ** 2))
    while hi - lo > 1e-15:
        mid = (lo + hi) / 2
        lo, hi = (mid, hi) if f(mid) > 0 else (lo, mid)
    return [arc(-16, lo, -6, -60, 60), arc(lo, 16, 6, second, 60)]


def mirrored(s):
    def m(g):
        if g["kind"] == "line":
            return line(-g["x1"], g["z1"], -g["x0"], g["z0"])
        return arc(-g["x1"], -g["x0"], -g["a"], g["b"], g["r"], g["sigma"])
    return dict(s, rail=[m(g) for g in reversed(s["rail"])], wheel=[m(g) for g in reversed(s["wheel"])],
                contact_rail_x=-s["contact_rail_x"], contact_wheel_x=-s["contact_wheel_x"],
                xi=[-v for v in reversed(s["xi"])])


def scaled(s, f):
    size = lambda v: [size(w) for w in v] if isinstance(v, list) else v * f
    grow = lambda g: {k: v if k in ("kind", "sigma") else v * f for k, v in g.items()}
    out = {k: size(v) for k, v in s.items() if k not in ("rail", "wheel")}
    return dict(out, rail=[grow(g) for g in s["rail"]], wheel=[grow(g) for g in s["wheel"]])


def split(s, rail_x, wheel_x):
    def cut(segments, x):
        (g,) = segments
        return [dict(g, x1=x), dict(g, x0=x)]
    return dict(s, rail=cut(s["rail"], rail_x), wheel=cut(s["wheel"], wheel_x))


CURVATURE_JUMP = scene(standard("rail"), HOLLOW, 460.0, 8.0, 8.8,
                       [-8.0, -4.0, -1.0, 0.0, 1.0, 2.4, 2.6, 4.0, 8.0], [0, 1, 4, 10], [0.05])
WINDOW = hollow([-2.0, -1.5, -0.5, 0.0, 0.7, 1.5, 2.0], [0, 0.5, 1.5], [0.05])
OWN = "made for this suite"
NO_HOLE = (
    "The issue asks for a patch with a hole. Without skew there is none. At fixed xi the wheel's height over the "
    "sagitta e has the slope cos(theta) - sin(theta) tan(psi) = cos(phi)/cos(psi), where psi is the tangent's angle "
    "in the contact frame and phi = psi + theta the one in the profile's own axes; cos(psi) > 0 on the sheet that "
    "faces the rail, and cos(phi) > 0 since the profile is a function z(x). So s rises with |eta|, and the slice "
    "{eta: s < delta} is empty or one interval about eta = 0. A point outside the patch then has a ray along its own "
    "xi, away from eta = 0, that never meets the patch, so that it belongs to the unbounded part of the complement: "
    "there is no hole. A dip of the rail deeper than the approach divides the patch in xi instead. Checked: two "
    "parts, and s rising along every column.")

# name: (title, provenance, scene, further keys)
CASES = {
    "within_one_nanometre_of_c": (
        "300 mm crown under a 330 mm hollow tread, within 1 nm of C", OWN + "; erratum 7",
        hollow([-1e-6, -3e-7, 0.0, 1.7e-7, 1e-6], [0, 1e-7, 1e-6], [1e-13]), {}),
    "conforming_to_1e-9": (
        "radii equal to 1e-9", OWN,
        scene(CROWN, [arc(-40, 40, 0, -300.0000003, 300.0000003)], 460.0, -12.0, -12.5,
              [-10.0, -3.0, -0.3, 0.0, 0.17, 1.0, 10.0], [0, 0.01, 5], [1e-9, 1e-4]), {}),
    "radius_of_one_kilometre": (
        "1 km rail crown under a 1 km convex tread", OWN,
        scene([arc(-40, 40, 0, -1e6, 1e6)], [arc(-40, 40, 0, 1e6, 1e6, -1)], 460.0, 5.0, 7.0,
              [-30.0, -3.0, -0.01, 0.0, 0.001, 1.0, 30.0], [0, 0.01, 10], [1e-4]), {}),
    "flange_at_70_degrees": (
        "gauge corner R13 in a throat R14 at 70 degrees", OWN,
        scene([arc(-12.99, 0, 0, 0, 13)], [arc(-13.95, 0, 0, 0, 14)], 460.0, -13 * fsin(radians(70)),
              -14 * fsin(radians(70)), [-2.0, -1.0, -0.2, 0.0, 0.3, 1.0, 3.0], [0, 1, 4, 8], [0.01, 0.05]), {}),
    "contact_on_a_joint": (
        "contact point on the joint of R300 and R80 of UIC60", OWN + "; rail as in UIC 861-3",
        scene(standard("rail"), HOLLOW, 460.0, 10.5, 11.55, [-6.0, -2.0, -0.1, 0.0, 0.1, 2.0, 6.0],
              [0, 1, 4, 10], [0.01, 0.05]), {}),
    "contact_on_a_kink": (
        "contact point on a kink of the tread, 1:20 to 1:10", OWN + "; the tangent is that of the left segment",
        scene(CROWN, [line(-40, -2.0, 0, 0.0), line(0, 0.0, 40, 4.0)], 460.0, -15.0, 0.0,
              [-6.0, -2.0, -0.1, 0.0, 0.1, 2.0, 6.0], [0, 1, 4, 10], [0.01, 0.05]), {}),
    "contact_at_a_profile_end": (
        "contact point on the last point of the rail", OWN,
        scene([arc(-36, 10, 0, -300, 300)], HOLLOW, 460.0, 10.0, 11.0, [-6.0, -2.0, 0.0, 0.1, 2.0],
              [0, 1, 4, 10], [0.05]), {}),
    "curvature_jump_under_the_window": (
        "R300 to R80 of UIC60 2.5 mm from C", OWN + "; rail as in UIC 861-3", CURVATURE_JUMP, {}),
    "columns_cross_one_joint": ("throat R14 to a 70 degree line inside the columns",
                                OWN + "; erratum 6", one_joint(), {}),
    "columns_cross_two_joints": ("line, 0.6 mm of arc, line inside one column", OWN + "; erratum 6",
                                 two_joints(), {}),
    "rail_overhangs": (
        "UIC60 in the frame of its gauge corner at 50 degrees: the field side turns vertical and overhangs",
        OWN + "; rail as in UIC 861-3",
        scene(standard("rail"), [through(0.0, 0.0, ftan(radians(50)), -30.0, 60.0)], 460.0, -33.0, 0.0,
              [-2.0, 0.0, 2.0, 20.0, 38.0, 41.0, 44.0, 46.0, 48.0, 60.0], [0, 2, 6], [0.05]), {}),
    "wheel_overhangs": (
        "EN 15302 wheel A in the frame of its flange at 68 degrees: the flange tip turns vertical",
        OWN + "; wheel as in EN 15302:2010",
        scene([through(0.0, 0.0, ftan(radians(68)), -30.0, 30.0)], standard("wheel"), 460.0, 0.0, -40.5,
              [-19.0, -17.0, -16.6, -16.3, -16.0, -15.0, -13.0, -11.0, -5.0, 0.0, 0.5, 1.0], [0, 5, 15, 40], [0.05]), {}),
    "approach_zero": ("approach 0: no patch", OWN, hollow([-1.0, 0.0, 0.5], [0, 1], [0.0]), {}),
    "approach_1e-9": ("approach of a picometre: a patch of 7 um by 4 um", OWN,
                      hollow([-0.005, -0.003, -0.001, 0.0, 0.002, 0.005], [0, 0.0005, 0.002], [1e-9]), {}),
    "approach_beyond_the_window": ("approach of 1 mm: the patch covers the window", OWN,
                                   hollow([-2.0, -1.0, 0.0, 2.0], [0, 1, 2], [1.0]), {}),
    "two_patches": ("two crowns: one, two and again one part of the patch", OWN,
                    scene(two_bumps(-60.02), [line(-40, 0.0, 40, 0.0)], 460.0, -6.0, 0.0,
                          [-5.0, -2.5, 0.0, 5.0, 10.0, 13.5, 17.0], [0, 1, 5, 25], [0.01, 0.05, 0.5]), {}),
    "no_hole": ("a dip of the rail under a hollow tread of a small wheel", NO_HOLE,
                scene(two_bumps(-60.0), [arc(-30, 30, 0, -400, 400)], 150.0, -7.059, -7.0587,
                      [-4.0, -2.0, 0.0, 3.0, 7.0, 11.0, 14.0, 16.0], [0, 1, 5, 15], [0.02, 0.1]), {}),
    "patch_cut_by_the_window": ("window of 4 mm by 3 mm inside a patch of 36 mm by 13 mm", OWN, WINDOW, {}),
    "wheel_radius_20_mm": (
        "wheel of 20 mm radius", OWN,
        scene([arc(-12, 12, 0, -13, 13)], [arc(-12, 12, 0, -14, 14)], 20.0, -5.0, -5.5,
              [-3.0, -1.0, 0.0, 0.5, 2.0, 4.0], [0, 1, 4, 8], [0.05, 0.5]), {}),
    "wheel_radius_100_m": (
        "wheel of 100 m radius", OWN,
        scene(CROWN, HOLLOW, 1e5, 10.0, 11.0, [-9.0, -3.0, 0.0, 1.0, 9.0], [0, 1, 10, 100], [0.01, 0.05]), {}),
    "lengths_times_4_to_20": (
        "all lengths of the curvature jump times 4^20", OWN, scaled(CURVATURE_JUMP, 4.0 ** 20),
        {"unit": 4.0 ** 20, "relation": {"to": "curvature_jump_under_the_window", "kind": "scaled"}}),
    "lengths_times_4_to_minus_20": (
        "all lengths of the curvature jump times 4^-20", OWN, scaled(CURVATURE_JUMP, 4.0 ** -20),
        {"unit": 4.0 ** -20, "relation": {"to": "curvature_jump_under_the_window", "kind": "scaled"}}),
    "mirrored": (
        "columns_cross_one_joint under x -> -x", OWN, mirrored(one_joint()),
        {"relation": {"to": "columns_cross_one_joint", "kind": "mirrored"}}),
    "arcs_split_in_two": (
        "patch_cut_by_the_window with both arcs split 1 mm from C", OWN, split(WINDOW, 11.0, 10.0),
        {"relation": {"to": "patch_cut_by_the_window", "kind": "same"}}),
    "eta_reversed": (
        "both signs of eta, on an axis that is not symmetric", OWN,
        hollow([-6.0, -1.0, 0.0, 2.0], [-10, -4, -1, 0, 1, 4, 10, 12], [0.05]),
        {"relation": {"to": "eta_reversed", "kind": "eta-reversed"}}),
}

# What the Report's method gives: undefined points, bounds of the errors [mm, 1], why. Found by running the program's
# report-newton at the points of each case; `cargo test hard_cases` tells when a line no longer holds.
CANCELS = "(6.13) cancels: noise of 1e-13 mm at any s"
REPORT_NEWTON = {
    "within_one_nanometre_of_c": (0, 4e-15, 16.0, "no digit is right: s is 1e-16 mm, the noise more"),
    "conforming_to_1e-9": (0, 1e-13, 0.3, "the gap of 1e-10 mm drowns in the noise of two heights of 0.2 mm"),
    "radius_of_one_kilometre": (0, 2e-10, 80.0, "b + sqrt(R^2 - x^2) with R = 1e6 leaves 1e-10 mm; no digit near C"),
    "flange_at_70_degrees": (0, 5e-14, 6e-11, CANCELS),
    "contact_on_a_joint": (0, 7e-14, 1.5, CANCELS + "; the joint's own step of 1e-14 mm is lost"),
    "contact_on_a_kink": (0, 1e-13, 6e-10, CANCELS),
    "contact_at_a_profile_end": (0, 1.3e-13, 2e-11, CANCELS + "; no value beyond the end, as it should be"),
    "curvature_jump_under_the_window": (0, 1.2e-13, 1.2e-10, CANCELS),
    "columns_cross_one_joint": (0, 2.4e-14, 6e-12, CANCELS + "; right only since the segment is sought anew at each iterate"),
    "columns_cross_two_joints": (0, 1.4e-14, 2.2e-13, CANCELS + "; right only since the segment is sought anew at each iterate"),
    "rail_overhangs": (0, 5e-14, 5e-12, CANCELS),
    "wheel_overhangs": (0, 3.6e-13, 6e-13, CANCELS + "; an iterate that leaves the flange tip ends in no value, which is right here"),
    "approach_zero": (0, 4e-14, 3.5e-10, CANCELS + "; (7.3) has a negative radicand from rounding at C"),
    "approach_1e-9": (0, 7e-14, 1.8e-4, CANCELS + "; four digits are left in a patch of 7 um"),
    "approach_beyond_the_window": (0, 7e-14, 1.2e-10, CANCELS),
    "two_patches": (0, 4e-14, 7e-12, CANCELS + "; INTERPEN takes one patch only"),
    "no_hole": (0, 6e-14, 3.6e-10, CANCELS + "; INTERPEN takes one patch only"),
    "patch_cut_by_the_window": (0, 8e-14, 4e-10, CANCELS),
    "wheel_radius_20_mm": (0, 6e-15, 9e-12, CANCELS),
    "wheel_radius_100_m": (0, 1.5e-11, 3e-6, "the noise of F at R = 1e5 exceeds the tolerance of 1e-12 mm: Newton does not settle at four points, whose values are those of the sagitta form"),
    "lengths_times_4_to_20": (0, 1.2e-13, 1.2e-10, CANCELS + "; scales exactly too"),
    "lengths_times_4_to_minus_20": (0, 1.2e-13, 1.2e-10, CANCELS + "; scales exactly too"),
    "mirrored": (0, 2.4e-14, 6e-12, CANCELS),
    "arcs_split_in_two": (0, 8e-14, 4e-10, CANCELS),
    "eta_reversed": (0, 1.3e-13, 1.2e-10, CANCELS),
}


def profile_height(profile, f, xi, best):
    """The outermost sheet of a plain profile in a frame: quadratic at most."""
    found = []
    for s in profile.segs:
        if s.kind == "line":
            den = f.c + s.m * f.s
            roots = [] if den == 0 else [(s.m * (f.xc + xi * f.c) + s.k - f.zc - xi * f.s) / den]
        else:
            X, Z = f.xc + xi * f.c - s.a, f.zc + xi * f.s - s.b
            B, C = -X * f.s + Z * f.c, X ** 2 + Z ** 2 - s.r ** 2
            D = B * B - C
            roots = [] if D < 0 else [-B + sqrt(D), -B - sqrt(D)]
        for r in roots:
            x, z = f.x(xi, r), f.z(xi, r)
            if s.has(x) and (s.kind == "line" or s.sg * (z - s.b) >= -mpf(10) ** -40):
                found.append(r)
    return best(found) if found else None


def cut(f, a, b):
    """Where f changes its (non-numerical) value between a and b."""
    left = f(a)
    for _ in range(160):
        mid = (a + b) / 2
        if f(mid) == left:
            a = mid
        else:
            b = mid
    return (a + b) / 2


def patch(parts, delta, window):
    _, rail, wheel, R, fr, fw = parts
    delta = M(delta)

    def gap(xi):
        zr, zw = profile_height(rail, fr, xi, max), profile_height(wheel, fw, xi, min)
        return None if zr is None or zw is None else zw - zr

    def state(xi):
        g = gap(xi)
        # At C, g is zero up to a residue of the arithmetic.
        return "void" if g is None else "in" if g < delta - mpf(10) ** -40 else "out"

    a, b = (M(v) for v in window["xi"])
    points = [a + (b - a) * k / SCAN for k in range(SCAN + 1)]
    if a < 0 < b:
        points = sorted(points + [mpf(0)])  # C itself
    events = []  # (xi, kind of end)
    for p, q in zip(points, points[1:]):
        s, t = state(p), state(q)
        if s != t and "in" in (s, t):
            events.append((cut(state, p, q), "profile-end" if "void" in (s, t) else "tip"))
    if state(a) == "in":
        events.insert(0, (a, "window"))
    if state(b) == "in":
        events.append((b, "window"))
    step = mpf(10) ** -25 * (b - a)
    slope = lambda xi: abs(gap(xi + step) - gap(xi - step)) / (2 * step)
    out = []
    for (x0, k0), (x1, k1) in zip(events[::2], events[1::2]):
        inner = [boundary_eta(parts, x0 + (x1 - x0) * k / 64, delta) for k in range(1, 64)]
        wide = any(v is not None and v > window["eta"][1] for v in inner)
        out.append({"xi": [n(x0), n(x1)], "ends": [k0, k1],
                    "slope": [n(slope(x)) if k == "tip" else None for x, k in ((x0, k0), (x1, k1))],
                    "cut_by_window": wide or "window" in (k0, k1)})
    return out


def n(v):
    return None if v is None else mp.nstr(v if abs(v) > mpf(10) ** -35 else mpf(0), 25)


def boundary(parts, xi, delta):
    if xi == 0 and delta == 0:
        return mpf(0)  # the patch is the point C, where rounding decides on which side of 0 eta^2 lies
    return boundary_eta(parts, M(xi), M(delta))


def solve(name):
    title, provenance, s, more = CASES[name]
    parts = separation(s)
    values = [[xi, eta, n(parts[0](M(xi), M(eta)))] for xi in s["xi"] for eta in s["eta"]]
    edges = [[d, xi, n(boundary(parts, xi, d))] for d in s["delta"] for xi in s["xi"]]
    eta = float(max(abs(v) for v in s["eta"]))
    window = {"xi": [min(s["xi"]), max(s["xi"])], "eta": [-eta, eta]}
    patches = [{"delta": d, "window": window, "components": patch(parts, d, window)} for d in s["delta"]]
    out = {"title": title, "provenance": provenance, "status": "holds", **more,
           "report_newton": report_newton(name), "scene": dict(s, title=title),
           "separation": values, "boundary": edges, "patches": patches}
    return "{\n" + ",\n".join(f' "{k}": {pretty(k, v)}' for k, v in out.items()) + "\n}\n"


def report_newton(name):
    undefined, absolute, relative, remark = REPORT_NEWTON.get(name, (0, 0.0, 0.0, ""))
    return {"undefined": undefined, "max_abs_error_mm": absolute, "max_rel_error": relative, "remark": remark}


def pretty(key, value):
    if key in ("separation", "boundary", "patches"):
        return "[\n  " + ",\n  ".join(json.dumps(row) for row in value) + "\n ]"
    if key == "scene":
        return "{\n  " + ",\n  ".join(f'"{k}": {json.dumps(v)}' for k, v in value.items()) + "\n }"
    return json.dumps(value)


if __name__ == "__main__":
    for name in sys.argv[1:] or CASES:
        (FOLDER / f"{name}.json").write_text(solve(name))
        print(name, file=sys.stderr)
