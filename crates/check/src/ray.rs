//! Measures the height of a surface over (ξ, η) by rays on meshes.
//!
//! A coarse mesh of the whole body tells the segment that is met, and the approximate place. The foot is then meshed anew
//! with cells that halve from level to level, while the ray keeps its relative position inside its cell. The chordal error
//! is then a power series c₂h² + c₃h³ + …, which Richardson's table removes. A last mesh of very small cells gives a
//! rigorous bracket.

use super::meshes::{RayOrigin, Vector};
use super::patch::{CurveMesh, ParameterPoint};
use super::sampler::SampledSurface;
use wheelrail::Interval;

/// Cells of the first level, as a share of the local scale (radius or length). Larger cells leave terms of
/// high order, smaller ones rounding.
pub(super) const FIRST_CELL: f64 = 1.0 / 32.0;
/// Number of levels. The cells of each level are half as large as those of the previous one.
const LEVELS: usize = 5;

/// Most times that the first cell is divided by four while the table has not converged.
const REFINEMENTS: i32 = 3;

/// Cell of the bracket's mesh, as a share of the local scale. Its chordal bound, about a quarter of the square, is near
/// rounding, and the cell itself still has seven digits.
const BRACKET_CELL: f64 = 1e-6;

/// Position of the ray inside its cell: off the diagonal and off symmetric places, where the error may have no h² term.
const INSIDE: [f64; 2] = [0.375, 0.25];

/// Most Newton steps for the foot's parameters; five are enough on any sheet that is not vertical.
const NEWTON: usize = 40;

/// One measured height.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    /// Place on the surface.
    pub place: ParameterPoint,
    /// Extrapolated ζ \[mm\].
    pub zeta: f64,
    /// Estimated error of the extrapolation \[mm\].
    pub error: f64,
    /// Rigorous bounds of ζ \[mm\].
    pub bracket: Interval,
    /// log₂ of the ratio of successive differences, if these are clear of rounding.
    pub order: Option<f64>,
    /// Extrapolated unit normal, up where the surface faces the other body.
    pub normal: Vector,
    /// Estimated error of the normal.
    pub normal_error: f64,
}

/// Returns the foot of (ξ, η) on one curve's surface or its continuation, by Newton steps in (t, v) from a guess; `None` if they
/// do not converge.
pub(super) fn foot(
    surface: &SampledSurface,
    guess: ParameterPoint,
    xi: f64,
    eta: f64,
) -> Option<ParameterPoint> {
    let mut place = guess;
    let curve = &surface.curves[place.curve];
    let mut last = f64::INFINITY;
    for _ in 0..NEWTON {
        let point = surface.point(place.curve, place.t, place.v);
        let [along, around] = surface.tangents(place.curve, place.t, place.v);
        let (dx, dy) = (xi - point.x, eta - point.y);
        let determinant = along.x * around.y - along.y * around.x;
        let dt = (dx * around.y - dy * around.x) / determinant;
        let dv = (dy * along.x - dx * along.y) / determinant;
        // A sheet turns by about one radian over its scale; longer steps would leave it.
        let limit = 0.5 * curve.scale;
        let step = dt.clamp(-limit, limit);
        (place.t, place.v) = (place.t + step, place.v + dv);
        let size = (step / curve.scale).abs() + (dv / surface.round_scale()).abs();
        if !size.is_finite() {
            return None;
        }
        // Steps below this size are rounding, and no longer shrink.
        if size < 1e3 * f64::EPSILON && size >= 0.5 * last || size == 0.0 {
            return Some(place);
        }
        last = size;
    }
    (last < 1e6 * f64::EPSILON).then_some(place)
}

/// Returns the height at a foot; `None` if the sheet is vertical there.
pub(super) fn height(surface: &SampledSurface, place: ParameterPoint, xi: f64, eta: f64) -> Option<Height> {
    let bracket = bracket(surface, place, xi, eta)?;
    let rounding = rounding(surface, bracket.1);
    let mut best: Option<RichardsonTable> = None;
    for refinement in 0..=REFINEMENTS {
        let first = FIRST_CELL / 4f64.powi(refinement);
        let Some(table) = heights(surface, place, xi, eta, first).map(|z| RichardsonTable::new(&z, rounding))
        else {
            continue;
        };
        if best.as_ref().is_none_or(|b| table.error < b.error) {
            best = Some(table);
        }
        if best.as_ref().is_some_and(|b| b.error <= 4.0 * rounding) {
            break;
        }
    }
    let table = best?;
    let (normal, normal_error) = normal(surface, place);
    Some(Height {
        place,
        zeta: table.value,
        error: table.error,
        bracket: bracket.0,
        order: table.order,
        normal,
        normal_error,
    })
}

/// Returns the rounding of a height \[mm\]: that of the largest coordinates, divided by the normal's ζ component.
fn rounding(surface: &SampledSurface, normal_zeta: f64) -> f64 {
    f64::EPSILON * surface.size / normal_zeta
}

/// Returns the heights on meshes of 3 × 3 cells, with the foot at the same relative position in the middle
/// cell.
fn heights(
    surface: &SampledSurface,
    place: ParameterPoint,
    xi: f64,
    eta: f64,
    first: f64,
) -> Option<[f64; LEVELS]> {
    let h = first * surface.curves[place.curve].scale;
    let k = surface.v_cell(place.curve, place.t, h);
    let mut out = [f64::NAN; LEVELS];
    for (level, zeta) in out.iter_mut().enumerate() {
        let share = 0.5f64.powi(level as i32);
        let patch = around(surface, place, [h * share, k * share])?;
        *zeta = patch.mesh.along_zeta(xi, eta, RayOrigin::Below)?.point.z;
    }
    Some(out)
}

/// Returns 3 × 3 cells with the place inside the middle one.
fn around(surface: &SampledSurface, place: ParameterPoint, [h, k]: [f64; 2]) -> Option<CurveMesh> {
    let nodes = |x: f64, cell: f64, inside: f64| {
        [-1.0, 0.0, 1.0, 2.0].iter().map(|i| x + (i - inside) * cell).collect()
    };
    CurveMesh::new(surface, place.curve, nodes(place.t, h, INSIDE[0]), nodes(place.v, k, INSIDE[1]))
}

/// Returns a rigorous bracket of ζ, and the least ζ component of the normal around the foot.
fn bracket(surface: &SampledSurface, place: ParameterPoint, xi: f64, eta: f64) -> Option<(Interval, f64)> {
    let h = BRACKET_CELL * surface.curves[place.curve].scale;
    let k = surface.v_cell(place.curve, place.t, h);
    let patch = around(surface, place, [h, k])?;
    let hit = patch.mesh.along_zeta(xi, eta, RayOrigin::Below)?;
    let [apart, turn] = surface.chordal_bound(place.curve, place.t, [h, k]);
    // Over the patch the normal turns by less than it can turn over three cells.
    let least = patch.mesh.normal(hit.triangle).z - 3.0 * turn;
    if least.is_nan() || least <= 0.0 {
        return None;
    }
    let half = apart / least + 4.0 * rounding(surface, least);
    Some((Interval::of(hit.point.z).grown(half), least))
}

/// Returns the normal of the cell centred on the place, its diagonals' cross product: it is even in h, so
/// that the errors in h², h⁴, … can be removed.
fn normal(surface: &SampledSurface, place: ParameterPoint) -> (Vector, f64) {
    let h = FIRST_CELL * surface.curves[place.curve].scale;
    let k = surface.v_cell(place.curve, place.t, h);
    let of_cell = |share: f64| {
        let corner =
            |a: f64, b: f64| surface.point(place.curve, place.t + a * share * h, place.v + b * share * k);
        (corner(0.5, 0.5) - corner(-0.5, -0.5)).cross(corner(-0.5, 0.5) - corner(0.5, -0.5)).normalize()
    };
    extrapolated(of_cell)
}

/// Returns the limit of a direction whose error is even in the share of the first cell, and the last change.
pub(super) fn extrapolated(direction: impl Fn(f64) -> Vector) -> (Vector, f64) {
    let mut row: Vec<Vector> = (0..LEVELS).map(|level| direction(0.5f64.powi(level as i32))).collect();
    let mut before = row[LEVELS - 1];
    let mut power = 4.0;
    while row.len() > 1 {
        before = row[row.len() - 1];
        row = row.windows(2).map(|pair| pair[1] + (pair[1] - pair[0]) / (power - 1.0)).collect();
        power *= 4.0;
    }
    let limit = row[0].normalize();
    (limit, limit.distance(before))
}

/// Richardson's table for errors c₂h² + c₃h³ + … at halved cells.
struct RichardsonTable {
    value: f64,
    error: f64,
    order: Option<f64>,
}

impl RichardsonTable {
    fn new(values: &[f64; LEVELS], rounding: f64) -> Self {
        let mut row = values.to_vec();
        let order = observed_order(values, rounding);
        let mut before = row[LEVELS - 1];
        let mut power = 4.0;
        while row.len() > 1 {
            before = row[row.len() - 1];
            row = row.windows(2).map(|pair| pair[1] + (pair[1] - pair[0]) / (power - 1.0)).collect();
            power *= 2.0;
        }
        Self { value: row[0], error: (row[0] - before).abs() + rounding, order }
    }
}

/// Returns log₂ of the ratio of the last two differences that are larger than a thousand roundings.
fn observed_order(values: &[f64; LEVELS], rounding: f64) -> Option<f64> {
    let differences: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let clear = differences.windows(2).rev().find(|pair| pair[1] > 1e3 * rounding)?;
    Some((clear[0] / clear[1]).log2())
}
