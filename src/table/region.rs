//! Divides the plane of lateral displacement and yaw into cells, along the curves at which other elements touch.
//!
//! A region lies between two curves and two yaws. It is searched along rows: the nodes of polynomials of the yaw and points between
//! them, or one row where the table has one yaw. Breaks that follow each other alike in all rows are curves, which divide the region.
//! Where rows differ, curves cross, begin or end in between: the yaw of that is found, and the region is divided there.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::asked::Asked;
use super::breaks::{Break, BreakRow, kind_of, laterals, row};
use super::cell::{Beginning, INSIDE, YAW_COEFFICIENTS};
use super::curve::{Curve, between, node};
use super::fit::{FittedCell, RegionFit, fit};
use super::quantity::TableQuantity;
use super::state::{Sampler, SideTopology, State};
use crate::error::{Error, ErrorKind, Result, in_order};
use crate::numerics::interval::Interval;
use crate::search::WheelsetOnTrack;

/// Rows of a region: at the nodes, and between each two of them.
const ROWS: usize = 2 * YAW_COEFFICIENTS - 1;

/// Largest difference \[mm\] between a curve and the breaks at the rows between its nodes.
const NEAR: f64 = 2.5e-8;

/// Width \[rad\] to which the yaw of a crossing is found: places move by less than 1e-6 mm over it.
const CROSSING: f64 = 1e-9;

/// Width \[rad\] up to which a region has the values of its middle: places move by less than 5e-5 mm over it.
const NARROWEST: f64 = 1e-7;

/// Share of a tolerance up to which a jump at a joint may stay inside a cell.
const WEAK: f64 = 0.1;

/// Width \[mm\] above which a part without breaks is cut off from where breaks begin, end and cross each other.
const WIDE: f64 = 0.1;

/// Distance \[mm\] from breaks at which a part without breaks is cut off.
const BESIDE: f64 = 0.02;

/// Most cells of a table over yaw: 200 MB.
const MOST_CELLS: usize = 15_000;

/// What changes at a break, on the left and on the right side; `None` on a side without a change.
type Change = [Option<[Option<SideTopology>; 2]>; 2];

/// A curve that divides a region, with its breaks in all rows.
type DividingCurve = (Vec<Break>, Curve);

/// A region with its curves, rows and changes.
struct Region {
    /// The curves at which it begins and ends.
    curves: [Curve; 2],
    /// The rows by ascending yaw: one or [`ROWS`].
    rows: Vec<BreakRow>,
    /// Changes whose breaks are curves even if no quantity jumps there.
    strong: Vec<Change>,
}

/// A divided region.
pub(super) enum Division {
    /// A cell.
    Cell(Box<FittedCell>),
    /// Parts one after the other along the displacement, and the curves between them.
    Along(Vec<Division>, Vec<Curve>),
    /// Parts below and above a yaw \[rad\].
    Yaw(f64, Box<[Division; 2]>),
}

impl Division {
    /// Lists the cells in order.
    pub fn cells(&self) -> Vec<&FittedCell> {
        match self {
            Self::Cell(cell) => vec![cell],
            Self::Along(parts, _) => parts.iter().flat_map(Self::cells).collect(),
            Self::Yaw(_, parts) => parts.iter().flat_map(Self::cells).collect(),
        }
    }
}

/// The wheelset, request and quantities with which regions are divided, and the number of cells made.
pub(super) struct Divider<'a> {
    system: &'a WheelsetOnTrack,
    asked: &'a Asked,
    quantities: &'a [TableQuantity],
    made: AtomicUsize,
}

impl<'a> Divider<'a> {
    pub fn new(system: &'a WheelsetOnTrack, asked: &'a Asked, quantities: &'a [TableQuantity]) -> Self {
        Self { system, asked, quantities, made: AtomicUsize::new(0) }
    }

    /// Divides the whole range.
    ///
    /// # Errors
    /// The errors of the search; more than [`MOST_CELLS`] over a range of yaws.
    pub fn whole(&self) -> Result<Division> {
        let Asked { lateral, yaw, .. } = *self.asked;
        let curves = lateral.ends().map(|y| Curve::constant(y, yaw, Beginning::Edge));
        let rows = self.rows(&curves, yaw, [None, None], 0.0)?;
        self.divide(Region { curves, rows, strong: Vec::new() })
    }

    /// Finds the rows between two yaws \[rad\], so far `inside` the curves \[mm\]. Known rows at the ends are not searched again. Yaws
    /// closer than [`NARROWEST`] have one row, in their middle.
    fn rows(
        &self,
        curves: &[Curve; 2],
        yaws: Interval,
        known: [Option<BreakRow>; 2],
        inside: f64,
    ) -> Result<Vec<BreakRow>> {
        let at = |yaw: f64| self.row_between(curves, yaw, inside, Interval::ALL);
        if yaws.width() <= NARROWEST {
            return Ok(vec![at(yaws.at(0.5))?]);
        }
        let [first, last] = known;
        let known = |k: usize| if k == 0 { first.clone() } else { last.clone().filter(|_| k == ROWS - 1) };
        let yaw = |k: usize| match k {
            0 => yaws.low,
            k if k == ROWS - 1 => yaws.high,
            k => yaws.at(0.5 * (1.0 + node(k, ROWS))),
        };
        in_order((0..ROWS).into_par_iter().map(|k| known(k).map_or_else(|| at(yaw(k)), Ok)))
    }

    fn divide(&self, mut region: Region) -> Result<Division> {
        loop {
            region.strengthen(self.quantities);
            let lists = region.lists(self.quantities);
            if lists.iter().any(|list| !list.is_empty()) {
                return self.along_curves(region, &lists);
            }
            let exist = |k: usize| region.rows[k].ends[0].exists();
            if (1..region.rows.len()).any(|k| exist(k) != exist(0)) {
                let middle = region.rows[ROWS / 2].clone();
                return self.at_yaw(region, [middle.clone(), middle]);
            }
            match fit(self.system, self.asked, self.quantities, &region.curves, &mut region.rows)? {
                RegionFit::Cell(cell) => {
                    let made = self.made.fetch_add(1, Ordering::Relaxed);
                    if made >= MOST_CELLS && region.rows.len() > 1 {
                        return Err(too_many());
                    }
                    return Ok(Division::Cell(cell));
                }
                RegionFit::Unseen => {}
                RegionFit::Coarse { .. } if region.promote() => {}
                RegionFit::Coarse { over_yaw: true, .. } => {
                    let middle = region.rows[ROWS / 2].clone();
                    return self.at_yaw(region, [middle.clone(), middle]);
                }
                RegionFit::Coarse { middles, .. } => return self.in_halves(region, middles),
            }
        }
    }

    /// Divides a region at curves that all its rows have, otherwise beside its breaks, otherwise at a yaw.
    fn along_curves(&self, region: Region, lists: &[Vec<usize>]) -> Result<Division> {
        let mut cuts = region.accurate(region.in_order(lists));
        if cuts.is_empty() {
            cuts = region.accurate(region.common(lists));
        }
        if cuts.is_empty() {
            cuts = self.beside(&region, lists)?;
        }
        if cuts.is_empty() {
            let ends = self.crossing(&region, lists)?;
            return self.at_yaw(region, ends);
        }
        let (breaks, curves): (Vec<_>, Vec<_>) = cuts.into_iter().unzip();
        let parts = region.cut(&breaks, &curves);
        let parts = in_order(parts.into_par_iter().map(|part| self.divide(part)))?;
        Ok(Division::Along(parts, curves))
    }

    /// Finds displacements that cut off parts wider than [`WIDE`] without breaks in any row. Only the surroundings of the breaks are then
    /// divided at a yaw.
    fn beside(&self, region: &Region, lists: &[Vec<usize>]) -> Result<Vec<DividingCurve>> {
        let of_row = |(row, list): (&BreakRow, &Vec<usize>)| -> Vec<f64> {
            list.iter().map(|&b| row.breaks[b][0].lateral).collect()
        };
        let mut places: Vec<f64> = region.rows.iter().zip(lists).flat_map(of_row).collect();
        places.sort_by(f64::total_cmp);
        let rows = region.rows.iter().map(|row| between(&region.curves, row.yaw));
        let common = rows.fold(Interval::ALL, Interval::cut);
        let bounds = [&[common.low - BESIDE], places.as_slice(), &[common.high + BESIDE]].concat();
        let wide = bounds.windows(2).filter(|pair| pair[1] - pair[0] > WIDE);
        let at = wide.flat_map(|pair| [pair[0] + BESIDE, pair[1] - BESIDE]);
        let cut = |y: f64| -> Result<DividingCurve> {
            let search = |row: &BreakRow| -> Result<Break> {
                let state = Sampler::new(self.system, self.asked, row.yaw).at(y, 0.0)?;
                Ok([state.clone(), state])
            };
            let breaks = in_order(region.rows.par_iter().map(search))?;
            Ok((breaks, Curve::constant(y, region.yaw(), Beginning::Smooth)))
        };
        at.filter(|y| *y > common.low + BESIDE && *y < common.high - BESIDE).map(cut).collect()
    }

    /// Divides a region at a yaw: `ends` are the last row below and the first one above.
    fn at_yaw(&self, region: Region, ends: [BreakRow; 2]) -> Result<Division> {
        let Region { curves, mut rows, strong } = region;
        let (Some(first), Some(last)) = (rows.first().cloned(), rows.pop()) else { return Err(too_many()) };
        let [below, above] = ends;
        let at = below.yaw + (above.yaw - below.yaw) / 2.0;
        let part = |ends: [BreakRow; 2]| {
            let yaws = ends.each_ref().map(|row| row.yaw).into();
            let rows = self.rows(&curves, yaws, ends.map(Some), INSIDE)?;
            self.divide(Region { curves, rows, strong: strong.clone() })
        };
        let (low, high) = rayon::join(|| part([first, below]), || part([above, last]));
        Ok(Division::Yaw(at, Box::new([low?, high?])))
    }

    /// Divides a region half way between its curves; `middles` are the states there.
    fn in_halves(&self, region: Region, middles: Vec<State>) -> Result<Division> {
        let yaw = region.yaw();
        let at = |row: &BreakRow| between(&region.curves, row.yaw).middle();
        let nodes: Vec<f64> = region.rows.iter().step_by(2).map(at).collect();
        let curve = Curve::through(&nodes, yaw, Beginning::Smooth);
        let breaks: Vec<Break> = middles.into_iter().map(|state| [state.clone(), state]).collect();
        let mut parts = region.cut(&[breaks], &[curve]).into_iter();
        let (Some(low), Some(high)) = (parts.next(), parts.next()) else { return Err(too_many()) };
        let (low, high) = rayon::join(|| self.divide(low), || self.divide(high));
        Ok(Division::Along(vec![low?, high?], vec![curve]))
    }

    /// Finds two rows, as close as [`CROSSING`], between which the changes differ, in the gap of rows nearest to the middle where they do;
    /// returns the middle row twice where the changes are the same in all rows.
    fn crossing(&self, region: &Region, lists: &[Vec<usize>]) -> Result<[BreakRow; 2]> {
        let marks = |k: usize| marks_of(&region.rows[k], &lists[k]);
        let differ = |k: &usize| !changes(&marks(k - 1)).eq(changes(&marks(*k)));
        let from_middle = |k: &usize| (2 * k - 1).abs_diff(lists.len() - 1);
        let Some(k) = (1..lists.len()).filter(differ).min_by_key(from_middle) else {
            let middle = region.rows[region.rows.len() / 2].clone();
            return Ok([middle.clone(), middle]);
        };
        let ends = [k - 1, k].map(|k| region.rows[k].yaw);
        let (mut yaws, mut sides, mut range) = (ends, [marks(k - 1), marks(k)], Interval::ALL);
        while yaws[1] - yaws[0] > CROSSING {
            range = narrowed(&mut sides, range);
            let yaw = yaws[0] + (yaws[1] - yaws[0]) / 2.0;
            let middle = self.row_between(&region.curves, yaw, INSIDE, range)?;
            let middle = marks_of(&middle, &list(&middle, &region.strong, self.quantities));
            let same = changes(&middle).eq(changes(&sides[0]));
            (yaws[usize::from(!same)], sides[usize::from(!same)]) = (yaw, middle);
        }
        if yaws[0] == ends[0] || yaws[1] == ends[1] {
            // The changes of the row at one end are found nowhere beside it: the yaws are divided in their middle.
            yaws = [ends[0] + (ends[1] - ends[0]) / 2.0; 2];
        }
        let row = |yaw| self.row_between(&region.curves, yaw, INSIDE, Interval::ALL);
        Ok([row(yaws[0])?, row(yaws[1])?])
    }

    /// Finds the row under a yaw between two curves, so far `inside` them, and within a range of displacements \[mm\].
    fn row_between(&self, curves: &[Curve; 2], yaw: f64, inside: f64, range: Interval) -> Result<BreakRow> {
        let all = between(curves, yaw);
        row(self.system, self.asked, yaw, all.grown(-inside.min(all.width() / 2.0)).cut(range))
    }
}

/// A break: what changes there, and between which displacements \[mm\].
type BreakMark = (Change, Interval);

/// Gives what changes at breaks.
fn changes(marks: &[BreakMark]) -> impl Iterator<Item = Change> {
    marks.iter().map(|mark| mark.0)
}

/// Narrows a range of displacements \[mm\] to where the changes of two rows differ, and leaves out the breaks outside.
fn narrowed(sides: &mut [Vec<BreakMark>; 2], range: Interval) -> Interval {
    let low = alike_until(sides).unwrap_or(f64::NEG_INFINITY);
    let behind = alike_until(&sides.each_ref().map(|marks| mirrored(marks)));
    let narrow = Interval::new(low, behind.map_or(f64::INFINITY, |place| -place)).cut(range);
    let within = |mark: &&BreakMark| mark.1.low > narrow.low && mark.1.high < narrow.high;
    let inner = sides.each_ref().map(|marks| marks.iter().filter(within).copied().collect::<Vec<_>>());
    if !narrow.has_width() || changes(&inner[0]).eq(changes(&inner[1])) {
        return range;
    }
    *sides = inner;
    narrow
}

/// Gives the breaks of a row with these numbers.
fn marks_of(row: &BreakRow, list: &[usize]) -> Vec<BreakMark> {
    list.iter().map(|&b| &row.breaks[b]).map(|b| (change(b), laterals(b))).collect()
}

/// Reverses the order of breaks and the sign of their displacements.
fn mirrored(marks: &[BreakMark]) -> Vec<BreakMark> {
    marks.iter().rev().map(|&(change, place)| (change, -place)).collect()
}

/// Returns the last displacement \[mm\] that divides the breaks of two rows such that those before it have the same changes in both, and
/// at least one is on each side; `None` if there is none.
fn alike_until([low, high]: &[Vec<BreakMark>; 2]) -> Option<f64> {
    let same = low.iter().zip(high).take_while(|(a, b)| a.0 == b.0).count();
    (1..=same).rev().find_map(|p| {
        let before = low[p - 1].1.high.max(high[p - 1].1.high);
        let after = [low, high].into_iter().filter_map(|marks| marks.get(p)).map(|mark| mark.1.low);
        let after = after.reduce(f64::min)?;
        (before < after).then(|| before + (after - before) / 2.0)
    })
}

fn too_many() -> Error {
    let found = format!("more than {MOST_CELLS} cells");
    let advice = "take a larger tolerance, a smaller range, or smooth the profiles";
    Error::new("table: yaw", found, "a table of at most 200 MB", advice).of_kind(ErrorKind::Limit)
}

/// Tells what changes at a break.
fn change([before, after]: &Break) -> Change {
    [0, 1].map(|k| {
        let sides = [before, after].map(|state| state.topology.map(|topology| topology.side(k)));
        (sides[0] != sides[1]).then_some(sides)
    })
}

/// Tells whether a quantity jumps at a break by more than a cell may hide.
fn jumps([before, after]: &Break, quantities: &[TableQuantity]) -> bool {
    let pairs = before.values.iter().zip(&after.values).zip(quantities);
    before.topology.is_some() != after.topology.is_some()
        || pairs
            .into_iter()
            .any(|((a, b), quantity)| a.is_nan() != b.is_nan() || (a - b).abs() > WEAK * quantity.tolerance)
}

/// Lists the numbers of the breaks of a row that are curves.
fn list(row: &BreakRow, strong: &[Change], quantities: &[TableQuantity]) -> Vec<usize> {
    let is = |b: &Break| strong.contains(&change(b)) || jumps(b, quantities);
    (0..row.breaks.len()).filter(|&b| is(&row.breaks[b])).collect()
}

impl Region {
    fn yaw(&self) -> Interval {
        Interval::new(self.rows[0].yaw, self.rows[self.rows.len() - 1].yaw)
    }

    /// Adds the changes at which a quantity jumps in any row: their breaks are curves in all rows.
    fn strengthen(&mut self, quantities: &[TableQuantity]) {
        let breaks = self.rows.iter().flat_map(|row| &row.breaks);
        let found: Vec<Change> = breaks.filter(|b| jumps(b, quantities)).map(change).collect();
        self.add(found);
    }

    /// Makes curves of all breaks; tells whether any was not a curve before.
    fn promote(&mut self) -> bool {
        let before = self.strong.len();
        let all: Vec<Change> = self.rows.iter().flat_map(|row| &row.breaks).map(change).collect();
        self.add(all);
        self.strong.len() > before
    }

    fn add(&mut self, changes: Vec<Change>) {
        for change in changes {
            if !self.strong.contains(&change) {
                self.strong.push(change);
            }
        }
    }

    fn lists(&self, quantities: &[TableQuantity]) -> Vec<Vec<usize>> {
        self.rows.iter().map(|row| list(row, &self.strong, quantities)).collect()
    }

    /// Gives the breaks of all rows, first with first and so on; none where rows differ in their number, or in the quantities that exist
    /// beside them.
    fn in_order(&self, lists: &[Vec<usize>]) -> Vec<Vec<Break>> {
        let exist =
            |k: usize| lists[k].iter().map(move |&b| self.rows[k].breaks[b].each_ref().map(State::exists));
        if (1..lists.len()).any(|k| !exist(0).eq(exist(k))) {
            return Vec::new();
        }
        let at =
            |p: usize| self.rows.iter().zip(lists).map(|(row, list)| row.breaks[list[p]].clone()).collect();
        (0..lists[0].len()).map(at).collect()
    }

    /// Gives the breaks of all rows for each change that each row has once, without those that change places with another, in ascending
    /// order.
    fn common(&self, lists: &[Vec<usize>]) -> Vec<Vec<Break>> {
        let changes: Vec<Vec<Change>> = self
            .rows
            .iter()
            .zip(lists)
            .map(|(row, list)| list.iter().map(|&b| change(&row.breaks[b])).collect())
            .collect();
        let at = |places: &[usize]| -> Vec<Break> {
            self.rows
                .iter()
                .zip(lists)
                .zip(places)
                .map(|((row, list), &p)| row.breaks[list[p]].clone())
                .collect()
        };
        let once = |row: &Vec<Change>, wanted: &Change| {
            let mut places = (0..row.len()).filter(|&p| row[p] == *wanted);
            places.next().filter(|_| places.next().is_none())
        };
        let everywhere =
            |wanted: &Change| -> Option<Vec<usize>> { changes.iter().map(|row| once(row, wanted)).collect() };
        let places: Vec<Vec<usize>> = changes[0].iter().filter_map(everywhere).collect();
        let crosses = |a: &Vec<usize>, b: &Vec<usize>| {
            let mut order = a.iter().zip(b).map(|(a, b)| a.cmp(b));
            let first = order.next();
            order.any(|order| Some(order) != first)
        };
        let stays = |a: &&Vec<usize>| !places.iter().any(|b| a != &b && crosses(a, b));
        places.iter().filter(stays).map(|places| at(places)).collect()
    }

    /// Fits curves through breaks of all rows, and gives those with errors of at most [`NEAR`], in ascending order.
    fn accurate(&self, all: Vec<Vec<Break>>) -> Vec<DividingCurve> {
        let mut last = self.curves[0];
        let mut cuts = Vec::new();
        for breaks in all {
            let (curve, error) = self.curve(&breaks);
            // At the yaw of a crossing curves may cross by their errors.
            let ordered = |row: &BreakRow| last.at(row.yaw) <= curve.at(row.yaw) + 2.0 * NEAR;
            if error <= NEAR && self.rows.iter().all(ordered) {
                last = curve;
                cuts.push((breaks, curve));
            }
        }
        cuts
    }

    /// Fits a curve through the breaks of all rows; gives it with its largest difference from them \[mm\].
    fn curve(&self, breaks: &[Break]) -> (Curve, f64) {
        let middle = |b: &Break| laterals(b).at(0.5);
        let kind = breaks.iter().map(kind_of).max().unwrap_or(Beginning::Joint);
        let nodes: Vec<f64> = breaks.iter().step_by(2).map(middle).collect();
        let curve = Curve::through(&nodes, self.yaw(), kind);
        let differences = self.rows.iter().zip(breaks).map(|(row, b)| (curve.at(row.yaw) - middle(b)).abs());
        (curve, differences.fold(0.0, f64::max))
    }

    /// Cuts a region at curves, whose breaks in all rows are given.
    fn cut(self, breaks: &[Vec<Break>], curves: &[Curve]) -> Vec<Self> {
        let bounds = [&self.curves[..1], curves, &self.curves[1..]].concat();
        let part = |k: usize| {
            let rows = self.rows.iter().enumerate().map(|(r, row)| {
                let begin = if k == 0 { &row.ends[0] } else { &breaks[k - 1][r][1] };
                let end = if k == curves.len() { &row.ends[1] } else { &breaks[k][r][0] };
                let inside = |b: &&Break| b[0].lateral >= begin.lateral && b[1].lateral <= end.lateral;
                let breaks = row.breaks.iter().filter(inside).cloned().collect();
                BreakRow { yaw: row.yaw, ends: [begin.clone(), end.clone()], breaks }
            });
            Self { curves: [bounds[k], bounds[k + 1]], rows: rows.collect(), strong: self.strong.clone() }
        };
        (0..=curves.len()).map(part).collect()
    }
}
