// A gap along the two lines of the cut.

import { theme } from "./colours.js";
import { Sheet, fixed, followed, length } from "./dom.js";
import { Plot } from "./plot.js";

/** Least gap shown, as a share of the scale below 0. */
const BELOW = 0.06;

export class Cut {
    /** `axis` is 0 for the cut along ξ, at the η of the state's cut, and 1 for that along η. */
    constructor(axis, state, moved) {
        Object.assign(this, { axis, state, moved });
        const names = axis === 0 ? "The gap over ξ at the η of the cut" : "The gap over η at the ξ of the cut";
        const label = `${names}. Arrow keys move the cut.`;
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { tabindex: 0, class: "cut" });
        this.listen(this.sheet.canvas);
    }

    listen(canvas) {
        followed(canvas, (event, held) => {
            const at = held && this.plot?.back(event.offsetX, event.offsetY, true);
            const { cut } = this.state;
            if (at) this.moved(this.axis === 0 ? [at[0], cut[1]] : [cut[0], at[0]]);
        });
    }

    /** The gap at a place of the line. */
    at(along) {
        const { gap, cut } = this.state;
        return this.axis === 0 ? gap.grid.at(along, cut[1]) : gap.grid.at(cut[0], along);
    }

    draw(context, width, height) {
        const { contact, gap, delta, cut } = this.state;
        const { scale } = contact;
        const { grid } = gap;
        const colours = theme();
        // Micrometres where millimetres would be all zeros.
        const [unit, factor] = scale < 1 ? ["µm", 1e3] : ["mm", 1];
        const [least] = grid.range();
        const low = Math.min(-BELOW * scale, least < 0 ? Math.max(1.1 * least, -scale) : 0);
        const ends = grid.ends(this.axis);
        const plot = new Plot(context, [58, 10, width - 72, height - 54], ends, [low * factor, scale * factor]);
        this.plot = plot;
        const axis = this.axis === 0 ? grid.xi : grid.eta;
        const points = Array.from(axis, (along) => [along, this.at(along) * factor]);
        // What δ closes along the line.
        const closed = Array.from(axis, (along) => [along, factor * gap.closed(delta, this.axis === 0 ? along : cut[0])]);
        const colour = this.axis === 0 ? colours.cutXi : colours.cutEta;
        plot.clipped(() => {
            this.inside(plot, points, closed, colours);
            plot.line([[ends[0], 0], [ends[1], 0]], colours.axis, 1);
            plot.line(closed, colours.boundary, 1.25, [5, 3]);
            plot.line(points, colour, 2);
            const end = closed.findLast(([, level]) => Number.isFinite(level));
            if (end) plot.words(gap.edge, end, { colour: colours.boundary, align: "right", shift: [-5, -9] });
            const here = cut[this.axis];
            const s = this.at(here);
            // The line ends below the words.
            plot.line([[here, plot.v[0]], [here, 0.87 * plot.v[1]]], colours.soft, 1, [2, 3]);
            context.beginPath();
            context.arc(plot.x(here), plot.y(Math.min(s * factor, plot.v[1])), 3.5, 0, 7);
            context.fillStyle = colour;
            context.fill();
        });
        const [other, value] = this.axis === 0 ? ["η", cut[1]] : ["ξ", cut[0]];
        const middle = (ends[0] + ends[1]) / 2;
        const text = `at ${other} = ${fixed(value, 3)} mm: ${gap.symbol} = ${length(this.at(cut[this.axis]))}`;
        plot.words(text, [middle, plot.v[1]], { align: "center", shift: [0, 11] });
        plot.axes([this.axis === 0 ? "ξ [mm]" : "η [mm]", `${gap.symbol} [${unit}]`]);
    }

    /** Fills what lies between the gap and what δ closes of it, inside of the patch. */
    inside(plot, points, closed, colours) {
        const { context } = plot;
        const filled = points.map(([along, gap], k) => [along, gap < closed[k][1] ? gap : closed[k][1]]);
        context.beginPath();
        plot.path([...filled, ...closed.toReversed()]);
        context.fillStyle = colours.patch;
        context.fill();
    }
}
