// Goes through pages by keyboard, as a reader without a mouse would, at the widths of a telephone, a tablet and a desk, light and dark.
//
//     node check_keys.mjs BROWSER PAGE…
//
// Tab reaches every control once, in the order of the page, on the screen and with a focus that is seen; arrows, Enter and Space do what
// each is for; nothing is wider than the screen; pictures and bars of colours have names. A failed check ends with exit code 1.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { chromium } from "playwright-core";
import { FLAGS, open, settled } from "./pages.mjs";

const WIDTHS = [390, 820, 1400];

const SCHEMES = ["light", "dark"];

/** Number of pages that are tried at a time. */
const TOGETHER = 3;

/** Least contrast of what shows the focus against the page (WCAG 2, 1.4.11). */
const LEAST_CONTRAST = 3;

/** Most lines of what stands below the title. */
const MOST_LINES = 6.5;

/** What takes keys and is shown. */
const CONTROLS = "button:not(:disabled), input, select, a[href], [tabindex='0']";

/** In the page: numbers all controls that are shown, in the order of the page, and says what they are. */
function numbered(selector) {
    const shown = [...document.querySelectorAll(selector)].filter((control) => control.checkVisibility());
    return shown.map((control, k) => {
        control.dataset.control = k;
        return control.type ?? control.tagName;
    });
}

/** In the page: the number of the control with the focus, whether it is on the screen, its outline, and the contrast of that. */
function focused() {
    const control = document.activeElement;
    const { outlineStyle, outlineWidth, outlineColor } = getComputedStyle(control);
    const linear = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
    const luminance = (colour) => {
        const [r, g, b] = colour.match(/[\d.]+/g).map((part) => linear(part / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const [a, b] = [outlineColor, getComputedStyle(document.body).backgroundColor].map(luminance);
    const { left, top, right, bottom } = control.getBoundingClientRect();
    const onScreen = left >= 0 && right <= innerWidth && bottom > 0 && top < innerHeight;
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    return { number: control.dataset.control, onScreen, outline: outlineStyle === "none" ? 0 : parseFloat(outlineWidth), contrast };
}

/** Tab goes from control to control. */
async function order(page, controls) {
    await page.evaluate(() => document.activeElement.blur());
    for (let k = 0; k < controls.length; k++) {
        await page.keyboard.press("Tab");
        const { number, onScreen, outline, contrast } = await page.evaluate(focused);
        assert.equal(number, String(k), `Tab reaches control ${number}, not ${k}, a ${controls[k]}`);
        assert.ok(onScreen, `control ${k}, a ${controls[k]}, is off the screen`);
        assert.ok(outline >= 2 && contrast >= LEAST_CONTRAST, `control ${k}, a ${controls[k]}: outline ${outline} px, contrast ${contrast}`);
    }
}

/** In the page: what a control may change: all words, the other controls, and its own picture, of one outside of pictures the first. */
function seen() {
    const here = document.activeElement;
    const picture = (here.closest("figure") ?? document.querySelector("figure")).querySelector("canvas").toDataURL();
    const others = [...document.querySelectorAll("input, select")].filter((control) => control !== here);
    const values = others.map((control) => [control.value, control.checked]);
    const pressed = [...document.querySelectorAll("[aria-pressed]")].map((button) => button.ariaPressed);
    return JSON.stringify([document.body.innerText, document.documentElement.dataset.theme, values, pressed, picture]);
}

/** Keys change what is seen. */
async function changes(page, keys, what) {
    const before = await page.evaluate(seen);
    for (const key of keys) await page.keyboard.press(key);
    await settled(page);
    assert.notEqual(await page.evaluate(seen), before, `${what} does not answer to ${keys}`);
}

/** Every control answers to its keys. */
async function answers(page, controls) {
    for (const [k, kind] of controls.entries()) {
        const control = page.locator(`[data-control="${k}"]`);
        const what = `control ${k}, a ${kind}, "${await control.evaluate((node) => node.ariaLabel ?? node.textContent)}"`;
        // A file or a contact that was chosen may have put others in its place.
        if ((await control.count()) === 0 || !(await control.isVisible()) || (await control.isDisabled())) continue;
        await control.focus();
        if (kind === "range") {
            const at = () => control.evaluate((input) => Number(input.value));
            const before = await at();
            await changes(page, ["ArrowRight"], what);
            assert.equal(await at(), before + 1, `${what}: one step`);
            await page.keyboard.press("ArrowLeft");
            assert.equal(await at(), before, `${what}: one step back`);
        } else if (kind === "select-one") await changes(page, ["ArrowDown"], what);
        else if (kind === "checkbox") await changes(page, ["Space"], what);
        else if (kind === "CANVAS") await changes(page, ["ArrowLeft", "ArrowUp"], what);
        else if (await control.evaluate((node) => node.classList.contains("save"))) await saves(page, what);
        else if (kind === "button") await presses(page, control, what);
        else assert.ok(await control.getAttribute("href"), `${what} leads nowhere`);
    }
}

/** Enter saves a picture. */
async function saves(page, what) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
    assert.match(download.suggestedFilename(), /\.png$/, what);
    const bytes = readFileSync(await download.path());
    assert.ok(bytes.length > 1000 && bytes.subarray(1, 4).toString() === "PNG", `${what}: ${bytes.length} bytes`);
}

/** Enter presses a button. What it shows may be there already, so that another of its kind, or the start of the slider, comes before. */
async function presses(page, control, what) {
    const others = control.locator("xpath=(preceding-sibling::button | following-sibling::button)[not(@disabled)]");
    const isEvent = await control.evaluate((node) => node.closest(".events") !== null);
    if (isEvent) await page.locator("#position").press("Home");
    else if ((await others.count()) > 0) await others.first().press("Enter");
    await settled(page);
    await control.focus();
    await changes(page, ["Enter"], what);
}

/** Nothing is wider than its place, and what has no text has a name. */
async function fits(page) {
    const wide = await page.evaluate(() => {
        const parts = [document.documentElement, ...document.querySelectorAll(".facts, figure, figcaption, header, .head")];
        return parts.filter((part) => part.scrollWidth > part.clientWidth + 1).map((part) => `${part.tagName} ${part.className} "${part.textContent.slice(0, 40)}"`);
    });
    assert.deepEqual(wide, [], "wider than its place");
    const lines = await page.locator(".from").evaluate((text) => text.offsetHeight / parseFloat(getComputedStyle(text).lineHeight));
    assert.ok(lines < MOST_LINES, `the line below the title has ${lines} lines`);
    const nameless = await page.evaluate(() => {
        const named = (part) => part.ariaLabel || part.labels?.length || part.textContent.trim();
        const bars = [...document.querySelectorAll(".legend")].filter((legend) => !legend.firstElementChild.textContent);
        return [...document.querySelectorAll("button, input, select, a, canvas, [role='img']")].filter((part) => !named(part)).concat(bars).length;
    });
    assert.equal(nameless, 0, "controls, pictures and bars without a name");
    const unsaved = await page.locator("figure:not(:has(.save))").count();
    assert.equal(unsaved, 0, "pictures without a button that saves them");
}

/** Tries page number k at all widths, light and dark in turn; at one width its keys are pressed. */
async function tried(browser, file, k) {
    for (const [n, width] of WIDTHS.entries()) {
        const colorScheme = SCHEMES[(k + n) % 2];
        const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme, offline: true });
        const page = await open(context, file);
        try {
            assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), colorScheme);
            await fits(page);
            const controls = await page.evaluate(numbered, CONTROLS);
            await order(page, controls);
            const pressed = n === k % WIDTHS.length;
            if (pressed) await answers(page, controls);
            assert.deepEqual(page.faults, []);
            console.log(`${file}, ${width} px, ${colorScheme}: ${controls.length} controls${pressed ? ", pressed" : ""}`);
        } catch (error) {
            throw new Error(`${file}, ${width} px, ${colorScheme}`, { cause: error });
        }
        await context.close();
    }
}

const [executablePath, ...files] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath, args: FLAGS });
try {
    // Pages wait for their next frame most of the time: some are tried together.
    const rest = files.entries();
    await Promise.all(Array.from({ length: TOGETHER }, async () => {
        for (const [k, file] of rest) await tried(browser, file, k);
    }));
} finally {
    await browser.close();
}
