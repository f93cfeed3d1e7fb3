// Bundles the scripts of the pages: `npm ci && npm run build` writes view.js, sweep.js, fleet.js and measure.js beside this file, or into the
// folder that is given. The page of a run holds a copy of three.js, so that its licence stands in the bundle.
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const out = process.argv[2] ?? here;
const licence = readFileSync(join(here, "node_modules/three/LICENSE"), "utf8").trim();

for (const [name, banner] of [
    ["view", `/*!\nThis script contains three.js.\n\n${licence}\n*/`],
    ["sweep", ""],
    ["fleet", ""],
    ["measure", ""],
]) {
    await build({
        entryPoints: [join(here, "source", `${name}.js`)],
        outfile: join(out, `${name}.js`),
        bundle: true,
        minify: true,
        format: "iife",
        target: "es2022",
        charset: "ascii",
        legalComments: "none",
        banner: { js: banner },
        logLevel: "warning",
    });
}
writeFileSync(join(out, "three-LICENSE.txt"), `${licence}\n`);
