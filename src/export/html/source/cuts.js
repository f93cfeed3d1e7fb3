// s along the two lines of the cut.

import { theme } from "./colours.js";
import { Sheet, fixed, followed, length } from "./dom.js";
import { Plot } from "./plot.js";

/** Least s shown, as a share of the scale below 0. */
const BELOW = 0.06;

export class Cut {
    /** `axis` is 0 for the cut along ξ, at the η of the state's cut, and 1 for that along η. */
    constructor(axis, state, moved) {
        Object.assign(this, { axis, state, moved });
        const names = axis === 0 ? "s over ξ at the η of the cut" : "s over η at the ξ of the cut";
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

    /** s at a place of the line. */
    at(along) {
        const { contact, cut } = this.state;
        return this.axis === 0 ? contact.grid.at(along, cut[1]) : contact.grid.at(cut[0], along);
    }

    draw(context, width, height) {
        const { contact, delta, cut } = this.state;
        const { grid, scale } = contact;
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
        const colour = this.axis === 0 ? colours.cutXi : colours.cutEta;
        plot.clipped(() => {
            this.inside(plot, points, delta * factor, colours);
            plot.line([[ends[0], 0], [ends[1], 0]], colours.axis, 1);
            plot.line([[ends[0], delta * factor], [ends[1], delta * factor]], colours.boundary, 1.25, [5, 3]);
            plot.line(points, colour, 2);
            plot.words("δ", [ends[1], delta * factor], { colour: colours.boundary, align: "right", shift: [-5, -9] });
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
        const text = `at ${other} = ${fixed(value, 3)} mm: s = ${length(this.at(cut[this.axis]))}`;
        plot.words(text, [middle, plot.v[1]], { align: "center", shift: [0, 11] });
        plot.axes([this.axis === 0 ? "ξ [mm]" : "η [mm]", `s [${unit}]`]);
    }

    /** Fills what lies between s and δ inside of the patch. */
    inside(plot, points, delta, colours) {
        const { context } = plot;
        context.beginPath();
        context.moveTo(plot.x(plot.u[0]), plot.y(delta));
        for (const [along, s] of points) context.lineTo(plot.x(along), plot.y(Math.min(Number.isNaN(s) ? delta : s, delta)));
        context.lineTo(plot.x(plot.u[1]), plot.y(delta));
        context.fillStyle = colours.patch;
        context.fill();
    }
}
