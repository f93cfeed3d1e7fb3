// Rail, wheel and separation as triangles around C: x lateral, y along the rail, z up, mm from C.

import { BufferGeometry, Float32BufferAttribute, ShapeUtils, Vector2 } from "three";
import { colourOf } from "./colours.js";

/** Neighbouring chords whose directions differ by more than this (cosine) meet at an edge; others are smooth. */
const EDGE = Math.cos(0.35);

/** Height of the bodies above and below their profiles, as a share of the profile's width. */
const DEPTH = 0.16;

/** Steps of a body about its axle. */
const AROUND = 64;

/** Largest share of its radius that a body is drawn ahead of and behind its middle. */
const MOST_AROUND = 0.9;

/** The closed cross-section of a body in its own axes: its profile, and straight sides up or down to a level. */
function crossSection(profile, up) {
    const [x, z] = [0, 1].map((k) => profile.map((at) => at[k]));
    const depth = DEPTH * (Math.max(...x) - Math.min(...x));
    const level = up ? Math.max(...z) + depth : Math.min(...z) - depth;
    const points = profile.filter((at, k) => k === 0 || at[0] !== profile[k - 1][0] || at[1] !== profile[k - 1][1]);
    return [...points, [points[points.length - 1][0], level], [points[0][0], level]];
}

/** A body as its cross-section carried through stations: `placed(point, station)` is a point of space. */
function swept(section, stations, placed) {
    const positions = [];
    const indices = [];
    const faces = smoothFaces(section);
    for (const face of faces) {
        const first = positions.length / 3;
        for (const at of face) for (const station of stations) positions.push(...placed(at, station));
        const m = stations.length;
        for (let i = 0; i + 1 < face.length; i++) {
            for (let j = 0; j + 1 < m; j++) {
                const a = first + i * m + j;
                indices.push(a, a + m, a + m + 1, a, a + m + 1, a + 1);
            }
        }
    }
    const flat = section.map(([x, z]) => new Vector2(x, z));
    const triangles = ShapeUtils.triangulateShape(flat, []);
    [stations[0], stations[stations.length - 1]].forEach((station, end) => {
        const first = positions.length / 3;
        for (const at of section) positions.push(...placed(at, station));
        for (const [a, b, c] of triangles) indices.push(first + a, first + (end ? b : c), first + (end ? c : b));
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
    geometry.setIndex(indices);
    geometry.computeVertexNormals();
    return geometry;
}

/** Divides a closed polygon at its edges, so that shading is smooth between them and sharp across. */
function smoothFaces(section) {
    const n = section.length;
    const direction = (k) => {
        const [a, b] = [section[k % n], section[(k + 1) % n]];
        const size = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
        return [(b[0] - a[0]) / size, (b[1] - a[1]) / size];
    };
    const faces = [[section[0]]];
    for (let k = 0; k < n; k++) {
        const face = faces[faces.length - 1];
        face.push(section[(k + 1) % n]);
        const [p, q] = [direction(k), direction(k + 1)];
        if (k + 1 < n && p[0] * q[0] + p[1] * q[1] < EDGE) faces.push([section[k + 1]]);
    }
    return faces;
}

/** Points of a contact in space. */
export class Space {
    constructor(contact) {
        Object.assign(this, { contact });
        this.skew = [Math.cos(contact.skew), Math.sin(contact.skew)];
    }

    /** (x, y, z) of (ξ, η, ζ). */
    point([xi, eta, zeta]) {
        const [c, s] = this.contact.railFrame.turn;
        return [c * xi - s * zeta, eta, s * xi + c * zeta];
    }

    /** (x, y, z) of a point of the wheel's profile, turned about the axle by psi. */
    ofWheel([x, z], psi) {
        const w = this.contact.pair.radius - z;
        const [own, zeta] = this.contact.wheelFrame.into([x, z + 2 * w * Math.sin(psi / 2) ** 2]);
        const along = w * Math.sin(psi);
        const [c, s] = this.skew;
        return this.point([c * own - s * along, s * own + c * along, zeta]);
    }

    /** (x, y, z) of a point of the rail's profile, extruded by y. */
    ofRail([x, z], y) {
        const [x0, z0] = this.contact.railFrame.origin;
        return [x - x0, y, z - z0];
    }

    /** (x, y, z) of a point of the roller's profile, turned about its axle by psi. */
    ofRoller([x, z], psi) {
        const w = this.contact.pair.roller + z;
        return this.ofRail([x, z - 2 * w * Math.sin(psi / 2) ** 2], w * Math.sin(psi));
    }

    /** The extruded rail, or the turned roller, over y = ± reach. */
    rail(reach) {
        const { rail, roller } = this.contact.pair;
        const section = crossSection(rail, false);
        if (!roller) return swept(section, [-reach, reach], (at, y) => this.ofRail(at, y));
        return swept(section, anglesOver([-reach, reach], roller), (at, psi) => this.ofRoller(at, psi));
    }

    /** (x, y, z) of the rail's surface at ξ and η, `height` being ζ of its profile at ξ and what it is lifted by. */
    onSurface(xi, eta, height) {
        const { pair, railFrame } = this.contact;
        if (!pair.roller) return this.point([xi, eta, height]);
        const [x, z] = railFrame.out([xi, height]);
        return this.ofRoller([x, z], Math.asin(eta / (pair.roller + z)));
    }

    /** The turned wheel between two y at its nominal radius. */
    wheel(ends) {
        const { wheel, radius } = this.contact.pair;
        return swept(crossSection(wheel, true), anglesOver(ends, radius), (at, psi) => this.ofWheel(at, psi));
    }

    /** The surface of the rail under the grid in the colours of a gap: opaque up to the end of the scale. */
    separation({ grid }) {
        const { railHeight, scale } = this.contact;
        const { xi, eta, values } = grid;
        const [n, m] = [xi.length, eta.length];
        const positions = new Float32Array(3 * n * m);
        const colours = new Float32Array(4 * n * m);
        for (let i = 0; i < n; i++) {
            for (let j = 0; j < m; j++) {
                const k = i * m + j;
                positions.set(this.onSurface(xi[i], eta[j], railHeight[i] || 0), 3 * k);
                const [r, g, b, a] = colourOf(values[k] / scale);
                colours.set([linear(r), linear(g), linear(b), a / 255], 4 * k);
            }
        }
        const indices = [];
        for (let i = 0; i + 1 < n; i++) {
            if (Number.isNaN(railHeight[i]) || Number.isNaN(railHeight[i + 1])) continue;
            for (let j = 0; j + 1 < m; j++) {
                const a = i * m + j;
                indices.push(a, a + m, a + m + 1, a, a + m + 1, a + 1);
            }
        }
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
        geometry.setAttribute("color", new Float32BufferAttribute(colours, 4));
        geometry.setIndex(indices);
        return geometry;
    }

    /** Pairs of points of polylines [ξ, η] on the rail, as many numbers in a row, lifted by `lift` mm. */
    onRail(lines, lift) {
        const pairs = [];
        for (const line of lines) {
            for (let k = 1; k < line.length; k++) {
                for (const [xi, eta] of [line[k - 1], line[k]]) {
                    pairs.push(...this.onSurface(xi, eta, this.height(xi) + lift));
                }
            }
        }
        return pairs;
    }

    /** ζ of the rail at ξ, linear between the columns of the grid. */
    height(xi) {
        return this.contact.grid.column(this.contact.railHeight, xi);
    }

    /** Pairs of points along the edges of the wheel's end faces. */
    wheelEdges(ends) {
        const { wheel: section, radius } = this.contact.pair;
        const angles = anglesOver(ends, radius);
        const pairs = [];
        for (const psi of [angles[0], angles[angles.length - 1]]) {
            for (let k = 1; k < section.length; k++) {
                pairs.push(...this.ofWheel(section[k - 1], psi), ...this.ofWheel(section[k], psi));
            }
        }
        return pairs;
    }
}

/** Angles of a body's points about its axle, in equal steps between two y at a radius. */
function anglesOver(ends, radius) {
    const [from, to] = ends.map((y) => Math.asin(Math.min(Math.max(y / radius, -MOST_AROUND), MOST_AROUND)));
    return Array.from({ length: AROUND + 1 }, (_, k) => from + ((to - from) * k) / AROUND);
}

/** A share of full brightness, 0 to 1, of a colour value of a screen. */
function linear(value) {
    const share = value / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
}
