//! The picture of a sweep: several quantities over one abscissa, a panel each.

use super::canvas::{Anchor, Canvas, Colour, Pen};
use super::panel::{GREY, INK, Panel, SMALL};
use super::{BOUNDARY, WHEEL, cut, heading, legend, png, range, svg};
use crate::error::Result;

/// Colours of the curves of a panel, in order.
const COLOURS: [Colour; 2] = [WHEEL.colour, BOUNDARY.colour];
const ZERO: Pen = Pen::new(GREY, 0.6);

/// Left edges of the two columns of panels, their width and height, and what one row takes \[page units\].
const LEFT: [f64; 2] = [90.0, 540.0];
const SIZE: [f64; 2] = [330.0, 190.0];
const ROW: f64 = 290.0;
const TOP: f64 = 112.0;

/// A change between neighbours that is this many times those beside it, and this share of the curve's range, is a jump:
/// a contact that has moved elsewhere. Curves are not drawn across.
const JUMP: f64 = 6.0;
const JUMP_SHARE: f64 = 0.02;

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What the legend says; empty for the only curve of a panel.
    pub name: String,
    /// (abscissa, value), ascending; NaN where there is none.
    pub points: Vec<[f64; 2]>,
}

/// The curves of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Heading.
    pub title: String,
    /// Name of the axis, with its unit.
    pub axis: String,
    /// At most two curves.
    pub curves: Vec<Curve>,
}

/// What the picture shows.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvesPicture {
    /// Title of the scene.
    pub title: String,
    /// One line below it.
    pub about: String,
    /// Name of the abscissa, with its unit.
    pub abscissa: String,
    /// The panels, row by row, two in a row.
    pub quantities: Vec<Quantity>,
}

impl CurvesPicture {
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
        let height = TOP + ROW * self.quantities.len().div_ceil(LEFT.len()) as f64;
        let mut page = Canvas { size: [900.0, height], marks: Vec::new() };
        page.text([40.0, 42.0], cut(&self.title, 80), 18.0, Anchor::Start, INK);
        page.text([40.0, 64.0], cut(&self.about, 110), SMALL + 1.0, Anchor::Start, INK);
        let all = self.quantities.iter().flat_map(|q| &q.curves).flat_map(|curve| &curve.points);
        let u = range(all.map(|p| p[0]).filter(|u| u.is_finite()));
        for (k, quantity) in self.quantities.iter().enumerate() {
            let place = [LEFT[k % LEFT.len()], TOP + ROW * (k / LEFT.len()) as f64, SIZE[0], SIZE[1]];
            self.panel(&mut page, place, u, quantity);
        }
        let foot = format!("wheelrail {}", env!("CARGO_PKG_VERSION"));
        page.text([860.0, height - 16.0], foot, 9.0, Anchor::End, GREY);
        page
    }

    fn panel(&self, page: &mut Canvas, place: [f64; 4], u: [f64; 2], quantity: &Quantity) {
        heading(page, place, &quantity.title);
        let values = quantity.curves.iter().flat_map(|curve| &curve.points).map(|p| p[1]);
        let [low, high] = range(values.filter(|v| v.is_finite()));
        // Rounding of a constant is a line, not a picture of rounding.
        let air = (0.06 * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-9);
        let panel = Panel { place, u, v: [low - air, high + air] };
        if panel.v[0] < 0.0 && panel.v[1] > 0.0 {
            page.line(panel.point([u[0], 0.0]), panel.point([u[1], 0.0]), ZERO);
        }
        for (k, (curve, colour)) in quantity.curves.iter().zip(COLOURS).enumerate() {
            let pen = Pen::new(colour, 1.6);
            page.lines(panel.curve(&parted(&curve.points)), pen);
            if !curve.name.is_empty() {
                legend(
                    page,
                    [place[0] + place[2] - 130.0 + 70.0 * k as f64, place[1] - 18.0],
                    pen,
                    &curve.name,
                );
            }
        }
        panel.frame(page);
        panel.axes(page, [&self.abscissa, &quantity.axis]);
    }
}

/// The points with an undefined one in every jump.
fn parted(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let [low, high] = range(points.iter().map(|p| p[1]).filter(|v| v.is_finite()));
    let change = |k: usize| match (points.get(k), points.get(k + 1)) {
        (Some(a), Some(b)) => (b[1] - a[1]).abs(),
        _ => 0.0,
    };
    let mut out = Vec::with_capacity(points.len() + 4);
    for (k, &point) in points.iter().enumerate() {
        out.push(point);
        let beside = k.checked_sub(1).map_or(0.0, change).max(change(k + 1));
        if change(k) > JUMP_SHARE * (high - low) && change(k) > JUMP * beside {
            out.push([f64::NAN; 2]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(points: Vec<[f64; 2]>) -> CurvesPicture {
        let curves = vec![Curve { name: "left".into(), points }];
        let quantity = Quantity { title: "Radius".into(), axis: "r [mm]".into(), curves };
        CurvesPicture {
            title: "A sweep".into(),
            about: String::new(),
            abscissa: "y [mm]".into(),
            quantities: vec![quantity],
        }
    }

    #[test]
    fn a_jump_is_not_drawn_across_and_a_slope_is() {
        let jump: Vec<[f64; 2]> =
            (0..20).map(|k| [f64::from(k), f64::from(k) * 0.1 + if k < 10 { 0.0 } else { 9.0 }]).collect();
        let undefined: Vec<usize> =
            parted(&jump).iter().enumerate().filter(|(_, p)| p[1].is_nan()).map(|(k, _)| k).collect();
        assert_eq!(undefined, [10]);
        let slope: Vec<[f64; 2]> = (0..20).map(|k| [f64::from(k), f64::from(k * k)]).collect();
        assert_eq!(parted(&slope), slope);
    }

    #[test]
    fn constants_and_nothing_at_all_make_finite_pictures() {
        let constant = (0..5).map(|k| [f64::from(k), 3.0]).collect();
        for points in [constant, vec![[1.0, f64::NAN], [2.0, f64::NAN]], vec![[1.0, 2.0]], Vec::new()] {
            let svg = picture(points.clone()).svg();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}: {svg}");
        }
    }
}
