// Lines of equal separation, by marching squares with linear interpolation along the grid's edges.

/**
 * The lines s = level of a grid, as polylines of [ξ, η] in mm. The region s < level lies on their left; a closed line ends
 * where it begins. Cells with an undefined corner have no lines.
 */
export function contours(grid, level) {
    const { xi, eta, values } = grid;
    const m = eta.length;
    // From the edge where a piece begins to the one where it ends. An edge is twice its lower node, plus 1 along η.
    const next = new Map();
    const s = new Float32Array(4);
    for (let i = 0; i + 1 < xi.length; i++) {
        for (let j = 0; j + 1 < m; j++) {
            const k = i * m + j;
            s[0] = values[k];
            s[1] = values[k + m];
            s[2] = values[k + m + 1];
            s[3] = values[k + 1];
            const inside = (s[0] < level) + (s[1] < level) + (s[2] < level) + (s[3] < level);
            if (inside === 0 || inside === 4 || Number.isNaN(s[0] + s[1] + s[2] + s[3])) continue;
            join(next, s, [2 * k, 2 * (k + m) + 1, 2 * (k + 1), 2 * k + 1], level);
        }
    }
    return chains(next, (edge) => crossing(grid, edge, level));
}

/** Adds the pieces inside one cell; corners and edges go counter-clockwise, an edge lies behind its corner. */
function join(next, s, edges, level) {
    const leaves = [];
    const enters = [];
    for (let k = 0; k < 4; k++) {
        const [here, there] = [s[k] < level, s[(k + 1) % 4] < level];
        if (here && !there) leaves.push(k);
        if (!here && there) enters.push(k);
    }
    if (leaves.length === 1) {
        next.set(edges[leaves[0]], edges[enters[0]]);
        return;
    }
    // On a saddle the mean of the corners decides which of them are joined.
    const turn = (s[0] + s[1] + s[2] + s[3]) / 4 < level ? 1 : 3;
    for (const k of leaves) next.set(edges[k], edges[(k + turn) % 4]);
}

/** Follows all pieces: open lines first, from their beginnings. */
function chains(next, point) {
    const ends = new Set(next.values());
    const starts = [...next.keys()].filter((edge) => !ends.has(edge));
    const lines = [];
    const follow = (start) => {
        const line = [point(start)];
        let here = start;
        while (next.has(here)) {
            const there = next.get(here);
            next.delete(here);
            line.push(point(there));
            here = there;
        }
        lines.push(line);
    };
    starts.forEach(follow);
    while (next.size > 0) follow(next.keys().next().value);
    return lines;
}

function crossing({ xi, eta, values }, edge, level) {
    const m = eta.length;
    const node = edge >> 1;
    const [i, j] = [Math.floor(node / m), node % m];
    const alongEta = edge % 2 === 1;
    const [a, b] = [values[node], values[alongEta ? node + 1 : node + m]];
    const t = (level - a) / (b - a);
    return alongEta
        ? [xi[i], eta[j] + t * (eta[j + 1] - eta[j])]
        : [xi[i] + t * (xi[i + 1] - xi[i]), eta[j]];
}

/** Whether a line ends where it begins. */
export function closed(line) {
    const [first, last] = [line[0], line[line.length - 1]];
    return line.length > 2 && first[0] === last[0] && first[1] === last[1];
}

/** Divides lines into those whose boxes meet the box around some loops, and the others: a neighbouring contact's. */
export function near(loops, lines) {
    if (loops.length === 0) return [lines, []];
    const own = boxOf(loops.flat());
    const meets = (line) => boxOf(line).every(([low, high], k) => low <= own[k][1] && high >= own[k][0]);
    return [lines.filter(meets), lines.filter((line) => !meets(line))];
}

/** Least and largest ξ and η of some points. */
function boxOf(points) {
    return [0, 1].map((k) => {
        const values = points.map((at) => at[k]);
        return [Math.min(...values), Math.max(...values)];
    });
}

/** Area inside of some lines, mm²: NaN where one of them is open, cut by the edge of the grid. */
export function areaInside(lines) {
    let area = 0;
    for (const line of lines) {
        if (!closed(line)) return NaN;
        for (let k = 1; k < line.length; k++) {
            const [[a, b], [c, d]] = [line[k - 1], line[k]];
            area += (a * d - b * c) / 2;
        }
    }
    return area;
}
