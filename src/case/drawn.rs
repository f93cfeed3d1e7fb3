//! What the picture of a part shows, on axes of its own.

use super::run::Part;
use crate::export::{Header, Loop, Nodes, PatchPicture, SEPARATOR};
use crate::mesh::equal_steps;
use crate::profile::Section;
use crate::separation::{EtaAxis, Evaluator, Values};

/// Points of a picture along ξ and along η: a line of equal separation is smooth to the eye, and C is among them where
/// the grid is symmetric about it.
const DRAWN: usize = 121;

/// Points of a picture's profile along one piece of it.
const OUTLINE_POINTS: usize = 32;

/// s over the window of the grid whatever the spacing of the solver's cells, and both profiles.
pub(super) struct Drawn {
    contact: String,
    xi: Vec<f64>,
    eta: EtaAxis,
    separation: Values,
    /// (ξ, s(ξ, 0))
    midplane: Vec<[f64; 2]>,
    /// Profiles of rail and wheel.
    outlines: [Vec<[f64; 2]>; 2],
}

impl Drawn {
    /// Computes what is drawn of a part.
    pub(super) fn new(part: &Part) -> Self {
        let placement = &part.site.contact.placement;
        let window = part.site.window();
        let axis = |[from, to]: [f64; 2]| if from < to { equal_steps(from, to, DRAWN) } else { vec![from] };
        let (xi, eta) = (axis(window.xi), EtaAxis::new(&axis(window.eta)));
        let mut separation = Values::new(xi.len() * eta.eta.len());
        part.analysis.plan.choice.fill(placement, &xi, &eta, &mut separation);
        let mut evaluator = Evaluator::new(placement);
        let midplane = xi.iter().map(|&xi| [xi, evaluator.separation(xi, 0.0)]).collect();
        let outlines = [&placement.rail().section, &placement.wheel().section].map(outline);
        Self { contact: contact_name(part), xi, eta, separation, midplane, outlines }
    }

    /// Gives the picture, with the part's own cells and boundary.
    pub(super) fn picture<'a>(
        &'a self,
        header: &'a Header,
        part: &'a Part,
        loops: &'a [Loop],
    ) -> PatchPicture<'a> {
        PatchPicture {
            header,
            contact: &self.contact,
            cells: [&part.site.grid.xi, &part.site.grid.eta],
            separation: Nodes { xi: &self.xi, eta: &self.eta.eta, values: &self.separation },
            midplane: &self.midplane,
            loops,
            rail: &self.outlines[0],
            wheel: &self.outlines[1],
        }
    }
}

/// Tells the pictures of a run apart: by side and number of a contact that was found, or by the part of the patch.
fn contact_name(part: &Part) -> String {
    match &part.site.found {
        Some(found) if found.side == "single" => format!("contact {}", found.contact),
        Some(found) => {
            let mirrored = if found.side == "left" { ", mirrored" } else { "" };
            format!("{} side{mirrored}{SEPARATOR}contact {}", found.side, found.contact)
        }
        None => part.site.folder.clone(),
    }
}

/// Gives a body's profile in the contact frame; NaN stands between pieces that do not join.
fn outline(section: &Section) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for piece in &section.pieces {
        if points.last().is_some_and(|last| last[0] != piece.xi[0]) {
            points.push([f64::NAN; 2]);
        }
        let branch = &section.branches[piece.branch];
        let xi = equal_steps(piece.xi[0], piece.xi[1], OUTLINE_POINTS);
        points.extend(xi.into_iter().map(|xi| [xi, branch.height(xi)]));
    }
    points
}
