//! Draws the picture of a sweep: several quantities over one abscissa, each in its own panel.

use super::page::{BLUE, Colour, Page, Pen, RED, SMALL, polygon};
use super::panel::{Panel, airy, range};
use crate::numerics::interval::Interval;

/// Width of most letters, as a share of their size.
const LETTER: f64 = 0.6;

/// Colours and widths of the curves of a panel, in order. The first is wider, so that it is seen where the second covers it.
const CURVES: [(Colour, f64); 2] = [(BLUE, 2.8), (RED, 1.4)];

/// Left edges of the two columns of panels \[page units\].
const LEFT: [f64; 2] = [90.0, 540.0];
/// Width and height of a panel \[page units\].
const SIZE: [f64; 2] = [330.0, 190.0];
/// Height of a row of panels \[page units\].
const ROW: f64 = 290.0;
/// Top of the first row \[page units\].
const TOP: f64 = 112.0;

/// Least jump of a contact, as a multiple of the median of the changes beside it.
const JUMP: f64 = 6.0;
/// Least jump of a contact, as a share of the range of the values.
const JUMP_SHARE: f64 = 0.02;

/// Number of changes on each side of a jump that are compared with it. It is found even if two other jumps are among them.
const BESIDE: usize = 3;

/// Height of the panel with the pair \[page units\].
const PAIR: f64 = 330.0;

const RAIL: Pen = Pen::new([70, 70, 70], 1.8);
const WHEEL: Pen = Pen::new(BLUE, 1.8);
const JOINED: Pen = Pen::new([160, 160, 160], 0.8);
const GAUGE: Pen = Pen::new(RED, 1.0).dashed([5.0, 3.0]);

/// Radius of the dot that represents a point without a line \[page units\].
const DOT: f64 = 2.2;

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct PlottedCurve {
    /// Name in the legend; empty for the only curve of a panel.
    pub name: String,
    /// Points \[abscissa, value\] by ascending abscissa; NaN where there is no value.
    pub points: Vec<[f64; 2]>,
    /// Indices of points after which the contact jumps: no line connects them with the next point.
    pub jumps: Vec<usize>,
}

/// The curves of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvesPanel {
    /// Heading of the panel.
    pub title: String,
    /// Name of the axis, with its unit.
    pub axis: String,
    /// The curves, at most two.
    pub curves: Vec<PlottedCurve>,
    /// Smallest and largest value that is shown; what is beyond is cut off at the panel's edge. `None` shows all.
    pub shown: Option<Interval>,
}

impl CurvesPanel {
    /// Returns the heading, with a remark if values are cut off.
    pub fn heading(&self) -> String {
        let cut = if self.shown.is_some() { "; flange cut off" } else { "" };
        format!("{}{cut}", self.title)
    }
}

/// The content of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvesPicture {
    /// Title of the scene.
    pub title: String,
    /// A line below the title.
    pub about: String,
    /// Name of the abscissa, with its unit.
    pub abscissa: String,
    /// The panels, row by row, two in a row.
    pub quantities: Vec<CurvesPanel>,
    /// The pair below them; `None` for none.
    pub pair: Option<JoinedPair>,
    /// A map in the place after the last panel; `None` for none.
    pub map: Option<CurvesMap>,
}

/// A quantity over two others, as cells in colour.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvesMap {
    /// Heading of the map.
    pub title: String,
    /// Name of the axis across, with its unit.
    pub across: String,
    /// Name of the axis up, with its unit.
    pub up: String,
    /// Values across, ascending.
    pub u: Vec<f64>,
    /// Values up, ascending.
    pub v: Vec<f64>,
    /// The quantity, a list over `v` for each of `u`; NaN where there is none.
    pub values: Vec<Vec<f64>>,
}

/// A rail and a wheel raised above it, with lines between the points that touch; all in the rail profile's axes \[x, z\] \[mm\].
#[derive(Debug, Clone, PartialEq)]
pub struct JoinedPair {
    /// The rail's profile.
    pub rail: Vec<[f64; 2]>,
    /// The wheel's profile.
    pub wheel: Vec<[f64; 2]>,
    /// Lines from the point of contact on the rail to that on the wheel, in the order of the positions.
    pub lines: Vec<[[f64; 2]; 2]>,
    /// Abscissa x of the gauge line \[mm\].
    pub gauge: Option<f64>,
}

impl CurvesPicture {
    /// Returns the picture as SVG.
    pub fn svg(&self) -> String {
        let places = self.quantities.len() + usize::from(self.map.is_some());
        let height = TOP + ROW * places.div_ceil(LEFT.len()) as f64;
        let place = |k: usize| [LEFT[k % LEFT.len()], TOP + ROW * (k / LEFT.len()) as f64, SIZE[0], SIZE[1]];
        let mut page = Page::new(&self.title, &self.about);
        let all = self.quantities.iter().flat_map(|q| &q.curves).flat_map(|curve| &curve.points);
        let u = range(all.map(|p| p[0]));
        for (k, quantity) in self.quantities.iter().enumerate() {
            self.panel(&mut page, place(k), u, quantity);
        }
        if let Some(map) = &self.map {
            map.draw(&mut page, place(self.quantities.len()));
        }
        let height = match &self.pair {
            Some(pair) => pair.draw(&mut page, height),
            None => height,
        };
        page.finish(height, &super::page::foot())
    }

    fn panel(&self, page: &mut Page, place: [f64; 4], u: Interval, quantity: &CurvesPanel) {
        page.heading(place, &quantity.heading());
        let values = quantity.curves.iter().flat_map(|curve| &curve.points).map(|p| p[1]);
        let shown = quantity.shown.unwrap_or_else(|| range(values));
        let least = (1e-6 * shown.magnitude()).max(1e-9);
        let panel = Panel { place, u, v: airy(shown, 0.06, least) };
        panel.zero_line(page);
        // The names end where the panel does, 12 apart.
        let letters = quantity.curves.iter().map(|curve| curve.name.chars().count()).max().unwrap_or(0);
        let stride = 44.0 + LETTER * SMALL.size * letters as f64;
        let first = place[0] + place[2] + 12.0 - stride * quantity.curves.len() as f64;
        for (k, (curve, (colour, wide))) in quantity.curves.iter().zip(CURVES).enumerate() {
            let pen = Pen::new(colour, wide);
            let parted = curve.parted();
            page.lines(&panel.curve(&parted), pen);
            page.area(&dots(&panel, &parted), colour);
            if !curve.name.is_empty() {
                page.legend([first + stride * k as f64, place[1] - 18.0], pen, &curve.name);
            }
        }
        panel.axes(page, [&self.abscissa, &quantity.axis]);
    }
}

impl CurvesMap {
    /// Draws the cells with their borders half-way between the values, and a key of the colours above them.
    fn draw(&self, page: &mut Page, place: [f64; 4]) {
        page.heading(place, &self.title);
        let (across, up) = (borders(&self.u), borders(&self.v));
        let ends = |borders: &[f64]| range(borders.iter().copied());
        let panel = Panel { place, u: ends(&across), v: ends(&up) };
        let [low, high] = range(self.values.iter().flatten().copied()).ends();
        for (i, column) in self.values.iter().enumerate() {
            for (k, value) in column.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                let corners =
                    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| panel.point([across[i + a], up[k + b]]));
                page.area(&[corners.to_vec()], shade((value - low) / (high - low)));
            }
        }
        panel.axes(page, [&self.across, &self.up]);
        let right = place[0] + place[2];
        for k in 0..KEY {
            let share = f64::from(k) / f64::from(KEY - 1);
            let x = right - KEY_WIDTH + (KEY_WIDTH - 14.0) * share;
            let top = place[1] + place[3] + 46.0;
            let cell = [[x, top], [x + 14.0, top], [x + 14.0, top + 8.0], [x, top + 8.0]];
            page.area(&[cell.to_vec()], shade(share));
            page.text([x + 7.0, top + 20.0], format!("{:.2}", low + share * (high - low)), SMALL.middle());
        }
    }
}

/// Number of colours of the key, and its width \[page units\].
const KEY: u32 = 6;
const KEY_WIDTH: f64 = 200.0;

/// Returns the borders of cells around ascending values.
fn borders(values: &[f64]) -> Vec<f64> {
    let [Some(first), Some(last)] = [values.first(), values.last()] else { return Vec::new() };
    let between = values.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
    let inner: Vec<f64> = between.collect();
    let [from, to] = [inner.first(), inner.last()].map(|border| border.copied());
    let low = from.map_or(first - 0.5, |border| 2.0 * first - border);
    let high = to.map_or(last + 0.5, |border| 2.0 * last - border);
    [low].into_iter().chain(inner).chain([high]).collect()
}

/// Colours of low, middle and high values: light to dark, so that they differ in grey, too.
const SHADES: [Colour; 3] = [[255, 244, 204], [227, 119, 61], [94, 15, 80]];

/// Returns the colour of a share of the range.
fn shade(share: f64) -> Colour {
    let at = 2.0 * share.clamp(0.0, 1.0);
    let [from, to] = if at < 1.0 { [SHADES[0], SHADES[1]] } else { [SHADES[1], SHADES[2]] };
    let rest = if at < 1.0 { at } else { at - 1.0 };
    std::array::from_fn(|k| {
        (f64::from(from[k]) + rest * (f64::from(to[k]) - f64::from(from[k]))).round() as u8
    })
}

impl JoinedPair {
    /// Draws the pair at true scale below `top`, and returns the height of the page.
    fn draw(&self, page: &mut Page, top: f64) -> f64 {
        let points = || self.rail.iter().chain(&self.wheel);
        let (u, v) = (range(points().map(|p| p[0])), range(points().map(|p| p[1])));
        let room = [LEFT[0], top, LEFT[1] + SIZE[0] - LEFT[0], PAIR];
        page.heading(room, "Points of contact on rail and raised wheel, right side, true scale");
        let panel = Panel::true_scale(room, airy(u, 0.02, 0.0), airy(v, 0.02, 0.0));
        let lines: Vec<_> = self.lines.iter().flat_map(|ends| panel.curve(ends)).collect();
        page.lines(&lines, JOINED);
        page.lines(&panel.curve(&self.rail), RAIL);
        page.lines(&panel.curve(&self.wheel), WHEEL);
        let foot = room[1] + room[3] + 24.0;
        if let Some(gauge) = self.gauge {
            page.lines(&panel.curve(&panel.v.ends().map(|v| [gauge, v])), GAUGE);
            page.legend([room[0] + 160.0, foot], GAUGE, "gauge line");
        }
        page.legend([room[0], foot], RAIL, "rail");
        page.legend([room[0] + 80.0, foot], WHEEL, "wheel");
        panel.scale_bar(page, [room[0] + room[2], foot], room[2] / 6.0);
        top + PAIR + 70.0
    }
}

impl PlottedCurve {
    /// Returns the points, with an undefined point in every jump.
    fn parted(&self) -> Vec<[f64; 2]> {
        let mut out = Vec::with_capacity(self.points.len() + self.jumps.len());
        for (k, &point) in self.points.iter().enumerate() {
            out.push(point);
            if self.jumps.contains(&k) {
                out.push([f64::NAN; 2]);
            }
        }
        out
    }
}

/// Returns dots at the points that have no line to either side.
fn dots(panel: &Panel, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let defined = |k: usize| points.get(k).is_some_and(|p| p[0].is_finite() && p[1].is_finite());
    let alone = |k: &usize| defined(*k) && !defined(k + 1) && !k.checked_sub(1).is_some_and(defined);
    (0..points.len()).filter(alone).map(|k| polygon(panel.point(points[k]), DOT, 12, 0.0)).collect()
}

/// Returns the indices k after which a contact jumps: one of its abscissae changes between k and k + 1 by far more than
/// between the neighbouring points.
pub fn jumps(abscissae: &[&[f64]]) -> Vec<usize> {
    let mut all: Vec<usize> = abscissae.iter().flat_map(|values| jumps_of(values)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

fn jumps_of(values: &[f64]) -> Vec<usize> {
    let all = range(values.iter().copied());
    let changes: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let middle = |k: usize| {
        let last = (k + BESIDE + 1).min(changes.len());
        let around = (k.saturating_sub(BESIDE)..last).filter(|&i| i != k).map(|i| changes[i]);
        let mut around: Vec<f64> = around.filter(|change| change.is_finite()).collect();
        around.sort_by(f64::total_cmp);
        around.get(around.len() / 2).copied().unwrap_or(0.0)
    };
    let jump = |&k: &usize| changes[k] > JUMP_SHARE * all.width() && changes[k] > JUMP * middle(k);
    (0..changes.len()).filter(jump).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(points: Vec<[f64; 2]>, jumps: Vec<usize>) -> CurvesPicture {
        let curves = vec![PlottedCurve { name: "left".into(), points, jumps }];
        let quantity = CurvesPanel { title: "Radius".into(), axis: "r [mm]".into(), curves, shown: None };
        CurvesPicture {
            title: "A sweep".into(),
            about: String::new(),
            abscissa: "y [mm]".into(),
            quantities: vec![quantity],
            pair: None,
            map: None,
        }
    }

    #[test]
    fn a_jump_is_not_drawn_across_and_a_slope_is() {
        let jump = |k: u32| f64::from(k) * 0.1 + if k < 10 { 0.0 } else { 9.0 };
        let found = jumps(&[&(0..20).map(jump).collect::<Vec<_>>()]);
        assert_eq!(found, [9]);
        let slope: Vec<f64> = (0..20).map(|k| f64::from(k * k)).collect();
        assert_eq!(jumps(&[&slope]), [0; 0]);
    }

    /// Returns the number of closed rings of a path.
    fn rings(path: &str) -> usize {
        path.matches('Z').count()
    }

    #[test]
    fn a_point_between_two_jumps_is_a_dot_and_each_jump_parts() {
        // The contact jumps away, and one position later it jumps on: neither jump hides the other.
        let x: Vec<f64> =
            (0..20).map(|k| f64::from(k) * 0.1 + [0.0, 5.0, 12.0][(k.max(9) - 9).min(2) as usize]).collect();
        let still = vec![0.0; 20];
        assert_eq!(jumps(&[&still, &x]), [9, 10]);
        let points = x.iter().enumerate().map(|(k, x)| [k as f64, *x]).collect();
        let svg = picture(points, vec![9, 10]).svg();
        let dots: Vec<usize> = svg.lines().filter(|line| line.contains("evenodd")).map(rings).collect();
        assert_eq!(dots, [1]);
    }

    #[test]
    fn constants_and_nothing_at_all_make_finite_pictures() {
        let constant = (0..5).map(|k| [f64::from(k), 3.0]).collect();
        for points in [constant, vec![[1.0, f64::NAN], [2.0, f64::NAN]], vec![[1.0, 2.0]], Vec::new()] {
            let svg = picture(points.clone(), Vec::new()).svg();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}: {svg}");
        }
    }
}
