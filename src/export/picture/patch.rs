//! Draws the picture of a patch for a report: both profiles at true scale, the exaggerated gap, and the lines
//! of equal separation with the boundary over the solver's cells, to scale, with units and a legend.

use super::super::model::Loop;
use super::contact::{APPROACH, ClosingPlace, PicturedContact, RAIL, SHOWN_GAP, WHEEL, WINDOW, overlaps};
use super::contour::Nodes;
use super::map::{Map, TrueContact};
use super::page::{INSIDE, Page};
use super::panel::{Panel, airy, range, significant};

/// Height of the page \[page units\].
const HEIGHT: f64 = 1040.0;

/// The content of the picture.
#[derive(Debug, Clone, Copy)]
pub struct PatchPicture<'a> {
    /// The contact.
    pub contact: PicturedContact<'a>,
    /// Centres ξ and η of the solver's cells \[mm\], ascending.
    pub cells: [&'a [f64]; 2],
    /// s \[mm\] over the window of the cells, on as many points as smooth lines need.
    pub separation: Nodes<'a>,
    /// Points \[ξ, s(ξ, 0)\] \[mm\] over the window of the cells.
    pub midplane: &'a [[f64; 2]],
    /// The boundary of the patch.
    pub loops: &'a [Loop],
    /// The true contact; `None` where no pressures were solved.
    pub pressed: Option<TrueContact<'a>>,
}

impl PatchPicture<'_> {
    /// Returns the picture as SVG.
    pub fn svg(&self) -> String {
        let mut page = self.contact.page();
        self.profiles(&mut page, [40.0, 110.0, 380.0, 250.0]);
        self.gap(&mut page, [520.0, 110.0, 340.0, 250.0]);
        self.contours(&mut page, [90.0, 460.0, 590.0, 500.0]);
        self.contact.finish(page, HEIGHT)
    }

    /// Draws both profiles at true scale, and marks the part of them that the other panels show.
    fn profiles(&self, page: &mut Page, room: [f64; 4]) {
        page.heading(room, "Profiles in the contact frame, true scale");
        self.contact.profiles(page, room, |page, panel, room| {
            let shown = range(self.cells[0].iter().copied()).map(|xi| panel.u.nearest(xi));
            let ([from, to], half) = (shown.ends(), shown.width() / 2.0);
            let corners =
                [[from, -half], [to, -half], [to, half], [from, half]].map(|corner| panel.point(corner));
            let window = corners.map(|[x, y]| [x, y.clamp(room[1], room[1] + room[3])]);
            page.area(&[window.to_vec()], WINDOW);
        });
    }

    /// Draws the gap in the midplane over a straightened rail, with the heights stretched.
    fn gap(&self, page: &mut Page, room: [f64; 4]) {
        let approach = self.contact.header.approach;
        let mut v = range(self.midplane.iter().map(|p| p[1]).chain([0.0, approach]));
        v.high = if approach > 0.0 { v.high.min(SHOWN_GAP * approach) } else { v.high };
        let u = range(self.cells[0].iter().copied());
        let panel = Panel { place: room, u, v: airy(v, 0.08, 0.0) };
        let [a, b] = panel.scale();
        page.heading(room, &format!("Gap at η = 0 over the rail, heights × {}", significant(b / a, 2)));
        let closing = |&[xi, s]: &[f64; 2]| ClosingPlace {
            wheel: [xi, s],
            closed: [xi, approach],
            overlap: approach - s,
        };
        page.area(&overlaps(&panel, &self.midplane.iter().map(closing).collect::<Vec<_>>()), INSIDE);
        page.lines(&panel.curve(&u.ends().map(|u| [u, 0.0])), RAIL);
        page.lines(&panel.curve(self.midplane), WHEEL);
        panel.axes(page, ["ξ [mm]", "s [mm]"]);
        if approach > 0.0 {
            page.lines(&panel.curve(&u.ends().map(|u| [u, approach])), APPROACH);
            page.legend([room[0], room[1] + room[3] + 52.0], APPROACH, "approach δ");
        }
    }

    /// Draws lines of equal separation over ξ–η, at one scale.
    fn contours(&self, page: &mut Page, room: [f64; 4]) {
        page.heading(room, "Separation s(ξ, η) before approach, true scale");
        let flat = |ring: &Loop| ring.points.iter().map(|point| [point.x, point.y]).collect();
        let map = Map {
            gap: "s",
            along: "ξ",
            boundary: "s = δ",
            cells: self.cells,
            values: self.separation,
            loops: self.loops.iter().map(flat).collect(),
            pressed: self.pressed,
            approach: self.contact.header.approach,
        };
        map.draw(page, room);
    }
}

#[cfg(test)]
mod tests;
