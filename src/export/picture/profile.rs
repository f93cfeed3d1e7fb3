//! Draws the picture of a profile: points and curve at true scale; residual and curvature against arc length.

use super::page::SEPARATOR;
use super::page::{BLUE, Page, Pen, RED, SMALL};
use super::panel::{Panel, airy, number, range};
use crate::numerics::interval::Interval;

const CURVE: Pen = Pen::new(BLUE, 1.4);
const POINT: Pen = Pen::new(RED, 1.0);

/// Left edge of the panels \[page units\].
const LEFT: f64 = 90.0;
/// Width of the panels \[page units\].
const WIDTH: f64 = 770.0;

/// Half the length of a cross's arms \[page units\].
const ARM: f64 = 2.0;

/// Most points of a panel that are marked, evenly chosen. More of them would be a smear, and a large file.
const MOST_CROSSES: usize = 4000;

/// The content of the picture.
#[derive(Debug, Clone, Copy)]
pub struct ProfilePicture<'a> {
    /// Name of the profile.
    pub title: &'a str,
    /// A line below the title.
    pub about: &'a str,
    /// Measured points \[x, z\] \[mm\]; none for a drawn profile.
    pub points: &'a [[f64; 2]],
    /// The curve \[x, z\] \[mm\].
    pub curve: &'a [[f64; 2]],
    /// Pairs \[arc length, distance of a point from the curve, positive above\] \[mm\].
    pub residual: &'a [[f64; 2]],
    /// Pairs \[arc length \[mm\], curvature \[1/mm\], positive with the hollow side up\].
    pub curvature: &'a [[f64; 2]],
}

impl ProfilePicture<'_> {
    /// Returns the picture as SVG; without points it has no residual panel.
    pub fn svg(&self) -> String {
        let mut page = Page::new(self.title, self.about);
        let mut top = self.shape(&mut page, 112.0);
        let along = range(self.curvature.iter().chain(self.residual).map(|p| p[0]));
        if !self.residual.is_empty() {
            top = self.residuals(&mut page, top, along);
        }
        top = self.curvatures(&mut page, top, along);
        page.finish(top + 20.0, &super::page::foot())
    }

    /// Draws points and curve at true scale, as high as the profile's proportions need. Returns the top of the next panel.
    fn shape(&self, page: &mut Page, top: f64) -> f64 {
        let both = || self.curve.iter().chain(self.points);
        let (u, v) = (range(both().map(|p| p[0])), range(both().map(|p| p[1])));
        let (u, v) = (airy(u, 0.02, 0.0), airy(v, 0.06, 0.0));
        let height = (WIDTH * v.width() / u.width()).clamp(120.0, 420.0);
        let room = [LEFT, top, WIDTH, height];
        page.heading(room, "Profile, true scale");
        let panel = Panel::true_scale(room, u, v);
        // The curve is drawn over the points, which would hide it otherwise.
        crosses(page, &panel, self.points);
        page.lines(&panel.curve(self.curve), CURVE);
        panel.axes(page, ["x [mm]", "z [mm]"]);
        let row = top - 18.0;
        page.legend([LEFT + WIDTH - 180.0, row], CURVE, "curve");
        if !self.points.is_empty() {
            let x = LEFT + WIDTH - 80.0;
            page.lines(&cross([x + 20.0, row]), POINT);
            page.text([x + 32.0, row + 4.0], "points", SMALL);
        }
        top + height + 84.0
    }

    /// Draws the distance of the points from the curve in µm. Returns the top of the next panel.
    fn residuals(&self, page: &mut Page, top: f64, u: Interval) -> f64 {
        let micrometres: Vec<[f64; 2]> = self.residual.iter().map(|[s, r]| [*s, 1e3 * r]).collect();
        let v = about_zero(range(micrometres.iter().map(|p| p[1])));
        let panel = Panel { place: [LEFT, top, WIDTH, 170.0], u, v };
        page.heading(panel.place, "Residual: points above the curve");
        panel.zero_line(page);
        crosses(page, &panel, &micrometres);
        panel.axes(page, ["arc length [mm]", "residual [µm]"]);
        top + 170.0 + 84.0
    }

    /// Draws the curvature in 1/m, with the radii of its extremes in words. Returns the top of the next panel.
    fn curvatures(&self, page: &mut Page, top: f64, u: Interval) -> f64 {
        let per_metre: Vec<[f64; 2]> = self.curvature.iter().map(|[s, k]| [*s, 1e3 * k]).collect();
        let all = range(per_metre.iter().map(|p| p[1]));
        let panel = Panel { place: [LEFT, top, WIDTH, 200.0], u, v: about_zero(all) };
        let radius = |k: f64, side: &str| {
            format!("{SEPARATOR}smallest {side} radius {} mm", number((1e3 / k).abs(), 0.1))
        };
        let mut title = String::from("Curvature, positive where hollow side up");
        if all.low < 0.0 {
            title += &radius(all.low, "convex-up");
        }
        if all.high > 0.0 {
            title += &radius(all.high, "hollow-up");
        }
        page.heading(panel.place, &title);
        panel.zero_line(page);
        page.lines(&panel.curve(&per_metre), CURVE);
        panel.axes(page, ["arc length [mm]", "curvature [1/m]"]);
        top + 200.0 + 60.0
    }
}

/// Returns a range that contains 0, with 5 % of free space, at least 1e-6: smaller values in µm and 1/m are rounding errors.
fn about_zero(range: Interval) -> Interval {
    airy(range.with(0.0), 0.05, 1e-6)
}

/// Returns the arms of a cross.
fn cross([x, y]: [f64; 2]) -> [Vec<[f64; 2]>; 2] {
    [vec![[x - ARM, y], [x + ARM, y]], vec![[x, y - ARM], [x, y + ARM]]]
}

/// Draws a small cross for every point.
fn crosses(page: &mut Page, panel: &Panel, points: &[[f64; 2]]) {
    let stride = points.len().div_ceil(MOST_CROSSES).max(1);
    let mut arms = Vec::with_capacity(2 * points.len() / stride);
    for &point in points.iter().step_by(stride) {
        arms.extend(cross(panel.point(point)));
    }
    if !arms.is_empty() {
        page.lines(&arms, Pen { width: 0.5, ..POINT });
    }
}
