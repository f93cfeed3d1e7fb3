// The page of a run.

import { Contact } from "./contact.js";
import { pageData, pairsOf } from "./data.js";
import { element } from "./dom.js";
import { Panel } from "./panel.js";
import { themeButton } from "./themes.js";

/** Least width of a contact's column, px. */
const COLUMN = 430;

/** Most contacts that are shown side by side without being asked to. */
const BESIDE = 3;

const data = pageData();
const pairs = pairsOf(data);
const panels = data.contacts.map((raw, k) => new Panel(new Contact(raw, pairs), k));
const refresh = () => panels.forEach((panel) => panel.refresh());

const all = element("div", { class: "contacts" }, ...panels.map((panel) => panel.node));
const page = document.getElementById("page");
page.replaceChildren(
    element(
        "header",
        {},
        element("h1", {}, data.title),
        element("p", { class: "from" }, `${data.about}; wheelrail ${data.version}, scene ${data.scene_hash.slice(0, 12)}`),
        themeButton(refresh),
    ),
    ...(panels.length > 1 ? [tabs()] : []),
    all,
    element(
        "footer",
        {},
        element("p", {}, "Keys: Tab goes from picture to picture; arrows move the cut (with Shift by ten steps), Home takes it back to C; + and \u2212 change δ. In the view in space arrows turn, Page Up and Page Down come closer and go away. Mouse and touch: drag to move the cut and to turn the view."),
        ...data.notes.map((note) => element("p", {}, note)),
    ),
);
align();
refresh();
addEventListener("resize", align);

/** Buttons that show one contact, or all side by side. */
function tabs() {
    const buttons = [];
    const show = (chosen) => {
        buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(k === chosen)));
        panels.forEach((panel, k) => (panel.node.hidden = chosen < panels.length && k !== chosen));
        all.classList.toggle("beside", chosen === panels.length);
        align();
        refresh();
    };
    const names = [...panels.map((panel) => panel.contact.name), "Side by side"];
    buttons.push(...names.map((name, k) => element("button", { type: "button", onclick: () => show(k) }, name)));
    show(panels.length <= BESIDE && innerWidth >= COLUMN * panels.length ? panels.length : 0);
    return element("nav", { class: "tabs", "aria-label": "Contacts" }, ...buttons);
}

/** Side by side: one scale for all plans, and rows at one height. */
function align() {
    const beside = all.classList.contains("beside");
    const sides = [0, 1].map((axis) => Math.max(...panels.map(({ contact }) => contact.grid.ends(axis)[1] - contact.grid.ends(axis)[0])));
    panels.forEach((panel) => (panel.state.sides = beside ? sides : undefined));
    for (const row of [".head", ".warnings", "figure.plan"]) {
        const parts = panels.map((panel) => panel.node.querySelector(row));
        parts.forEach((part) => (part.style.minHeight = ""));
        const highest = Math.max(...parts.map((part) => part.offsetHeight));
        // Columns below each other, on a narrow page, have no rows in common.
        const apart = parts.some((part) => part.offsetLeft !== parts[0].offsetLeft);
        if (beside && apart) parts.forEach((part) => (part.style.minHeight = `${highest}px`));
    }
}

// What tests and scripts ask of the page: lengths in mm.
window.wheelrail = {
    contacts: panels.map((panel) => panel.contact.name),
    contour: (k = 0) => panels[k].state.lines,
    steps: (k = 0) => panels[k].contact.grid.steps,
    given: (k = 0) => panels[k].contact.delta,
    delta: (k = 0) => panels[k].state.delta,
    setDelta: (value, k = 0) => panels[k].setDelta(value),
    cut: (k = 0) => panels[k].state.cut,
    area: (k = 0) => panels[k].area(),
    gap: (xi, eta, k = 0) => panels[k].state.gap.grid.at(xi, eta),
};
