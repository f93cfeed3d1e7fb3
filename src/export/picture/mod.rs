//! `patch.svg` and, on request, `patch.png`: the picture for a report. Both profiles at true scale, the gap
//! exaggerated, and the lines of equal separation with the boundary, to scale, with units and a legend.

mod canvas;
mod contour;
mod panel;
mod png;
pub mod profile;
mod svg;

use super::model::{GridFields, Header, Loop};
use crate::error::Result;
use canvas::{Anchor, Canvas, Colour, Pen};
use contour::Nodes;
use panel::{GREY, INK, Panel, SMALL, number, round_below};

const RAIL: Pen = Pen::new([70, 70, 70], 1.8);
const WHEEL: Pen = Pen::new([31, 98, 168], 1.8);
const BOUNDARY: Pen = Pen::new([200, 30, 30], 2.2);
const INSIDE: Colour = [253, 232, 226];
const THIN: Pen = Pen::new(GREY, 0.6);

/// Contours are drawn from at most this many rows and columns: more cannot be seen on a page, and would make
/// the file large.
const DRAWN: usize = 120;

/// Lines of equal separation aimed at.
const LEVELS: f64 = 10.0;

/// The lines of one level.
struct Level {
    name: String,
    pen: Pen,
    /// (ξ, η) \[mm\]
    lines: Vec<Vec<[f64; 2]>>,
}

/// What the picture shows.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Title, approach, version.
    pub header: &'a Header,
    /// The separation.
    pub grid: &'a GridFields<'a>,
    /// The boundary.
    pub loops: &'a [Loop],
    /// The rail's profile (ξ, ζ) \[mm\]; NaN points part its pieces.
    pub rail: &'a [[f64; 2]],
    /// The wheel's profile in the midplane η = 0, before any approach, likewise.
    pub wheel: &'a [[f64; 2]],
}

impl Picture<'_> {
    /// The picture as SVG.
    pub fn svg(&self) -> String {
        svg::document(&self.page())
    }

    /// The same as PNG, two pixels to the page unit.
    ///
    /// # Errors
    /// What the encoder refuses, which would be a fault of this program.
    pub fn png(&self) -> Result<Vec<u8>> {
        png::encode(&self.page(), 2.0)
    }

    fn page(&self) -> Canvas {
        let mut page = Canvas { size: [900.0, 1040.0], marks: Vec::new() };
        let header = self.header;
        let angle = header.frame.xi[2].atan2(header.frame.xi[0]).to_degrees();
        let about = format!(
            "approach δ = {:?} mm    contact angle θ = {}°    rail point ({}, {}) mm",
            header.approach,
            number(angle, 0.001),
            number(header.frame.origin[0], 0.001),
            number(header.frame.origin[2], 0.001),
        );
        page.text([40.0, 42.0], cut(&header.title, 80), 18.0, Anchor::Start, INK);
        page.text([40.0, 64.0], about, SMALL + 1.0, Anchor::Start, INK);
        self.profiles(&mut page, [40.0, 110.0, 380.0, 250.0]);
        self.gap(&mut page, [520.0, 110.0, 340.0, 250.0]);
        self.contours(&mut page, [90.0, 460.0, 590.0, 500.0]);
        let foot = format!("wheelrail {}, scene {}", header.version, header.scene_hash);
        page.text([860.0, 1024.0], cut(&foot, 100), 9.0, Anchor::End, GREY);
        page
    }

    /// Both profiles at true scale.
    fn profiles(&self, page: &mut Canvas, room: [f64; 4]) {
        heading(page, room, "Profiles in the contact frame, true scale");
        let points = || self.rail.iter().chain(self.wheel).filter(|p| p[0].is_finite() && p[1].is_finite());
        if points().next().is_none() {
            return;
        }
        let panel = Panel::true_scale(room, range(points().map(|p| p[0])), range(points().map(|p| p[1])));
        page.lines(panel.curve(self.rail), RAIL);
        page.lines(panel.curve(self.wheel), WHEEL);
        // The frame's axes at C.
        let origin = panel.point([0.0, 0.0]);
        let [x, y] = origin;
        page.lines(vec![vec![[x, y - 38.0], origin, [x + 38.0, y]]], Pen::new(BOUNDARY.colour, 1.0));
        page.text([x + 34.0, y + 16.0], "ξ", SMALL, Anchor::Start, BOUNDARY.colour);
        page.text([x, y - 42.0], "ζ", SMALL, Anchor::Middle, BOUNDARY.colour);
        let foot = room[1] + room[3] + 28.0;
        legend(page, [room[0], foot], RAIL, "rail");
        legend(page, [room[0] + 80.0, foot], WHEEL, "wheel");
        panel.scale_bar(page, [room[0] + room[2], foot], room[2] / 4.0);
    }

    /// The gap over ξ with the heights stretched.
    fn gap(&self, page: &mut Canvas, room: [f64; 4]) {
        let grid = self.grid;
        // The column nearest the midplane.
        let near = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
        let (j, eta) = grid.eta().iter().enumerate().min_by(|a, b| near(a.1, b.1)).unwrap_or((0, &0.0));
        let rail: Vec<[f64; 2]> = grid.xi().iter().zip(grid.rail_height()).map(|(&x, &z)| [x, z]).collect();
        let lifted = |i: usize, by: f64| [rail[i][0], rail[i][1] + by];
        let wheel: Vec<_> = (0..rail.len()).map(|i| lifted(i, grid.column(i)[j])).collect();
        let raised: Vec<_> = (0..rail.len()).map(|i| lifted(i, self.header.approach)).collect();
        let heights = || rail.iter().chain(&wheel).chain(&raised).map(|p| p[1]).filter(|z| z.is_finite());
        let (u, [low, high]) = (range(grid.xi().iter().copied()), range(heights()));
        let air = 0.05 * (high - low);
        let panel = Panel { place: room, u, v: [low - air, high + air] };
        let [a, b] = panel.scale();
        let stretch = b / a;
        heading(
            page,
            room,
            &format!("Gap at η = {} mm, heights × {}", number(*eta, 0.01), two_digits(stretch)),
        );
        page.lines(panel.curve(&raised), Pen { width: 1.0, ..RAIL }.dashed([5.0, 3.0]));
        page.lines(panel.curve(&rail), RAIL);
        page.lines(panel.curve(&wheel), WHEEL);
        panel.frame(page);
        panel.axes(page, ["ξ [mm]", "ζ [mm]"]);
        let foot = room[1] + room[3] + 52.0;
        legend(page, [room[0], foot], Pen { width: 1.0, ..RAIL }.dashed([5.0, 3.0]), "rail raised by δ");
    }

    /// Lines of equal separation over ξ–η, at one scale.
    fn contours(&self, page: &mut Canvas, room: [f64; 4]) {
        heading(page, room, "Separation s(ξ, η) before approach, true scale");
        let grid = self.grid;
        let (u, v) = (range(grid.xi().iter().copied()), range(grid.eta().iter().copied()));
        let panel = Panel::true_scale(room, u, v);
        let rings: Vec<Vec<[f64; 2]>> = self
            .loops
            .iter()
            .map(|ring| {
                ring.points.iter().chain(ring.points.first()).map(|p| panel.point([p[0], p[1]])).collect()
            })
            .collect();
        page.area(rings.clone(), INSIDE);
        let side = room[0] + room[2] + 40.0;
        let mut row = room[1] + 20.0;
        page.text([side, row], "s [mm]", SMALL + 1.0, Anchor::Start, INK);
        for Level { name, pen, lines } in self.levels() {
            page.lines(lines.iter().flat_map(|line| panel.curve(line)).collect(), pen);
            row += 20.0;
            legend(page, [side, row], pen, &name);
        }
        page.lines(rings, BOUNDARY);
        row += 32.0;
        legend(page, [side, row], BOUNDARY, "boundary s = δ");
        self.grid_ticks(page, &panel);
        panel.frame(page);
        panel.axes(page, ["ξ [mm]", "η [mm]  (rolling direction)"]);
        page.text(
            [side, row + 32.0],
            format!("grid {} × {}", grid.xi().len(), grid.eta().len()),
            SMALL,
            Anchor::Start,
            INK,
        );
        panel.scale_bar(page, [side + 130.0, room[1] + room[3]], 130.0);
    }

    fn levels(&self) -> Vec<Level> {
        let (xi, eta, values) = self.thinned();
        let nodes = Nodes { xi: &xi, eta: &eta, values: &values };
        let [low, high] = extremes(values.iter().copied().filter(|s| s.is_finite()));
        if low >= high {
            return Vec::new();
        }
        let step = round_below(1.5 * (high - low) / LEVELS);
        // The lowest value itself is no line: it would be a point.
        let (first, last) = ((low / step).floor() as i64 + 1, (high / step).floor() as i64);
        let level = |k: i64| {
            let value = k as f64 * step;
            let pen = Pen::new(shade((value - low) / (high - low)), 1.2);
            let pen = if k < 0 { pen.dashed([4.0, 3.0]) } else { pen };
            Level { name: number(value, step), pen, lines: nodes.lines(value) }
        };
        (first..=last).map(level).filter(|level| !level.lines.is_empty()).collect()
    }

    /// The grid with so many rows and columns left out that at most [`DRAWN`] remain, the last always among them.
    fn thinned(&self) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let grid = self.grid;
        let kept = |count: usize| {
            let stride = count.div_ceil(DRAWN).max(1);
            let last = (!(count - 1).is_multiple_of(stride)).then_some(count - 1);
            (0..count).step_by(stride).chain(last).collect::<Vec<_>>()
        };
        let (rows, columns) = (kept(grid.xi().len()), kept(grid.eta().len()));
        let values = rows.iter().flat_map(|&i| columns.iter().map(move |&j| grid.column(i)[j])).collect();
        let pick = |values: &[f64], kept: &[usize]| kept.iter().map(|&k| values[k]).collect();
        (pick(grid.xi(), &rows), pick(grid.eta(), &columns), values)
    }

    /// The grid's rows and columns as ticks inside the frame, every so many that they stay apart.
    fn grid_ticks(&self, page: &mut Canvas, panel: &Panel) {
        let [x, y, w, h] = panel.place;
        let every = |count: usize, length: f64| (4.0 * count as f64 / length).ceil().max(1.0) as usize;
        let (xi, eta) = (self.grid.xi(), self.grid.eta());
        let columns = xi.iter().step_by(every(xi.len(), w)).map(|&xi| {
            let px = panel.point([xi, 0.0])[0];
            vec![[px, y + h], [px, y + h - 4.0]]
        });
        let rows = eta.iter().step_by(every(eta.len(), h)).map(|&eta| {
            let py = panel.point([0.0, eta])[1];
            vec![[x, py], [x + 4.0, py]]
        });
        page.lines(columns.chain(rows).collect(), THIN);
    }
}

fn heading(page: &mut Canvas, room: [f64; 4], text: &str) {
    page.text([room[0], room[1] - 14.0], text, SMALL + 2.0, Anchor::Start, INK);
}

fn legend(page: &mut Canvas, [x, y]: [f64; 2], pen: Pen, name: &str) {
    page.line([x, y], [x + 26.0, y], pen);
    page.text([x + 32.0, y + 4.0], name, SMALL, Anchor::Start, INK);
}

/// The smallest range that holds all values, widened to a length if they are one.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    match extremes(values) {
        [low, high] if high > low => [low, high],
        [low, _] if low.is_finite() => [low - 0.5, low + 0.5],
        _ => [0.0, 1.0],
    }
}

/// The smallest and the largest value; of none, +∞ and −∞.
fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// Two significant digits.
fn two_digits(x: f64) -> String {
    let step = 10f64.powf(x.log10().floor() - 1.0);
    number((x / step).round() * step, step)
}

/// Colours of the contours, dark to light with t from 0 to 1 (five colours of viridis, without its palest).
fn shade(t: f64) -> Colour {
    const STOPS: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [190.0, 200.0, 40.0],
    ];
    let at = t.clamp(0.0, 1.0) * 4.0;
    let k = (at as usize).min(3);
    let mix = at - k as f64;
    [0, 1, 2].map(|c| (STOPS[k][c] + mix * (STOPS[k + 1][c] - STOPS[k][c])).round() as u8)
}

fn cut(text: &str, longest: usize) -> String {
    if text.chars().count() <= longest {
        return text.into();
    }
    text.chars().take(longest - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests;
