// A quantity over two others, as cells in the colours of the scale; pointer and arrow keys read a cell.

import { colourOf, scaleBar, theme } from "./colours.js";
import { Sheet, arrow, figure, followed } from "./dom.js";
import { Plot } from "./plot.js";

export class Heat {
    /**
     * `map` has title, the names of its axes across and up, the ascending borders [across, up] of its cells, values at
     * i_across * n_up + i_up, NaN where there is none, the range of its colours, the name and the format of a value, and words(i_across,
     * i_up) on a cell. `under`, if any, draws below the axes, in a share of the height, within a range across.
     */
    constructor(map, under) {
        Object.assign(this, { map, under });
        this.counts = map.borders.map((borders) => borders.length - 1);
        const label = `${map.title}: ${map.up} over ${map.across}. Arrow keys go from cell to cell.`;
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { class: under ? "heat" : "cut", tabindex: 0 });
        this.readout = document.createElement("output");
        this.readout.value = "The pointer, or arrow keys, read a cell.";
        followed(this.sheet.canvas, (event, held) => {
            const at = this.plot?.back(event.offsetX, event.offsetY, held);
            if (at) this.choose(at.map((value, axis) => map.borders[axis].findLastIndex((border) => border <= value)));
        });
        this.sheet.canvas.addEventListener("keydown", (event) => this.key(event));
    }

    /** The map with its scale, what else there is, and what it says of a cell. */
    figure(...content) {
        const { title, range: [low, high], name, format } = this.map;
        const names = [0, 0.5, 1].map((share) => [share, format(low + share * (high - low))]);
        return figure("map", title, this.sheet, scaleBar(name, names), ...content, this.readout);
    }

    key(event) {
        const direction = arrow(event);
        if (!direction) return;
        const from = this.chosen ?? this.counts.map((count) => count >> 1);
        this.choose(this.chosen ? from.map((at, axis) => at + direction[axis]) : from);
        event.preventDefault();
        // The page has other plans with arrows.
        event.stopPropagation();
    }

    /** Reads a cell, the nearest one of those beyond the edges. */
    choose(cell) {
        this.chosen = cell.map((at, axis) => Math.min(Math.max(at, 0), this.counts[axis] - 1));
        this.readout.value = this.map.words(...this.chosen);
        this.sheet.refresh();
    }

    draw(context, width, height) {
        const { map: { borders: [across, up], values, range: [low, high] }, under, counts } = this;
        const below = under ? under.share * height : 0;
        const shown = under?.across ?? [across[0], across.at(-1)];
        const plot = new Plot(context, [66, 8, width - 80, height - below - 50], shown, [up[0], up.at(-1)]);
        this.plot = plot;
        const place = (i, k) => {
            const [x, y] = [plot.x(across[i]), plot.y(up[k + 1])];
            return [x, y, plot.x(across[i + 1]) - x, plot.y(up[k]) - y];
        };
        for (let i = 0; i < counts[0]; i++) {
            for (let k = 0; k < counts[1]; k++) {
                const value = values[i * counts[1] + k];
                if (!Number.isFinite(value)) continue;
                const [red, green, blue] = colourOf(high > low ? (value - low) / (high - low) : 0.5);
                context.fillStyle = `rgb(${red} ${green} ${blue})`;
                // Half a pixel more closes the seams between cells.
                const [x, y, wide, tall] = place(i, k);
                context.fillRect(x, y, wide + 0.5, tall + 0.5);
            }
        }
        if (this.chosen) {
            for (const [colour, line] of [[theme().paper, 4], [theme().boundary, 2]]) {
                Object.assign(context, { strokeStyle: colour, lineWidth: line });
                context.strokeRect(...place(...this.chosen));
            }
        }
        plot.axes([this.map.across, this.map.up]);
        under?.draw(context, [66, height - below + 4, width - 80, below - 8]);
    }
}

/** Borders of cells around ascending values. */
export function bordersOf(values) {
    const inner = [...values].slice(1).map((value, k) => (value + values[k]) / 2);
    const low = inner.length > 0 ? 2 * values[0] - inner[0] : values[0] - 0.5;
    const high = inner.length > 0 ? 2 * values[values.length - 1] - inner.at(-1) : values[values.length - 1] + 0.5;
    return [low, ...inner, high];
}
