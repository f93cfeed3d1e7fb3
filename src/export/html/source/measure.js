// The page of measured profiles.

import { theme } from "./colours.js";
import { floats, pageData } from "./data.js";
import { Sheet, arrow, element, figure, fixed } from "./dom.js";
import { Plot } from "./plot.js";
import { themeButton } from "./themes.js";

/** Magnifications, and the length that the longest arrow has at most, mm. */
const MAGNIFIED = [1000, 500, 200, 100, 50, 20, 10, 5, 2, 1];
const LONGEST = 12;

const data = pageData();
const files = data.files.map((file) => ({
    ...file,
    nominal: points(file.nominal, 2),
    measured: points(file.measured, 2),
    differences: points(file.differences, 4),
}));
let at = 0;

/** Decodes tuples of so many numbers. */
function points(text, size) {
    const values = floats(text);
    return Array.from({ length: values.length / size }, (_, k) => [...values.subarray(size * k, size * (k + 1))]);
}

function length([x, z, u, v]) {
    return Math.hypot(u - x, v - z);
}

/** The largest difference of a file, and by how much its arrows are magnified. */
function scale({ differences }) {
    const largest = Math.max(0, ...differences.map(length));
    return [largest, MAGNIFIED.find((times) => times * largest <= LONGEST) ?? 1];
}

/** The differences of a file as arrows, so many times as long. */
function magnified({ differences }, times) {
    return differences.map(([x, z, u, v]) => [[x, z], [x + times * (u - x), z + times * (v - z)]]);
}

/** The extent of points along one axis, with a margin. */
function range(all, k) {
    const values = all.map((point) => point[k]);
    return [Math.min(...values) - 2, Math.max(...values) + 2];
}

/** The shape of a sheet that a drawing of a file in true scale fills; a sixth of the width is for the names of the axis. */
function shape(file, times) {
    const all = [...file.nominal, ...file.measured, ...magnified(file, times).flat()];
    const [wide, high] = [0, 1].map((k) => range(all, k)).map(([from, to]) => to - from);
    return `${wide} / ${high + wide / 6}`;
}

const sheet = new Sheet("The profile over its nominal, with magnified differences", (context, width, height) => {
    const file = files[at];
    const colours = theme();
    const [, times] = scale(file);
    const arrows = magnified(file, times);
    const all = [...file.nominal, ...file.measured, ...arrows.flat()];
    if (all.length === 0) return;
    const plot = Plot.trueScale(context, [60, 8, width - 70, height - 50], range(all, 0), range(all, 1));
    plot.line(file.nominal, colours.rail, 1.2);
    plot.line(file.measured, colours.wheel, 1.8);
    plot.lines(arrows, colours.boundary, 1);
    plot.axes(["x [mm]", "z [mm]"]);
}, { class: "overlay", tabindex: 0 });

const chosen = element("select", { id: "file", onchange: () => go(chosen.selectedIndex) }, ...files.map(({ name }, k) => element("option", { value: k }, name)));
const [before, after] = [[-1, "Previous"], [1, "Next"]].map(([step, text]) => element("button", { type: "button", onclick: () => go(at + step) }, text));
const number = element("output", { for: "file", class: "said" });
const heading = element("span", {});
const alignment = element("output", {});
const names = element("p", { class: "names" }, element("span", { class: "rail" }, "nominal"), element("span", { class: "wheel" }, "measured"), element("span", { class: "difference" }, "difference"));
const drawing = figure("profile", heading, sheet, names, alignment);
const values = element("div", { class: "facts wide" });
const lists = element("div", {});

/** Goes to a file by its number. */
function go(to) {
    at = Math.min(Math.max(to, 0), files.length - 1);
    const file = files[at];
    chosen.selectedIndex = at;
    [before.disabled, after.disabled] = [at === 0, at === files.length - 1];
    number.value = `${at + 1} of ${files.length}`;
    const [largest, times] = scale(file);
    const shown = file.differences.length ? `differences along the normal × ${times}; the largest is ${fixed(largest, 3)} mm` : file.measured.length ? "the profile" : "no profile of its own";
    heading.textContent = `${file.name}: ${shown}`;
    sheet.canvas.hidden = file.measured.length === 0;
    drawing.querySelector(".save").hidden = sheet.canvas.hidden;
    if (file.measured.length) sheet.canvas.style.aspectRatio = shape(file, times);
    alignment.value = file.alignment;
    names.hidden = file.differences.length === 0;
    const interval = file.measures.some((row) => row[3]);
    const rows = file.measures.map(([text, ...cells]) => element("tr", {}, element("th", { scope: "row" }, text), ...cells.slice(0, interval ? 3 : 2).map((cell) => element("td", {}, cell))));
    values.replaceChildren(element("table", {}, element("caption", {}, interval ? "Measures, what their alignment is worth, and their intervals" : "Measures, and what their alignment is worth"), element("tbody", {}, ...rows)));
    const list = (label, items) => (items.length ? [element("ul", { class: "warnings", "aria-label": label }, ...items.map((text) => element("li", {}, text)))] : []);
    lists.replaceChildren(...list("Broken limits", file.broken), ...list("Findings", file.findings));
    sheet.refresh();
}

const page = document.getElementById("page");
page.replaceChildren(
    element("header", {}, element("h1", {}, data.title), element("p", { class: "from" }, `${data.about}; wheelrail ${data.version}`), themeButton(() => sheet.refresh())),
    element("div", { class: "head" }, element("div", { class: "slider" }, element("label", { for: "file" }, "File"), chosen, before, after, number)),
    lists,
    element("div", { class: "fleet" }, drawing, values),
    element("footer", {}, element("p", {}, "± is how far a value may be off: if the profile lay 0.1 mm or 0.1° otherwise, or as a fit has it, and by the noise of its points. An interval holds 95 % of the samples of noise, or of further measurements; the ± behind it is the sampling error of its ends. The left and right arrows go through the files.")),
);
page.addEventListener("keydown", (event) => {
    const [step] = arrow(event) ?? [0];
    if (!step || event.target === chosen) return;
    go(at + step);
    event.preventDefault();
});
go(0);

// What tests and scripts ask of the page.
window.wheelrail = { files: files.length, at: () => at, go, differences: (k) => files[k].differences.length };
