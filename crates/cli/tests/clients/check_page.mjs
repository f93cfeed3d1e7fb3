// Opens pages of runs in a headless browser, as a reader would, and prints one line for each.
//
//     node check_page.mjs BROWSER < JSON
//
// The JSON is a list of pages: { name, page, others: [{ contact, delta, loops, area, plane }] }, where `others` are runs of the
// same scene with other approaches, mm: the exact loops of their boundaries and their area, of the gap that the page shows first.
// Runs over the rail's surface have the loops of s, too, as `plane`. A page with `table`, the CSV of a sweep or a march, is that of
// the sweep or the march, whose events are in `events`. Keys, pointer, themes and telephone are tried on the first page and on those of more than two contacts. A failed check
// ends with exit code 1.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { FLAGS, open, settled } from "./pages.mjs";

/** Largest distance of an exact boundary from the page's contour, in steps of the page's grid along each axis. */
const WITHIN_STEPS = 0.05;
/** Largest distance of two points of contact that a picture of profiles joins, mm. */
const WITHIN_PICTURE = 0.02;
/** Largest relative difference of the areas. */
const WITHIN_AREA = 1e-3;

/** Numbers of different colours of all visible canvases. */
function colours(page) {
    return page.evaluate(() =>
        [...document.querySelectorAll("canvas")].filter((canvas) => canvas.clientWidth > 0).map((canvas) => {
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return new Set(new Uint32Array(data.buffer)).size;
        }),
    );
}

/** Largest distance of exact points from polylines, in steps. */
function farthest(exact, lines, [dx, dy]) {
    let most = 0;
    for (const [x, y] of exact.flat()) {
        let least = Infinity;
        for (const line of lines) {
            for (let k = 1; k < line.length; k++) {
                const [a, b] = [line[k - 1], line[k]].map(([u, v]) => [(u - x) / dx, (v - y) / dy]);
                const d = [b[0] - a[0], b[1] - a[1]];
                const share = -(a[0] * d[0] + a[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
                const t = Math.min(Math.max(share, 0), 1) || 0;
                least = Math.min(least, Math.hypot(a[0] + t * d[0], a[1] + t * d[1]));
            }
        }
        most = Math.max(most, least);
    }
    return most;
}

/** The lines that reach into the box around some loops: a page's window may show a neighbouring contact, too. */
function around(loops, lines) {
    const box = [0, 1].map((k) => {
        const values = loops.flat().map((at) => at[k]);
        return [Math.min(...values), Math.max(...values)];
    });
    const inside = (at) => box.every(([low, high], k) => at[k] >= low && at[k] <= high);
    return lines.filter((line) => line.some(inside));
}

/** The slider moves the contour to the boundary that a run gives for that δ. */
async function slider(page, others) {
    const found = [];
    for (const { contact, delta, loops, area, plane } of others) {
        await page.locator(`#delta-${contact}`).evaluate((input, share) => {
            input.value = share * input.max;
            input.dispatchEvent(new Event("input"));
        }, await page.evaluate(([k, mm]) => mm / (3 * window.wheelrail.given(k)), [contact, delta]));
        const [near, step] = await page.evaluate((k) => [window.wheelrail.delta(k), window.wheelrail.given(k) / 200], contact);
        assert.ok(Math.abs(near - delta) <= step, `δ ${near}, not ${delta}`);
        const [drawn, steps, shown] = await page.evaluate(([k, mm]) => {
            // The slider has steps; the rest of the way is none of them.
            if (Math.abs(window.wheelrail.delta(k) - mm) > 1e-9) window.wheelrail.setDelta(mm, k);
            return [window.wheelrail.contour(k), window.wheelrail.steps(k), window.wheelrail.area(k)];
        }, [contact, delta]);
        const lines = around(loops, drawn);
        assert.equal(lines.length, loops.length, "as many loops as the run has");
        const distance = farthest(loops, lines, steps);
        const relative = Math.abs(shown / area - 1);
        const within = plane ? await withinOfPlane(page, contact, plane, steps) : WITHIN_STEPS;
        assert.ok(distance < within, `contact ${contact}, δ ${delta}: ${distance} steps from the run's boundary`);
        assert.ok(relative < WITHIN_AREA, `contact ${contact}, δ ${delta}: area differs by ${relative}`);
        found.push(`δ ${delta}: ${distance.toFixed(4)} steps, area ${relative.toExponential(1)}`);
    }
    return found;
}

/** Where a joint of the profiles bends the boundaries within a cell, that of t lies no farther off than that of s. */
async function withinOfPlane(page, contact, plane, steps) {
    const layer = page.locator(`#layer-${contact}`);
    await layer.selectOption("separation s");
    const distance = farthest(plane, await page.evaluate((k) => window.wheelrail.contour(k), contact), steps);
    await layer.selectOption({ index: 0 });
    assert.ok(distance < 2 * WITHIN_STEPS, `s = δ is ${distance} steps from the run's boundary`);
    return Math.max(WITHIN_STEPS, distance);
}

/** Keys move the cut and δ. */
async function keys(page) {
    const state = () => page.evaluate(() => [window.wheelrail.cut(0), window.wheelrail.delta(0), window.wheelrail.steps(0)]);
    const plan = page.locator("canvas.plan").first();
    await plan.focus();
    await page.keyboard.press("Home");
    const [before, delta, steps] = await state();
    for (const key of ["ArrowRight", "Shift+ArrowUp", "+"]) await page.keyboard.press(key);
    const [after, larger] = await state();
    assert.ok(Math.abs(after[0] - before[0] - steps[0]) < 1e-9 && Math.abs(after[1] - before[1] - 10 * steps[1]) < 1e-9);
    assert.ok(larger > delta, "+ raises δ");
}

/** The pointer reads s, and a drag turns the view in space. */
async function pointer(page) {
    const plan = page.locator("canvas.plan").first();
    const box = await plan.boundingBox();
    await page.mouse.move(box.x + 0.55 * box.width, box.y + 0.4 * box.height);
    const text = await page.locator("figure.plan output").first().textContent();
    assert.match(text, /^ξ\s\S+\smm {3}η\s\S+\smm {3}s\s(\S+\s(µm|mm)|no\ssurface)$/);
    const space = page.locator("canvas.space").first();
    const [before, room] = [await space.screenshot(), await space.boundingBox()];
    await page.mouse.move(room.x + 0.3 * room.width, room.y + 0.5 * room.height);
    await page.mouse.down();
    await page.mouse.move(room.x + 0.5 * room.width, room.y + 0.6 * room.height, { steps: 3 });
    await page.mouse.up();
    await settled(page);
    assert.ok(!before.equals(await space.screenshot()), "a drag turns the view");
}

/** Over the rail's surface t is shown first and said to be so; the choice, by keys, shows s and the boundary `plane` of its own. */
async function conformal(page, plane) {
    const figure = page.locator("figure.plan");
    assert.match(await figure.locator("output").textContent(), / {3}t\s\S+\s(µm|mm) {3}s\s\S+\s(µm|mm)$/);
    const shown = async (edge, name) => {
        assert.match(await figure.locator(".boundary").textContent(), new RegExp(`${edge}$`));
        assert.match(await figure.locator(".legend").textContent(), name);
        return page.evaluate(() => [window.wheelrail.contour(), window.wheelrail.steps()]);
    };
    await page.getByRole("button", { name: "δ of the run" }).click();
    const [t] = await shown("t = δ cos α", /^gap t along the rail's normal/);
    const drawn = await figure.locator("canvas").screenshot();
    await page.locator("#layer-0").focus();
    await page.keyboard.press("ArrowDown");
    await settled(page);
    const [s, steps] = await shown("s = δ", /^separation s/);
    const distance = farthest(plane, s, steps);
    assert.ok(distance < WITHIN_STEPS, `s = δ is ${distance} steps from the run's boundary`);
    assert.ok(!drawn.equals(await figure.locator("canvas").screenshot()), "s and t look different");
    await page.keyboard.press("ArrowUp");
    assert.deepEqual(await shown("t = δ cos α", /^gap t/), [t, steps]);
}

/** The same page looks the same twice, and otherwise in the dark. */
async function themes(page) {
    const shots = [await page.screenshot(), await page.screenshot()];
    assert.ok(shots[0].equals(shots[1]), "two screenshots of one page");
    await page.locator("button.theme").click();
    await page.mouse.move(0, 0);
    await settled(page);
    assert.ok(!shots[0].equals(await page.screenshot()), "light and dark");
}

/** On a telephone nothing is wider than the screen, and a touch moves the cut. */
async function telephone(browser, file) {
    const context = await browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    const page = await open(context, file);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "no sideways scrolling");
    const plan = page.locator("canvas.plan").first();
    await plan.scrollIntoViewIfNeeded();
    const box = await plan.boundingBox();
    const before = await page.evaluate(() => window.wheelrail.cut(0));
    await page.touchscreen.tap(box.x + 0.55 * box.width, box.y + 0.3 * box.height);
    const after = await page.evaluate(() => window.wheelrail.cut(0));
    assert.notDeepEqual(after, before, "a touch moves the cut");
    assert.deepEqual(page.faults, []);
    await context.close();
}

/** The rows of a CSV file by the names of their columns. */
function rowsOf(file) {
    const [header, ...lines] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
    return lines.map((cells) => Object.fromEntries(header.map((name, k) => [name, cells[k]])));
}

/** A number of the page, and half of its last decimal. */
function numberOf(text) {
    const value = Number(text.replace("\u2212", "-"));
    return [value, 0.51 * 10 ** -(text.split(".")[1]?.length ?? 0)];
}

/** What the panels of a march show of a side's lowest contact: column and factor. */
const OF_MARCH = [
    ["z_mm", 1], ["rolling_radius_mm", 1], ["rail_x_mm", 1], ["wheel_x_mm", 1], ["y_mm", 1], ["contact_angle_rad", 180 / Math.PI],
];

/** The panels say what the rows of a position say. */
function panelsAgree(panels, rows, column) {
    const place = rows[0][column];
    if (column === "lateral_mm") {
        const [shown, within] = numberOf(panels[0][0][1]);
        assert.ok(Math.abs(shown - rows[0].delta_r_mm) <= within, `Δr ${shown} and ${rows[0].delta_r_mm} at ${place}`);
        return;
    }
    for (const [k, [name, factor]] of OF_MARCH.entries()) {
        for (const [side, text] of panels[k]) {
            const expected = factor * rows.find((row) => row.side === side && row.contact === "1")[name];
            const [shown, within] = numberOf(text);
            assert.ok(Math.abs(shown - expected) <= within + 1e-6 * Math.abs(expected), `${side} ${name} ${shown} and ${expected} at ${place}`);
        }
    }
}

/** The page of a sweep or a march says what its table says, wherever the slider, the pointer and the keys take it. */
async function sweep(page, table) {
    const rows = rowsOf(table);
    const [column] = Object.keys(rows[0]);
    const places = [...new Set(rows.map((row) => row[column]))];
    assert.equal(await page.evaluate(() => window.wheelrail.positions), places.length);
    let apart = 0;
    for (const [number, place] of places.entries()) {
        await page.locator("#position").fill(String(number));
        const [position, sides, panels] = await page.evaluate(() => {
            const { wheelrail } = window;
            const sides = [0, 1].map((k) => [wheelrail.contacts(k), wheelrail.joined(k)]);
            return [wheelrail.position(), sides, Array.from({ length: wheelrail.panels }, (_, k) => wheelrail.values(k))];
        });
        assert.ok(Math.abs(position - place) < 1e-5, `${position} at ${place}`);
        const here = rows.filter((row) => row[column] === place);
        for (const [side, [contacts, joined]] of ["left", "right"].map((side, k) => [side, sides[k]])) {
            const own = here.filter((row) => row.side === side);
            const shown = contacts.map(({ rail, wheel, angle, gap }) => [rail, wheel, angle, gap]);
            const expected = own.map((row) => [row.rail_x_mm, row.wheel_x_mm, row.contact_angle_rad, row.gap_mm].map(Number));
            assert.equal(shown.length, expected.length, `${side} at ${place}`);
            shown.flat().forEach((x, k) => assert.ok(Math.abs(x - expected.flat()[k]) < 1e-4));
            const touching = joined.filter((_, k) => Number(own[k].gap_mm) === 0);
            for (const [[a, b], [c, d]] of touching) apart = Math.max(apart, Math.hypot(a - c, b - d));
        }
        panelsAgree(panels, here, column);
    }
    assert.ok(apart < WITHIN_PICTURE, `points of contact ${apart} mm apart`);
    const canvas = page.locator("canvas.cut").nth(3);
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
    const pointed = await page.evaluate(() => window.wheelrail.at());
    assert.ok(pointed > 0 && pointed < places.length / 2, `the pointer chose ${pointed}`);
    await canvas.focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => window.wheelrail.at()), pointed + 1);
    return `${places.length} positions, points of contact at most ${apart.toExponential(1)} mm apart`;
}

/** The events of a march are those of its table; each is marked on the curves, and its button, by pointer or key, goes there. */
async function listed(page, file) {
    const expected = rowsOf(file);
    const [column] = Object.keys(expected[0]);
    const buttons = page.locator(".events button");
    assert.equal(await buttons.count(), expected.length);
    for (const [k, event] of expected.entries()) {
        const button = buttons.nth(k);
        const [shown, within] = numberOf(await button.textContent());
        assert.ok(Math.abs(shown - event[column]) <= within, `${shown} and ${event[column]}`);
        const cells = await page.locator(".events tbody tr").nth(k).locator("td").allTextContents();
        assert.deepEqual(cells.slice(1, 3), [event.side, event.event]);
        await page.evaluate(() => window.wheelrail.move(0));
        if (k % 2 === 0) await button.click();
        else await button.press("Enter");
        const [position, step] = await page.evaluate(() => [window.wheelrail.position(), window.wheelrail.step]);
        assert.ok(Math.abs(position - event[column]) <= 0.5001 * step, `${position} at ${event[column]}`);
    }
    assert.equal(await page.evaluate(() => window.wheelrail.events.length), expected.length);
    return `; ${expected.length} events`;
}

/** Side by side, the rows of contacts are at one height. */
async function aligned(page) {
    const tops = await page.evaluate(() =>
        ["figure.space", "figure.plan", "figure.profiles"].map((row) => [...document.querySelectorAll(row)].map((part) => part.getBoundingClientRect().top)),
    );
    for (const row of tops) assert.ok(Math.max(...row) - Math.min(...row) < 1.5, `rows at ${row}`);
}

const profile = mkdtempSync(join(tmpdir(), "wheelrail-pages-"));
const [executablePath] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath, args: [...FLAGS, `--disk-cache-dir=${profile}`] });
try {
    for (const [number, { name, page: file, others, table, events }] of JSON.parse(readFileSync(0, "utf8")).entries()) {
        const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, offline: true });
        const page = await open(context, file);
        const drawn = await colours(page);
        assert.ok(drawn.length >= 5 && drawn.every((count) => count > 8), `${name}: colours of the pictures: ${drawn}`);
        if (table) {
            console.log(`page ${name}: ${drawn.length} pictures; ${await sweep(page, table)}${events ? await listed(page, events) : ""}`);
            await themes(page);
            assert.deepEqual(page.faults, [], name);
            await context.close();
            continue;
        }
        const found = await slider(page, others);
        const tried = number === 0 || (await page.evaluate(() => window.wheelrail.contacts.length)) > 2;
        for (const attempt of tried ? [keys, pointer, themes] : []) await attempt(page);
        if (name === "wheelset") await aligned(page);
        const plane = others[0]?.plane;
        if (plane) await conformal(page, plane);
        assert.deepEqual(page.faults, [], name);
        await context.close();
        if (tried || plane) await telephone(browser, file);
        console.log(`page ${name}: ${drawn.length} pictures; ${found.join("; ") || "no patch"}`);
    }
} finally {
    await browser.close();
    rmSync(profile, { recursive: true });
}
