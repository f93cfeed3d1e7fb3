//! Draws the picture of a patch for a report: both profiles at true scale, the exaggerated gap, and the lines
//! of equal separation with the boundary over the solver's cells, to scale, with units and a legend.

use nalgebra::Point3;

use super::super::model::{Header, Loop};
use super::contour::Nodes;
use super::levels;
use super::page::SEPARATOR;
use super::page::{BLUE, BODY, Colour, INSIDE, Page, Pen, RED, SMALL};
use super::panel::{Panel, airy, extremes, in_power, number, power_for, power_of_ten, range};

const RAIL: Pen = Pen::new([70, 70, 70], 1.8);
const WHEEL: Pen = Pen::new(BLUE, 1.8);
const BOUNDARY: Pen = Pen::new(RED, 2.2);
const APPROACH: Pen = Pen::new(RED, 1.0).dashed([5.0, 3.0]);
const CELL: Pen = Pen::new([226, 220, 218], 0.6);
const WINDOW: Colour = [240, 240, 240];

/// Shortest side \[page units\] of cells that are drawn. The borders of smaller cells would look like a grey area.
const SMALLEST_CELL: f64 = 5.0;

/// Largest gap shown, as a multiple of the approach. Near a flange s grows to many times the approach.
const SHOWN_GAP: f64 = 3.0;

/// Length of the frame's axes at C \[page units\].
const AXIS: f64 = 38.0;
/// Room for the ζ axis with its letter \[page units\].
const AXIS_ROOM: f64 = AXIS + 16.0;

/// Distance from the edge of the window, as a share of its width, up to which a line lies along it: far below a line's width.
const ON_EDGE: f64 = 1e-6;

/// Height of the page \[page units\].
const HEIGHT: f64 = 1040.0;

/// The content of the picture.
#[derive(Debug, Clone, Copy)]
pub struct PatchPicture<'a> {
    /// Header with title, approach and version.
    pub header: &'a Header,
    /// Side and number of the contact, which distinguish the pictures of one run; empty for a single contact.
    pub contact: &'a str,
    /// Centres ξ and η of the solver's cells \[mm\], ascending.
    pub cells: [&'a [f64]; 2],
    /// s \[mm\] over the window of the cells, on as many points as smooth lines need.
    pub separation: Nodes<'a>,
    /// Points \[ξ, s(ξ, 0)\] \[mm\] over the window of the cells.
    pub midplane: &'a [[f64; 2]],
    /// The boundary of the patch.
    pub loops: &'a [Loop],
    /// The geometric "no"s, which the picture shows in red.
    pub refusals: &'a [String],
    /// The rail's profile \[ξ, ζ\] \[mm\]; NaN points separate its pieces.
    pub rail: &'a [[f64; 2]],
    /// The wheel's profile \[ξ, ζ\] \[mm\] in the midplane η = 0 before any approach; NaN points separate its
    /// pieces.
    pub wheel: &'a [[f64; 2]],
}

impl PatchPicture<'_> {
    /// Returns the picture as SVG.
    pub fn svg(&self) -> String {
        let header = self.header;
        let angle = header.frame.xi[2].atan2(header.frame.xi[0]).to_degrees();
        let approach = || format!("approach δ = {} mm", significant(header.approach, 4));
        let [x, z] = [0, 2].map(|k| number(header.frame.origin[k], 0.001));
        let about = [
            Some(self.contact.to_owned()).filter(|contact| !contact.is_empty()),
            (header.approach > 0.0).then(approach),
            Some(format!("contact angle θ = {}°", number(angle, 0.001))),
            Some(format!("rail point ({x}, {z}) mm")),
        ];
        let about = about.into_iter().flatten().collect::<Vec<_>>().join(SEPARATOR);
        let mut page = Page::new(&header.title, &about);
        // The first clause says what is wrong; the rest, what to do, is on stderr.
        let refused = self.refusals.iter().filter_map(|refusal| refusal.split(';').next());
        page.text([40.0, 82.0], refused.collect::<Vec<_>>().join(SEPARATOR), BODY.in_colour(RED));
        self.profiles(&mut page, [40.0, 110.0, 380.0, 250.0]);
        self.gap(&mut page, [520.0, 110.0, 340.0, 250.0]);
        self.contours(&mut page, [90.0, 460.0, 590.0, 500.0]);
        page.finish(HEIGHT, &format!("wheelrail {}, scene {}", header.version, header.scene_hash))
    }

    /// Draws both profiles at true scale, and marks the part of them that the other panels show.
    fn profiles(&self, page: &mut Page, room: [f64; 4]) {
        page.heading(room, "Profiles in the contact frame, true scale");
        let points = || self.rail.iter().chain(self.wheel).filter(|p| p[0].is_finite() && p[1].is_finite());
        if points().next().is_none() {
            return;
        }
        let (u, v) = (range(points().map(|p| p[0])), range(points().map(|p| p[1])));
        // C may be at the very top, as on a flange. The ζ axis and its letter must stay below the heading.
        let above = Panel::true_scale(room, u, v).point([0.0, 0.0])[1] - room[1];
        let lower = (AXIS_ROOM - above).clamp(0.0, AXIS_ROOM);
        let room = [room[0], room[1] + lower, room[2], room[3] - lower];
        let panel = Panel::true_scale(room, u, v);
        let [from, to] = range(self.cells[0].iter().copied()).map(|xi| xi.clamp(panel.u[0], panel.u[1]));
        let half = (to - from) / 2.0;
        let corners =
            [[from, -half], [to, -half], [to, half], [from, half]].map(|corner| panel.point(corner));
        let window = corners.map(|[x, y]| [x, y.clamp(room[1], room[1] + room[3])]);
        page.area(&[window.to_vec()], WINDOW);
        page.lines(&panel.curve(self.rail), RAIL);
        page.lines(&panel.curve(self.wheel), WHEEL);
        // The frame's axes at C.
        let origin = panel.point([0.0, 0.0]);
        let [x, y] = origin;
        page.lines(&[vec![[x, y - AXIS], origin, [x + AXIS, y]]], Pen::new(RED, 1.0));
        page.text([x + AXIS - 4.0, y + 16.0], "ξ", SMALL.in_colour(RED));
        page.text([x, y - AXIS - 4.0], "ζ", SMALL.in_colour(RED).middle());
        let foot = room[1] + room[3] + 28.0;
        page.legend([room[0], foot], RAIL, "rail");
        page.legend([room[0] + 80.0, foot], WHEEL, "wheel");
        page.legend([room[0] + 170.0, foot], Pen::new(WINDOW, 9.0), "grid");
        panel.scale_bar(page, [room[0] + room[2], foot], room[2] / 4.0);
    }

    /// Draws the gap in the midplane over a straightened rail, with the heights stretched.
    fn gap(&self, page: &mut Page, room: [f64; 4]) {
        let approach = self.header.approach;
        let [low, high] = range(self.midplane.iter().map(|p| p[1]).chain([0.0, approach]));
        let high = if approach > 0.0 { high.min(SHOWN_GAP * approach) } else { high };
        let u = range(self.cells[0].iter().copied());
        let panel = Panel { place: room, u, v: airy([low, high], 0.08, 0.0) };
        let [a, b] = panel.scale();
        page.heading(room, &format!("Gap at η = 0 over the rail, heights × {}", significant(b / a, 2)));
        page.area(&self.overlap(&panel), INSIDE);
        page.lines(&panel.curve(&[[u[0], 0.0], [u[1], 0.0]]), RAIL);
        page.lines(&panel.curve(self.midplane), WHEEL);
        panel.axes(page, ["ξ [mm]", "s [mm]"]);
        if approach > 0.0 {
            page.lines(&panel.curve(&[[u[0], approach], [u[1], approach]]), APPROACH);
            page.legend([room[0], room[1] + room[3] + 52.0], APPROACH, "approach δ");
        }
    }

    /// Returns the areas between the wheel and the approach, stretch by stretch of the midplane.
    fn overlap(&self, panel: &Panel) -> Vec<Vec<[f64; 2]>> {
        let approach = self.header.approach;
        let quad = |pair: &[[f64; 2]]| {
            let ([[a, s], [b, t]], over) = ([pair[0], pair[1]], |s: f64| s <= approach);
            let at = a + (b - a) * ((approach - s) / (t - s));
            let corners = match (over(s), over(t)) {
                (true, true) => vec![[a, s], [b, t], [b, approach], [a, approach]],
                (true, false) => vec![[a, s], [at, approach], [a, approach]],
                (false, true) => vec![[at, approach], [b, t], [b, approach]],
                (false, false) => Vec::new(),
            };
            let drawn = corners.iter().flatten().all(|x| x.is_finite());
            (drawn && !corners.is_empty()).then(|| corners.into_iter().map(|p| panel.point(p)).collect())
        };
        self.midplane.windows(2).filter_map(quad).collect()
    }

    /// Draws lines of equal separation over ξ–η, at one scale.
    fn contours(&self, page: &mut Page, room: [f64; 4]) {
        page.heading(room, "Separation s(ξ, η) before approach, true scale");
        let [u, v] = self.cells.map(|values| range(values.iter().copied()));
        let panel = Panel::true_scale(room, u, v);
        let ring = |ring: &Loop| {
            let closed = ring.points.iter().chain(ring.points.first());
            closed.map(|p| panel.point([p[0], p[1]])).collect::<Vec<_>>()
        };
        let rings: Vec<Vec<[f64; 2]>> = self.loops.iter().map(ring).collect();
        page.area(&rings, INSIDE);
        self.cells(page, &panel);
        let levels = levels::levels(&self.separation, self.header.approach, &panel);
        for level in &levels {
            page.lines(&level.lines, level.pen);
        }
        levels::label(page, &levels, &rings, &panel, self.header.approach);
        let boundary: Vec<_> = self.loops.iter().flat_map(|ring| self.boundary(&panel, ring)).collect();
        page.lines(&boundary, BOUNDARY);
        panel.axes(page, ["ξ [mm]", "η [mm] (rolling direction)"]);
        let side = room[0] + room[2] + 40.0;
        self.key(page, [side, room[1] + 20.0], &levels);
        panel.scale_bar(page, [side + 130.0, room[1] + room[3]], 130.0);
    }

    /// Returns the lines of a loop where s = δ: without those along the window, which cut the patch off.
    fn boundary(&self, panel: &Panel, ring: &Loop) -> Vec<Vec<[f64; 2]>> {
        let edges = self.cells.map(|values| range(values.iter().copied()));
        let along = |a: &Point3<f64>, b: &Point3<f64>| {
            (0..2).any(|k| {
                let near = ON_EDGE * (edges[k][1] - edges[k][0]);
                edges[k].iter().any(|edge| (a[k] - edge).abs() < near && (b[k] - edge).abs() < near)
            })
        };
        let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
        let next = ring.points.iter().cycle().skip(1);
        let mut open = false;
        for (a, b) in ring.points.iter().zip(next) {
            if along(a, b) {
                open = false;
                continue;
            }
            let [from, to] = [a, b].map(|point| panel.point([point.x, point.y]));
            match lines.last_mut() {
                Some(line) if open => line.push(to),
                _ => lines.push(vec![from, to]),
            }
            open = true;
        }
        lines
    }

    /// Writes what the lines mean, beside them.
    fn key(&self, page: &mut Page, [side, top]: [f64; 2], levels: &[levels::Level]) {
        let mut row = top;
        let power = levels.first().map_or(0, |level| level.power);
        page.text([side, row], in_power("s [mm]", power), BODY);
        for level in levels {
            row += 20.0;
            page.legend([side, row], level.pen, &level.name);
        }
        row += 32.0;
        if !self.loops.is_empty() {
            page.legend([side, row], BOUNDARY, "boundary s = δ");
            row += 32.0;
        }
        let [xi, eta] = self.cells;
        page.text([side, row], format!("grid {} × {} cells", xi.len(), eta.len()), SMALL);
        for (name, step) in ["Δξ", "Δη"].into_iter().zip(self.cells.map(even_step)) {
            let Some(step) = step else { continue };
            row += 18.0;
            page.text([side, row], format!("{name} = {} mm", significant(step, 3)), SMALL);
        }
    }

    /// Draws the borders of the solver's cells, half-way between their centres. Small cells are not drawn; the key gives
    /// their number and size.
    fn cells(&self, page: &mut Page, panel: &Panel) {
        let [x, y, w, h] = panel.place;
        let [xi, eta] = self.cells;
        if w / (xi.len() as f64) < SMALLEST_CELL || h / (eta.len() as f64) < SMALLEST_CELL {
            return;
        }
        let between = |pair: &[f64]| f64::midpoint(pair[0], pair[1]);
        let columns = xi.windows(2).map(|pair| panel.point([between(pair), panel.v[0]])[0]);
        let rows = eta.windows(2).map(|pair| panel.point([panel.u[0], between(pair)])[1]);
        let borders = columns.map(|px| vec![[px, y], [px, y + h]]);
        let borders: Vec<_> = borders.chain(rows.map(|py| vec![[x, py], [x + w, py]])).collect();
        page.lines(&borders, CELL);
    }
}

/// Returns the step of values that are equally spaced to three digits; `None` if the steps differ.
fn even_step(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let [low, high] = extremes(values.windows(2).map(|pair| pair[1] - pair[0]));
    (low > 0.0 && high - low <= 1e-4 * high).then_some(low)
}

/// Numbers in words from here on are written without a power of ten.
const PLAIN: f64 = 1e-4;

/// Returns a positive number with so many significant digits, without zeros at its end; small ones with a power of ten.
fn significant(x: f64, digits: i32) -> String {
    let power = if x < PLAIN { power_for(x) } else { 0 };
    if power != 0 {
        return format!("{}·{}", significant(x / 10f64.powi(power), digits), power_of_ten(power));
    }
    let step = 10f64.powi(x.log10().floor() as i32 + 1 - digits);
    let text = number((x / step).round() * step, step);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests;
