// Both profiles in the rail's axes, where they touch, at one scale.

import { theme } from "./colours.js";
import { Sheet } from "./dom.js";
import { Plot } from "./plot.js";

export class Profiles {
    constructor(state) {
        const { contact } = state;
        this.state = state;
        this.rail = contact.pair.rail;
        this.wheel = contact.pair.wheel.map((at) => contact.railFrame.out(contact.wheelFrame.into(at)));
        const label = `Profiles of rail ${contact.pair.names[0]} and wheel ${contact.pair.names[1]} with the contact point C`;
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { class: "profiles" });
    }

    draw(context, width, height) {
        const { contact, lines } = this.state;
        const colours = theme();
        const all = [...this.rail, ...this.wheel];
        const range = (k) => {
            const values = all.map((at) => at[k]);
            return [Math.min(...values), Math.max(...values)];
        };
        const [x, z] = [range(0), range(1)];
        const margin = 0.02 * (x[1] - x[0]);
        const room = [52, 10, width - 64, height - 54];
        // Above there is room for ζ.
        const plot = Plot.trueScale(context, room, [x[0] - margin, x[1] + margin], [z[0], z[1] + 7 * margin]);
        plot.clipped(() => {
            plot.fill(this.rail, plot.v[0], colours.railFill);
            plot.fill(this.wheel, plot.v[1], colours.wheelFill);
            plot.line(this.rail, colours.rail, 1.75);
            plot.line(this.wheel, colours.wheel, 1.75);
            this.frame(plot, contact, lines, colours);
        });
        plot.axes(["x on the rail [mm]", "z [mm]"]);
    }

    /** The directions ξ and ζ at C, and the patch along ξ. */
    frame(plot, { railFrame }, lines, colours) {
        const { context } = plot;
        const xi = lines.flat().map((at) => at[0]);
        const scale = plot.place[2] / (plot.u[1] - plot.u[0]);
        const reach = Math.min(34, 0.1 * plot.place[2]) / scale;
        if (xi.length > 0) {
            const ends = [Math.min(...xi), Math.max(...xi)].map((at) => railFrame.out([at, 0]));
            plot.line(ends, colours.boundary, 5);
        }
        plot.line([railFrame.out([0, reach]), railFrame.out([0, 0]), railFrame.out([reach, 0])], colours.ink, 1.25);
        plot.words("ξ", railFrame.out([1.3 * reach, 0]), { align: "center" });
        plot.words("ζ", railFrame.out([0, 1.25 * reach]), { align: "center" });
        const [x, z] = railFrame.origin;
        context.beginPath();
        context.arc(plot.x(x), plot.y(z), 3.5, 0, 7);
        Object.assign(context, { fillStyle: "#fff", strokeStyle: "#111", lineWidth: 1.25 });
        context.fill();
        context.stroke();
    }
}
