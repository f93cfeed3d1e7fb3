// Rail and wheel of one side of a track in the section through the axle, seen along the track: left is left.

import { theme } from "./colours.js";
import { floats } from "./data.js";
import { Sheet, fixed } from "./dom.js";
import { Plot } from "./plot.js";

/** What a lifted wheel is lifted by, as a share of its profile's width. */
const LIFT = 0.14;

export class PairView {
    /** `state` is shared by all views: { lateral, at, lifted }. */
    constructor(side, pairs, state) {
        Object.assign(this, { side, state, pair: pairs[side.pair] });
        this.sign = side.right ? 1 : -1;
        this.places = floats(side.places);
        this.contacts = Array.from(state.lateral, () => []);
        const [rail, wheel] = [floats(side.rail_x), floats(side.wheel_x)];
        side.position.forEach((number, k) => this.contacts[number]?.push([rail[k], wheel[k]]));
        const x = this.pair.wheel.map((at) => at[0]);
        this.lift = LIFT * (Math.max(...x) - Math.min(...x));
        this.frame();
        const label = `Profiles of the ${side.right ? "right" : "left"} side at the position, with the points of contact`;
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { class: "pair" });
    }

    /** Position x, z and angle of the wheel's axes in those of the rail at a position; `null` without contact. */
    place(at) {
        const [x, z, angle] = this.places.slice(3 * at, 3 * at + 3);
        return Number.isNaN(x) ? null : { x, z, turn: [Math.cos(angle), Math.sin(angle)] };
    }

    /** A point of the wheel's profile in track axes. */
    ofWheel([x, z], { x: dx, z: dz, turn: [c, s] }, lift = 0) {
        return this.ofRail([dx + c * x - s * z, dz + s * x + c * z + lift]);
    }

    /** A point of the rail's profile in track axes: lateral to the right, height over the top of rail. */
    ofRail([x, z]) {
        const [x0, z0] = this.side.rail;
        return [this.sign * (x0 + x), z0 + z];
    }

    /** The window that holds rail and wheel at all positions. */
    frame() {
        const boxes = [this.pair.rail.map((at) => this.ofRail(at))];
        for (let at = 0; at < this.state.lateral.length; at += Math.max(1, this.state.lateral.length >> 4)) {
            const place = this.place(at);
            if (place) boxes.push(this.pair.wheel.map((point) => this.ofWheel(point, place)));
        }
        const all = boxes.flat();
        this.window = [0, 1].map((k) => {
            const values = all.map((at) => at[k]);
            return [Math.min(...values) - 3, Math.max(...values) + (k === 1 ? this.lift + 6 : 3)];
        });
    }

    /** The points of contact [rail, wheel] in track axes. */
    joined() {
        const place = this.place(this.state.at);
        const lift = this.state.lifted ? this.lift : 0;
        if (!place) return [];
        return this.contacts[this.state.at].map(([rail, wheel]) => [
            this.ofRail([rail, heightAt(this.pair.rail, rail, Math.max)]),
            this.ofWheel([wheel, heightAt(this.pair.wheel, wheel, Math.min)], place, lift),
        ]);
    }

    draw(context, width, height) {
        const colours = theme();
        const plot = Plot.trueScale(context, [52, 8, width - 64, height - 50], ...this.window);
        const place = this.place(this.state.at);
        const rail = this.pair.rail.map((at) => this.ofRail(at));
        plot.clipped(() => {
            plot.fill(rail, plot.v[0], colours.railFill);
            plot.line(rail, colours.rail, 1.75);
            if (!place) return;
            const lift = this.state.lifted ? this.lift : 0;
            const wheel = this.pair.wheel.map((at) => this.ofWheel(at, place, lift));
            context.globalAlpha = 0.7;
            plot.fill(wheel, plot.v[1], colours.wheelFill);
            context.globalAlpha = 1;
            plot.line(wheel, colours.wheel, 1.75);
            this.joined().forEach((ends, k) => this.contact(plot, ends, k === 0, colours));
        });
        if (!place) {
            const middle = [0, 1].map((k) => (this.window[k][0] + this.window[k][1]) / 2);
            plot.words("no contact at this position", middle, { align: "center" });
        }
        plot.axes(["across the track [mm]", "z [mm]"]);
    }

    /** Joins the two points of one contact. */
    contact(plot, ends, first, colours) {
        const { context } = plot;
        plot.line(ends, colours.boundary, first ? 1.75 : 1.25, first ? [] : [4, 3]);
        for (const [u, v] of ends) {
            context.beginPath();
            context.arc(plot.x(u), plot.y(v), first ? 4 : 3, 0, 7);
            Object.assign(context, { fillStyle: first ? colours.boundary : colours.paper, strokeStyle: colours.boundary, lineWidth: 1.5 });
            context.fill();
            context.stroke();
        }
    }

    /** The contacts in words. */
    said() {
        const found = this.contacts[this.state.at];
        if (found.length === 0) return "no contact";
        return found.map(([rail, wheel]) => `rail x ${fixed(rail, 2)}, wheel x ${fixed(wheel, 2)} mm`).join("; ");
    }
}

/** Height of a profile at an abscissa; `choose` decides between several. */
function heightAt(profile, x, choose) {
    const found = [];
    for (let k = 1; k < profile.length; k++) {
        const [[a, b], [c, d]] = [profile[k - 1], profile[k]];
        if ((a - x) * (c - x) > 0 || a === c) continue;
        found.push(b + ((x - a) / (c - a)) * (d - b));
    }
    // Single precision may put the end of a profile a little short of it.
    return found.length > 0 ? choose(...found) : profile[x < profile[0][0] ? 0 : profile.length - 1][1];
}
