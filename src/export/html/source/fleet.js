// The page of a fleet.

import { theme } from "./colours.js";
import { floats, pageData, profilePoints } from "./data.js";
import { Sheet, element, figure, fixed } from "./dom.js";
import { Heat } from "./heat.js";
import { Plot } from "./plot.js";
import { themeButton } from "./themes.js";

const data = pageData();
const sheets = [];

/** The bars of a distribution. */
function bars({ title, axis, from, width, counts, told }) {
    const most = Math.max(...counts);
    const ends = [from, from + width * counts.length];
    const sheet = new Sheet(`${title}: ${told}`, (context, across, height) => {
        const colours = theme();
        const plot = new Plot(context, [66, 8, across - 80, height - 50], ends, [0, 1.06 * most]);
        counts.forEach((count, k) => {
            const [left, right] = [k, k + 1].map((n) => plot.x(from + n * width));
            context.fillStyle = colours.wheelBody;
            context.fillRect(left, plot.y(count), Math.max(right - left - 0.5, 0.5), plot.y(0) - plot.y(count));
        });
        plot.axes([axis, "number"]);
    }, { class: "cut" });
    sheets.push(sheet);
    return figure("bars", title, sheet, element("output", {}, told));
}

/** Where how many per cent of the wheels touch, by displacement, over the outline of a rail. */
function heatMap({ from, width, cells, first, step, rail, ...of }) {
    const shares = floats(of.shares);
    const rows = shares.length / cells;
    const borders = [[cells, from, width], [rows, first - step / 2, step]].map(([count, begin, size]) => Array.from({ length: count + 1 }, (_, k) => begin + size * k));
    const share = (cell, row) => shares[row * cells + cell];
    const values = Float32Array.from(shares, (_, k) => share(Math.floor(k / rows), k % rows) || NaN);
    const words = (cell, row) => {
        const [begin, end] = borders[0].slice(cell, cell + 2);
        return `${fixed(share(cell, row), 1)} % of the wheels touch ${fixed(begin, 1)} to ${fixed(end, 1)} mm at ${fixed(first + row * step, 2)} mm towards the rail`;
    };
    const map = {
        title: "Where the wheels touch the rail", across: "x on the rail [mm]", up: "towards the rail [mm]", borders, values, words,
        range: [0, Math.max(...shares)], name: "share of the wheels", format: (value) => `${fixed(value, 1)} %`,
    };
    const heat = new Heat(map, rail ? outline(rail, [borders[0][0] - 3, borders[0].at(-1) + 3]) : undefined);
    sheets.push(heat.sheet);
    return heat.figure(...(rail ? [element("p", { class: "names" }, element("span", { class: "rail" }, `rail ${rail.name}`))] : []));
}

/** The top of a rail below a map, at the same x. */
function outline(rail, across) {
    const points = profilePoints(rail).filter(([x]) => x >= across[0] && x <= across[1]);
    const heights = points.map(([, z]) => z);
    const up = [Math.max(Math.min(...heights), Math.max(...heights) - 25) - 1, Math.max(...heights) + 2];
    const draw = (context, place) => {
        const plot = new Plot(context, place, across, up);
        plot.clipped(() => plot.line(points, theme().rail, 1.8));
    };
    return { share: 0.26, across, draw };
}

function table(caption, columns, rows) {
    const head = element("tr", {}, ...columns.map((name) => element("th", { scope: "col" }, name)));
    const lines = rows.map((cells) => element("tr", {}, ...cells.map((cell) => element("td", {}, cell))));
    return element("div", { class: "facts wide" }, element("table", {}, element("caption", {}, caption), element("thead", {}, head), element("tbody", {}, ...lines)));
}

const worst = data.worst.map(({ cells: [name, ...cells], page }) => [element("a", { href: page }, name), ...cells]);
const more = data.with_finding - data.findings.length;
document.getElementById("page").replaceChildren(
    element(
        "header", {}, element("h1", {}, data.title), element("p", { class: "from" }, `${data.about}; wheelrail ${data.version}`),
        themeButton(() => sheets.forEach((sheet) => sheet.refresh())),
    ),
    element("div", { class: "fleet" }, ...(data.heat ? [heatMap(data.heat)] : []), table("Largest conicity", data.columns, worst)),
    element("div", { class: "curves" }, ...data.distributions.map(bars)),
    ...(data.findings.length ? [table("Findings", ["wheelset", "rails", "finding"], data.findings)] : []),
    element(
        "footer", {},
        ...(more > 0 ? [element("p", {}, `${more} more pairs have a finding: see the table.`)] : []),
        element("p", {}, "The map shows, at each displacement of the wheelset towards the wheel's own rail, how many per cent of the wheels have their lowest contact in each cell of the rail's profile, in its own axes."),
        element("p", {}, "A row for every pair is in fleet.csv beside this page."),
    ),
);

// What tests and scripts ask of the page.
window.wheelrail = { distributions: data.distributions, heat: data.heat && floats(data.heat.shares), worst: data.worst.length, findings: data.with_finding };
