// The plan of the contact: a gap or the pressure in colour over ξ and η, the boundary, and the two lines of the cut.

import { colourOf, theme } from "./colours.js";
import { contours } from "./contours.js";
import { Sheet, fixed, followed, length } from "./dom.js";
import { Plot } from "./plot.js";

/** Axes thinner than this get a scale each. */
const THINNEST = 4;

export class PlanView {
    /** `state` is shared by all views of a contact: { contact, layer, gap, delta, lines, others, cut }; `moved` is told when the cut moves. */
    constructor(state, moved) {
        Object.assign(this, { state, moved });
        const label = "The gap over ξ and η. Arrow keys move the cut, plus and minus change δ.";
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { tabindex: 0, class: "plan" });
        this.readout = document.createElement("output");
        this.listen(this.sheet.canvas);
    }

    listen(canvas) {
        followed(canvas, (event, held) => {
            const at = this.plot?.back(event.offsetX, event.offsetY, held);
            if (at && held) this.moved(at);
            this.say(at ?? this.state.cut);
        });
        canvas.addEventListener("pointerleave", () => this.say(this.state.cut));
    }

    /** Writes ξ, η, the gaps and the pressure of a point below the plan. */
    say([xi, eta]) {
        const { layers, pressure } = this.state.contact;
        const gaps = layers.filter(({ gap, grid }) => gap.grid === grid);
        const said = [["ξ", `${fixed(xi, 3)} mm`], ["η", `${fixed(eta, 3)} mm`], ...gaps.map(({ gap, grid }) => [gap.symbol, length(grid.at(xi, eta))])];
        if (pressure) said.push(["p", `${fixed(pressure.at(xi, eta) || 0, 0)} N/mm²`]);
        // A line ends between two quantities, never within one.
        this.readout.value = said.map((words) => words.join(" ").replaceAll(" ", "\u00a0")).join("   ");
    }

    draw(context, width, height, ratio) {
        const { contact, delta, lines, others, cut, layer, gap } = this.state;
        const isGap = layer.grid === gap.grid;
        const { grid } = contact;
        const room = [58, 10, width - 72, height - 54];
        const [u, v] = [0, 1].map((axis) => widened(grid.ends(axis), this.state.sides?.[axis]));
        const plot = Plot.trueScale(context, room, u, v, THINNEST);
        this.plot = plot;
        const colours = theme();
        context.save();
        if (!isGap) context.clip(inside(plot, gap.pressed));
        context.drawImage(this.field(plot, ratio), ...plot.place);
        context.restore();
        plot.clipped(() => {
            if (isGap) plot.lines(this.isolines, "rgb(255 255 255 / 35%)", 1);
            if (contact.approach && delta !== contact.approach) {
                plot.lines(gap.boundary, colours.given, 1.75, [1.5, 3]);
            }
            plot.lines(others, colours.boundary, 1.25, [4, 3]);
            plot.lines(lines, colours.halo, 4.5);
            plot.lines(lines, colours.boundary, 2.25);
            plot.lines(gap.pressed, colours.halo, 3.5);
            plot.lines(gap.pressed, colours.pressed, 1.5, [7, 3]);
            plot.line([[cut[0], plot.v[0]], [cut[0], plot.v[1]]], colours.cutEta, 1.25, [6, 3]);
            plot.line([[plot.u[0], cut[1]], [plot.u[1], cut[1]]], colours.cutXi, 1.25, [6, 3]);
            dot(plot, [0, 0], colours);
        });
        plot.axes(["ξ [mm]", "η [mm]"]);
        this.say(cut);
    }

    /** A layer in colour, drawn once for every size. */
    field(plot, ratio) {
        const { grid, scale } = this.state.layer;
        const [width, height] = [plot.place[2], plot.place[3]].map((side) => Math.max(2, Math.round(side * ratio)));
        const shown = [...plot.u, ...plot.v, width, height];
        if (this.shown === grid && shown.every((value, k) => value === this.within?.[k])) return this.image;
        Object.assign(this, { shown: grid, within: shown });
        const image = new ImageData(width, height);
        for (let y = 0; y < height; y++) {
            const v = plot.v[1] - ((y + 0.5) / height) * (plot.v[1] - plot.v[0]);
            for (let x = 0; x < width; x++) {
                const u = plot.u[0] + ((x + 0.5) / width) * (plot.u[1] - plot.u[0]);
                image.data.set(colourOf(grid.at(u, v) / scale), 4 * (y * width + x));
            }
        }
        this.image = Object.assign(document.createElement("canvas"), { width, height });
        this.image.getContext("2d").putImageData(image, 0, 0);
        this.isolines = [1, 2, 4, 5].flatMap((k) => contours(grid, (k / 6) * scale));
        return this.image;
    }
}

/** An interval of at least this length about the same middle. */
function widened([from, to], side = 0) {
    const more = Math.max(0, side - (to - from)) / 2;
    return [from - more, to + more];
}

/** The region inside closed lines, on the page. */
function inside(plot, lines) {
    const path = new Path2D();
    for (const line of lines) {
        line.forEach(([u, v], k) => (k === 0 ? path.moveTo(plot.x(u), plot.y(v)) : path.lineTo(plot.x(u), plot.y(v))));
        path.closePath();
    }
    return path;
}

/** Marks C. */
function dot(plot, at, colours) {
    const { context } = plot;
    context.beginPath();
    context.arc(plot.x(at[0]), plot.y(at[1]), 3.5, 0, 7);
    Object.assign(context, { fillStyle: "#fff", strokeStyle: "#111", lineWidth: 1.25 });
    context.fill();
    context.stroke();
    context.font = "600 12px system-ui, sans-serif";
    context.fillStyle = "#fff";
    Object.assign(context, { textAlign: "left", textBaseline: "bottom", strokeStyle: "rgb(0 0 0 / 60%)", lineWidth: 3 });
    context.strokeText("C", plot.x(at[0]) + 6, plot.y(at[1]) - 4);
    context.fillText("C", plot.x(at[0]) + 6, plot.y(at[1]) - 4);
}
