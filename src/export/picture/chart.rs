//! Draws charts of the report: values over values, both on logarithmic axes.

use super::page::{Colour, INK, Page, Pen, SMALL, polygon};
use super::panel::{Panel, extremes};
use crate::numerics::interval::Interval;
use std::f64::consts::FRAC_PI_4;

/// Left, top, width and height of the plotting area \[page units\].
const PLACE: [f64; 4] = [90.0, 70.0, 560.0, 350.0];
/// Height of the picture \[page units\].
const HEIGHT: f64 = 490.0;

/// Radius of a strong mark \[page units\].
const STRONG: f64 = 5.5;
/// Radius of a faint mark \[page units\].
const FAINT: f64 = 3.0;

const LIMIT: Pen = Pen::new(INK, 1.0).dashed([4.0, 4.0]);

/// Okabe and Ito's palette, which colour-blind readers can distinguish too.
const COLOURS: [Colour; 7] =
    [[230, 159, 0], [86, 180, 233], [0, 158, 115], [213, 94, 0], [0, 114, 178], [204, 121, 167], [0, 0, 0]];

/// One set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Single values (x, y), drawn faintly.
    pub marks: Vec<[f64; 2]>,
    /// Main values (x, y), drawn strongly and joined.
    pub line: Vec<[f64; 2]>,
}

/// A chart with logarithmic axes. Values that are not positive are drawn at the lower end of the axis; NaN
/// values are not drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title of the chart.
    pub title: String,
    /// Title and unit of both axes.
    pub labels: [String; 2],
    /// The sets of points; colours repeat after seven.
    pub series: Vec<Series>,
    /// A vertical line and its name.
    pub limit: Option<(f64, String)>,
}

impl Chart {
    /// Returns the chart as SVG.
    pub fn svg(&self) -> String {
        let all = || self.series.iter().flat_map(|series| series.marks.iter().chain(&series.line));
        let limit = self.limit.as_ref().map(|(value, _)| *value);
        let u = decades(all().map(|p| p[0]).chain(limit));
        let panel = Panel { place: PLACE, u, v: decades(all().map(|p| p[1])) };
        let mut page = Page::new(&self.title, "");
        panel.decade_grid(&mut page);
        if let Some((value, name)) = &self.limit {
            let [x, top] = panel.point([log_within(*value, panel.u), panel.v.high]);
            page.line([x, top], [x, top + PLACE[3]], LIMIT);
            page.text([x - 4.0, top + 12.0], name, SMALL.end());
        }
        panel.decade_axes(&mut page, [&self.labels[0], &self.labels[1]]);
        for (k, series) in self.series.iter().enumerate() {
            series.draw_marks(&mut page, &panel, k);
        }
        for (k, series) in self.series.iter().enumerate() {
            series.draw_line(&mut page, &panel, k);
        }
        page.finish(HEIGHT, &super::page::foot())
    }
}

impl Series {
    /// Draws the faint marks of the k-th series. Each mark is an area of its own: in one common area,
    /// overlaps would be holes.
    fn draw_marks(&self, page: &mut Page, panel: &Panel, k: usize) {
        let pale = COLOURS[k % COLOURS.len()].map(|c| 255 - (255 - c) / 3);
        placed(&self.marks, panel).into_iter().for_each(|at| page.area(&[mark(at, k, FAINT)], pale));
    }

    /// Draws the line of the k-th series, and its row in the legend to the right of the panel.
    fn draw_line(&self, page: &mut Page, panel: &Panel, k: usize) {
        let colour = COLOURS[k % COLOURS.len()];
        let line = placed(&self.line, panel);
        page.lines(std::slice::from_ref(&line), Pen::new(colour, 1.5));
        let row = [PLACE[0] + PLACE[2] + 24.0, PLACE[1] + 14.0 + 22.0 * k as f64];
        line.into_iter().chain([row]).for_each(|at| page.area(&[mark(at, k, STRONG)], colour));
        page.text([row[0] + 14.0, row[1] + 4.0], &self.name, SMALL);
    }
}

/// Returns the places on the page of the points without NaN.
fn placed(points: &[[f64; 2]], panel: &Panel) -> Vec<[f64; 2]> {
    let known = points.iter().filter(|p| !p[0].is_nan() && !p[1].is_nan());
    known.map(|&[x, y]| panel.point([log_within(x, panel.u), log_within(y, panel.v)])).collect()
}

/// Returns the k-th series' mark, whose shape tells the series too.
fn mark(at: [f64; 2], k: usize, radius: f64) -> Vec<[f64; 2]> {
    let (corners, turn) = [(24, 0.0), (4, FRAC_PI_4), (3, 0.0), (4, 0.0)][k % 4];
    polygon(at, if corners > 4 { radius } else { 1.2 * radius }, corners, turn)
}

/// Returns the whole decades around all positive values, as logarithms; at least one decade.
fn decades(values: impl Iterator<Item = f64>) -> Interval {
    let all = extremes(values.filter(|value| *value > 0.0).map(f64::log10));
    if all.is_empty() {
        return Interval::new(0.0, 1.0);
    }
    let low = all.low.floor();
    Interval::new(low, all.high.ceil().max(low + 1.0))
}

/// Returns the logarithm of a value, limited to the range of its axis; a value without logarithm gives the
/// lower end.
fn log_within(value: f64, axis: Interval) -> f64 {
    if value > 0.0 { axis.nearest(value.log10()) } else { axis.low }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_its_place_and_zero_the_lowest() {
        let axis = decades([1e-3, 50.0, 0.0].into_iter());
        assert_eq!([axis, decades([1.0].into_iter())], [Interval::new(-3.0, 2.0), Interval::new(0.0, 1.0)]);
        assert!((log_within(0.1, axis) + 1.0).abs() < 1e-15);
        assert_eq!([0.0, -1.0, f64::INFINITY].map(|value| log_within(value, axis)), [-3.0, -3.0, 2.0]);
    }

    #[test]
    fn a_chart_of_nothing_is_still_a_picture() {
        let labels = ["x".to_string(), "y".to_string()];
        let series = vec![Series { name: "none".into(), marks: vec![[f64::NAN; 2]], line: Vec::new() }];
        let picture = Chart { title: "empty".into(), labels, series, limit: None }.svg();
        assert!(picture.ends_with("</svg>\n") && !picture.contains("NaN"), "{picture}");
    }
}
