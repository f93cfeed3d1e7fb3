//! Ten conforming pairs under a load: how far t, s and s cos α lie apart over the patch, and what each gap does to the pressure.
//!
//! The pressures are the data of `data/conformal.csv`. The tests of the program's clients compute them anew with Tamaas, and
//! fail if they differ from the data.

use crate::loads::{Loaded, Solved};
use crate::whole_case;
use wheelrail::Interval;
use wheelrail::case::{Site, sites};
use wheelrail::conformal::{NormalGap, fill_normal_gap};
use wheelrail::error::{Error, Result};
use wheelrail::mesh::equal_steps;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::Pair;
use wheelrail::profile::{inclination, standards};
use wheelrail::separation::{EtaAxis, Evaluator, FULL_PRECISION};

/// The pressures and approaches, by pair.
const SOLVED: &str = include_str!("../../data/conformal.csv");

/// Header of the data.
pub const HEADER: &str = "pair,offset_mm,yaw_rad,load_n,contact,normal_load_n,peak_t_mpa,approach_t_mm,area_t_mm2,peak_s_mpa,\
                          approach_s_mm,area_s_mm2,peak_s_cos_mpa,approach_s_cos_mm,area_s_cos_mm2";

/// Load of every wheel \[N\].
const LOAD: f64 = 60e3;

/// Name, rail, run of the rail's inclination 1:run, wheel, radius \[mm\], offset \[mm\] and yaw \[rad\] of the drawn pairs. All
/// have the patch where the gauge corner lies in the flange root.
const DRAWN: [(&str, &str, f64, &str, f64, f64, f64); 9] = [
    ("60E1 1:40 under S1002", "60E1", 40.0, "S1002", 460.0, 2.3, 0.0),
    ("60E1 1:40 under S1002", "60E1", 40.0, "S1002", 460.0, 3.3, 0.0),
    ("60E1 1:20 under EN15302-B", "60E1", 20.0, "EN15302-B", 460.0, 3.8, 0.0),
    ("60E1 1:20 under EN15302-B", "60E1", 20.0, "EN15302-B", 460.0, 4.3, 0.0),
    ("UIC60 1:20 under S1002", "UIC60", 20.0, "S1002", 500.0, 3.8, 0.0),
    ("UIC60 1:40 under EN15302-A", "UIC60", 40.0, "EN15302-A", 460.0, 3.8, 0.0),
    ("54E1 1:20 under S1002", "54E1", 20.0, "S1002", 460.0, 4.8, 0.0),
    ("49E1 1:40 under S1002", "49E1", 40.0, "S1002", 460.0, 5.8, 0.01),
    ("50E6 1:20 under EN15302-H", "50E6", 20.0, "EN15302-H", 460.0, 7.3, 0.0),
];

/// Name, radius \[mm\], offset \[mm\] and yaw \[rad\] of the measured pair.
const MEASURED: (&str, f64, f64, f64) = ("worn, measured", 460.0, 4.5, 0.0);

/// Points a side of the grids that are solved.
const SIDE: usize = 96;

/// Growth of the grid beyond the patches of all gaps, as a share of their extent.
const MARGIN: f64 = 0.15;

/// Growth of the window in which a patch is sought beyond the plane's patch, as a share of its extent.
const SEARCHED: f64 = 0.5;

/// Names of the three gaps. An approach δ closes t and s cos α by δ cos α, and s by δ.
pub const GAPS: [&str; 3] = ["t", "s", "s cos α"];

/// A conforming pair under its load.
#[derive(Debug, Clone)]
pub struct ConformingPair {
    /// The wheel.
    pub loaded: Loaded,
    /// Placement, estimated approach and normal force.
    pub site: Site,
    /// The patch t < δ cos α of the estimated approach.
    pub patch: Patch,
    /// The grid of the three gaps.
    pub grid: GapGrid,
    /// What Tamaas finds; `None` if the data have no row.
    pub solved: Option<[Solved; GAPS.len()]>,
}

/// The three gaps of a pair over one grid of the rail's surface.
#[derive(Debug, Clone, PartialEq)]
pub struct GapGrid {
    /// σ \[mm\], in equal steps.
    pub sigma: Vec<f64>,
    /// η \[mm\], in equal steps.
    pub eta: Vec<f64>,
    /// cos α at every σ.
    pub cosine: Vec<f64>,
    /// The gaps of [`GAPS`] \[mm\] at i_σ · n_η + i_η; NaN where undefined.
    pub gaps: [Vec<f64>; GAPS.len()],
}

impl ConformingPair {
    /// Finds the most conforming contact of a loaded wheel.
    fn new(loaded: Loaded, pair: &Pair) -> Result<Self> {
        let sites = sites(&loaded.case(pair)?)?;
        let conforming = sites.into_iter().filter_map(|site| Some((patch(&site)?, site)));
        let turn =
            |(patch, site): &(Patch, Site)| angles(patch, site).map(Interval::width).fold(0.0, f64::max);
        let (patch, site) = conforming
            .max_by(|a, b| turn(a).total_cmp(&turn(b)))
            .ok_or_else(|| Error::new(loaded.pair, "no patch", "a patch over the rail", "report this"))?;
        let grid = GapGrid::new(&site, &patch);
        let mut found = Self { loaded, site, patch, grid, solved: None };
        found.solved = solved(&found.key())?;
        Ok(found)
    }

    /// Returns the name of the pair, its position and its contact, as in the data.
    pub fn key(&self) -> String {
        self.loaded.key(self.site.contact.found.as_ref().map_or(1, |found| found.contact))
    }

    /// Returns the normal force along ζ \[N\].
    pub fn normal_load(&self) -> f64 {
        self.site.normal_load.unwrap_or(f64::NAN)
    }

    /// Returns the turn of the rail's normal over the patch \[rad\].
    pub fn turn(&self) -> f64 {
        angles(&self.patch, &self.site).fold(Interval::NONE, Interval::hull).width()
    }

    /// Returns the largest difference of a gap of [`GAPS`] from t over the grid's points in the patch \[mm\].
    pub fn difference(&self, gap: usize) -> f64 {
        let (grid, approach) = (&self.grid, self.patch.approach);
        let rows = grid.eta.len();
        let inside = |&k: &usize| grid.gaps[0][k] < approach * grid.cosine[k / rows];
        let differences = (0..grid.gaps[0].len()).filter(inside);
        differences.map(|k| (grid.gaps[gap][k] - grid.gaps[0][k]).abs()).fold(0.0, f64::max)
    }
}

impl GapGrid {
    /// Lays a grid over the patches of all three gaps.
    fn new(site: &Site, patch: &Patch) -> Self {
        let placement = &site.contact.placement;
        let (gap, mut plane) = (NormalGap::new(placement), Evaluator::new(placement));
        let [sigma, eta] = joined(plane_extents(site, &gap), patch).map(|extent| {
            let [low, high] = widened(extent, MARGIN).ends();
            equal_steps(low, high, SIDE)
        });
        let points: Vec<_> = sigma.iter().map(|&sigma| gap.rail().point(sigma)).collect();
        let cosine: Vec<f64> = points.iter().map(|at| at.map_or(f64::NAN, |at| at.cos)).collect();
        let (mut t, mut s) = (vec![f64::NAN; SIDE * SIDE], vec![f64::NAN; SIDE * SIDE]);
        fill_normal_gap(&gap, &sigma, &EtaAxis::new(&eta), FULL_PRECISION, &mut t);
        for (column, at) in s.chunks_exact_mut(SIDE).zip(&points) {
            if let Some(at) = at {
                plane.column(at.xi, &eta, column);
            }
        }
        let shortened = s.iter().enumerate().map(|(k, s)| s * cosine[k / SIDE]).collect();
        Self { sigma, eta, cosine, gaps: [t, s, shortened] }
    }
}

/// Finds the patch over the rail of a site under its estimated approach; `None` without one.
fn patch(site: &Site) -> Option<Patch> {
    let gap = NormalGap::new(&site.contact.placement);
    let [xi, eta] = plane_extents(site, &gap).map(|extent| widened(extent, SEARCHED));
    let window = Window { xi, eta };
    let patch = Patch::over_rail(&site.contact.placement, site.approach(), &window);
    Some(patch).filter(|patch| !patch.components.is_empty())
}

/// Returns the range of α \[rad\] within each part of a patch over the rail's surface.
fn angles(patch: &Patch, site: &Site) -> impl Iterator<Item = Interval> {
    let gap = NormalGap::new(&site.contact.placement);
    patch.components.iter().map(move |part| gap.angles(part.xi))
}

/// Returns the ranges of σ and η of the plane's patch over the grid of a site \[mm\].
fn plane_extents(site: &Site, gap: &NormalGap<'_>) -> [Interval; 2] {
    let none = [Interval::NONE; 2];
    let [xi, eta] = site.patch().map_or(none, |patch| joined(none, &patch));
    [xi.map(|xi| gap.rail().sigma(xi)), eta]
}

/// Returns the hulls of two ranges and those of the parts of a patch.
fn joined(ranges: [Interval; 2], patch: &Patch) -> [Interval; 2] {
    let parts = patch.components.iter();
    parts.fold(ranges, |[xi, eta], part| [xi.hull(part.xi), eta.hull(part.eta)])
}

fn widened(extent: Interval, share: f64) -> Interval {
    extent.grown(share * extent.width())
}

/// Computes the ten pairs with their grids.
///
/// # Errors
/// A pair without contact, which is a fault of this program.
pub fn conforming_pairs() -> Result<Vec<ConformingPair>> {
    let mut out = Vec::new();
    for (name, rail, run, wheel, radius, offset, yaw) in DRAWN {
        let rail = standards::rail(rail)?.rotated(inclination(1.0, run)?);
        let pair = Pair::new(rail, standards::wheel(wheel)?, radius)?;
        out.push(ConformingPair::new(Loaded { pair: name, offset, yaw, load: LOAD }, &pair)?);
    }
    let (name, radius, offset, yaw) = MEASURED;
    let [rail, wheel] = whole_case::measured()?;
    let pair = Pair::new(rail, wheel, radius)?;
    out.push(ConformingPair::new(Loaded { pair: name, offset, yaw, load: LOAD }, &pair)?);
    Ok(out)
}

/// Returns the solutions of the row of the data with this name; `None` if there is none.
fn solved(key: &str) -> Result<Option<[Solved; GAPS.len()]>> {
    let Some(row) = SOLVED.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(',')) else {
        return Ok(None);
    };
    let cells: std::result::Result<Vec<f64>, _> = row.split(',').map(str::parse).collect();
    let bad = || Error::new("conformal.csv", row, "ten numbers", "let the tests make it anew");
    let [_, rest @ ..] = &*cells.map_err(|_| bad())? else { return Err(bad()) };
    let of = |k: usize| match rest.get(3 * k..3 * k + 3) {
        Some(&[peak, approach, area]) => Ok(Solved { peak, approach, area }),
        _ => Err(bad()),
    };
    Ok(Some([of(0)?, of(1)?, of(2)?]))
}
