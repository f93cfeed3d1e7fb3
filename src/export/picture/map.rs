//! Draws a map: lines of equal gap over the solver's cells with the patch and its boundary, to scale, with units and a key.

use super::contour::Nodes;
use super::levels::{self, LevelLines};
use super::page::{BODY, INSIDE, Page, Pen, RED, SMALL};
use super::panel::{Panel, extremes, in_power, number, range, significant};

const BOUNDARY: Pen = Pen::new(RED, 2.2);
/// The edge of the true contact, which lies inside the boundary.
const PRESSED: Pen = Pen::new([40, 40, 40], 1.8).dashed([7.0, 3.0]);
const CELL: Pen = Pen::new([226, 220, 218], 0.6);

/// Shortest side \[page units\] of cells that are drawn. The borders of smaller cells would look like a grey area.
const SMALLEST_CELL: f64 = 5.0;

/// Distance from the edge of the window, as a share of its width, up to which a line lies along it: far below a line's width.
const ON_EDGE: f64 = 1e-6;

/// The true contact inside a patch.
#[derive(Debug, Clone, Copy)]
pub struct TrueContact<'a> {
    /// Its edges, lines in \[ξ, η\] \[mm\].
    pub edges: &'a [Vec<[f64; 2]>],
    /// The largest pressure \[N/mm²\].
    pub largest: f64,
}

/// A gap over a surface with the coordinates (u, η) \[mm\].
#[derive(Debug)]
pub(super) struct Map<'a> {
    /// Letter of the gap, s or t.
    pub(super) gap: &'a str,
    /// Letter of u, ξ or σ.
    pub(super) along: &'a str,
    /// Equation of the boundary.
    pub(super) boundary: &'a str,
    /// Centres u and η of the solver's cells \[mm\], ascending.
    pub(super) cells: [&'a [f64]; 2],
    /// The gap \[mm\] over the window of the cells, on as many points as smooth lines need.
    pub(super) values: Nodes<'a>,
    /// The boundary of the patch: closed loops of \[u, η\] \[mm\], whose first points are not repeated.
    pub(super) loops: Vec<Vec<[f64; 2]>>,
    /// The true contact, over ξ; `None` where no pressures were solved.
    pub(super) pressed: Option<TrueContact<'a>>,
    /// Approach δ \[mm\].
    pub(super) approach: f64,
}

impl Map<'_> {
    /// Draws the map into a room with free space on all sides for numbers, and to the right for the key. Returns its panel.
    pub(super) fn draw(&self, page: &mut Page, room: [f64; 4]) -> Panel {
        let [u, v] = self.cells.map(|values| range(values.iter().copied()));
        let panel = Panel::true_scale(room, u, v);
        let ring = |ring: &Vec<[f64; 2]>| {
            ring.iter().chain(ring.first()).map(|p| panel.point(*p)).collect::<Vec<_>>()
        };
        let rings: Vec<Vec<[f64; 2]>> = self.loops.iter().map(ring).collect();
        page.area(&rings, INSIDE);
        self.cells(page, &panel);
        let levels = levels::levels(&self.values, self.approach, &panel);
        for level in &levels {
            page.lines(&level.lines, level.pen);
        }
        levels::label(page, &levels, &rings, &panel);
        let boundary: Vec<_> = self.loops.iter().flat_map(|ring| self.boundary(&panel, ring)).collect();
        page.lines(&boundary, BOUNDARY);
        let edges = self.pressed.map_or(&[][..], |pressed| pressed.edges);
        page.lines(&edges.iter().flat_map(|line| panel.curve(line)).collect::<Vec<_>>(), PRESSED);
        panel.axes(page, [&format!("{} [mm]", self.along), "η [mm] (rolling direction)"]);
        let side = room[0] + room[2] + 40.0;
        self.key(page, [side, room[1] + 20.0], &levels);
        panel.scale_bar(page, [side + 130.0, room[1] + room[3]], 130.0);
        panel
    }

    /// Returns the lines of a loop on which the approach closes the gap: those along the window, which cut the patch off, are left out.
    fn boundary(&self, panel: &Panel, ring: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let edges = self.cells.map(|values| range(values.iter().copied()));
        let along = |a: &[f64; 2], b: &[f64; 2]| {
            (0..2).any(|k| {
                let near = ON_EDGE * edges[k].width();
                edges[k].ends().iter().any(|edge| (a[k] - edge).abs() < near && (b[k] - edge).abs() < near)
            })
        };
        let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
        let next = ring.iter().cycle().skip(1);
        let mut open = false;
        for (a, b) in ring.iter().zip(next) {
            if along(a, b) {
                open = false;
                continue;
            }
            let [from, to] = [a, b].map(|point| panel.point(*point));
            match lines.last_mut() {
                Some(line) if open => line.push(to),
                _ => lines.push(vec![from, to]),
            }
            open = true;
        }
        lines
    }

    /// Writes what the lines mean, beside them.
    fn key(&self, page: &mut Page, [side, top]: [f64; 2], levels: &[LevelLines]) {
        let mut row = top;
        let power = levels.first().map_or(0, |level| level.power);
        page.text([side, row], in_power(&format!("{} [mm]", self.gap), power), BODY);
        for level in levels {
            row += 20.0;
            page.legend([side, row], level.pen, &level.name);
        }
        row += 32.0;
        if !self.loops.is_empty() {
            page.legend([side, row], BOUNDARY, &format!("boundary {}", self.boundary));
            row += 32.0;
        }
        if let Some(TrueContact { largest, .. }) = self.pressed {
            page.legend([side, row - 10.0], PRESSED, "true contact");
            page.text([side, row + 8.0], format!("p ≤ {} N/mm²", number(largest, 1.0)), SMALL);
            row += 40.0;
        }
        let [along, eta] = self.cells;
        page.text([side, row], format!("grid {} × {} cells", along.len(), eta.len()), SMALL);
        for (name, step) in [self.along, "η"].into_iter().zip(self.cells.map(even_step)) {
            let Some(step) = step else { continue };
            row += 18.0;
            page.text([side, row], format!("Δ{name} = {} mm", significant(step, 3)), SMALL);
        }
    }

    /// Draws the borders of the solver's cells, half-way between their centres. Small cells are not drawn; the key gives
    /// their number and size.
    fn cells(&self, page: &mut Page, panel: &Panel) {
        let [x, y, w, h] = panel.place;
        let [along, eta] = self.cells;
        if w / (along.len() as f64) < SMALLEST_CELL || h / (eta.len() as f64) < SMALLEST_CELL {
            return;
        }
        let between = |pair: &[f64]| f64::midpoint(pair[0], pair[1]);
        let columns = along.windows(2).map(|pair| panel.point([between(pair), panel.v.low])[0]);
        let rows = eta.windows(2).map(|pair| panel.point([panel.u.low, between(pair)])[1]);
        let borders = columns.map(|px| vec![[px, y], [px, y + h]]);
        let borders: Vec<_> = borders.chain(rows.map(|py| vec![[x, py], [x + w, py]])).collect();
        page.lines(&borders, CELL);
    }
}

/// Returns the step of values that are equally spaced within 1e-4 of the step; `None` if the steps differ.
fn even_step(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let steps = extremes(values.windows(2).map(|pair| pair[1] - pair[0]));
    (steps.low > 0.0 && steps.width() <= 1e-4 * steps.high).then_some(steps.low)
}
