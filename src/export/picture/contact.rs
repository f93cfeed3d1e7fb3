//! What all pictures of a contact share: the head of the page, and a panel with both profiles.

use super::super::model::Header;
use super::page::{BLUE, BODY, Colour, Page, Pen, RED, SEPARATOR, SMALL};
use super::panel::{Panel, number, range, significant};

pub(super) const RAIL: Pen = Pen::new([70, 70, 70], 1.8);
pub(super) const WHEEL: Pen = Pen::new(BLUE, 1.8);
/// The line at which the approach closes the gap.
pub(super) const APPROACH: Pen = Pen::new(RED, 1.0).dashed([5.0, 3.0]);
/// Colour of what the grid covers.
pub(super) const WINDOW: Colour = [240, 240, 240];

/// Largest gap shown, as a multiple of the approach. Near a flange the gap grows to many times the approach.
pub(super) const SHOWN_GAP: f64 = 3.0;

/// Length of the frame's axes at C \[page units\].
const AXIS: f64 = 38.0;
/// Room for the ζ axis with its letter \[page units\].
const AXIS_ROOM: f64 = AXIS + 16.0;

/// A contact as its pictures show it.
#[derive(Debug, Clone, Copy)]
pub struct PicturedContact<'a> {
    /// Header with title, approach and version.
    pub header: &'a Header,
    /// Side and number of the contact, which distinguish the pictures of one run; empty for a single contact.
    pub name: &'a str,
    /// Why the contact is infeasible or its patch empty; the picture shows it in red.
    pub refusals: &'a [String],
    /// The rail's profile \[ξ, ζ\] \[mm\]; NaN points separate its pieces.
    pub rail: &'a [[f64; 2]],
    /// The wheel's profile \[ξ, ζ\] \[mm\] in the midplane η = 0 before any approach; NaN points separate its
    /// pieces.
    pub wheel: &'a [[f64; 2]],
}

impl PicturedContact<'_> {
    /// Begins the page: title, numbers of the contact, refusals.
    pub(super) fn page(&self) -> Page {
        let header = self.header;
        let angle = header.frame.xi[2].atan2(header.frame.xi[0]).to_degrees();
        let approach = || format!("approach δ = {} mm", significant(header.approach, 4));
        let [x, z] = [0, 2].map(|k| number(header.frame.origin[k], 0.001));
        let about = [
            Some(self.name.to_owned()).filter(|name| !name.is_empty()),
            (header.approach > 0.0).then(approach),
            Some(format!("contact angle θ = {}°", number(angle, 0.001))),
            Some(format!("rail point ({x}, {z}) mm")),
        ];
        let about = about.into_iter().flatten().collect::<Vec<_>>().join(SEPARATOR);
        let mut page = Page::new(&header.title, &about);
        // The first clause says what is wrong; the rest, what to do, is on stderr.
        let refused = self.refusals.iter().filter_map(|refusal| refusal.split(';').next());
        page.text([40.0, 82.0], refused.collect::<Vec<_>>().join(SEPARATOR), BODY.in_colour(RED));
        page
    }

    /// Returns the SVG document of a page of this height.
    pub(super) fn finish(&self, page: Page, height: f64) -> String {
        page.finish(height, &format!("wheelrail {}, scene {}", self.header.version, self.header.scene_hash))
    }

    /// Draws both profiles at true scale in a room below its heading. `below` is called first and draws what lies under them; it
    /// gets their panel and the room left for it as left, top, width and height.
    pub(super) fn profiles(
        &self,
        page: &mut Page,
        room: [f64; 4],
        below: impl Fn(&mut Page, &Panel, [f64; 4]),
    ) {
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
        below(page, &panel, room);
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
}

/// A place along a gap with an approach \[mm\], in the coordinates of a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct ClosingPlace {
    /// The wheel.
    pub(super) wheel: [f64; 2],
    /// Where the approach closes the gap.
    pub(super) closed: [f64; 2],
    /// What the approach closes beyond the gap \[mm\]; negative where the bodies stay apart.
    pub(super) overlap: f64,
}

/// Returns the areas on the page between the wheel and the approach where they overlap, stretch by stretch. Stretches with an
/// undefined end have none.
pub(super) fn overlaps(panel: &Panel, along: &[ClosingPlace]) -> Vec<Vec<[f64; 2]>> {
    let area = |pair: &[ClosingPlace]| {
        let [a, b] = [pair[0], pair[1]];
        let share = a.overlap / (a.overlap - b.overlap);
        let at = [0, 1].map(|k| a.closed[k] + (b.closed[k] - a.closed[k]) * share);
        let corners = match (a.overlap >= 0.0, b.overlap >= 0.0) {
            (true, true) => vec![a.wheel, b.wheel, b.closed, a.closed],
            (true, false) => vec![a.wheel, at, a.closed],
            (false, true) => vec![at, b.wheel, b.closed],
            (false, false) => Vec::new(),
        };
        let drawn = corners.iter().flatten().all(|x| x.is_finite());
        (drawn && !corners.is_empty()).then(|| corners.into_iter().map(|p| panel.point(p)).collect())
    };
    along.windows(2).filter_map(area).collect()
}
