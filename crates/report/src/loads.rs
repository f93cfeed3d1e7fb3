//! Compares approaches that `load` estimates with those that a boundary-element solver finds for the same regions: 60
//! positions of five pairs, on treads, in flange roots, on flanges, with yaw, in two places at once.
//!
//! The solved approaches, largest pressures and contact areas are the data of `data/loads.csv`. The tests of the program's clients
//! compute them anew with Tamaas, pressures and areas of every eighth region, and fail if they differ from the data.

use super::speed::{LEAST_RUNS, Timing, race, timed};
use super::whole_case;
use wheelrail::case::{Case, Profiles, Site, sites};
use wheelrail::error::{Error, Result};
use wheelrail::placement::Pair;
use wheelrail::profile::{Profile, inclination, standards};
use wheelrail::scene::{parse, with_profiles};

/// The solved approaches, by position and contact.
const SOLVED: &str = include_str!("../data/loads.csv");

/// Names of the pairs.
const PAIRS: [&str; 5] = [
    "60E1 1:40 under S1002",
    "UIC60 1:20 under S1002",
    "60E2 1:40 under EN13715-1:40-h28-e32.5",
    "54E3 1:20 under EN15302-C",
    "worn, measured",
];

/// Offset \[mm\], yaw \[rad\] and load \[N\] of the positions of every pair.
const POSITIONS: [[f64; 3]; 12] = [
    [-6.0, 0.0, 60e3],
    [-3.0, 0.0, 60e3],
    [-1.5, 0.01, 60e3],
    [0.0, 0.0, 20e3],
    [0.0, 0.0, 100e3],
    [1.0, 0.0, 60e3],
    [1.7, 0.0, 60e3],
    [2.3, 0.0, 90e3],
    [3.0, 0.01, 60e3],
    [3.5, 0.0, 60e3],
    [4.5, 0.0, 60e3],
    [6.0, 0.015, 40e3],
];

/// A wheel on a rail under a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loaded {
    /// Name of the pair.
    pub pair: &'static str,
    /// Offset of the wheel \[mm\].
    pub offset: f64,
    /// Yaw \[rad\].
    pub yaw: f64,
    /// Vertical load \[N\].
    pub load: f64,
}

/// One region of contact that carries a share of a load, with its approach estimated, and solved as if it were alone.
#[derive(Debug, Clone)]
pub struct CarriedRegion {
    /// The wheel.
    pub loaded: Loaded,
    /// Placement, patch, normal force and estimate.
    pub site: Site,
    /// What Tamaas finds for the same normal force: δ on cells three times as fine as those of the automatic grid, pressure and area on
    /// cells nine times as fine. NaN if the data have none.
    pub solved: Solved,
}

/// The solution of a region or a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solved {
    /// Largest pressure \[MPa\].
    pub peak: f64,
    /// δ \[mm\].
    pub approach: f64,
    /// Area in contact \[mm²\].
    pub area: f64,
}

/// The error of one estimated approach.
#[derive(Debug, Clone, PartialEq)]
pub struct ApproachError {
    /// Name of the region, as in the data.
    pub region: String,
    /// Whether the patch has several parts or several places of contact.
    pub joined: bool,
    /// Error of δ relative to the solved one.
    pub error: f64,
}

/// Time that the contacts of a wheel take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadCost {
    /// The wheel.
    pub loaded: Loaded,
    /// Number of regions that carry the load.
    pub regions: usize,
    /// Shortest time under the load \[s\].
    pub load: f64,
    /// Shortest time under the approach that the load causes \[s\].
    pub approach: f64,
}

const NOTHING: Solved = Solved { peak: f64::NAN, approach: f64::NAN, area: f64::NAN };

/// Pair and offset \[mm\] of the wheels that are timed: one place, two in one region, one place of noisy profiles, two regions.
const TIMED: [(usize, f64); 4] = [(0, 0.0), (0, -3.0), (4, -1.5), (4, -3.0)];

/// Times contacts of wheels under 60 kN, each for at least `seconds`. Call it on one thread.
///
/// # Errors
/// A position without contact, which is a fault of this program.
pub fn costs(seconds: f64) -> Result<Vec<LoadCost>> {
    let pairs = pairs()?;
    let cost = |(index, offset): (usize, f64)| {
        let loaded = Loaded { pair: PAIRS[index], offset, yaw: 0.0, load: 60e3 };
        let under_load = loaded.case(&pairs[index])?;
        let found = sites(&under_load)?;
        let approach = found.first().map_or(0.0, Site::approach);
        let under_approach = loaded.under(&pairs[index], &format!("approach = {approach:?}"))?;
        let mut timings = [Timing::NONE; 2];
        race(&mut timings, seconds, LEAST_RUNS, |k| {
            timed(|| drop(sites(if k == 0 { &under_load } else { &under_approach })))
        });
        let [load, approach] = timings.map(|timing| timing.best);
        Ok(LoadCost { loaded, regions: found.len(), load, approach })
    };
    TIMED.into_iter().map(cost).collect()
}

impl Loaded {
    /// Resolves the case of this position over a pair.
    pub(super) fn case(&self, pair: &Pair) -> Result<Case> {
        // Tamaas solves in the frame of the place that touches first.
        self.under(pair, &format!("load = {:?}\nframe = \"contact\"", self.load))
    }

    /// Resolves the case of this position; `patch` is the text of the scene's `[patch]`.
    fn under(&self, pair: &Pair, patch: &str) -> Result<Case> {
        let Self { offset, yaw, .. } = self;
        // The profiles named here are not read, because the pair is given.
        let scene = format!(
            "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\noffset = {offset:?}\n\
             yaw = {yaw:?}\n[patch]\n{patch}\n"
        );
        with_profiles(&parse(&scene, false)?, Profiles::drawn(pair.clone()), self.pair)
    }

    /// Returns the name of the position and one of its contacts, as in the data.
    pub fn key(&self, contact: usize) -> String {
        let Self { pair, offset, yaw, load } = self;
        format!("{pair},{offset:?},{yaw:?},{load:?},{contact}")
    }
}

impl CarriedRegion {
    /// Returns the number of the contact, from 1.
    pub fn contact(&self) -> usize {
        self.site.contact.found.as_ref().map_or(1, |found| found.contact)
    }

    /// Gives the lowering \[mm\] of the surface by the pressures on the wheel's other regions, which Tamaas does not know.
    pub fn lowered(&self) -> f64 {
        self.site.contact.pressures.first().map_or(0.0, |pressures| pressures.lowered)
    }

    /// Gives the part of δ \[mm\] that the region would have alone.
    pub fn own_approach(&self) -> f64 {
        self.site.approach() - self.lowered()
    }

    /// Compares the estimated δ with the solved one.
    pub fn compared(&self) -> ApproachError {
        let merged = self.site.contact.found.as_ref().is_some_and(|found| !found.merged.is_empty());
        let parts = self.site.contact.whole_patch().map_or(0, |patch| patch.components.len());
        ApproachError {
            region: self.loaded.key(self.contact()),
            joined: merged || parts > 1,
            error: self.own_approach() / self.solved.approach - 1.0,
        }
    }
}

/// Makes the pairs, in the order of their names.
fn pairs() -> Result<Vec<Pair>> {
    let pair = |rail: Profile, run: f64, wheel: Profile, radius: f64| {
        Pair::new(rail.rotated(inclination(1.0, run)?), wheel, radius)
    };
    let [worn_rail, worn_wheel] = whole_case::measured()?;
    Ok(vec![
        pair(standards::rail("60E1")?, 40.0, standards::wheel("S1002")?, 460.0)?,
        pair(standards::rail("UIC60")?, 20.0, standards::wheel("S1002")?, 500.0)?,
        pair(standards::rail("60E2")?, 40.0, standards::wheel("EN13715-1:40-h28-e32.5")?, 420.0)?,
        pair(standards::rail("54E3")?, 20.0, standards::wheel("EN15302-C")?, 415.0)?,
        pair(worn_rail, 40.0, worn_wheel, 460.0)?,
    ])
}

/// Computes the regions of contact that carry every wheel's load.
///
/// # Errors
/// A position without contact, which is a fault of this program.
pub fn carried() -> Result<Vec<CarriedRegion>> {
    let mut out = Vec::new();
    for (name, pair) in PAIRS.into_iter().zip(pairs()?) {
        for [offset, yaw, load] in POSITIONS {
            let loaded = Loaded { pair: name, offset, yaw, load };
            for site in sites(&loaded.case(&pair)?)? {
                let mut one = CarriedRegion { loaded, site, solved: NOTHING };
                one.solved = solved(&loaded.key(one.contact()))?;
                out.push(one);
            }
        }
    }
    Ok(out)
}

/// Returns what the data have of the region with this name.
fn solved(key: &str) -> Result<Solved> {
    let Some(row) = SOLVED.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(',')) else {
        return Ok(NOTHING);
    };
    let bad = || Error::new("loads.csv", row, "four numbers", "let the tests make it anew");
    let numbers: std::result::Result<Vec<f64>, _> = row.split(',').map(str::parse).collect();
    let numbers = numbers.map_err(|_| bad())?;
    let [_, approach, peak, area] = numbers[..] else { return Err(bad()) };
    Ok(Solved { peak, approach, area })
}
