// The page of a sweep or a march.

import { Curves, nearest } from "./curves.js";
import { floats, pageData, pairsOf } from "./data.js";
import { arrow, element, figure, fixed } from "./dom.js";
import { Heat, bordersOf } from "./heat.js";
import { PairView } from "./pair.js";
import { themeButton } from "./themes.js";

const data = pageData();
const positions = floats(data.positions);
const [, axis, unit] = /^(.*) \[(.*)\]$/.exec(data.abscissa);
const name = axis[0].toUpperCase() + axis.slice(1);
const step = (positions[positions.length - 1] - positions[0]) / Math.max(positions.length - 1, 1);
/** Decimals of a position: two more than a step has. */
const decimals = Math.min(Math.max(2 - Math.round(Math.log10(step || 1)), 0), 6);
const state = { positions, at: positions.length >> 1, lifted: false, events: data.events.rows.map((event) => event.at) };
const pairs = pairsOf(data);
const sides = data.sides.map((side) => new PairView(side, pairs, state));
const panels = data.panels.map((panel) => {
    const curves = panel.curves.map((curve) => ({ ...curve, values: floats(curve.values) }));
    return new Curves({ ...panel, curves }, data.abscissa, state, move);
});
const heat = data.map ? conicityMap(data.map) : null;
const said = [...sides, ...panels].map(() => element("output", {}));
const position = element("output", { for: "position", class: "said" });
const slider = element("input", {
    id: "position", type: "range", min: 0, max: positions.length - 1, step: 1, oninput: () => move(Number(slider.value)),
});
const lifted = element("input", {
    id: "lifted", type: "checkbox",
    onchange: () => {
        state.lifted = lifted.checked;
        refresh();
    },
});

const page = document.getElementById("page");
page.replaceChildren(
    element("header", {}, element("h1", {}, data.title), element("p", { class: "from" }, `${data.about}; wheelrail ${data.version}`), themeButton(refresh)),
    ...(data.findings.length > 0 ? [element("ul", { class: "warnings" }, ...data.findings.map((text) => element("li", {}, text)))] : []),
    element(
        "div",
        { class: "head" },
        element("div", { class: "slider" }, element("label", { for: "position" }, name), slider, position, element("label", { for: "lifted", class: "choice" }, lifted, " wheels lifted")),
    ),
    element("div", { class: "pairs" }, ...sides.map((side, k) => figure("pair", side.side.right ? "Right side" : "Left side", side.sheet, names(side.pair), said[k]))),
    element(
        "div",
        { class: "curves" },
        ...panels.map((panel, k) => figure("curve", panel.panel.title, panel.sheet, said[sides.length + k])),
        ...(heat ? [heat.figure()] : []),
    ),
    ...(data.events.rows.length > 0 ? [eventList()] : []),
    ...(data.figures.length > 0 ? [keyFigures()] : []),
    element(
        "footer",
        {},
        element("p", {}, "The pointer over a curve, the slider, and the left and right arrows (with Shift by ten positions) choose the position; the profiles above stand where the wheelset is there, with its roll and height, seen along the track. Filled: the lowest contact of a side; open: further ones within the gap that the scene asks for."),
        ...(data.events.rows.length > 0 ? [element("p", {}, "Triangles below the curves are the events of the list.")] : []),
        ...data.notes.map((note) => element("p", {}, note)),
    ),
);
page.addEventListener("keydown", (event) => {
    const [step] = arrow(event) ?? [0];
    if (!step || event.target === slider) return;
    move(state.at + step * (event.shiftKey ? 10 : 1));
    event.preventDefault();
});
move(state.at);

/** What the lines of a pair are. */
function names({ names: [rail, wheel] }) {
    return element("p", { class: "names" }, element("span", { class: "rail" }, `rail ${rail}`), element("span", { class: "wheel" }, `wheel ${wheel}`));
}

/** The conicity over gauge and amplitude. */
function conicityMap({ title, across, up, ...arrays }) {
    const [gauges, amplitudes, values] = [arrays.gauges, arrays.amplitudes, arrays.values].map(floats);
    const known = [...values].filter(Number.isFinite);
    const words = (i, k) => `${fixed(gauges[i], 2)} mm, amplitude ${fixed(amplitudes[k], 2)} mm: ${fixed(values[i * amplitudes.length + k], 3)}`;
    return new Heat({
        title, across, up, values, words,
        borders: [gauges, amplitudes].map(bordersOf),
        range: known.length > 0 ? [Math.min(...known), Math.max(...known)] : [0, 1],
        name: "equivalent conicity tan γ", format: (value) => fixed(value, 3),
    });
}

/** What happens between the positions: the place of each goes there. */
function eventList() {
    const { columns, rows, more } = data.events;
    const go = (at, place) => element("button", { type: "button", onclick: () => move(nearest(positions, at)), "aria-label": `Go to ${place}` }, place);
    const named = (k, cell) => element("td", { "data-name": columns[k] }, cell);
    const row = ({ at, cells: [place, ...cells] }) => element("tr", {}, named(0, go(at, place)), ...cells.map((cell, k) => named(k + 1, cell)));
    const table = element(
        "table", { class: "events" }, element("caption", {}, "Events"),
        element("thead", {}, element("tr", {}, ...columns.map((column) => element("th", { scope: "col" }, column)))), element("tbody", {}, ...rows.map(row)),
    );
    const rest = more > 0 ? [element("p", {}, `${more} more are in the table of events.`)] : [];
    return element("div", { class: "facts wide" }, table, ...rest);
}

/** The key figures with their meaning. */
function keyFigures() {
    const row = ({ name, value, meaning }) =>
        element("tr", {}, element("th", {}, name), element("td", { class: "number" }, value), element("td", {}, meaning));
    const table = element("table", { class: "figures" }, element("caption", {}, "Key figures"), ...data.figures.map(row));
    return element("div", { class: "facts wide" }, table);
}

/** Goes to a position by its number. */
function move(at) {
    state.at = Math.min(Math.max(at, 0), positions.length - 1);
    slider.value = state.at;
    position.value = `${fixed(positions[state.at], decimals)} ${unit}`;
    slider.setAttribute("aria-valuetext", position.value);
    sides.forEach((side, k) => (said[k].value = side.said()));
    panels.forEach((panel, k) => {
        const values = panel.said().map(([name, value]) => element("span", {}, `${name} ${value}`.trim()));
        said[sides.length + k].replaceChildren(...values);
    });
    refresh();
}

function refresh() {
    [...sides, ...panels, ...(heat ? [heat] : [])].forEach((view) => view.sheet.refresh());
}

// What tests and scripts ask of the page: lengths in mm, angles in rad.
window.wheelrail = {
    positions: positions.length,
    at: () => state.at,
    position: () => positions[state.at],
    step,
    events: state.events,
    panels: panels.length,
    move,
    values: (k) => panels[k].said(),
    contacts: (k) => sides[k].contacts[state.at],
    joined: (k) => sides[k].joined(),
};
