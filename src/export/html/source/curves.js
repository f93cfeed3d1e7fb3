// One quantity over the positions of a sweep or a march.

import { theme } from "./colours.js";
import { Sheet, fixed, followed } from "./dom.js";
import { Plot } from "./plot.js";

/** Height of a mark on the axis, pixels. */
const MARK = 9;

export class Curves {
    /** `panel` has a title, an axis and curves; `state` is shared by all: { positions, at, events }; `moved` is told an index. */
    constructor(panel, abscissa, state, moved) {
        Object.assign(this, { panel, abscissa, state, moved });
        const label = `${panel.title}, ${panel.axis} over ${abscissa}. Arrow keys move the position.`;
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { tabindex: 0, class: "cut" });
        followed(this.sheet.canvas, (event, held) => {
            const at = this.plot?.back(event.offsetX, event.offsetY, held);
            if (at) moved(nearest(state.positions, at[0]));
        });
        this.range = this.values();
    }

    /** Least and largest value that is shown, with some air, never without extent. */
    values() {
        const all = this.panel.curves.flatMap((curve) => [...curve.values]).filter((value) => Number.isFinite(value));
        if (all.length === 0) return [0, 1];
        const [low, high] = this.panel.shown ?? [Math.min(...all), Math.max(...all)];
        const air = Math.max(0.06 * (high - low), 1e-6 * Math.max(Math.abs(low), Math.abs(high)), 1e-9);
        return [low - air, high + air];
    }

    draw(context, width, height) {
        const { positions, at, events } = this.state;
        const colours = theme();
        const ends = [positions[0], positions[positions.length - 1]];
        // A sweep of one position has no width of its own.
        const across = ends[0] < ends[1] ? ends : [ends[0] - 1, ends[0] + 1];
        const plot = new Plot(context, [66, 8, width - 80, height - 50], across, this.range);
        this.plot = plot;
        const colour = (k) => [colours.cutXi, colours.boundary][k];
        plot.clipped(() => {
            plot.line([[across[0], 0], [across[1], 0]], colours.line, 1);
            events.forEach((event) => mark(plot, event, colours.boundary));
            plot.line([[positions[at], plot.v[0]], [positions[at], plot.v[1]]], colours.soft, 1.25, [3, 3]);
            this.panel.curves.forEach((curve, k) => {
                const pieces = parted(positions, curve);
                plot.lines(pieces, colour(k), 1.9);
                pieces.filter((piece) => piece.length === 1).forEach(([point]) => dot(plot, point, 2.2, colour(k)));
            });
        });
        this.panel.curves.forEach(({ values }, k) => {
            if (!(values[at] >= plot.v[0] && values[at] <= plot.v[1])) return;
            dot(plot, [positions[at], values[at]], 4, colour(k));
            Object.assign(context, { strokeStyle: colours.paper, lineWidth: 1.5 });
            context.stroke();
        });
        plot.axes([this.abscissa, this.panel.axis]);
    }

    /** What the curves say at the position, with the names of the curves. */
    said() {
        const decimals = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(this.range[1] - this.range[0]))));
        return this.panel.curves.map(({ name, values }) => [name, fixed(values[this.state.at], decimals)]);
    }
}

/** The pieces of a curve between its jumps and missing values; a piece may be a single point. */
function parted(positions, { values, jumps }) {
    const ends = new Set(jumps);
    const pieces = [[]];
    for (let k = 0; k < positions.length; k++) {
        if (Number.isNaN(values[k])) pieces.push([]);
        else pieces[pieces.length - 1].push([positions[k], values[k]]);
        if (ends.has(k)) pieces.push([]);
    }
    return pieces.filter((piece) => piece.length > 0);
}

function dot(plot, [u, v], radius, colour) {
    const { context } = plot;
    context.beginPath();
    context.arc(plot.x(u), plot.y(v), radius, 0, 7);
    context.fillStyle = colour;
    context.fill();
}

/** A mark on the axis below. */
function mark(plot, u, colour) {
    const { context, v } = plot;
    const [x, y] = [plot.x(u), plot.y(v[0])];
    context.beginPath();
    context.moveTo(x, y - MARK);
    context.lineTo(x + MARK / 2, y);
    context.lineTo(x - MARK / 2, y);
    context.closePath();
    context.fillStyle = colour;
    context.fill();
}

/** Index of the nearest of some ascending values. */
export function nearest(values, value) {
    let [low, high] = [0, values.length - 1];
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (values[middle] <= value) low = middle;
        else high = middle;
    }
    return value - values[low] <= values[high] - value ? low : high;
}
