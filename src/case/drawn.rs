//! What the picture of a part shows, on axes of its own.

use nalgebra::Point3;

use super::found::Found;
use super::pressure::PartPressure;
use super::run::Part;
use super::site::ends;
use crate::export::{
    Frame, Header, Loop, Nodes, PatchPicture, PicturedContact, QuadMesh, SEPARATOR, TrueContact,
};
use crate::mesh::{StripMesh, equal_steps};
use crate::numerics::interval::Interval;
use crate::patch::{Patch, Window};
use crate::placement::Placement;
use crate::profile::Section;
use crate::search::TrackSide;
use crate::separation::{Choice, Demand, EtaAxis, Evaluator, Method};

/// Points of a picture along ξ and along η: a line of equal separation is smooth to the eye, and C is among them where
/// the grid is symmetric about it.
const DRAWN: usize = 121;

/// Tolerance on s \[mm\] of a picture without a plan: far below the width of a line.
pub(super) const DRAWN_TOLERANCE: f64 = 1e-6;

/// Points of a picture's profile along one piece of it.
const OUTLINE_POINTS: usize = 32;

/// s over the window of the grid whatever the spacing of the solver's cells, and both profiles.
pub(super) struct Drawn {
    contact: String,
    refusals: Vec<String>,
    pressure: Option<PartPressure>,
    xi: Vec<f64>,
    eta: EtaAxis,
    separation: Vec<f64>,
    /// (ξ, s(ξ, 0))
    midplane: Vec<[f64; 2]>,
    /// Profiles of rail and wheel.
    outlines: [Vec<[f64; 2]>; 2],
}

impl Drawn {
    /// Computes what is drawn of a part.
    pub(super) fn new(part: &Part) -> Self {
        let (site, choice) = (&part.site, &part.analysis.plan.choice);
        let drawn = Self::of(&site.contact.placement, &site.window(), choice, contact_name(part));
        Self { refusals: part.refusals(), pressure: part.analysis.pressure.clone(), ..drawn }
    }

    /// Computes what is drawn of a placed pair over a window.
    fn of(placement: &Placement, window: &Window, choice: &Choice, contact: String) -> Self {
        let (xi, eta) = (places(window.xi), EtaAxis::new(&places(window.eta)));
        let mut separation = vec![0.0; xi.len() * eta.eta.len()];
        choice.fill(placement, &xi, &eta, &mut separation);
        let mut evaluator = Evaluator::new(placement);
        let midplane = xi.iter().map(|&xi| [xi, evaluator.separation(xi, 0.0)]).collect();
        let outlines = [&placement.rail().section, &placement.wheel().section].map(outline);
        Self { contact, refusals: Vec::new(), pressure: None, xi, eta, separation, midplane, outlines }
    }

    /// Gives the picture, with the solver's cells and the boundary.
    pub(super) fn picture<'a>(
        &'a self,
        header: &'a Header,
        cells: [&'a [f64]; 2],
        loops: &'a [Loop],
    ) -> PatchPicture<'a> {
        PatchPicture {
            contact: self.contact(header),
            cells,
            separation: Nodes { xi: &self.xi, eta: &self.eta.eta, values: &self.separation },
            midplane: &self.midplane,
            loops,
            pressed: self.pressure.as_ref().map(|found| TrueContact {
                edges: &found.outline,
                largest: found.largest.pressure_n_per_mm2,
            }),
        }
    }

    /// Gives the contact as all its pictures show it.
    pub(super) fn contact<'a>(&'a self, header: &'a Header) -> PicturedContact<'a> {
        let [rail, wheel] = &self.outlines;
        PicturedContact { header, name: &self.contact, refusals: &self.refusals, rail, wheel }
    }
}

/// Gives the places along an axis at which a picture's values are computed; one alone of an interval without length.
pub(super) fn places(axis: Interval) -> Vec<f64> {
    if axis.has_width() { equal_steps(axis.low, axis.high, DRAWN) } else { vec![axis.low] }
}

/// Draws the patch of a placed pair with its boundary and both profiles, as SVG. `title` and `contact` head it; `cells` are
/// the centres ξ and η \[mm\] of the solver's cells, ascending, and set its window.
pub fn patch_picture(
    [title, contact]: [&str; 2],
    placement: &Placement,
    patch: &Patch,
    cells: [&[f64]; 2],
) -> String {
    let window = Window { xi: ends(cells[0]), eta: ends(cells[1]) };
    let choice =
        Choice { method: Method::Spectral, demand: Demand::for_tolerance(DRAWN_TOLERANCE), coefficients: 1 };
    let drawn = Drawn::of(placement, &window, &choice, contact.into());
    let header = Header {
        title: title.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        scene_hash: "in memory".into(),
        approach: patch.approach,
        frame: Frame::of(placement),
        remarks: Vec::new(),
    };
    let loops = loops_of(placement, patch);
    drawn.picture(&header, cells, &loops).svg()
}

/// Gives the boundary of a patch on the rail's surface.
pub(super) fn loops_of(placement: &Placement, patch: &Patch) -> Vec<Loop> {
    let mut bodies = Evaluator::new(placement);
    let loops = patch.components.iter().enumerate().flat_map(|(index, component)| {
        [&component.boundary].into_iter().chain(&component.holes).map(move |points| (index, points))
    });
    loops
        .map(|(component, points)| {
            let lifted = |&[xi, eta]: &[f64; 2]| Point3::new(xi, eta, bodies.lower_height(xi, eta));
            let points = points.iter().map(lifted).collect();
            Loop { component, points }
        })
        .collect()
}

/// Gives the boundary-fitted mesh as writers take it.
pub fn quads(strips: &StripMesh) -> QuadMesh {
    QuadMesh {
        points: strips.points.clone(),
        quads: strips.cells.iter().map(|cell| cell.corners).collect(),
        area: strips.cells.iter().map(|cell| cell.area).collect(),
        component: strips.cells.iter().map(|cell| cell.component).collect(),
    }
}

/// Tells the pictures of a run apart: by side and number of a contact that was found, or by the part of the patch.
pub(super) fn contact_name(part: &Part) -> String {
    match &part.site.contact.found {
        Some(Found { side: None, contact, .. }) => format!("contact {contact}"),
        Some(Found { side: Some(side), contact, .. }) => {
            let mirrored = if *side == TrackSide::Left { ", mirrored" } else { "" };
            format!("{side} side{mirrored}{SEPARATOR}contact {contact}")
        }
        None => part.site.folder.clone(),
    }
}

/// Gives a body's profile in the contact frame; NaN stands between pieces that do not join.
fn outline(section: &Section) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for piece in &section.pieces {
        if points.last().is_some_and(|last| last[0] != piece.xi.low) {
            points.push([f64::NAN; 2]);
        }
        let branch = &section.branches[piece.branch];
        let xi = equal_steps(piece.xi.low, piece.xi.high, OUTLINE_POINTS);
        points.extend(xi.into_iter().map(|xi| [xi, branch.height(xi)]));
    }
    points
}
