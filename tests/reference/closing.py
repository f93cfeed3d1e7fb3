"""Closes a drawn chain in 60 digits, by the rule in src/docs/numerics.md, section 7; shares no code with the program.

A chain whose segments miss each other is bent over w on either side of the joint. Chains that are closed by a crossing are
refused: no scene has one.
"""
from mpmath import atan, cos, mpf, polyval, sin, sqrt

ROUNDING = 16 * mpf(2) ** -52
BEND, SHORTEST, SHARE = mpf(1) / 8, mpf(1) / 8192, mpf(1) / 3


class Curve:
    """A segment as z(x), with stations (x, z, angle)."""

    def __init__(c, d):
        c.d, c.kind = d, d["kind"]
        c.x = [mpf(d["x0"]), mpf(d["x1"])]
        if c.kind == "line":
            z0, z1 = mpf(d["z0"]), mpf(d["z1"])
            c.c = [z0 - (z1 - z0) / (c.x[1] - c.x[0]) * c.x[0], (z1 - z0) / (c.x[1] - c.x[0])]
        elif c.kind == "poly":
            c.c = [mpf(v) for v in d["c"]]
        else:
            c.a, c.b, c.r, c.sigma = (mpf(d[k]) for k in ("a", "b", "r", "sigma"))

    def z(c, x):
        return c.b + c.sigma * sqrt(c.r**2 - (x - c.a) ** 2) if c.kind == "arc" else polyval(c.c[::-1], x)

    def slope(c, x):
        if c.kind == "arc":
            return -c.sigma * (x - c.a) / sqrt(c.r**2 - (x - c.a) ** 2)
        return polyval([k * v for k, v in enumerate(c.c)][:0:-1], x)

    def curvature(c, x):
        if c.kind == "arc":
            return -c.sigma / c.r
        second = polyval([k * (k - 1) * v for k, v in enumerate(c.c)][:1:-1], x) if len(c.c) > 2 else mpf(0)
        return second / (1 + c.slope(x) ** 2) ** mpf("1.5")

    def station(c, x):
        return (x, c.z(x), atan(c.slope(x)))

    def away(c, end, s):
        """Abscissa at the distance s along the segment from its end."""
        x = c.x[end]
        if c.kind == "poly":
            return x + s * cos(atan(c.slope(x)))
        return onward(c.station(x), c.curvature(x), s)[0]

    def cut(c, end, x):
        """The segment with another abscissa at one end."""
        d = dict(c.d)
        d[("x0", "x1")[end]] = x
        if c.kind == "line":
            d[("z0", "z1")[end]] = c.z(x)
        return d

    def bent(c, end, w, length, change):
        """The bent stretch beside an end, and its station at the joint."""
        out = 1 if end else -1
        near = c.away(end, -out * w)
        if c.kind == "poly":
            x = c.x[end]
            speed = 1 / cos(atan(c.slope(x)))
            half = change * speed**3 / 2
            parabola = [half * near**2, -2 * half * near, half]
            n = max(3, len(c.c))
            sums = [(c.c + [mpf(0)] * n)[k] + (parabola + [mpf(0)] * n)[k] for k in range(n)]
            far = near + out * length / speed
            d = {"kind": "poly", "x0": min(near, far), "x1": max(near, far), "c": sums}
            return d, Curve(d).station(far)
        k = c.curvature(near) + change
        x, z, phi = c.station(near)
        far = onward((x, z, phi), k, out * length)
        if k == 0:
            ends = sorted([(x, z), far[:2]])
            return {"kind": "line", "x0": ends[0][0], "z0": ends[0][1], "x1": ends[1][0], "z1": ends[1][1]}, far
        d = {"kind": "arc", "x0": min(x, far[0]), "x1": max(x, far[0]), "a": x - sin(phi) / k, "b": z + cos(phi) / k,
             "r": abs(1 / k), "sigma": -1 if k > 0 else 1}
        return d, far


def onward(station, curvature, s):
    x, z, phi = station
    if curvature == 0:
        return (x + s * cos(phi), z + s * sin(phi), phi)
    end = phi + curvature * s
    return (x + (sin(end) - sin(phi)) / curvature, z + (cos(phi) - cos(end)) / curvature, end)


def seen(p, frame):
    dx, dz = p[0] - frame[0], p[1] - frame[1]
    return (dx * cos(frame[2]) + dz * sin(frame[2]), dz * cos(frame[2]) - dx * sin(frame[2]), p[2] - frame[2])


def miss(left, right):
    a, b = seen(right, left), seen(left, right)
    return ((a[0] - b[0]) / 2, min(a[1], -b[1], key=abs), a[2])


def chord(c):
    return sqrt((c.x[1] - c.x[0]) ** 2 + (c.z(c.x[1]) - c.z(c.x[0])) ** 2)


def joint(left, right, chain, longest):
    """The segments left, bent, bent, right of a joint with a step."""
    along, across, kink = miss(left.station(left.x[1]), right.station(right.x[0]))
    k_left, k_right = left.curvature(left.x[1]), right.curvature(right.x[0])
    share = mpf(1) / 2 if k_left == k_right == 0 else abs(k_right) / (abs(k_left) + abs(k_right))
    left = Curve(left.cut(1, left.away(1, share * along)))
    right = Curve(right.cut(0, right.away(0, (share - 1) * along)))
    along, across, kink = miss(left.station(left.x[1]), right.station(right.x[0]))
    most = BEND / chain
    w = min(max(sqrt(abs(across) / most), SHORTEST * chain), longest)
    if abs(kink) > most * w:
        raise NotImplementedError("a crossing at x = %s" % left.x[1])
    length, change = w, [mpf(0), mpf(0)]
    for _ in range(400):
        (bent_left, end), (bent_right, start) = left.bent(1, w, length, change[0]), right.bent(0, w, length, change[1])
        apart = seen(start, end)
        if max(abs(v) for v in apart) < mpf(10) ** -52:
            return [left.cut(1, left.away(1, -w)), bent_left, bent_right, right.cut(0, right.away(0, w))]
        lift, level = apart[1] / w**2, apart[2] / (2 * w)
        change = [change[0] + level + lift, change[1] + level - lift]
        length += apart[0] / 2
    raise ArithmeticError("no bend at x = %s" % left.x[1])


def closed(segments):
    """The closed chain: segments of the same kinds with 60-digit numbers."""
    if any(d["kind"] not in ("line", "arc", "poly") for d in segments):
        return segments
    curves = [Curve(d) for d in segments]
    lengths = [chord(c) for c in curves]
    ends = [(x, c.z(x)) for c in curves for x in c.x]
    extent = max(max(p[k] for p in ends) - min(p[k] for p in ends) for k in (0, 1))
    out = [segments[0]]
    for i in range(1, len(segments)):
        left, right = Curve(out[-1]), curves[i]
        end, start = left.station(left.x[1]), right.station(right.x[0])
        gap = sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2)
        if gap <= ROUNDING * (extent + abs(end[0]) + abs(end[1])):
            out.append(segments[i])
        else:
            out[-1:] = joint(left, right, sum(lengths), SHARE * min(lengths[i - 1], lengths[i]))
    return out
