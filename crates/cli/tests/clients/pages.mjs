// How the tests of pages open one.
import { pathToFileURL } from "node:url";

export const FLAGS = [
    "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    // Where there is no graphics card, WebGL alone is emulated: with the compositor, too, these tests take a fifth longer, and
    // with smooth edges a picture in space takes three times as long.
    "--disable-gpu-compositing", "--webgl-antialiasing-mode=none",
];

/** A driver's note on its own speed, no fault of a page: without a card, pictures in space are copied to the compositor. */
const OF_DRIVER = /GL Driver Message \(OpenGL, Performance/;

/** How long an action may take on a machine that has much else to do, ms: what never comes ends a test, what is slow does not. */
const PATIENCE = 300_000;

/** Opens a page; whatever it says or asks for is a failure. */
export async function open(context, file) {
    const page = await context.newPage();
    page.setDefaultTimeout(PATIENCE);
    page.faults = [];
    page.on("console", (message) => {
        if (!OF_DRIVER.test(message.text())) page.faults.push(`console: ${message.text()}`);
    });
    page.on("pageerror", (error) => page.faults.push(error.stack));
    page.on("request", (request) => {
        if (request.url() !== pathToFileURL(file).href) page.faults.push(`request: ${request.url()}`);
    });
    await page.goto(pathToFileURL(file).href);
    await page.waitForFunction(() => window.wheelrail !== undefined);
    await settled(page);
    return page;
}

/** Waits until what was asked for is drawn. */
export function settled(page) {
    return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}
