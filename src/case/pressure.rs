//! The pressures of a part: those that its load was found with, or those solved over its grid.

use nalgebra::Point2;

use super::contact::PlacedContact;
use super::grids::Grid;
use super::input::{AskedPressure, Question};
use super::site::Site;
use super::usual;
use crate::error::{Error, ErrorKind, Result};
use crate::export::{Nodes, even_step};
use crate::load::{
    Cells, HalfSpace, Largest, Pressures, SharpEdge, on_finer_cells, on_wider_cells, press_alone, sharp_edge,
};
use crate::numerics::interval::Interval;
use crate::patch::Window;
use crate::placement::Placement;

/// Largest violation of contact's conditions relative to δ: the largest pressure then errs by 5e-4 of itself at most.
const SETTLED: f64 = 1e-4;

/// Estimated error of the largest pressure, relative, above which cells are divided again, and of which the user is told.
const DOUBTFUL: f64 = 0.01;

/// Parts into which the steps of a grid are divided; an odd number leaves every point of the grid in the middle of a cell. On the
/// steps themselves the largest pressure errs by 3 % where profiles have joints, and its estimate does not show it.
const FINER: usize = 3;

/// Most cells that are made unasked: they take half a second.
const MOST_UNASKED: usize = 300_000;

/// Most cells on which the largest pressure under a load is solved again: they take 50 ms.
const MOST_OF_LOAD: usize = 20_000;

/// Most cells that may be asked for: they take two seconds.
const MOST_ASKED: usize = 1_000_000;

/// Difference of the largest pressure on the cells of a grid from that on finer ones, relative, of which the user is told.
const ROUGH: f64 = 0.02;

/// What a solver finds on the cells of an automatic grid, whose points are their middles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnGrid {
    /// The largest pressure on these cells \[N/mm²\].
    pub largest: f64,
    /// That on finer cells \[N/mm²\]: those of the pressures over the grid if their sides were not given, or else half as wide.
    pub finer: f64,
}

impl OnGrid {
    /// Solves a site on the cells of its automatic grid, and on cells half as wide if no finer pressure is known. `None` on other grids,
    /// on unequal steps, for more cells than are made unasked, and where pressures do not settle.
    fn new(site: &Site, finer: Option<f64>, modulus: f64) -> Option<Self> {
        let Grid { xi, eta, groups, .. } = &site.grid;
        if groups.is_empty() {
            return None;
        }
        let steps = [step("xi", xi).ok()?, step("eta", eta).ok()?];
        let most = |parts: usize| {
            let cells = cells_of([xi, eta], steps, [parts; 2], MOST_UNASKED).ok()?;
            let region = overlap(&site.contact, &site.grid, cells).ok()?;
            let [found, _] = press_alone(region, super::wheel::SETTLED, modulus).ok()?;
            Some(found.values().into_iter().fold(0.0, f64::max))
        };
        Some(Self { finer: finer.or_else(|| most(2))?, largest: most(1)? })
    }

    /// Gives the difference of the pressures, relative to the finer one.
    pub fn difference(&self) -> f64 {
        self.largest / self.finer - 1.0
    }
}

/// An edge in a contact, with its place on the rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeOnRail {
    /// The kink of s.
    pub edge: SharpEdge,
    /// Abscissa on the rail's profile \[mm\].
    pub rail_x: f64,
}

impl EdgeOnRail {
    fn new(placement: &Placement, edge: SharpEdge) -> Self {
        let [xi, eta] = edge.at_mm;
        let rail_x = match placement.lofted_rail() {
            Some(lofted) => {
                let [across, along, _] = lofted.axes();
                lofted.origin()[0] + xi * across[0] + eta * along[0]
            }
            None => {
                let body = placement.rail();
                let height = body.section().height(xi);
                let height = if height.is_nan() { 0.0 } else { height };
                (body.contact_frame() * Point2::new(xi, height)).x
            }
        };
        Self { edge, rail_x }
    }

    /// Says why there is no largest pressure.
    pub fn said(&self) -> String {
        format!("unbounded: an edge at x = {:.2} mm on the rail", self.rail_x)
    }
}

/// The pressures of a part, in its contact frame.
#[derive(Debug, Clone)]
pub struct PartPressure {
    /// The largest pressure and its place.
    pub largest: Largest,
    /// Estimated error of the largest pressure \[N/mm²\]; infinite where an edge leaves it unbounded.
    pub largest_error: f64,
    /// The edge in the contact at which the elastic pressure has no bound: `largest` is then that on these cells; `None` without.
    pub unbounded: Option<EdgeOnRail>,
    /// True contact area \[mm²\], where pressures are positive.
    pub contact_area: f64,
    /// Normal force \[N\] of the pressures.
    pub load: f64,
    /// Sides of the cells \[mm\] along ξ and η.
    pub cell: [f64; 2],
    /// Mean p \[N/mm²\] over the cells around the points of the grid, at i_ξ · n_η + i_η; `None` unless it was asked for.
    pub field: Option<Vec<f64>>,
    /// The edges of the true contact: lines in ξ and η \[mm\].
    pub outline: Vec<Vec<[f64; 2]>>,
    /// The largest pressure on the cells of the grid beside that on finer ones; `None` on grids that are not automatic, and where they have
    /// too many cells or pressures do not settle.
    pub on_grid: Option<OnGrid>,
}

impl PartPressure {
    /// Finds the pressures of a site: over its grid if they are asked for, or else those that its load was found with. `None`
    /// where nothing is pressed: without a load and unasked, for an infeasible contact, and without a patch; and where a profile ends in the
    /// contact.
    ///
    /// # Errors
    /// Asked for on unequal steps, a single line, or more cells than a case bears.
    pub(super) fn new(site: &Site, question: &Question) -> Result<Option<Self>> {
        if site.is_infeasible() || site.contact.approach.is_none() || site.contact.open_end().is_some() {
            return Ok(None);
        }
        let modulus = question.modulus();
        let found = match question.pressure {
            Some(asked) => Some(Self::over_grid(site, asked, modulus)?),
            None => Self::of_load(&site.contact, &site.grid)?,
        };
        let Some(mut found) = found.filter(|found| found.load > 0.0) else { return Ok(None) };
        let own_cells = question.pressure.is_some_and(|asked| asked.cell.is_none());
        let finer = own_cells.then_some(found.largest.pressure_n_per_mm2);
        found.on_grid = OnGrid::new(site, finer, modulus);
        Ok(Some(found))
    }

    /// Reads the pressures that the load was found with. Where the largest one may err by more than 1 %, they are solved again on
    /// finer cells.
    fn of_load(contact: &PlacedContact, grid: &Grid) -> Result<Option<Self>> {
        let mut all: Option<Self> = None;
        for solved in covered(contact, grid) {
            let wider = on_wider_cells(solved, super::wheel::SETTLED)?;
            let one = Self::resolved(contact, solved.clone(), wider);
            all = Some(match all {
                Some(before) => before.and(one),
                None => one,
            });
        }
        Ok(all)
    }

    /// Reads pressures, those on `wider` cells beside them, or finer ones until the largest pressure is known to 1 %, or an edge found.
    fn resolved(contact: &PlacedContact, mut here: Pressures, mut wider: Pressures) -> Self {
        let (placement, approach) = (&contact.placement, contact.approach.unwrap_or(0.0));
        loop {
            let found = Self::read(placement, &here, &wider);
            let [columns, rows] = here.cells.count;
            if found.unbounded.is_some() || !found.is_doubtful() || 2 * columns * rows > MOST_OF_LOAD {
                return found;
            }
            // The error says what cells that do not settle leave.
            let Ok(finer) = on_finer_cells(placement, &here, approach, super::wheel::SETTLED) else {
                return found;
            };
            let Ok(of_finer) = on_wider_cells(&finer, super::wheel::SETTLED) else { return found };
            (here, wider) = (finer, of_finer);
        }
    }

    /// Solves the pressures over the grid of a site, of equal steps; `modulus` is E* \[N/mm²\].
    ///
    /// The points of the grid are middles of cells, whose sides are the steps divided by an odd number: by three unless a side is asked
    /// for, and by nine where the largest pressure may then err by more than 1 %.
    /// Accuracy: the largest pressure within 1 % and the load within 0.3 % where `largest_error` is not beyond 1 %; at a kink of a profile
    /// the elastic pressure has no bound. Cost: 30 ms for 200 × 200 cells, and s in their middles.
    ///
    /// # Errors
    /// Unequal steps, a single line, or more than a million cells; a profile that ends in the contact.
    pub fn over_grid(site: &Site, asked: AskedPressure, modulus: f64) -> Result<Self> {
        if let Some(end) = site.contact.open_end() {
            let doubt = usual::profile_end(end);
            return Err(Error::new(
                "patch: pressure",
                doubt.found,
                "profiles that go on",
                doubt.kind.cause(),
            ));
        }
        let (axes, contact) = ([&site.grid.xi, &site.grid.eta], &site.contact);
        let steps = [step("xi", axes[0])?, step("eta", axes[1])?];
        let counts = axes.map(Vec::len);
        let mut parts = match asked.cell {
            Some(side) => steps.map(|step| odd_above(step / side)),
            None => [FINER; 2],
        };
        loop {
            let cells = cells_of(axes, steps, parts, MOST_ASKED)?;
            let [fine, wider] = press_alone(overlap(contact, &site.grid, cells)?, SETTLED, modulus)?;
            let mut found = Self::read(&contact.placement, &fine, &wider);
            let finer = parts.map(|part| FINER * part);
            let affordable = cells_of(axes, steps, finer, MOST_UNASKED).is_ok();
            let once = asked.cell.is_none() && parts == [FINER; 2] && found.unbounded.is_none();
            if once && found.is_doubtful() && affordable {
                parts = finer;
                continue;
            }
            found.field = Some(over_points(&fine, counts, parts));
            return Ok(found);
        }
    }

    fn read(placement: &Placement, solved: &Pressures, wider: &Pressures) -> Self {
        let edge = sharp_edge(solved, placement);
        let unbounded = edge.filter(|edge| !edge.rounded).map(|edge| EdgeOnRail::new(placement, edge));
        let largest_error = match (unbounded, edge) {
            (Some(_), _) => f64::INFINITY,
            (None, Some(rounded)) => solved.largest_error(wider).max(rounded.beyond_n_per_mm2),
            (None, None) => solved.largest_error(wider),
        };
        Self {
            largest: solved.largest(),
            largest_error,
            unbounded,
            contact_area: solved.contact_area(),
            load: solved.load(),
            cell: solved.cells.step,
            field: None,
            outline: outline(solved),
            on_grid: None,
        }
    }

    /// Joins the pressures of two parts of one patch.
    fn and(self, mut other: Self) -> Self {
        let [more, less] = if self.largest.pressure_n_per_mm2 < other.largest.pressure_n_per_mm2 {
            [other.clone(), self.clone()]
        } else {
            [self.clone(), other.clone()]
        };
        let mut outline = self.outline;
        outline.append(&mut other.outline);
        let unbounded = more.unbounded.or(less.unbounded);
        Self {
            unbounded,
            largest_error: if unbounded.is_some() { f64::INFINITY } else { more.largest_error },
            contact_area: more.contact_area + less.contact_area,
            load: more.load + less.load,
            outline,
            ..more
        }
    }

    fn is_doubtful(&self) -> bool {
        self.largest_error > DOUBTFUL * self.largest.pressure_n_per_mm2
    }

    /// Says by how much the largest pressure may err, where it was asked for and that is more than 1 %, and by how much it differs on the
    /// cells of the grid, where that is more than 2 %.
    pub(super) fn warnings(&self) -> Vec<String> {
        let (p, error) = (self.largest.pressure_n_per_mm2, self.largest_error);
        let [xi, eta] = self.cell;
        if let Some(unbounded) = &self.unbounded {
            let (said, SharpEdge { kink, rise_n_per_mm2: rise, .. }) = (unbounded.said(), unbounded.edge);
            let why = if kink.is_finite() {
                format!("where the gap has a kink of {:.2} degrees", kink.to_degrees())
            } else {
                "where a surface ends".into()
            };
            return vec![format!(
                "the largest pressure is {said}, {why}: it is {p:.0} N/mm² on cells of {xi:.2e} x {eta:.2e} mm, and {rise:.0} N/mm² more \
                 where they are half as wide"
            )];
        }
        let doubtful = (self.field.is_some() && self.is_doubtful()).then(|| {
            format!(
                "the largest pressure, {p:.0} N/mm² on cells of {xi:.2e} x {eta:.2e} mm, may err by {:.0} %: give a smaller \
                 patch.pressure_cell",
                100.0 * error / p
            )
        });
        let rough = self.on_grid.filter(|on| on.difference().abs() > ROUGH).map(|on| {
            format!(
                "on the cells of this grid a solver finds a largest pressure of {:.0} N/mm², which is {:+.1} % off that on finer \
                 cells: give a smaller grid.spacing",
                on.largest,
                100.0 * on.difference()
            )
        });
        doubtful.into_iter().chain(rough).collect()
    }
}

/// Traces the edges of the true contact.
fn outline(solved: &Pressures) -> Vec<Vec<[f64; 2]>> {
    let ([xi, eta], values) = solved.squares_to_edges();
    Nodes { xi: &xi, eta: &eta, values: &values }.lines(0.0)
}

/// Lists the solved groups of parts that a grid covers.
fn covered<'a>(contact: &'a PlacedContact, grid: &'a Grid) -> impl Iterator<Item = &'a Pressures> {
    let all = grid.groups.is_empty();
    contact.pressures.iter().enumerate().filter(move |(k, _)| all || grid.groups.contains(k)).map(|(_, p)| p)
}

/// Gives the step of an axis \[mm\].
fn step(axis: &str, values: &[f64]) -> Result<f64> {
    even_step("pressures", axis, values).map_err(|mut error| {
        error.advice = format!("give grid.{axis} as from, to, n, or leave patch.pressure out");
        error
    })
}

/// Divides the cells of a grid, whose points are their middles.
///
/// # Errors
/// More cells than `most`.
fn cells_of(axes: [&Vec<f64>; 2], steps: [f64; 2], parts: [usize; 2], most: usize) -> Result<Cells> {
    let count = [0, 1].map(|k| axes[k].len().saturating_mul(parts[k]));
    if count[0].saturating_mul(count[1]) > most {
        let found = format!("{} x {} cells", count[0], count[1]);
        let advice = "take a coarser grid, a smaller window or a larger pressure_cell";
        let error = Error::new("patch: pressure", found, format!("at most {most} cells"), advice);
        return Err(error.of_kind(ErrorKind::Limit));
    }
    let side = |k: usize| {
        let (half, axis) = (0.5 * steps[k], axes[k]);
        Interval::new(axis[0], axis[axis.len() - 1]).grown(half)
    };
    Cells::over(&Window { xi: side(0), eta: side(1) }, count)
}

/// Returns the smallest odd number that is not below a ratio.
fn odd_above(ratio: f64) -> usize {
    2 * ((ratio - 1.0) / 2.0).ceil().max(0.0) as usize + 1
}

/// Gives how far the bodies overlap in every cell, less what other contacts of the wheel have pressed down. Under a load, cells outside
/// of the parts that the grid covers have no overlap: it belongs to other contacts.
fn overlap(contact: &PlacedContact, grid: &Grid, cells: Cells) -> Result<HalfSpace> {
    let known: Vec<&Pressures> = covered(contact, grid).collect();
    // Parts that share a grid press upon each other there.
    let lowered = if let [one] = known.as_slice() { one.lowered } else { 0.0 };
    let mut separations = cells.separations(&contact.placement);
    if !known.is_empty() {
        let eta = cells.middles(1);
        for (column, xi) in separations.chunks_exact_mut(eta.len()).zip(cells.middles(0)) {
            for (s, eta) in column.iter_mut().zip(&eta) {
                if !known.iter().any(|part| part.cells.hold([xi, *eta])) {
                    *s = f64::NAN;
                }
            }
        }
    }
    HalfSpace::new(cells, &separations, contact.approach.unwrap_or(0.0) - lowered)
}

/// Gives the mean pressures over the cells of a grid, so that their sum is the load; each is divided into parts.
fn over_points(solved: &Pressures, counts: [usize; 2], parts: [usize; 2]) -> Vec<f64> {
    let (values, rows) = (solved.values(), solved.cells.count[1]);
    let all = (parts[0] * parts[1]) as f64;
    let points = (0..counts[0]).flat_map(|i| (0..counts[1]).map(move |j| [i * parts[0], j * parts[1]]));
    let sum = |[i, j]: [usize; 2]| {
        let lines = values.chunks_exact(rows).skip(i).take(parts[0]);
        lines.flat_map(|line| &line[j..j + parts[1]]).sum::<f64>()
    };
    points.map(|first| sum(first) / all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_grid_are_middles_of_divided_cells() -> Result<()> {
        assert_eq!([0.2, 1.0, 1.01, 3.0, 3.1, 1e3].map(odd_above), [1, 1, 3, 3, 5, 1001]);
        let axes = [&vec![-0.3, 0.0, 0.3], &vec![1.0, 1.5]];
        let cells = cells_of(axes, [0.3, 0.5], [3, 5], 1000)?;
        assert_eq!(cells.count, [9, 10]);
        for (k, axis) in axes.into_iter().enumerate() {
            let middles = cells.middles(k);
            let parts = [3, 5][k];
            assert!(axis.iter().enumerate().all(|(i, x)| (middles[i * parts + parts / 2] - x).abs() < 1e-15));
        }
        assert!(cells_of(axes, [0.3, 0.5], [3, 5], 89).is_err());
        Ok(())
    }
}
