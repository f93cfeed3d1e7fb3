//! One body as a coarse mesh: which segments a ray meets first, and the heights measured there.

use super::meshes::{Hit, Mesh, Origin, Vector};
use super::patch::{Patch, Place};
use super::ray::{Height, foot, height};
use super::sampler::Surface;

/// Cells of the coarse mesh per local scale, least per curve, and around.
const CELLS_PER_SCALE: f64 = 8.0;
const LEAST_CELLS: usize = 2;
const CELLS_AROUND: usize = 12;

/// Within this share of the body's size from a segment's end the neighbour counts as well: rounding of the
/// foot's position, which grows with the slope.
pub(super) const JOINT: f64 = 1e-11;

/// A foot is looked for on all curves that begin or end within this many coarse cells of the coarse hit.
const NEARBY_CELLS: f64 = 2.0;

/// Below this ζ component of the normal a ray is tangent for practical purposes: heights lose two digits and
/// neighbouring sheets cannot be told apart.
pub(super) const STEEPEST: f64 = 0.02;

/// A body with its coarse mesh; only triangles that face the other body are in it.
pub(super) struct Solid {
    /// Its surface.
    pub surface: Surface,
    /// Reach from the origin that is meshed \[mm\].
    pub reach: f64,
    patches: Vec<Patch>,
    mesh: Option<Mesh>,
    /// Curve and triangle of its patch, for each triangle of the mesh.
    owners: Vec<(usize, usize)>,
}

/// What a line along ζ finds.
#[derive(Debug, Clone)]
pub(super) enum Found {
    /// Heights of all sheets that may be the outer one: one, or two at a joint.
    Heights(Vec<Height>),
    /// No surface.
    Nothing,
    /// A sheet steeper than [`STEEPEST`], or the very end of the body.
    Steep,
    /// A sheet whose foot could not be pinned down.
    Unresolved,
}

impl Solid {
    /// The body, meshed around the ξ–η window with the given reach from the origin \[mm\]; `None` where its
    /// profile has a point that is not finite.
    pub fn new(surface: Surface, reach: f64) -> Option<Self> {
        let v = surface.v_reach(reach);
        let mut patches = Vec::with_capacity(surface.curves.len());
        let (mut vertices, mut owners) = (Vec::new(), Vec::new());
        for (index, curve) in surface.curves.iter().enumerate() {
            let n = LEAST_CELLS.max((CELLS_PER_SCALE * curve.length / curve.scale).ceil() as usize);
            let patch =
                Patch::new(&surface, index, spread(0.0, curve.length, n), spread(-v, v, CELLS_AROUND))?;
            for triangle in (0..patch.mesh.len()).filter(|&k| patch.mesh.normal(k).z > 0.0) {
                vertices.extend(patch.mesh.corners(triangle));
                owners.push((index, triangle));
            }
            patches.push(patch);
        }
        let corners = (0..owners.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = Mesh::new(vertices, corners);
        Some(Self { surface, reach, patches, mesh, owners })
    }

    /// The heights that the line through (ξ, η) meets first.
    pub fn along_zeta(&self, xi: f64, eta: f64) -> Found {
        let guesses = match self.coarse(xi, eta) {
            Some(coarse) => self.candidates(&coarse),
            None => self.all_ends(eta),
        };
        let near = !guesses.is_empty() && self.coarse(xi, eta).is_some();
        let mut found = Vec::new();
        let mut steep = false;
        for guess in guesses {
            let Some(place) = foot(&self.surface, guess, xi, eta) else { continue };
            if !self.on_curve(&place) {
                continue;
            }
            match height(&self.surface, place, xi, eta) {
                Some(height) if height.normal.z > STEEPEST => found.push(height),
                Some(height) if height.normal.z < -STEEPEST => {}
                _ => steep = true,
            }
        }
        match (steep, found.is_empty()) {
            (true, _) => Found::Steep,
            (false, false) => Found::Heights(self.outermost(found)),
            (false, true) if near => Found::Unresolved,
            (false, true) => Found::Nothing,
        }
    }

    /// The outermost of the heights, with all others that end at a joint right there.
    fn outermost(&self, mut found: Vec<Height>) -> Vec<Height> {
        let sign = if self.surface.is_wheel() { 1.0 } else { -1.0 };
        found.sort_by(|a, b| (sign * a.zeta).total_cmp(&(sign * b.zeta)));
        // At a joint the outermost may be there by rounding only: the next one then counts as well.
        if let Some(inner) = found.iter().position(|height| !self.at_joint(&height.place)) {
            found.truncate(inner + 1);
        }
        found
    }

    /// Guesses on every curve, for lines that slip past the coarse mesh near a silhouette or an end.
    fn all_ends(&self, eta: f64) -> Vec<Place> {
        let curves = self.surface.curves.iter().enumerate();
        curves.flat_map(|(curve, c)| [0.0, c.length].map(|t| Place { curve, t, v: eta })).collect()
    }

    fn coarse(&self, xi: f64, eta: f64) -> Option<Place> {
        let origin = if self.surface.is_wheel() { Origin::Below } else { Origin::Above };
        let mesh = self.mesh.as_ref()?;
        // Rays through an edge or vertex of the mesh may slip through: look beside it then.
        let nudge = self.surface.size * f64::EPSILON.sqrt();
        let beside = [[0.0, 0.0], [1.0, 0.7], [-0.7, 1.0], [-1.0, -0.6], [0.6, -1.0]];
        let hit =
            beside.iter().find_map(|[a, b]| mesh.along_zeta(xi + a * nudge, eta + b * nudge, origin))?;
        Some(self.own_place(hit))
    }

    /// The coarse place, and the near ends of its neighbours where it is close to an end.
    fn candidates(&self, coarse: &Place) -> Vec<Place> {
        let curves = &self.surface.curves;
        let mut all = vec![*coarse];
        let cell = |i: usize| {
            let c = &curves[i];
            NEARBY_CELLS * c.speed(0.0) * (c.scale / CELLS_PER_SCALE).min(c.length / LEAST_CELLS as f64)
        };
        let near = cell(coarse.curve);
        let mut left = coarse.t * curves[coarse.curve].speed(0.0);
        for i in (0..coarse.curve).rev() {
            if left > near {
                break;
            }
            all.push(Place { curve: i, t: curves[i].length, v: coarse.v });
            left += curves[i].length * curves[i].speed(0.0);
        }
        let mut right = (curves[coarse.curve].length - coarse.t) * curves[coarse.curve].speed(0.0);
        for (i, curve) in curves.iter().enumerate().skip(coarse.curve + 1) {
            if right > near {
                break;
            }
            all.push(Place { curve: i, t: 0.0, v: coarse.v });
            right += curve.length * curve.speed(0.0);
        }
        all
    }

    fn on_curve(&self, place: &Place) -> bool {
        let curve = &self.surface.curves[place.curve];
        let slack = self.slack(place);
        place.t >= -slack && place.t <= curve.length + slack
    }

    /// Whether a place is the end of its curve up to rounding.
    pub fn at_joint(&self, place: &Place) -> bool {
        let curve = &self.surface.curves[place.curve];
        let slack = self.slack(place);
        place.t <= slack || place.t >= curve.length - slack
    }

    fn slack(&self, place: &Place) -> f64 {
        JOINT * self.surface.size / self.surface.curves[place.curve].speed(place.t)
    }

    /// Whether a place is an end of the whole chain up to rounding.
    pub fn at_end(&self, place: &Place) -> bool {
        let last = self.surface.curves.len() - 1;
        let slack = self.slack(place);
        (place.curve == 0 && place.t <= slack)
            || (place.curve == last && place.t >= self.surface.curves[last].length - slack)
    }

    /// Where on the coarse mesh `point` is closest to, and the curves around.
    pub fn near(&self, point: Vector) -> Vec<Place> {
        let Some(mesh) = &self.mesh else { return Vec::new() };
        let place = self.own_place(mesh.closest_to(point));
        self.candidates(&place)
    }

    fn own_place(&self, hit: Hit) -> Place {
        let (curve, triangle) = self.owners[hit.triangle];
        self.patches[curve].place(&Hit { triangle, ..hit })
    }
}

/// n + 1 values from a to b.
pub(super) fn spread(a: f64, b: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| a + (b - a) * k as f64 / n as f64).collect()
}
