//! The lower body under a grid: the heights and normals by which files place s in space.

use rayon::prelude::*;

use super::Evaluator;
use crate::lofted::{Feet, LoftFoot};
use crate::placement::Placement;
use crate::profile::Station;

/// The lower body under a grid, in the contact frame.
#[derive(Debug, Clone, PartialEq)]
pub struct LowerBody {
    /// ζ^R(ξ) \[mm\] at η = 0 for each ξ; NaN where a rail or roller has no surface, 0 where a rail that varies along the track has none.
    pub height: Vec<f64>,
    /// Components (n_ξ, n_ζ) of the outward (upward) unit normal at η = 0 for each ξ; NaN where a rail or roller has no surface, (0, 1)
    /// where a rail that varies along the track has none.
    pub normal: Vec<[f64; 2]>,
    /// Its surface over the whole grid; `None` for an extruded rail, where η changes nothing.
    pub surface: Option<LowerSurface>,
}

/// The surface of a lower body that is not extruded, a roller or a rail that varies along the track, over a grid: at
/// `i_xi * n_eta + i_eta`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LowerSurface {
    /// How far it lies below [`LowerBody::height`] along ζ \[mm\]; NaN where it has no surface.
    pub fall: Vec<f64>,
    /// Outward (upward) unit normals (ξ, η, ζ); NaN where it has no surface.
    pub normal: Vec<[f64; 3]>,
}

/// Fall and normal where a lower body has no surface.
const NO_SURFACE: (f64, [f64; 3]) = (f64::NAN, [f64::NAN; 3]);

impl LowerBody {
    /// Computes the lower body of a placed pair under the grid of these ξ and η \[mm\]. Accuracy: that of
    /// [`Evaluator::separation`] beyond the contact segments.
    pub fn under(placement: &Placement, xi: &[f64], eta: &[f64]) -> Self {
        let (height, normal): (Vec<f64>, Vec<[f64; 2]>) = if placement.lofted_rail().is_some() {
            // Where the rail has no surface at η = 0, the tangent plane takes its place.
            let mut bodies = Evaluator::new(placement);
            let column = |&xi: &f64| {
                let normal = bodies.normals(xi, 0.0).rail.map_or([0.0, 1.0], |normal| [normal.x, normal.z]);
                (Some(bodies.lower_height(xi, 0.0)).filter(|zeta| !zeta.is_nan()).unwrap_or(0.0), normal)
            };
            xi.iter().map(column).unzip()
        } else {
            let section = &placement.rail().section;
            let station = |&xi: &f64| section.branch_at(xi).map(|branch| branch.station(xi));
            let column = |s: Station| (s.z, [-s.sin, s.cos]);
            xi.iter().map(|xi| station(xi).map_or((f64::NAN, [f64::NAN; 2]), column)).unzip()
        };
        let surface = LowerSurface::under(placement, (xi, &height), eta);
        Self { height, normal, surface }
    }
}

impl LowerSurface {
    /// Computes the surface of a roller, or of a rail that varies along the track; `None` for an extruded rail.
    fn under(placement: &Placement, (xi, height): (&[f64], &[f64]), eta: &[f64]) -> Option<Self> {
        let column = |(&xi, &height): (&f64, &f64)| -> Vec<(f64, [f64; 3])> {
            if let Some(lofted) = placement.lofted_rail() {
                let mut feet = Feet::new(lofted);
                let point = |foot: LoftFoot| (height - foot.zeta, foot.normal().into_inner().into());
                return eta.iter().map(|&eta| feet.at(xi, eta).map_or(NO_SURFACE, point)).collect();
            }
            let mut bodies = Evaluator::new(placement);
            let normals = eta.iter().map(|&eta| bodies.normals(xi, eta).rail);
            let normals =
                normals.map(|normal| normal.map_or(NO_SURFACE.1, |normal| normal.into_inner().into()));
            let mut under = placement.under().map(Evaluator::new);
            let fall = |eta: f64| under.as_mut().map_or(f64::NAN, |under| under.separation(xi, eta));
            eta.iter().copied().map(fall).zip(normals).collect()
        };
        (placement.under().is_some() || placement.lofted_rail().is_some()).then(|| {
            let (fall, normal) = xi.par_iter().zip(height).flat_map_iter(column).unzip();
            Self { fall, normal }
        })
    }
}
