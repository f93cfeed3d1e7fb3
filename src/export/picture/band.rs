//! Draws an average profile with the spread of the profiles as a magnified band.

use super::page::{BLUE, Colour, Page, Pen};
use super::panel::{Panel, airy, range};
use crate::numerics::interval::Interval;

const MEAN: Pen = Pen::new(BLUE, 1.4);
const ALL: Colour = [222, 233, 245];
const SPREAD: Colour = [158, 192, 226];

/// Left edge and width of the panel \[page units\].
const LEFT: f64 = 90.0;
const WIDTH: f64 = 770.0;
/// Largest magnified offset of the band from the average \[mm\].
const LONGEST: f64 = 10.0;
/// Magnifications to choose from.
const MAGNIFIED: [f64; 10] = [1000.0, 500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0];

/// A point of the average; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandPoint {
    /// The point \[x, z\].
    pub at: [f64; 2],
    /// Unit normal \[x, z\].
    pub normal: [f64; 2],
    /// Standard deviation along the normal.
    pub spread: f64,
    /// Least and largest offset along the normal.
    pub range: Interval,
}

/// The content of the picture.
#[derive(Debug, Clone, Copy)]
pub struct BandPicture<'a> {
    /// Title.
    pub title: &'a str,
    /// A line below the title.
    pub about: &'a str,
    /// The average from left to right.
    pub points: &'a [BandPoint],
}

impl BandPicture<'_> {
    /// Returns the picture as SVG.
    pub fn svg(&self) -> String {
        let largest =
            self.points.iter().flat_map(|point| point.range.ends()).map(f64::abs).fold(0.0, f64::max);
        let times = MAGNIFIED.into_iter().find(|times| times * largest <= LONGEST).unwrap_or(1.0);
        let offset = |point: &BandPoint, by: f64| [0, 1].map(|k| point.at[k] + times * by * point.normal[k]);
        let edges = |of: fn(&BandPoint) -> [f64; 2]| -> Vec<[[f64; 2]; 2]> {
            self.points.iter().map(|point| of(point).map(|by| offset(point, by))).collect()
        };
        let (all, spread) = (edges(|point| point.range.ends()), edges(|point| [-point.spread, point.spread]));
        let places = || all.iter().flatten();
        let (u, v) = (range(places().map(|p| p[0])), range(places().map(|p| p[1])));
        let (u, v) = (airy(u, 0.02, 0.0), airy(v, 0.06, 0.0));
        let (top, height) = (112.0, (WIDTH * v.width() / u.width()).clamp(160.0, 560.0));
        let panel = Panel::true_scale([LEFT, top, WIDTH, height], u, v);
        let mut page = Page::new(self.title, self.about);
        let heading = format!("Spread along the normal, × {times}; the largest offset is {largest:.3} mm");
        page.heading([LEFT, top, WIDTH, height], &heading);
        for (band, colour) in [(&all, ALL), (&spread, SPREAD)] {
            // Each cell is an area of its own: in one area, overlaps at hollow corners would be holes.
            for pair in band.windows(2) {
                let ring = [pair[0][0], pair[1][0], pair[1][1], pair[0][1]].map(|p| panel.point(p));
                page.area(&[ring.to_vec()], colour);
            }
        }
        let mean: Vec<[f64; 2]> = self.points.iter().map(|point| point.at).collect();
        page.lines(&panel.curve(&mean), MEAN);
        panel.axes(&mut page, ["x [mm]", "z [mm]"]);
        let row = top + height + 62.0;
        let pens = [
            (MEAN, "average"),
            (Pen::new(SPREAD, 6.0), "standard deviation"),
            (Pen::new(ALL, 6.0), "all profiles"),
        ];
        for (k, (pen, name)) in pens.into_iter().enumerate() {
            page.legend([LEFT + 170.0 * k as f64, row], pen, name);
        }
        page.finish(row + 34.0, &super::page::foot())
    }
}
