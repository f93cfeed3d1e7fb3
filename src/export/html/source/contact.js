// A contact of a run: its gaps, their patches, and the pressure.

import { areaInside } from "./contours.js";
import { Frame, Grid, floats } from "./data.js";

/** The separation s along the fixed normal. */
class Separation {
    symbol = "s";
    name = "separation s";
    edge = "δ";

    constructor(grid, { boundary, area, pressed }) {
        // `closedBy` is the δ that closes the gap at a point.
        Object.assign(this, { grid, closedBy: grid, area });
        // The exact boundary under δ of the run, closed.
        this.boundary = boundary.map(pointsOf).map((points) => [...points, points[0]]);
        // The edges of the true contact; none where it was not solved.
        this.pressed = pressed.map(pointsOf);
    }

    /** What δ closes at ξ. */
    closed(delta) {
        return delta;
    }

    /** Area of the patch inside of some lines, mm²; NaN where one is open. */
    areaInside(lines) {
        return areaInside(lines);
    }
}

/** The gap t along the rail's turning normal, which δ closes by δ cos α. */
class NormalGap extends Separation {
    symbol = "t";
    name = "gap t along the rail's normal";
    edge = "δ cos α";

    constructor(grid, { gap, boundary, area, cosine, sigma }) {
        const t = new Grid(grid.xi, grid.eta, floats(gap));
        super(t, { boundary, area, pressed: [] });
        [this.cosine, this.sigma] = [floats(cosine), floats(sigma)];
        this.closedBy = new Grid(t.xi, t.eta, t.values.map((value, k) => value / this.cosine[Math.floor(k / t.eta.length)]));
    }

    closed(delta, xi) {
        return delta * this.grid.column(this.cosine, xi);
    }

    /** The patch lies on the rail's surface. */
    areaInside(lines) {
        return areaInside(lines.map((line) => line.map(([xi, eta]) => [this.grid.column(this.sigma, xi), eta])));
    }
}

/** One contact of a run, decoded. */
export class Contact {
    constructor(raw, pairs) {
        const { name, approach, skew, facts, warnings } = raw;
        Object.assign(this, { name: name || "contact", approach, skew, facts, warnings });
        this.grid = new Grid(floats(raw.xi), floats(raw.eta), floats(raw.separation));
        this.railHeight = floats(raw.rail_height);
        // The pressures over the grid of the run: null where they were not solved.
        this.pressure = raw.pressure && new Grid(...["xi", "eta", "values"].map((key) => floats(raw.pressure[key])));
        [this.railFrame, this.wheelFrame] = raw.frames.map((frame) => new Frame(frame));
        this.pair = pairs[raw.pair];
        // Colours are made for gaps from 0 to 3 δ; without δ, for all that the contours can show.
        const s = new Separation(this.grid, raw);
        const t = raw.conformal && new NormalGap(this.grid, raw.conformal);
        const edge = (t ?? s).closedBy.leastOnEdge();
        const [, high] = (t ?? s).closedBy.range();
        const fallback = [edge, high, 0.1].find((s) => s > 0 && Number.isFinite(s));
        this.scale = approach ? 3 * approach : fallback;
        this.delta = approach ?? fallback / 3;
        // What can be shown in colour, the first one first, and the gap whose patch is shown over it.
        this.layers = [t, s].filter(Boolean).map((gap) => ({ gap, grid: gap.grid, name: gap.name, scale: this.scale }));
        if (this.pressure) this.layers.push({ gap: s, grid: this.pressure, name: "pressure p", scale: this.pressure.range()[1] });
    }
}

/** Decodes the points [ξ, η] of a line, mm. */
function pointsOf(line) {
    const values = floats(line);
    return Array.from({ length: values.length / 2 }, (_, k) => [values[2 * k], values[2 * k + 1]]);
}
