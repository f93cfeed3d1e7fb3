// Small helpers for elements and numbers.

/** Makes an element with attributes and children; text is never read as markup. */
export function element(tag, attributes = {}, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
        else if (value !== undefined && value !== false) node.setAttribute(name, value === true ? "" : value);
    }
    node.append(...children);
    return node;
}

/** A number with this many decimals and a true minus sign. */
export function fixed(value, decimals) {
    if (!Number.isFinite(value)) return "–";
    const text = value.toFixed(decimals);
    return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "\u2212");
}

/** A length in µm below 1 mm, in mm above. */
export function length(mm) {
    if (!Number.isFinite(mm)) return "no surface";
    return Math.abs(mm) < 1 ? `${fixed(1e3 * mm, 2)} µm` : `${fixed(mm, 4)} mm`;
}

/**
 * Tells `moved` of the pointer over an element, and whether it is held down; an element that is held keeps the pointer beyond
 * its edges.
 */
export function followed(node, moved) {
    const told = (event) => moved(event, event.buttons > 0);
    node.addEventListener("pointerdown", (event) => {
        node.setPointerCapture(event.pointerId);
        told(event);
    });
    node.addEventListener("pointermove", told);
}

/** Round values inside of a range, about so many; two at least. */
export function ticks([from, to], about) {
    const raw = (to - from) / Math.max(about, 1);
    const power = 10 ** Math.floor(Math.log10(raw));
    const ends = (size) => [Math.ceil(from / size - 1e-6), Math.floor(to / size + 1e-6)];
    const alone = (size) => ends(size)[0] >= ends(size)[1];
    const sizes = [0.5, 1, 2, 5, 10].map((m) => m * power);
    const fits = sizes.findIndex((size) => size >= raw * 0.999);
    const step = alone(sizes[fits]) ? sizes[fits - 1] : sizes[fits];
    const [first, last] = ends(step);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return Array.from({ length: last - first + 1 }, (_, k) => {
        const value = (first + k) * step;
        return [value, fixed(value, decimals)];
    });
}

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Direction of an arrow key, to the right and up; undefined of other keys, and of those that the browser takes. */
export function arrow(event) {
    return event.ctrlKey || event.metaKey || event.altKey ? undefined : ARROWS[event.key];
}

/** A sheet below its heading, a text or an element, with a button that saves it. */
export function figure(kind, heading, sheet, ...content) {
    const words = heading instanceof Node ? heading : element("span", {}, heading);
    return element("figure", { class: kind }, element("figcaption", {}, words, saveButton(sheet, words)), sheet.canvas, ...content);
}

/** A button that saves what a sheet shows as a PNG, on the ground of the page, under the title of the page and its own. */
function saveButton(sheet, heading) {
    const save = () => {
        const { canvas } = sheet;
        const name = `${document.title}, ${heading.textContent}`;
        const copy = element("canvas", { width: canvas.width, height: canvas.height });
        const context = copy.getContext("2d");
        context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--sheet");
        context.fillRect(0, 0, copy.width, copy.height);
        context.drawImage(canvas, 0, 0);
        copy.toBlob((blob) => {
            const href = URL.createObjectURL(blob);
            element("a", { href, download: `${name}.png` }).click();
            // The browser reads it after the click.
            setTimeout(() => URL.revokeObjectURL(href), 10_000);
        });
    };
    const label = `Save the picture: ${sheet.canvas.getAttribute("aria-label")}`;
    return element("button", { type: "button", class: "save", title: "Save this picture as PNG", "aria-label": label, onclick: save }, "PNG");
}

/**
 * A canvas that is as sharp as the screen. It is drawn in the next frame after its size or its content has changed. `draw`
 * gets its context, in CSS pixels, its width and height, and the number of pixels of the screen in one of CSS.
 */
export class Sheet {
    constructor(label, draw, attributes = {}) {
        // What takes keys is no mere picture to a screen reader.
        const role = "tabindex" in attributes ? "application" : "img";
        this.canvas = element("canvas", { role, "aria-label": label, ...attributes });
        this.draw = draw;
        new ResizeObserver(() => this.refresh()).observe(this.canvas);
    }

    /** Asks for the picture to be drawn; several wishes before the next frame are one. */
    refresh() {
        this.asked ??= requestAnimationFrame(() => {
            this.asked = undefined;
            this.paint();
        });
    }

    paint() {
        const { canvas } = this;
        const [width, height] = [canvas.clientWidth, canvas.clientHeight];
        if (width === 0 || height === 0) return;
        const ratio = window.devicePixelRatio || 1;
        const size = [Math.round(width * ratio), Math.round(height * ratio)];
        if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
        const context = canvas.getContext("2d");
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        context.clearRect(0, 0, width, height);
        this.draw(context, width, height, ratio);
    }
}
