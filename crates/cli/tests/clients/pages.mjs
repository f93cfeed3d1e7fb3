// How the tests of pages open one.
import { pathToFileURL } from "node:url";

export const FLAGS = [
    "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/** Opens a page; whatever it says or asks for is a failure. */
export async function open(context, file) {
    const page = await context.newPage();
    page.faults = [];
    page.on("console", (message) => page.faults.push(`console: ${message.text()}`));
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
