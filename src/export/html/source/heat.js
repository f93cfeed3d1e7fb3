// A quantity over two others, as cells in the colours of the scale.

import { colourOf, theme } from "./colours.js";
import { Sheet, fixed, followed } from "./dom.js";
import { Plot } from "./plot.js";

export class Heat {
    /** `map` has across, up, gauges, amplitudes, both ascending, and values at i_gauge * n_amplitudes + i_amplitude. */
    constructor(map) {
        this.map = map;
        this.borders = [map.gauges, map.amplitudes].map(borders);
        const known = [...map.values].filter((value) => Number.isFinite(value));
        this.range = known.length > 0 ? [Math.min(...known), Math.max(...known)] : [0, 1];
        this.sheet = new Sheet(`${map.title}: ${map.up} over ${map.across}`, (...to) => this.draw(...to), { class: "cut" });
        this.readout = document.createElement("output");
        followed(this.sheet.canvas, (event, held) => this.say(this.plot?.back(event.offsetX, event.offsetY, held)));
        this.say(null);
    }

    /** Number of the cell at a point. */
    cell([u, v]) {
        const [i, k] = [u, v].map((at, axis) => this.borders[axis].findIndex((border) => at < border) - 1);
        return i < 0 || k < 0 ? -1 : i * this.map.amplitudes.length + k;
    }

    /** Writes the value under the pointer below the map, or the range of all. */
    say(at) {
        const { map } = this;
        const cell = at ? this.cell(at) : -1;
        if (cell < 0) {
            this.readout.value = `${fixed(this.range[0], 3)} (dark) to ${fixed(this.range[1], 3)} (light)`;
            return;
        }
        const [i, k] = [Math.floor(cell / map.amplitudes.length), cell % map.amplitudes.length];
        this.readout.value = `${fixed(map.gauges[i], 2)} mm, amplitude ${fixed(map.amplitudes[k], 2)} mm: ${fixed(map.values[cell], 3)}`;
    }

    draw(context, width, height) {
        const [across, up] = this.borders;
        const plot = new Plot(context, [66, 8, width - 80, height - 50], [across[0], across.at(-1)], [up[0], up.at(-1)]);
        this.plot = plot;
        const [low, high] = this.range;
        for (let i = 0; i + 1 < across.length; i++) {
            for (let k = 0; k + 1 < up.length; k++) {
                const value = this.map.values[i * this.map.amplitudes.length + k];
                if (!Number.isFinite(value)) continue;
                const [red, green, blue] = colourOf(high > low ? (value - low) / (high - low) : 0.5);
                context.fillStyle = `rgb(${red} ${green} ${blue})`;
                const [x, y] = [plot.x(across[i]), plot.y(up[k + 1])];
                // Half a pixel more closes the seams between cells.
                context.fillRect(x, y, plot.x(across[i + 1]) - x + 0.5, plot.y(up[k]) - y + 0.5);
            }
        }
        context.fillStyle = theme().ink;
        plot.axes([this.map.across, this.map.up]);
    }
}

/** Borders of cells around ascending values. */
function borders(values) {
    const inner = [...values].slice(1).map((value, k) => (value + values[k]) / 2);
    const low = inner.length > 0 ? 2 * values[0] - inner[0] : values[0] - 0.5;
    const high = inner.length > 0 ? 2 * values[values.length - 1] - inner.at(-1) : values[values.length - 1] + 0.5;
    return [low, ...inner, high];
}
