//! Draws a measured profile over its nominal one, with their differences as magnified arrows.

use super::page::{BLUE, GREY, Page, Pen, RED};
use super::panel::{Panel, airy, range};

const NOMINAL: Pen = Pen::new(GREY, 1.2);
const MEASURED: Pen = Pen::new(BLUE, 1.4);
const ARROW: Pen = Pen::new(RED, 0.9);

/// Left edge and width of the panel \[page units\].
const LEFT: f64 = 90.0;
const WIDTH: f64 = 770.0;
/// Largest length of a magnified arrow \[mm\].
const LONGEST: f64 = 12.0;
/// Magnifications to choose from.
const MAGNIFIED: [f64; 9] = [500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0];
/// Length of an arrow's head \[page units\], and the sine and cosine of the angle of its sides, 25°.
const HEAD: f64 = 5.0;
const HEAD_TURN: [f64; 2] = [0.4226, 0.9063];

/// The content of the picture.
#[derive(Debug, Clone, Copy)]
pub struct OverlayPicture<'a> {
    /// Name of the profile.
    pub title: &'a str,
    /// A line below the title.
    pub about: &'a str,
    /// The nominal curve \[x, z\] \[mm\].
    pub nominal: &'a [[f64; 2]],
    /// The measured curve \[x, z\] \[mm\].
    pub measured: &'a [[f64; 2]],
    /// Points of the nominal, each with the point of the measured curve on its normal \[mm\].
    pub differences: &'a [[[f64; 2]; 2]],
}

impl OverlayPicture<'_> {
    /// Returns the picture as SVG.
    pub fn svg(&self) -> String {
        let length = |[from, to]: &[[f64; 2]; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
        let largest = self.differences.iter().map(length).fold(0.0, f64::max);
        let times = MAGNIFIED.into_iter().find(|times| times * largest <= LONGEST).unwrap_or(1.0);
        let arrows: Vec<[[f64; 2]; 2]> = self
            .differences
            .iter()
            .map(|[from, to]| [*from, [0, 1].map(|k| from[k] + times * (to[k] - from[k]))])
            .collect();
        let all = || self.nominal.iter().chain(self.measured).chain(arrows.iter().flatten());
        let (u, v) = (range(all().map(|p| p[0])), range(all().map(|p| p[1])));
        let (u, v) = (airy(u, 0.02, 0.0), airy(v, 0.06, 0.0));
        let height = (WIDTH * v.width() / u.width()).clamp(160.0, 560.0);
        let mut page = Page::new(self.title, self.about);
        let top = 112.0;
        let panel = Panel::true_scale([LEFT, top, WIDTH, height], u, v);
        let heading =
            format!("Differences along the nominal's normal, × {times}; the largest is {largest:.3} mm");
        page.heading([LEFT, top, WIDTH, height], &heading);
        page.lines(&panel.curve(self.nominal), NOMINAL);
        page.lines(&panel.curve(self.measured), MEASURED);
        let shafts: Vec<Vec<[f64; 2]>> = arrows.iter().flat_map(|arrow| drawn(&panel, arrow)).collect();
        page.lines(&shafts, ARROW);
        panel.axes(&mut page, ["x [mm]", "z [mm]"]);
        let row = top + height + 62.0;
        for (k, (pen, name)) in
            [(NOMINAL, "nominal"), (MEASURED, "measured"), (ARROW, "difference")].into_iter().enumerate()
        {
            page.legend([LEFT + 110.0 * k as f64, row], pen, name);
        }
        page.finish(row + 34.0, &super::page::foot())
    }
}

/// Returns the shaft of an arrow and its head; an arrow shorter than a head is a shaft alone.
fn drawn(panel: &Panel, [from, to]: &[[f64; 2]; 2]) -> Vec<Vec<[f64; 2]>> {
    let [a, b] = [panel.point(*from), panel.point(*to)];
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy);
    if length < HEAD {
        return vec![vec![a, b]];
    }
    let [sin, cos] = HEAD_TURN;
    let (ux, uy) = (HEAD * dx / length, HEAD * dy / length);
    let side = |sin: f64| [b[0] - ux * cos + uy * sin, b[1] - uy * cos - ux * sin];
    vec![vec![a, b], vec![side(sin), b, side(-sin)]]
}
