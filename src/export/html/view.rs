//! The page of a run: rail, wheel and separation of every contact, to be turned, cut and read.

use nalgebra::Isometry2;
use serde::Serialize;

use super::document::document;
use super::numbers::floats;

/// The bundled script; its sources are in `source/view.js` and the files that this imports.
const SCRIPT: &str = include_str!("view.js");

/// A profile in its own axes, as a polyline along the chain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageProfile {
    /// Name of the profile.
    pub name: String,
    /// Abscissae \[mm\].
    #[serde(serialize_with = "floats")]
    pub x: Vec<f64>,
    /// Heights \[mm\].
    #[serde(serialize_with = "floats")]
    pub z: Vec<f64>,
}

/// The two profiles of a side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PagePair {
    /// The rail's profile.
    pub rail: PageProfile,
    /// The wheel's profile.
    pub wheel: PageProfile,
    /// Distance \[mm\] of the axle from the wheel profile's origin.
    pub radius: f64,
    /// Distance \[mm\] of a roller's axle from the origin of the rail's profile; `None` for a rail.
    pub roller: Option<f64>,
}

/// The contact frame in a profile's own axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PageFrame {
    /// C \[mm\].
    origin: [f64; 2],
    /// Cosine and sine of θ_C.
    turn: [f64; 2],
}

impl From<&Isometry2<f64>> for PageFrame {
    fn from(frame: &Isometry2<f64>) -> Self {
        let (origin, turn) = (frame.translation.vector, frame.rotation);
        Self { origin: [origin.x, origin.y], turn: [turn.re, turn.im] }
    }
}

/// One contact of the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ViewContact {
    /// Side and number; empty for the only contact of a run.
    pub name: String,
    /// Index of its profiles in the page's pairs.
    pub pair: usize,
    /// The contact frame in the axes of rail and wheel.
    pub frames: [PageFrame; 2],
    /// Skew of the wheel \[rad\].
    pub skew: f64,
    /// δ \[mm\]; `None` without an approach.
    pub approach: Option<f64>,
    /// Exact area \[mm²\] of the patch under δ; `None` without an approach.
    pub area: Option<f64>,
    /// ξ of the page's own grid \[mm\], ascending in equal steps.
    #[serde(serialize_with = "floats")]
    pub xi: Vec<f64>,
    /// η of the page's own grid \[mm\], ascending in equal steps.
    #[serde(serialize_with = "floats")]
    pub eta: Vec<f64>,
    /// s \[mm\] at `i_xi * n_eta + i_eta`, NaN where undefined.
    #[serde(serialize_with = "floats")]
    pub separation: Vec<f64>,
    /// ζ of the rail \[mm\] at each ξ, NaN where it has no surface.
    #[serde(serialize_with = "floats")]
    pub rail_height: Vec<f64>,
    /// The exact boundary under δ: closed loops of ξ, η \[mm\] in turn.
    pub boundary: Vec<PageLoop>,
    /// The edges of the true contact: lines of ξ, η \[mm\] in turn, closed by their first points; none where no pressures were solved.
    pub pressed: Vec<PageLoop>,
    /// The pressures over the grid of the run; `None` unless they were asked for.
    pub pressure: Option<PagePressure>,
    /// Labels and values of the table beside the pictures.
    pub facts: Vec<[String; 2]>,
    /// The gap along the rail's turning normal; `None` for a run over the tangent plane.
    pub conformal: Option<PageConformal>,
    /// What a user should know before using the numbers.
    pub warnings: Vec<String>,
}

/// The gap t along the rail's turning normal, over the ξ and η of a contact's grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageConformal {
    /// t \[mm\] at `i_xi * n_eta + i_eta`, NaN where undefined.
    #[serde(serialize_with = "floats")]
    pub gap: Vec<f64>,
    /// Arc length σ \[mm\] of the rail's point at each ξ, NaN beyond its surface.
    #[serde(serialize_with = "floats")]
    pub sigma: Vec<f64>,
    /// cos α of the rail's point at each ξ, α the angle of its normal from ζ; NaN beyond its surface.
    #[serde(serialize_with = "floats")]
    pub cosine: Vec<f64>,
    /// The exact boundary t = δ cos α: closed loops of ξ, η \[mm\] in turn.
    pub boundary: Vec<PageLoop>,
    /// Exact area \[mm²\] of the conformal patch on the rail's surface; `None` without an approach.
    pub area: Option<f64>,
}

/// The pressures over the grid of a run, which has equal steps.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PagePressure {
    /// ξ \[mm\], ascending.
    #[serde(serialize_with = "floats")]
    pub xi: Vec<f64>,
    /// η \[mm\], ascending.
    #[serde(serialize_with = "floats")]
    pub eta: Vec<f64>,
    /// p \[N/mm²\] at `i_xi * n_eta + i_eta`.
    #[serde(serialize_with = "floats")]
    pub values: Vec<f64>,
}

/// One closed loop of a boundary.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageLoop(
    /// ξ, η \[mm\] of every point in turn; the first point is not repeated.
    #[serde(serialize_with = "floats")]
    pub Vec<f64>,
);

/// The page of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ViewPage {
    /// Title of the scene.
    pub title: String,
    /// A line below the title: profiles, inclination, radius, gauge and position.
    pub about: String,
    /// Version of this program.
    pub version: String,
    /// Hash of the scene that was run.
    pub scene_hash: String,
    /// The profiles of the sides.
    pub pairs: Vec<PagePair>,
    /// The contacts, the first one first.
    pub contacts: Vec<ViewContact>,
    /// Statements about the page, below all contacts.
    pub notes: Vec<String>,
}

impl ViewPage {
    /// Returns the page as HTML. Its size is that of the script, 0.6 MB, and 16/3 bytes for every number of an array.
    pub fn html(&self) -> Vec<u8> {
        document(&self.title, self, SCRIPT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_comes_with_the_licence_of_what_it_contains() {
        assert!(SCRIPT.contains("Permission is hereby granted"));
    }
}
