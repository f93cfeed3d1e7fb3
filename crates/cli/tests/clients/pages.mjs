// How the tests of pages open one.
import { pathToFileURL } from "node:url";

// Without a GPU the processor puts pages together, in two thirds of the time that a GPU's driver in software takes; WebGL keeps that driver.
export const FLAGS = [
    "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/** What this driver says of its own speed, whenever a picture of WebGL is put on a page. */
const OF_DRIVER = /^\[\.WebGL-0x[0-9a-f]+\]GL Driver Message \(OpenGL, Performance, GL_CLOSE_PATH_NV, High\): GPU stall due to ReadPixels( \(this message will no longer repeat\))?$/;

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
