// A panel of a canvas with its own coordinates, frame, ticks and names of the axes.

import { theme } from "./colours.js";
import { ticks } from "./dom.js";

const FONT = "12px system-ui, sans-serif";
const NAMES = "600 12px system-ui, sans-serif";

export class Plot {
    /** `place` is left, top, width, height in pixels; `u` and `v` the ranges shown, v upwards. */
    constructor(context, place, u, v) {
        Object.assign(this, { context, place, u, v, colours: theme() });
    }

    /** The largest panel inside of `room` with one scale on both axes, or all of it where that would be thinner than 1 : `most`. */
    static trueScale(context, room, u, v, most = Infinity) {
        const [left, top, width, height] = room;
        const [du, dv] = [u[1] - u[0], v[1] - v[0]];
        const scale = Math.min(width / du, height / dv);
        const [w, h] = [scale * du, scale * dv];
        if (Math.max(w / h, h / w) > most) return new Plot(context, room, u, v);
        const plot = new Plot(context, [left + (width - w) / 2, top + (height - h) / 2, w, h], u, v);
        plot.isTrue = true;
        return plot;
    }

    x(u) {
        return this.place[0] + ((u - this.u[0]) / (this.u[1] - this.u[0])) * this.place[2];
    }

    y(v) {
        return this.place[1] + ((this.v[1] - v) / (this.v[1] - this.v[0])) * this.place[3];
    }

    /** The coordinates of a point of the canvas, kept inside of the panel; `null` for a point outside of it. */
    back(x, y, kept = false) {
        const [left, top, width, height] = this.place;
        const [a, b] = [(x - left) / width, (y - top) / height];
        if (!kept && (a < 0 || a > 1 || b < 0 || b > 1)) return null;
        const within = (share) => Math.min(Math.max(share, 0), 1);
        return [
            this.u[0] + within(a) * (this.u[1] - this.u[0]),
            this.v[1] - within(b) * (this.v[1] - this.v[0]),
        ];
    }

    /** Draws with a clip at the panel's edges. */
    clipped(draw) {
        this.context.save();
        this.context.beginPath();
        this.context.rect(...this.place);
        this.context.clip();
        draw();
        this.context.restore();
    }

    /** Adds a polyline to the path; undefined points part it. */
    path(points) {
        let pen = false;
        for (const [u, v] of points) {
            if (Number.isNaN(u) || Number.isNaN(v)) pen = false;
            else {
                this.context[pen ? "lineTo" : "moveTo"](this.x(u), this.y(v));
                pen = true;
            }
        }
    }

    /** Draws a polyline. */
    line(points, colour, width = 1.5, dash = []) {
        this.lines([points], colour, width, dash);
    }

    lines(lines, colour, width = 1.5, dash = []) {
        const { context } = this;
        context.beginPath();
        lines.forEach((line) => this.path(line));
        Object.assign(context, { strokeStyle: colour, lineWidth: width, lineJoin: "round" });
        context.setLineDash(dash);
        context.stroke();
        context.setLineDash([]);
    }

    /** Fills what lies between a polyline and a height. */
    fill(points, level, colour) {
        const { context } = this;
        context.beginPath();
        this.path(points);
        context.lineTo(this.x(points[points.length - 1][0]), this.y(level));
        context.lineTo(this.x(points[0][0]), this.y(level));
        context.closePath();
        context.fillStyle = colour;
        context.fill();
    }

    /** Frame, ticks, numbers and names of both axes. */
    axes([below, beside]) {
        const { context, colours } = this;
        const [left, top, width, height] = this.place;
        context.font = FONT;
        context.lineWidth = 1;
        const across = ticks(this.u, Math.max(2, width / 60));
        const up = ticks(this.v, Math.max(2, height / 30));
        context.strokeStyle = colours.axis;
        context.beginPath();
        for (const [u] of across) mark(context, this.x(u), top + height, 0, 4);
        for (const [v] of up) mark(context, left, this.y(v), -4, 0);
        context.stroke();
        context.strokeStyle = colours.axis;
        context.strokeRect(left, top, width, height);
        context.fillStyle = colours.soft;
        Object.assign(context, { textAlign: "center", textBaseline: "top" });
        for (const [u, text] of across) context.fillText(text, this.x(u), top + height + 5);
        Object.assign(context, { textAlign: "right", textBaseline: "middle" });
        let widest = 0;
        for (const [v, text] of up) {
            context.fillText(text, left - 6, this.y(v));
            widest = Math.max(widest, context.measureText(text).width);
        }
        context.font = NAMES;
        Object.assign(context, { fillStyle: colours.ink, textAlign: "center", textBaseline: "top" });
        context.fillText(below, left + width / 2, top + height + 22);
        context.save();
        context.translate(left - 12 - widest, top + height / 2);
        context.rotate(-Math.PI / 2);
        context.textBaseline = "bottom";
        context.fillText(beside, 0, 0);
        context.restore();
    }

    /** Words at a point of the panel, with a halo that keeps them readable over lines. */
    words(text, [u, v], { colour, align = "left", shift = [0, 0], baseline = "middle" } = {}) {
        const { context, colours } = this;
        context.font = FONT;
        Object.assign(context, { textAlign: align, textBaseline: baseline, lineJoin: "round" });
        const [x, y] = [this.x(u) + shift[0], this.y(v) + shift[1]];
        Object.assign(context, { strokeStyle: colours.paper, lineWidth: 3 });
        context.strokeText(text, x, y);
        context.fillStyle = colour ?? colours.ink;
        context.fillText(text, x, y);
    }
}

function mark(context, x, y, dx, dy) {
    context.moveTo(x, y);
    context.lineTo(x + dx, y + dy);
}
