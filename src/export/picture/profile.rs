//! The picture of a profile: points and curve at true scale, and against arc length the residual and the curvature.

use super::canvas::{Anchor, Canvas, Pen};
use super::panel::{GREY, INK, Panel, SMALL, number};
use super::{BOUNDARY, SEPARATOR, WHEEL, cut, heading, legend, png, range, svg};
use crate::error::Result;

const CURVE: Pen = Pen::new(WHEEL.colour, 1.4);
const POINT: Pen = Pen::new(BOUNDARY.colour, 1.0);
const ZERO: Pen = Pen::new(GREY, 0.6);

/// Left, width and foot of the panels \[page units\].
const LEFT: f64 = 90.0;
const WIDTH: f64 = 770.0;

/// Half the arms of a point's cross \[page units\].
const ARM: f64 = 2.0;

/// At most this many points of a panel are marked, evenly chosen: more are a smear, and a large file.
const MOST_CROSSES: usize = 4000;

/// What the picture shows.
#[derive(Debug, Clone, Copy)]
pub struct ProfilePicture<'a> {
    /// Name of the profile.
    pub title: &'a str,
    /// One line below it.
    pub about: &'a str,
    /// Measured points \[x, z\] \[mm\]; none of a drawn profile.
    pub points: &'a [[f64; 2]],
    /// The curve \[x, z\] \[mm\].
    pub curve: &'a [[f64; 2]],
    /// \[arc length, distance of a point from the curve, positive above\] \[mm\].
    pub residual: &'a [[f64; 2]],
    /// \[arc length \[mm\], curvature \[1/mm\], positive where hollow side up\].
    pub curvature: &'a [[f64; 2]],
}

impl ProfilePicture<'_> {
    /// The picture as SVG; without points it has no residual panel.
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
        let mut page = Canvas { size: [900.0, 0.0], marks: Vec::new() };
        page.text([40.0, 42.0], cut(self.title, 80), 18.0, Anchor::Start, INK);
        page.text([40.0, 64.0], cut(self.about, 120), SMALL + 1.0, Anchor::Start, INK);
        let mut top = self.shape(&mut page, 112.0);
        let along = range(self.curvature.iter().chain(self.residual).map(|p| p[0]));
        if !self.residual.is_empty() {
            top = self.residuals(&mut page, top, along);
        }
        top = self.curvatures(&mut page, top, along);
        let foot = format!("wheelrail {}", env!("CARGO_PKG_VERSION"));
        page.text([LEFT + WIDTH, top], foot, 9.0, Anchor::End, GREY);
        page.size[1] = top + 20.0;
        page
    }

    /// Points and curve at true scale, as high as the profile's proportions ask for; returns the next panel's top.
    fn shape(&self, page: &mut Canvas, top: f64) -> f64 {
        let both = || self.curve.iter().chain(self.points);
        let (u, v) = (range(both().map(|p| p[0])), range(both().map(|p| p[1])));
        let widened = |[low, high]: [f64; 2], share: f64| {
            let air = share * (high - low);
            [low - air, high + air]
        };
        let (u, v) = (widened(u, 0.02), widened(v, 0.06));
        let height = (WIDTH * (v[1] - v[0]) / (u[1] - u[0])).clamp(120.0, 420.0);
        let room = [LEFT, top, WIDTH, height];
        heading(page, room, "Profile, true scale");
        let panel = Panel::true_scale(room, u, v);
        // The curve lies above its points, or they would hide it.
        crosses(page, &panel, self.points);
        page.lines(panel.curve(self.curve), CURVE);
        panel.frame(page);
        panel.axes(page, ["x [mm]", "z [mm]"]);
        let row = top - 18.0;
        legend(page, [LEFT + WIDTH - 180.0, row], CURVE, "curve");
        if !self.points.is_empty() {
            let x = LEFT + WIDTH - 80.0;
            page.lines(cross([x + 20.0, row]).to_vec(), POINT);
            page.text([x + 32.0, row + 4.0], "points", SMALL, Anchor::Start, INK);
        }
        top + height + 84.0
    }

    /// Distance of the points from the curve in µm.
    fn residuals(&self, page: &mut Canvas, top: f64, u: [f64; 2]) -> f64 {
        let micrometres: Vec<[f64; 2]> = self.residual.iter().map(|[s, r]| [*s, 1e3 * r]).collect();
        let v = about_zero(range(micrometres.iter().map(|p| p[1])));
        let panel = Panel { place: [LEFT, top, WIDTH, 170.0], u, v };
        heading(page, panel.place, "Residual: points above the curve");
        zero_line(page, &panel);
        crosses(page, &panel, &micrometres);
        panel.frame(page);
        panel.axes(page, ["arc length [mm]", "residual [µm]"]);
        top + 170.0 + 84.0
    }

    /// Curvature in 1/m, with the radii of its extremes in words.
    fn curvatures(&self, page: &mut Canvas, top: f64, u: [f64; 2]) -> f64 {
        let per_metre: Vec<[f64; 2]> = self.curvature.iter().map(|[s, k]| [*s, 1e3 * k]).collect();
        let extremes = range(per_metre.iter().map(|p| p[1]));
        let panel = Panel { place: [LEFT, top, WIDTH, 200.0], u, v: about_zero(extremes) };
        let radius = |k: f64| number((1e3 / k).abs(), 0.1);
        let of = |k: f64, side: &str| format!("{SEPARATOR}smallest {side} radius {} mm", radius(k));
        let mut title = String::from("Curvature, positive where hollow side up");
        if extremes[0] < 0.0 {
            title += &of(extremes[0], "convex-up");
        }
        if extremes[1] > 0.0 {
            title += &of(extremes[1], "hollow-up");
        }
        heading(page, panel.place, &title);
        zero_line(page, &panel);
        page.lines(panel.curve(&per_metre), CURVE);
        panel.frame(page);
        panel.axes(page, ["arc length [mm]", "curvature [1/m]"]);
        top + 200.0 + 60.0
    }
}

/// The range with 0 in it and 5 % of air.
fn about_zero([low, high]: [f64; 2]) -> [f64; 2] {
    let (low, high) = (low.min(0.0), high.max(0.0));
    // A residual of nothing but rounding is a line at 0, not a picture of rounding.
    let air = (0.05 * (high - low)).max(1e-6);
    [low - air, high + air]
}

fn zero_line(page: &mut Canvas, panel: &Panel) {
    page.line(panel.point([panel.u[0], 0.0]), panel.point([panel.u[1], 0.0]), ZERO);
}

/// The arms of a cross.
fn cross([x, y]: [f64; 2]) -> [Vec<[f64; 2]>; 2] {
    [vec![[x - ARM, y], [x + ARM, y]], vec![[x, y - ARM], [x, y + ARM]]]
}

/// A small cross for every point.
fn crosses(page: &mut Canvas, panel: &Panel, points: &[[f64; 2]]) {
    let stride = points.len().div_ceil(MOST_CROSSES).max(1);
    let mut arms = Vec::with_capacity(2 * points.len() / stride);
    for &point in points.iter().step_by(stride) {
        arms.extend(cross(panel.point(point)));
    }
    if !arms.is_empty() {
        page.lines(arms, Pen { width: 0.5, ..POINT });
    }
}
