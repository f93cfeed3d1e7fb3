//! What the picture of a part over the rail's surface shows, on axes of its own.

use super::conformal::Conformal;
use super::drawn::{DRAWN_TOLERANCE, Drawn, places};
use super::run::Part;
use super::site::ends;
use crate::conformal::{NormalGap, fill_normal_gap};
use crate::export::{ConformalPicture, Header, Nodes, PicturedContact, RailNormal};
use crate::separation::EtaAxis;

/// t over the window of the grid whatever the spacing of the solver's cells, and the rail's normals.
pub(super) struct Unrolled<'a> {
    refusals: Vec<String>,
    cells: [&'a [f64]; 2],
    sigma: Vec<f64>,
    eta: EtaAxis,
    gap: Vec<f64>,
    normals: Vec<RailNormal>,
    loops: Vec<Vec<[f64; 2]>>,
}

impl<'a> Unrolled<'a> {
    /// Computes what is drawn of a part; `None` for one over the tangent plane.
    pub(super) fn new(part: &'a Part) -> Option<Self> {
        let (site, conformal) = (&part.site, part.analysis.conformal.as_ref()?);
        let cells = [site.grid.sigma.as_deref()?, &site.grid.eta];
        let [sigma, eta] = cells.map(|values| places(ends(values)));
        let (normal_gap, eta) = (NormalGap::new(&site.contact.placement), EtaAxis::new(&eta));
        let mut gap = vec![0.0; sigma.len() * eta.eta().len()];
        fill_normal_gap(&normal_gap, &sigma, &eta, DRAWN_TOLERANCE, &mut gap);
        let normal = |&sigma: &f64| {
            let (at, gap) = (normal_gap.rail().point(sigma)?, normal_gap.gap(sigma, 0.0));
            Some(RailNormal { sigma, foot: [at.xi, at.zeta], direction: [-at.sin, at.cos], gap })
        };
        let normals = sigma.iter().filter_map(normal).collect();
        let components = conformal.patch.iter().flat_map(|patch| &patch.components);
        let loops =
            components.flat_map(|component| [&component.boundary].into_iter().chain(&component.holes));
        let loops = loops.cloned().collect();
        Some(Self { refusals: refusals(part, conformal), cells, sigma, eta, gap, normals, loops })
    }

    /// Gives the picture, with the profiles that are drawn over the plane.
    pub(super) fn picture<'p>(&'p self, header: &'p Header, drawn: &'p Drawn) -> ConformalPicture<'p> {
        ConformalPicture {
            contact: PicturedContact { refusals: &self.refusals, ..drawn.contact(header) },
            cells: self.cells,
            gap: Nodes { xi: &self.sigma, eta: self.eta.eta(), values: &self.gap },
            normals: &self.normals,
            loops: &self.loops,
        }
    }
}

/// Lists why the contact is infeasible, and whether its conformal patch is empty.
fn refusals(part: &Part, conformal: &Conformal) -> Vec<String> {
    let Some(patch) = &conformal.patch else { return part.refusals() };
    let mut out = part.site.refusals(None);
    if patch.components.is_empty() {
        out.push("empty patch: t is nowhere below δ cos α in the window of the grid".into());
    }
    out
}
