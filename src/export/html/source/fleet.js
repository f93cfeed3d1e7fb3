// The page of a fleet.

import { colourOf, gradient, theme } from "./colours.js";
import { floats, pageData, profilePoints } from "./data.js";
import { Sheet, element, fixed, followed } from "./dom.js";
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
    return element("figure", {}, element("figcaption", {}, title), sheet.canvas, element("output", {}, told));
}

/** Where how many per cent of the wheels touch, by displacement, over the outline of a rail. */
function heatMap(heat) {
    const shares = floats(heat.shares);
    const rows = shares.length / heat.cells;
    // Half of all wheels in one cell have the brightest colour, fewer where no cell has so many.
    const most = Math.max(...shares);
    const across = [heat.from, heat.from + heat.width * heat.cells];
    const up = [heat.first - heat.step / 2, heat.first + heat.step * (rows - 0.5)];
    const rail = heat.rail && profilePoints(heat.rail).filter(([x]) => x >= across[0] - 3 && x <= across[1] + 3);
    const wide = [across[0] - 3, across[1] + 3];
    const said = element("output", {}, "The pointer over the map reads a cell.");
    let plot;
    const sheet = new Sheet("Share of the wheels that touch the rail, by displacement", (context, width, height) => {
        const colours = theme();
        const below = rail ? 0.26 * height : 0;
        plot = new Plot(context, [66, 8, width - 80, height - below - 50], wide, up);
        for (let row = 0; row < rows; row++) {
            for (let cell = 0; cell < heat.cells; cell++) {
                const share = shares[row * heat.cells + cell];
                if (share === 0) continue;
                const [red, green, blue] = colourOf(share / most);
                context.fillStyle = `rgb(${red} ${green} ${blue})`;
                const [left, right] = [cell, cell + 1].map((n) => plot.x(heat.from + n * heat.width));
                const [top, bottom] = [row + 0.5, row - 0.5].map((n) => plot.y(heat.first + n * heat.step));
                context.fillRect(left, top, right - left + 0.5, bottom - top + 0.5);
            }
        }
        plot.axes(["x on the rail [mm]", "towards the rail [mm]"]);
        if (!rail) return;
        const heights = rail.map(([, z]) => z);
        const range = [Math.max(Math.min(...heights), Math.max(...heights) - 25) - 1, Math.max(...heights) + 2];
        const under = new Plot(context, [66, height - below + 4, width - 80, below - 8], wide, range);
        under.clipped(() => under.line(rail, colours.rail, 1.8));
    }, { class: "heat" });
    followed(sheet.canvas, (event) => {
        const at = plot?.back(event.offsetX, event.offsetY);
        if (!at) return;
        const [cell, row] = [Math.floor((at[0] - heat.from) / heat.width), Math.round((at[1] - heat.first) / heat.step)];
        const share = cell >= 0 && cell < heat.cells && row >= 0 && row < rows ? shares[row * heat.cells + cell] : 0;
        const from = heat.from + cell * heat.width;
        said.value = `${fixed(share, 1)} % of the wheels touch ${fixed(from, 1)} to ${fixed(from + heat.width, 1)} mm at ${fixed(heat.first + row * heat.step, 2)} mm towards the rail`;
    });
    sheets.push(sheet);
    const mark = (share) => element("span", { style: `left: ${100 * share}%; transform: translateX(-${100 * share}%)` }, `${fixed(share * most, 1)} %`);
    const legend = element(
        "div", { class: "legend", role: "img", "aria-label": "Scale of the share of the wheels" },
        element("div", { class: "bar", style: `background: ${gradient()}` }), element("div", { class: "marks" }, ...[0, 0.5, 1].map(mark)),
    );
    const names = heat.rail ? element("p", { class: "names" }, element("span", { class: "rail" }, `rail ${heat.rail.name}`)) : "";
    return element("figure", {}, element("figcaption", {}, "Where the wheels touch the rail"), sheet.canvas, legend, names, said);
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
