// Rail and wheel of one side of a track in the section through the axle, seen along the track: left is left.

import { theme } from "./colours.js";
import { floats } from "./data.js";
import { Sheet, fixed } from "./dom.js";
import { Plot } from "./plot.js";

/** What a lifted wheel is lifted by, as a share of its profile's width. */
const LIFT = 0.14;

/** Numbers of one position in the places of a side. */
const PLACE = 5;

/** Positions at which the window is made to hold all that is drawn. */
const LOOKED_AT = 24;

export class PairView {
    /** `state` is shared by all views: { positions, at, lifted }. */
    constructor(side, pairs, state) {
        Object.assign(this, { side, state, pair: pairs[side.pair] });
        this.sign = side.right ? 1 : -1;
        this.places = floats(side.places);
        this.contacts = Array.from(state.positions, () => []);
        const [rail, wheel, angle, gap, load] = [side.rail_x, side.wheel_x, side.angle, side.gap, side.load].map(floats);
        side.position.forEach((number, k) => this.contacts[number]?.push({ rail: rail[k], wheel: wheel[k], angle: angle[k], gap: gap[k], load: load[k] }));
        const x = this.pair.wheel.map((at) => at[0]);
        this.lift = LIFT * (Math.max(...x) - Math.min(...x));
        this.frame();
        const label = `Profiles of the ${side.right ? "right" : "left"} side at the position, with the points of contact`;
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { class: "pair" });
    }

    /** Position x, z and angle of the wheel's axes in those of the rail, its yaw, and how far ahead the section lies; `null` without contact. */
    place(at) {
        const [x, z, angle, yaw, ahead] = this.places.slice(PLACE * at, PLACE * (at + 1));
        const turn = (angle) => [Math.cos(angle), Math.sin(angle)];
        return Number.isNaN(x) ? null : { x, z, turn: turn(angle), yaw: turn(yaw), ahead };
    }

    /** A point of the wheel's profile in track axes, where its circle goes through the section. */
    ofWheel([x, z], { x: dx, z: dz, turn: [c, s], yaw: [cos, sin], ahead }, lift = 0) {
        const along = (ahead - x * sin) / cos;
        const across = x * cos - along * sin;
        const up = this.pair.radius - Math.sqrt((this.pair.radius - z) ** 2 - along ** 2);
        return this.ofRail([dx + c * across - s * up, dz + s * across + c * up + lift]);
    }

    /** A point of the rail's profile in track axes: lateral to the right, height over the top of rail. */
    ofRail([x, z]) {
        const [x0, z0] = this.side.rail;
        return [this.sign * (x0 + x), z0 + z];
    }

    /** The pieces of the profiles of rail and wheel at a position, in their own axes. */
    profiles(at) {
        const { rails, wheels } = this.side;
        const [rail, wheel] = [[rails, this.pair.rail], [wheels, this.pair.wheel]];
        return [rail, wheel].map(([cuts, profile]) => (cuts.length > 0 ? piecesOf(floats(cuts[at])) : [profile]));
    }

    /** The pieces of rail and wheel at a position in track axes; no wheel without contact. */
    pieces(at, lift = 0) {
        const [rail, wheel] = this.profiles(at);
        const place = this.place(at);
        return [rail.map((piece) => piece.map((point) => this.ofRail(point))), place ? wheel.map((piece) => piece.map((point) => this.ofWheel(point, place, lift))) : []];
    }

    /** The window that holds rail and wheel at all positions. */
    frame() {
        const ends = [[Infinity, -Infinity], [Infinity, -Infinity]];
        const count = this.state.positions.length;
        for (let k = 0; k < LOOKED_AT; k++) {
            const at = Math.round((k / (LOOKED_AT - 1)) * (count - 1));
            for (const point of this.pieces(at).flat(2)) {
                ends.forEach((range, axis) => {
                    if (Number.isNaN(point[axis])) return;
                    range[0] = Math.min(range[0], point[axis]);
                    range[1] = Math.max(range[1], point[axis]);
                });
            }
        }
        this.window = ends.map(([low, high], axis) => [low - 3, high + (axis === 1 ? this.lift + 6 : 3)]);
    }

    /** The points of contact [rail, wheel] in track axes. */
    joined() {
        const { at, lifted } = this.state;
        const place = this.place(at);
        if (!place) return [];
        const [onRail, onWheel] = this.profiles(at);
        return this.contacts[at].map(({ rail, wheel }) => [
            this.ofRail([rail, heightAt(onRail, rail, Math.max)]),
            this.ofWheel([wheel, heightAt(onWheel, wheel, Math.min)], place, lifted ? this.lift : 0),
        ]);
    }

    draw(context, width, height) {
        const colours = theme();
        const plot = Plot.trueScale(context, [52, 8, width - 64, height - 50], ...this.window);
        const [rail, wheel] = this.pieces(this.state.at, this.state.lifted ? this.lift : 0);
        plot.clipped(() => {
            rail.forEach((piece) => plot.fill(piece, plot.v[0], colours.railFill));
            plot.lines(rail, colours.rail, 1.75);
            context.globalAlpha = 0.7;
            wheel.forEach((piece) => plot.fill(piece, plot.v[1], colours.wheelFill));
            context.globalAlpha = 1;
            plot.lines(wheel, colours.wheel, 1.75);
            this.joined().forEach((ends, k) => this.contact(plot, ends, k === 0, colours));
        });
        if (wheel.length === 0) {
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
        const words = ({ rail, wheel, angle, gap, load }) => {
            const near = gap > 0 ? `, gap ${fixed(gap, 3)} mm` : "";
            const carries = load >= 0 ? `, ${fixed(load / 1000, 2)} kN` : "";
            return `rail x ${fixed(rail, 2)}, wheel x ${fixed(wheel, 2)} mm, angle ${fixed((angle * 180) / Math.PI, 2)}°${near}${carries}`;
        };
        return found.map(words).join("; ");
    }
}

/** The pieces of a section: its points x, z in turn, with NaN between two. */
function piecesOf(numbers) {
    const pieces = [[]];
    for (let k = 0; k < numbers.length; k += 2) {
        if (Number.isNaN(numbers[k])) pieces.push([]);
        else pieces[pieces.length - 1].push([numbers[k], numbers[k + 1]]);
    }
    return pieces.filter((piece) => piece.length > 0);
}

/** Height of the pieces of a profile at an abscissa; `choose` decides between several. */
function heightAt(pieces, x, choose) {
    const found = [];
    for (const piece of pieces) {
        for (let k = 1; k < piece.length; k++) {
            const [[a, b], [c, d]] = [piece[k - 1], piece[k]];
            if ((a - x) * (c - x) > 0 || a === c) continue;
            found.push(b + ((x - a) / (c - a)) * (d - b));
        }
    }
    if (found.length > 0) return choose(...found);
    // Single precision may put the end of a profile a little short of it.
    const nearest = pieces.flat().reduce((least, at) => (Math.abs(at[0] - x) < Math.abs(least[0] - x) ? at : least), [Infinity, NaN]);
    return nearest[1];
}
