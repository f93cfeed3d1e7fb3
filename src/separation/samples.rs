//! Measures the error of a method that has no estimate of its own: it is compared with single points at a number of
//! places that does not grow with the grid.

use super::axis::EtaAxis;
use super::evaluator::Evaluator;
use super::grid::{Choice, Method};
use crate::numerics::nan_max;
use crate::placement::Placement;

/// Where a method is compared with single points.
struct SampledPlaces {
    /// Number of columns evenly spread.
    columns: usize,
    /// Most columns beside joints and half way between two of them.
    beside: usize,
    /// Least number of η in these columns.
    eta: usize,
    /// Number of points up to which all points of a grid are compared. A larger grid is compared at about so many or more.
    points: usize,
}

/// The places for a quadratic form. It has no joints, so that its error is that of two smooth surfaces between the joints of
/// the bodies: over 15,000 random grids the largest error of all places was at most 1.13 times that of 9 columns and 8 beside joints at
/// 5 η each, 1.19 times that of 9 columns and 16 beside joints at 3 η, and 1.84 times that of columns away from joints alone.
const OF_A_FORM: SampledPlaces = SampledPlaces { columns: 9, beside: 8, eta: 3, points: 0 };

/// The places for methods by columns or points, whose error may be large in a single column.
const OF_COLUMNS: SampledPlaces = SampledPlaces { columns: 65, beside: usize::MAX, eta: 9, points: 4096 };

/// Values at single points of a few columns.
pub(super) struct Samples<'a> {
    placement: &'a Placement,
    xi: Vec<f64>,
    axis: EtaAxis,
    exact: Vec<f64>,
}

impl<'a> Samples<'a> {
    /// Takes the samples of a grid for a method.
    pub fn new(placement: &'a Placement, xi: &[f64], whole: &EtaAxis, method: Method) -> Self {
        let places = if method == Method::Quadratic { OF_A_FORM } else { OF_COLUMNS };
        let all = xi.len() * whole.eta.len() <= places.points;
        let columns = if all { xi.to_vec() } else { sampled_columns(placement, xi, &places) };
        let axis = EtaAxis::new(&thinned(&whole.eta, places.eta.max(places.points / columns.len().max(1))));
        let mut evaluator = Evaluator::new(placement);
        let mut exact = vec![f64::NAN; columns.len() * axis.eta.len()];
        for (&xi, out) in columns.iter().zip(exact.chunks_mut(axis.eta.len().max(1))) {
            evaluator.column(xi, &axis.eta, out);
        }
        Self { placement, xi: columns, axis, exact }
    }

    /// Computes the largest difference \[mm\] of a method from the values at single points; NaN if only one of the two has
    /// a value somewhere.
    pub fn difference(&self, choice: &Choice) -> f64 {
        let mut values = vec![f64::NAN; self.exact.len()];
        choice.fill(self.placement, &self.xi, &self.axis, &mut values);
        difference(&values, &self.exact)
    }
}

/// Computes the largest difference of two lists. It is NaN if only one has a value at some place: a number off the surface
/// is as wrong as a missing one on it.
pub(super) fn difference(values: &[f64], exact: &[f64]) -> f64 {
    let differences = values.iter().zip(exact).filter(|(s, exact)| !(s.is_nan() && exact.is_nan()));
    differences.map(|(s, exact)| (s - exact).abs()).fold(0.0, nan_max)
}

/// Chooses columns of the grid: some evenly spread, and some of those next to the joints of both bodies and to the middle between
/// two joints.
fn sampled_columns(placement: &Placement, xi: &[f64], places: &SampledPlaces) -> Vec<f64> {
    let mut columns = thinned(xi, places.columns);
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return columns };
    if columns.len() < xi.len() {
        let joints = placement.joints(first, last);
        let middles = joints.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) / 2.0);
        let mut beside = Vec::new();
        for place in joints.iter().copied().chain(middles) {
            let beyond = xi.partition_point(|&xi| xi < place);
            // If a column is on the joint, both its neighbours are chosen, too.
            beside.extend(&xi[beyond.saturating_sub(1)..xi.len().min(beyond + 2)]);
        }
        beside.sort_by(f64::total_cmp);
        beside.dedup();
        columns.extend(thinned(&beside, places.beside));
        columns.sort_by(f64::total_cmp);
        columns.dedup();
    }
    columns
}

/// Returns at most `n` of the values, evenly spread, both ends included.
pub(super) fn thinned(values: &[f64], n: usize) -> Vec<f64> {
    places(values.len(), n).map(|k| values[k]).collect()
}

/// Returns at most `n` of the indices below `count`, evenly spread, both ends included.
pub(super) fn places(count: usize, n: usize) -> impl Iterator<Item = usize> {
    let n = n.min(count);
    (0..n).map(move |k| if n == 1 { 0 } else { k * (count - 1) / (n - 1) })
}
