// Colours: the scale of what is shown in colour, and those of the page's theme.

import { element } from "./dom.js";

/** Viridis at nine even places, dark to light. */
const STOPS = [
    [68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
    [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37],
];

/** Colour of s below 0, where the bodies overlap before any approach. */
const OVERLAP = [200, 0, 110];

/** Beyond this multiple of the scale nothing is coloured; between, colours fade. */
const FADED = 1.25;

/** Colour [red, green, blue, opacity 0 … 255] of a share of the scale. */
export function colourOf(share) {
    if (!(share <= FADED)) return [0, 0, 0, 0];
    if (share < 0) return [...OVERLAP, 255];
    const at = Math.min(share, 1) * (STOPS.length - 1);
    const k = Math.min(Math.floor(at), STOPS.length - 2);
    const mixed = STOPS[k].map((c, n) => c + (at - k) * (STOPS[k + 1][n] - c));
    return [...mixed, share <= 1 ? 255 : (255 * (FADED - share)) / (FADED - 1)];
}

/** A bar of all colours from left to right below its title, with names at shares of its length. */
export function scaleBar(title, names) {
    const stops = STOPS.map((c, k) => `rgb(${c.join(" ")}) ${(100 * k) / (STOPS.length - 1)}%`);
    const bar = element("div", { class: "bar", style: `background: linear-gradient(to right, ${stops.join(", ")})` });
    const label = ([share, text]) => element("span", { style: `left: ${100 * share}%; transform: translateX(-${100 * share}%)` }, text);
    const marks = element("div", { class: "marks" }, ...names.map(label));
    return element("div", { class: "legend", role: "img", "aria-label": `Scale of ${title}` }, element("div", {}, title), bar, marks);
}

/** The colours of the theme in use, by the names that the style sheet gives them. */
export function theme() {
    const style = getComputedStyle(document.documentElement);
    return new Proxy({}, { get: (_, name) => style.getPropertyValue(`--${name}`).trim() });
}
