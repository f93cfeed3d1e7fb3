// All views of one contact, with the slider, the table and the keys.

import { scaleBar } from "./colours.js";
import { closed, contours, near } from "./contours.js";
import { Cut } from "./cuts.js";
import { arrow, element, figure, fixed } from "./dom.js";
import { PlanView } from "./map.js";
import { Profiles } from "./profiles.js";
import { SpaceView } from "./scene.js";

/** Steps of the slider from 0 to the end of the scale. */
const STEPS = 600;

export class Panel {
    constructor(contact, number) {
        const [layer] = contact.layers;
        const state = { contact, layer, gap: layer.gap, delta: contact.delta, cut: [0, 0], lines: [], others: [] };
        state.cut = [0, 1].map((axis) => kept(0, contact.grid.ends(axis)));
        Object.assign(this, { contact, state });
        const moved = (cut) => this.moveCut(cut);
        this.space = new SpaceView(state);
        this.plan = new PlanView(state, moved);
        this.cuts = [0, 1].map((axis) => new Cut(axis, state, moved));
        this.profiles = new Profiles(state);
        this.legend = element("div");
        this.boundary = element("span", { class: "boundary" });
        this.given = element("span", { class: "given" }, "boundary of the run");
        this.edge = element("span", { class: "edge" }, "edge of the true contact");
        this.node = this.build(number);
        this.node.addEventListener("keydown", (event) => this.key(event));
        this.showLayer(0);
    }

    build(number) {
        const { contact } = this;
        const heading = `contact-${number}`;
        const [first, ...others] = contact.layers;
        const gap = first.gap.symbol === "s" ? "Separation" : "Gap";
        return element(
            "section",
            { class: "contact", "aria-labelledby": heading, id: `panel-${number}` },
            element("div", { class: "head" }, element("h2", { id: heading }, contact.name), this.slider(number)),
            this.warnings(),
            element(
                "div",
                { class: "views" },
                figure("space", `${gap} on the rail`, this.space.sheet, this.viewButtons(number)),
                figure("plan", others.length ? "On the contact plane" : "Separation on the contact plane", this.plan.sheet, this.legend, this.lines(), this.plan.readout, this.layers(number)),
                this.facts(),
                figure("cut", "Cut along ξ", this.cuts[0].sheet),
                figure("cut", "Cut along η", this.cuts[1].sheet),
                figure("profiles", "Profiles in the midplane", this.profiles.sheet, this.names()),
            ),
        );
    }

    warnings() {
        const { warnings } = this.contact;
        // Empty, it holds the place of a neighbour's.
        if (warnings.length === 0) return element("div", { class: "warnings none" });
        return element("ul", { class: "warnings", "aria-label": "Warnings" }, ...warnings.map((text) => element("li", {}, text)));
    }

    slider(number) {
        const id = `delta-${number}`;
        this.input = element("input", {
            id, type: "range", min: 0, max: STEPS, step: 1,
            oninput: () => this.setDelta((this.input.value / STEPS) * this.contact.scale, true),
        });
        this.reset = element("button", { type: "button", onclick: () => this.setDelta(this.contact.delta) }, "δ of the run");
        this.reset.hidden = !this.contact.approach;
        this.said = element("output", { for: id, class: "said" });
        return element("div", { class: "slider" }, element("label", { for: id }, "δ"), this.input, this.said, this.reset);
    }

    viewButtons(number) {
        const button = (view, text) => element("button", { type: "button", onclick: () => this.space.look(view) }, text);
        const option = (value, text) => element("option", { value }, text);
        const wheel = element("select", { id: `wheel-${number}` }, option("half", "half"), option("whole", "whole"), option("none", "none"));
        wheel.addEventListener("change", () => this.space.showWheel(wheel.value));
        return element(
            "div",
            { class: "buttons", role: "group", "aria-label": "View in space" },
            button("contact", "Contact"), button("whole", "Whole"), button("above", "Along ζ"),
            element("label", { for: wheel.id }, "wheel "), wheel,
        );
    }

    /** What the plan shows in colour, where there is a choice. */
    layers(number) {
        const { layers } = this.contact;
        if (layers.length === 1) return "";
        const choice = element("select", { id: `layer-${number}` }, ...layers.map(({ name }, k) => element("option", { value: k }, name)));
        choice.addEventListener("change", () => this.showLayer(choice.value));
        return element("div", { class: "layers" }, element("label", { for: choice.id }, "colour "), choice);
    }

    showLayer(number) {
        const { state } = this;
        state.layer = this.contact.layers[number];
        state.gap = state.layer.gap;
        const { gap, grid } = state.layer;
        this.legend.replaceChildren(grid === gap.grid ? this.gaps(gap) : this.pressures());
        this.boundary.textContent = `boundary of the patch, ${gap.symbol} = ${gap.edge}`;
        this.edge.hidden = gap.pressed.length === 0;
        this.setDelta(state.delta);
    }

    /** The scale of colours of the pressure. */
    pressures() {
        const { name, scale: largest } = this.state.layer;
        return scaleBar(`${name}, linear from 0`, [[0, "0"], [0.5, fixed(largest / 2, 0)], [1, `${fixed(largest, 0)} N/mm²`]]);
    }

    /** The scale of colours of a gap, which reaches from 0 to 3 δ of the run. */
    gaps({ name }) {
        const { scale, approach } = this.contact;
        const [unit, factor] = scale < 1 ? ["µm", 1e3] : ["mm", 1];
        const value = (share) => fixed(share * scale * factor, scale * factor < 10 ? 2 : 0);
        const names = approach
            ? [[0, "0"], [1 / 3, "δ"], [1, `3 δ = ${value(1)} ${unit}`]]
            : [[0, "0"], [0.5, value(0.5)], [1, `${value(1)} ${unit}`]];
        return scaleBar(`${name}, ${approach ? "linear from 0 to 3 δ of the run" : "linear from 0"}`, names);
    }

    /** What the lines of the plan are. */
    lines() {
        const cuts = element("span", { class: "cuts" }, "cuts");
        return element("p", { class: "names" }, this.boundary, this.edge, cuts, this.given);
    }

    names() {
        const [rail, wheel] = this.contact.pair.names;
        return element("p", { class: "names" }, element("span", { class: "rail" }, `rail ${rail}`), element("span", { class: "wheel" }, `wheel ${wheel}`));
    }

    facts() {
        const rows = this.contact.facts.map(([name, value]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value)));
        return element("div", { class: "facts" }, element("table", {}, element("caption", {}, "From the run"), element("tbody", {}, ...rows)));
    }

    /** Moves the boundary to another δ, mm. */
    setDelta(delta, bySlider = false) {
        const { contact, state } = this;
        const { gap } = state;
        state.delta = kept(delta, [0, contact.scale]);
        // The slider's steps do not hit the δ of the run, which its button gives.
        if (!bySlider) this.input.value = Math.round((state.delta / contact.scale) * STEPS);
        const own = contact.approach && state.delta === contact.approach;
        const [lines, others] = near(gap.boundary, contours(gap.closedBy, state.delta));
        state.lines = own ? gap.boundary : lines;
        state.others = others;
        this.say();
        this.refresh();
    }

    say() {
        const { contact, state } = this;
        const own = contact.approach && state.delta === contact.approach;
        this.given.hidden = own || !contact.approach;
        const cut = !own && state.lines.some((line) => !closed(line));
        const area = this.area();
        const size = cut ? "cut by the edge of the page's grid" : `area ${fixed(area, own ? 3 : 2)} mm²`;
        this.said.value = `${fixed(state.delta, 5)} mm, ${size}`;
        this.input.setAttribute("aria-valuetext", `δ ${this.said.value}`);
        this.reset.disabled = state.delta === contact.delta;
    }

    /** Area of the patch that is shown, mm². */
    area() {
        const { state: { gap, delta, lines }, contact } = this;
        return contact.approach && delta === contact.approach ? gap.area : gap.areaInside(lines);
    }

    moveCut([xi, eta]) {
        const { grid } = this.contact;
        this.state.cut = [kept(xi, grid.ends(0)), kept(eta, grid.ends(1))];
        this.refresh();
    }

    /** Arrows move the cut (turn the view, where it has the focus), plus and minus change δ, Home goes back to C. */
    key(event) {
        const { state, contact } = this;
        const direction = arrow(event);
        const inSpace = event.target === this.space.sheet.canvas;
        const onSheet = inSpace || event.target.tagName === "CANVAS";
        const step = (axis) => contact.grid.steps[axis] * (event.shiftKey ? 10 : 1);
        const delta = { "+": 1, "=": 1, "-": -1, "\u2212": -1 }[event.key];
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (delta) this.setDelta(state.delta + (delta * contact.scale) / (STEPS / 6));
        else if (inSpace && this.space.key(event)) event.preventDefault();
        else if (onSheet && direction) {
            const [dx, dy] = direction;
            this.moveCut([state.cut[0] + dx * step(0), state.cut[1] + dy * step(1)]);
        } else if (onSheet && event.key === "Home") this.moveCut([0, 0]);
        else return;
        event.preventDefault();
    }

    refresh() {
        [this.space, this.plan, ...this.cuts, this.profiles].forEach((view) => view.sheet.refresh());
    }
}

function kept(value, [low, high]) {
    return Math.min(Math.max(value, low), high);
}
