//! A body as a coarse mesh. Finds the segments that a ray meets first, and the heights measured there.

use super::meshes::{Hit, Mesh, RayOrigin, Vector};
use super::patch::{CurveMesh, ParameterPoint};
use super::ray::{Height, foot, height};
use super::sampler::{SampledCurve, SampledSurface};
use wheelrail::Interval;
use wheelrail::error::{Error, ErrorKind, Result};
use wheelrail::placement::Placement;

/// Cells of the coarse mesh per local scale.
const CELLS_PER_SCALE: f64 = 8.0;
/// Fewest cells of the coarse mesh per curve.
const LEAST_CELLS: usize = 2;
/// Fewest cells of the coarse mesh around the axle, or along the rail.
const CELLS_AROUND: usize = 12;
/// Longest cell of the coarse mesh around the axle, or along the rail \[mm\]. On a wheel of 460 mm its sagitta is 0.07 mm: with a
/// larger one, the closest points of mesh and body may lie on different parts of the profile.
const LONGEST_CELL: f64 = 16.0;

/// Most cells of the coarse mesh of a body: about 700 MB for rail, wheel and lifted wheel.
const MOST_CELLS: f64 = 1e5;

/// Distance from a segment's end, as a share of the body's size, within which the neighbour counts as well. It covers the
/// rounding of the foot's position, which grows with the slope.
pub(super) const JOINT: f64 = 1e-11;

/// Distance from the coarse hit, in coarse cells, within which a foot is looked for on all curves that begin
/// or end there.
const NEARBY_CELLS: f64 = 2.0;

/// Least ζ component of the normal. Below it a ray is practically tangent, heights lose two digits, and neighbouring sheets
/// cannot be distinguished.
pub(super) const STEEPEST: f64 = 0.02;

/// Least distance \[mm\] by which another head, such as a guard rail, stands in front of the sheet through C. The program then
/// takes the sheet through C.
pub(super) const FLANGEWAY: f64 = 10.0;

/// A body with its coarse mesh, which has only triangles that face the other body.
pub(super) struct Solid {
    /// The surface of the body.
    pub surface: SampledSurface,
    /// Largest distance from the origin that is meshed \[mm\].
    pub reach: f64,
    patches: Vec<CurveMesh>,
    mesh: Option<Mesh>,
    /// For each triangle of the mesh, its curve and its index in the patch.
    owners: Vec<(usize, usize)>,
}

/// The result along a line parallel to ζ.
#[derive(Debug, Clone)]
pub(super) enum AlongZeta {
    /// Heights of all sheets that may be the outer one: one, or two at a joint.
    Heights(Vec<Height>),
    /// There is no surface.
    Nothing,
    /// A sheet is steeper than [`STEEPEST`].
    Steep,
    /// The foot on a sheet could not be located.
    Unresolved,
}

impl Solid {
    /// Meshes a body of a placed pair up to a distance from the origin \[mm\], or as far as the wheel has a surface.
    ///
    /// # Errors
    /// A distance or points that are not finite; bodies so large that their meshes take more than 10⁵ cells.
    pub fn up_to(placement: &Placement, surface: SampledSurface, distance: f64) -> Result<Self> {
        // Beyond its largest radius along η, and the profile's extent along ξ, the wheel has no surface.
        let extent = placement.wheel().profile().extent();
        let reach = distance.min(extent.hypot(placement.wheel_radius() + extent));
        let not_finite = || {
            let expected = "finite points over a finite window";
            Error::new("check: profiles", "points that are not finite", expected, "check profiles and grid")
        };
        let cells = Self::cells(&surface, reach);
        if !distance.is_finite() || !cells.is_finite() {
            return Err(not_finite());
        }
        if cells > MOST_CELLS {
            let (found, expected) =
                (format!("a mesh of {cells:.0e} cells"), format!("at most {MOST_CELLS:e}"));
            let advice = "take a smaller window, or profiles without parts far from the contact";
            return Err(Error::new("check", found, expected, advice).of_kind(ErrorKind::Limit));
        }
        Self::new(surface, reach).ok_or_else(not_finite)
    }

    /// Returns the number of cells of the coarse mesh up to this distance from the origin \[mm\]; infinite or NaN if surface or
    /// distance is not finite.
    fn cells(surface: &SampledSurface, reach: f64) -> f64 {
        let along = surface.curves.iter().map(along).sum::<f64>();
        along * around(surface.v_reach(reach))
    }

    /// Meshes a body around the ξ–η window, up to the given distance from the origin \[mm\]; `None` if its
    /// profile has a point that is not finite.
    pub(super) fn new(surface: SampledSurface, reach: f64) -> Option<Self> {
        let v = surface.v_reach(reach);
        let around = around(v) as usize;
        let mut patches = Vec::with_capacity(surface.curves.len());
        let (mut vertices, mut owners) = (Vec::new(), Vec::new());
        for (index, curve) in surface.curves.iter().enumerate() {
            let n = along(curve) as usize;
            let patch = CurveMesh::new(&surface, index, spread(0.0, curve.length, n), spread(-v, v, around))?;
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

    /// Returns the heights that the line through (ξ, η) meets first.
    pub fn along_zeta(&self, xi: f64, eta: f64) -> AlongZeta {
        let origin = if self.surface.is_wheel() { RayOrigin::Below } else { RayOrigin::Above };
        self.met(xi, eta, origin)
    }

    /// Returns the heights that the line through (ξ, η) meets first at [`FLANGEWAY`] or more behind `zeta` \[mm\].
    pub fn behind(&self, xi: f64, eta: f64, zeta: f64) -> AlongZeta {
        let wheel = self.surface.is_wheel();
        let from = if wheel { zeta + FLANGEWAY } else { zeta - FLANGEWAY };
        self.met(xi, eta, if wheel { RayOrigin::UpFrom(from) } else { RayOrigin::DownFrom(from) })
    }

    fn met(&self, xi: f64, eta: f64, origin: RayOrigin) -> AlongZeta {
        let coarse = self.coarse(xi, eta, origin);
        let guesses = match &coarse {
            Some(coarse) => self.candidates(coarse),
            None => self.all_ends(eta),
        };
        let near = !guesses.is_empty() && coarse.is_some();
        let passed = |zeta: f64| match origin {
            RayOrigin::Below | RayOrigin::Above => false,
            RayOrigin::UpFrom(from) => zeta < from,
            RayOrigin::DownFrom(from) => zeta > from,
        };
        let mut found = Vec::new();
        let mut steep = false;
        for guess in guesses {
            let Some(place) = foot(&self.surface, guess, xi, eta) else { continue };
            if !self.on_curve(&place) {
                continue;
            }
            match height(&self.surface, place, xi, eta) {
                Some(height) if passed(height.zeta) => {}
                Some(height) if height.normal.z > STEEPEST => found.push(height),
                Some(height) if height.normal.z < -STEEPEST => {}
                _ => steep = true,
            }
        }
        match (steep, found.is_empty()) {
            (true, _) => AlongZeta::Steep,
            (false, false) => AlongZeta::Heights(self.outermost(found)),
            (false, true) if near => AlongZeta::Unresolved,
            (false, true) => AlongZeta::Nothing,
        }
    }

    /// Returns the heights from the outermost one inwards, up to the first that is not at a joint.
    fn outermost(&self, mut found: Vec<Height>) -> Vec<Height> {
        let sign = if self.surface.is_wheel() { 1.0 } else { -1.0 };
        found.sort_by(|a, b| (sign * a.zeta).total_cmp(&(sign * b.zeta)));
        // The outermost height may be outermost only by rounding at a joint; the next one then counts, too.
        if let Some(inner) = found.iter().position(|height| !self.at_joint(&height.place)) {
            found.truncate(inner + 1);
        }
        found
    }

    /// Returns both ends of every curve: guesses for lines that miss the coarse mesh near a silhouette or an end.
    fn all_ends(&self, eta: f64) -> Vec<ParameterPoint> {
        let curves = self.surface.curves.iter().enumerate();
        curves.flat_map(|(curve, c)| [0.0, c.length].map(|t| ParameterPoint { curve, t, v: eta })).collect()
    }

    fn coarse(&self, xi: f64, eta: f64, origin: RayOrigin) -> Option<ParameterPoint> {
        let mesh = self.mesh.as_ref()?;
        let hit = mesh.along_zeta_beside(xi, eta, origin, self.surface.size * f64::EPSILON.sqrt())?;
        Some(self.own_place(hit))
    }

    /// Returns the coarse place, and the near ends of its neighbours if it is close to an end.
    fn candidates(&self, coarse: &ParameterPoint) -> Vec<ParameterPoint> {
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
            all.push(ParameterPoint { curve: i, t: curves[i].length, v: coarse.v });
            left += curves[i].length * curves[i].speed(0.0);
        }
        let mut right = (curves[coarse.curve].length - coarse.t) * curves[coarse.curve].speed(0.0);
        for (i, curve) in curves.iter().enumerate().skip(coarse.curve + 1) {
            if right > near {
                break;
            }
            all.push(ParameterPoint { curve: i, t: 0.0, v: coarse.v });
            right += curve.length * curve.speed(0.0);
        }
        all
    }

    fn on_curve(&self, place: &ParameterPoint) -> bool {
        let curve = &self.surface.curves[place.curve];
        let slack = self.slack(place);
        place.t >= -slack && place.t <= curve.length + slack
    }

    /// Returns whether a place is the end of its curve, up to rounding.
    pub fn at_joint(&self, place: &ParameterPoint) -> bool {
        let curve = &self.surface.curves[place.curve];
        let slack = self.slack(place);
        place.t <= slack || place.t >= curve.length - slack
    }

    fn slack(&self, place: &ParameterPoint) -> f64 {
        JOINT * self.surface.size / self.surface.curves[place.curve].speed(place.t)
    }

    /// Returns whether a place is an end of the whole chain, up to rounding.
    pub fn at_end(&self, place: &ParameterPoint) -> bool {
        let last = self.surface.curves.len() - 1;
        let slack = self.slack(place);
        (place.curve == 0 && place.t <= slack)
            || (place.curve == last && place.t >= self.surface.curves[last].length - slack)
    }

    /// Returns the place of the coarse mesh that is closest to `point`, and the near ends of the curves around it.
    pub fn near(&self, point: Vector) -> Vec<ParameterPoint> {
        let Some(mesh) = &self.mesh else { return Vec::new() };
        let place = self.own_place(mesh.closest_to(point));
        self.candidates(&place)
    }

    fn own_place(&self, hit: Hit) -> ParameterPoint {
        let (curve, triangle) = self.owners[hit.triangle];
        self.patches[curve].place(&Hit { triangle, ..hit })
    }
}

/// Returns the number of coarse cells along a curve.
fn along(curve: &SampledCurve) -> f64 {
    let cells = (CELLS_PER_SCALE * curve.length / curve.scale).ceil();
    if cells < LEAST_CELLS as f64 { LEAST_CELLS as f64 } else { cells }
}

/// Returns the number of coarse cells from −v to v \[mm\] around the axle or along the rail.
fn around(v: f64) -> f64 {
    let cells = (2.0 * v / LONGEST_CELL).ceil();
    if cells < CELLS_AROUND as f64 { CELLS_AROUND as f64 } else { cells }
}

/// Returns n + 1 values from a to b, both to the bit.
pub(super) fn spread(a: f64, b: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| Interval::new(a, b).step(k, n)).collect()
}
