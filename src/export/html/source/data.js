// The data of a page: arrays, grids and profiles.

/** Decodes base64 of little-endian single precision; browsers run on little-endian machines only. */
export function floats(base64) {
    return new Float32Array(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer);
}

/** Reads the JSON that the page carries. */
export function pageData() {
    return JSON.parse(document.getElementById("data").textContent);
}

/** A polyline [x, z] of a profile in its own axes, mm. */
export function profilePoints(profile) {
    const [x, z] = [floats(profile.x), floats(profile.z)];
    return Array.from(x, (value, k) => [value, z[k]]);
}

/** A quantity on a rectangular grid of equal steps, at i * eta.length + j; NaN where a body has no surface. Lengths in mm. */
export class Grid {
    constructor(xi, eta, values) {
        Object.assign(this, { xi, eta, values });
        this.steps = [xi, eta].map((axis) => (axis[axis.length - 1] - axis[0]) / (axis.length - 1));
    }

    /** Both ends of an axis: 0 is ξ, 1 is η. */
    ends(axis) {
        const values = axis === 0 ? this.xi : this.eta;
        return [values[0], values[values.length - 1]];
    }

    /** The value at a point, interpolated linearly along both axes; NaN outside. */
    at(xi, eta) {
        const [i, u] = place(xi, this.xi, this.steps[0]);
        const [j, v] = place(eta, this.eta, this.steps[1]);
        const m = this.eta.length;
        const s = this.values;
        const k = i * m + j;
        // A node's own value counts alone, so that an undefined neighbour does not spoil it.
        const near = v === 0 ? s[k] : (1 - v) * s[k] + v * s[k + 1];
        if (u === 0) return near;
        const far = v === 0 ? s[k + m] : (1 - v) * s[k + m] + v * s[k + m + 1];
        return (1 - u) * near + u * far;
    }

    /** What is known at every ξ, linear between them and beyond. */
    column(values, xi) {
        const at = (xi - this.xi[0]) / this.steps[0];
        const i = Math.min(Math.max(Math.floor(at), 0), values.length - 2);
        return at === i ? values[i] : values[i] + (at - i) * (values[i + 1] - values[i]);
    }

    /** Least and largest defined value. */
    range() {
        let [low, high] = [Infinity, -Infinity];
        for (const s of this.values) {
            if (s < low) low = s;
            if (s > high) high = s;
        }
        return [low, high];
    }

    /** Least s on the edges of the grid: contours of larger s are cut by them. */
    leastOnEdge() {
        const [n, m] = [this.xi.length, this.eta.length];
        let least = Infinity;
        for (let i = 0; i < n; i++) {
            for (let j = 0; j < m; j += i === 0 || i === n - 1 ? 1 : m - 1) {
                const s = this.values[i * m + j];
                if (s < least) least = s;
            }
        }
        return least;
    }
}

/** Index of the node below a value, and the share of the step beyond it; not numbers outside of the axis. */
function place(value, axis, step) {
    const at = (value - axis[0]) / step;
    if (!(at >= 0 && at <= axis.length - 1)) return [NaN, NaN];
    const index = Math.min(Math.floor(at), axis.length - 2);
    const share = at - index;
    return share === 1 ? [index + 1, 0] : [index, share];
}

/** A rigid motion of the plane from a contact frame (ξ, ζ) to own axes (x, z), and back. */
export class Frame {
    constructor({ origin, turn }) {
        Object.assign(this, { origin, turn });
    }

    out([xi, zeta]) {
        const [c, s] = this.turn;
        return [this.origin[0] + c * xi - s * zeta, this.origin[1] + s * xi + c * zeta];
    }

    into([x, z]) {
        const [c, s] = this.turn;
        const [dx, dz] = [x - this.origin[0], z - this.origin[1]];
        return [c * dx + s * dz, c * dz - s * dx];
    }
}

/** Decodes the profiles of a page. */
export function pairsOf(data) {
    return data.pairs.map(({ rail, wheel, radius, roller }) => ({
        rail: profilePoints(rail),
        wheel: profilePoints(wheel),
        names: [rail.name, wheel.name],
        radius,
        roller,
    }));
}
