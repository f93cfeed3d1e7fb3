//! Fits polynomials over a region without breaks.

use rayon::prelude::*;

use super::asked::Asked;
use super::breaks::{Break, BreakRow, HOP, divide, laterals};
use super::cell::{BREAK, COEFFICIENTS, Cell, Lacks, YAW_COEFFICIENTS};
use super::curve::{Curve, POWERS, YAW_POWERS, between, node, share};
use super::quantity::{MOST, Needs, QuantityValues, TableQuantity};
use super::state::{Sampler, State};
use crate::error::{Result, in_order};
use crate::numerics::interval::Interval;
use crate::search::WheelsetOnTrack;

/// Stated error over the largest difference in the check of a cell. The check is made between the nodes, where the error of an
/// interpolation is largest.
pub(super) const MARGIN: f64 = 2.0;

/// Share of the tolerance that the check of a cell may find: the stated error is then at most half of the tolerance.
const ACCEPTED: f64 = 0.25;

/// Share of the tolerance by which a polynomial may fall between two points where the samples ascend, or rise where they descend.
const STEP_BACK: f64 = 1e-3;

/// Width \[mm\] up to which a cell is not divided, whatever its error; the stated error then shows it.
const SHORTEST: f64 = 1e-6;

/// Width \[mm\] up to which a cell that is too coarse is searched for a jump between two places on the same elements.
const MAY_JUMP: f64 = 1e-3;

/// States along a row of a cell: at the nodes, and at points between each two of them.
const SAMPLES: usize = 2 * COEFFICIENTS - 1;

/// Number of points at which polynomials are checked for being monotone.
const LOOKED_AT: usize = 33;

/// Coefficients along the displacement, of 1, t, …
type Powers = [QuantityValues; COEFFICIENTS];

/// A cell with its polynomials.
pub(super) struct FittedCell {
    pub cell: Cell,
    /// For each power of u the coefficients of 1, t, … of all quantities; one power under one yaw, and none where nothing touches.
    pub coefficients: Vec<Powers>,
    /// Largest differences in the check.
    pub errors: QuantityValues,
}

/// The result of fitting a region.
pub(super) enum RegionFit {
    /// One cell is accurate enough, or cannot be divided.
    Cell(Box<FittedCell>),
    /// Breaks were found that were not known: they have been added to the rows.
    Unseen,
    /// It has to be divided.
    Coarse {
        /// Whether the polynomials of the yaw have larger errors than those of the displacement.
        over_yaw: bool,
        /// The states in the middle of all rows.
        middles: Vec<State>,
    },
}

/// Fits a region between two curves, with the nodes of the yaw and points between them as rows, or with one row.
///
/// # Errors
/// The errors of the search.
pub(super) fn fit(
    system: &WheelsetOnTrack,
    asked: &Asked,
    quantities: &[TableQuantity],
    curves: &[Curve; 2],
    rows: &mut [BreakRow],
) -> Result<RegionFit> {
    let begin = rows[0].ends[0].topology;
    let cell = Cell {
        yaw: Interval::new(rows[0].yaw, rows[rows.len() - 1].yaw),
        curves: [0; 2],
        touches: begin.is_some(),
        lacks: begin.map_or([Lacks::Nothing; 2], |topology| topology.lacks),
    };
    if begin.is_none() {
        let fitted = FittedCell { cell, coefficients: Vec::new(), errors: [0.0; MOST] };
        return Ok(RegionFit::Cell(Box::new(fitted)));
    }
    let width = rows.iter().map(|row| laterals(&row.ends).width()).fold(0.0, f64::max);
    let along = |row: &mut BreakRow| {
        let mut sampler = Sampler::new(system, asked, row.yaw);
        let samples = samples(&mut sampler, &row.ends)?;
        let unseen = width > SHORTEST && add_unseen(&mut sampler, &samples, row)?;
        Ok((samples, unseen))
    };
    let found = in_order(rows.par_iter_mut().map(along))?;
    if found.iter().any(|(_, unseen)| *unseen) {
        return Ok(RegionFit::Unseen);
    }
    let mut samples: Vec<Vec<State>> = found.into_iter().map(|(samples, _)| samples).collect();
    if width <= SHORTEST {
        // Breaks so close to each other are one.
        for (samples, row) in samples.iter_mut().zip(&*rows) {
            let begin = &row.ends[0];
            let others = samples.iter_mut().filter(|sample| sample.topology != begin.topology);
            others.for_each(|sample| sample.values = begin.values);
        }
    }
    let (fitted, over_yaw) = FittedCell::new(cell, quantities, curves, &samples, rows);
    if width <= SHORTEST || fitted.is_fine(quantities, &samples, rows) {
        return Ok(RegionFit::Cell(Box::new(fitted)));
    }
    if width <= MAY_JUMP && add_jumps(system, asked, &samples, rows)? {
        return Ok(RegionFit::Unseen);
    }
    let middles = samples.iter().map(|samples| samples[SAMPLES / 2].clone()).collect();
    Ok(RegionFit::Coarse { over_yaw, middles })
}

/// Searches at all points of a row.
fn samples(sampler: &mut Sampler<'_>, ends: &Break) -> Result<Vec<State>> {
    let range = laterals(ends);
    let mut samples = Vec::with_capacity(SAMPLES);
    samples.push(ends[0].clone());
    for k in 1..SAMPLES - 1 {
        let y = range.at(0.5 * (1.0 + node(k, SAMPLES))).clamp(range.low, range.high);
        let sample = sampler.near(y, 0.0, &samples[k - 1])?;
        samples.push(sample);
    }
    samples.push(ends[1].clone());
    Ok(samples)
}

/// Adds breaks to a row that the search of breaks has not seen: other elements touch at one of the samples. Tells whether there are any.
fn add_unseen(sampler: &mut Sampler<'_>, samples: &[State], row: &mut BreakRow) -> Result<bool> {
    let mut breaks = Vec::new();
    for pair in samples.windows(2).filter(|pair| pair[0].topology != pair[1].topology) {
        if !is_known(&row.breaks, pair) {
            divide(sampler, &pair[0], &pair[1], &mut breaks)?;
        }
    }
    let some = !breaks.is_empty();
    add(row, breaks);
    Ok(some)
}

/// Tells whether a break is known between two samples.
fn is_known(breaks: &[Break], pair: &[State]) -> bool {
    let range = Interval::new(pair[0].lateral, pair[1].lateral);
    breaks.iter().any(|known| laterals(known).meets(range))
}

/// Adds breaks to a row, in order.
fn add(row: &mut BreakRow, breaks: Vec<Break>) {
    row.breaks.extend(breaks);
    row.breaks.sort_by(|a, b| a[0].lateral.total_cmp(&b[0].lateral));
}

/// Adds jumps of places of contact to the rows. Tells whether there are any.
fn add_jumps(
    system: &WheelsetOnTrack,
    asked: &Asked,
    samples: &[Vec<State>],
    rows: &mut [BreakRow],
) -> Result<bool> {
    let mut some = false;
    for (samples, row) in samples.iter().zip(rows) {
        let mut sampler = Sampler::new(system, asked, row.yaw);
        if let Some(jump) = jump(&mut sampler, samples, &row.breaks)? {
            add(row, vec![jump]);
            some = true;
        }
    }
    Ok(some)
}

/// Finds a jump of a place of contact between the samples: the largest change, halved to the width of a break.
fn jump(sampler: &mut Sampler<'_>, samples: &[State], known: &[Break]) -> Result<Option<Break>> {
    let change = |pair: &[State]| pair[0].moved(&pair[1]);
    let Some(pair) = samples.windows(2).max_by(|a, b| change(a).total_cmp(&change(b))) else {
        return Ok(None);
    };
    if is_known(known, pair) {
        return Ok(None);
    }
    let [mut from, mut to] = [pair[0].clone(), pair[1].clone()];
    while to.lateral - from.lateral > BREAK {
        let middle = from.lateral + (to.lateral - from.lateral) / 2.0;
        if middle <= from.lateral || middle >= to.lateral {
            break;
        }
        let middle = sampler.at(middle, 0.0)?;
        if middle.topology != from.topology {
            return Ok(None);
        }
        if from.moved(&middle) > middle.moved(&to) { to = middle } else { from = middle }
    }
    Ok((from.moved(&to) > HOP).then_some([from, to]))
}

impl FittedCell {
    /// Fits the polynomials, and tells whether those of the yaw have larger errors than those of the displacement.
    fn new(
        cell: Cell,
        quantities: &[TableQuantity],
        curves: &[Curve; 2],
        samples: &[Vec<State>],
        rows: &[BreakRow],
    ) -> (Self, bool) {
        let node = |(samples, row): (&Vec<State>, &BreakRow)| {
            let own = laterals(&row.ends);
            stretched(&through(samples), between(curves, row.yaw).map(|y| share(own, y)))
        };
        let nodes: Vec<Powers> = samples.iter().zip(rows).step_by(2).map(node).collect();
        let mut coefficients = if nodes.len() < YAW_COEFFICIENTS { nodes } else { over_yaw(&nodes) };
        for (q, quantity) in quantities.iter().enumerate().filter(|(_, quantity)| !exists(&cell, quantity)) {
            debug_assert!(quantity.needs != Needs::Contact);
            coefficients.iter_mut().flatten().for_each(|row| row[q] = f64::NAN);
        }
        let mut fitted = Self { cell, coefficients, errors: [0.0; MOST] };
        let [along, over_yaw] = fitted.compare(quantities, curves, samples, rows);
        (fitted, over_yaw > along)
    }

    /// Finds the errors at all samples. Returns the largest one, as a share of its tolerance, between nodes of the displacement at nodes of
    /// the yaw, then between nodes of the yaw at nodes of the displacement.
    fn compare(
        &mut self,
        quantities: &[TableQuantity],
        curves: &[Curve; 2],
        samples: &[Vec<State>],
        rows: &[BreakRow],
    ) -> [f64; 2] {
        let most = 1.0 + MOST_STRETCHED;
        let mut shares = [0.0_f64; 2];
        for (r, (samples, row)) in samples.iter().zip(rows).enumerate() {
            let (powers, ends) = (self.along(row.yaw), between(curves, row.yaw));
            for (k, sample) in samples.iter().enumerate() {
                let values = at(&powers, share(ends, sample.lateral).clamp(-most, most));
                let found = values.iter().zip(&sample.values).map(|(p, value)| (p - value).abs());
                for ((error, found), quantity) in self.errors.iter_mut().zip(found).zip(quantities) {
                    // `max` leaves out what is not a number: quantities that do not exist.
                    *error = error.max(found);
                    let share = found / quantity.tolerance;
                    match (r % 2, k % 2) {
                        (0, 1) => shares[0] = shares[0].max(share),
                        (1, 0) => shares[1] = shares[1].max(share),
                        _ => {}
                    }
                }
            }
        }
        shares
    }

    /// Gives the polynomials along the displacement under a yaw \[rad\].
    fn along(&self, yaw: f64) -> Powers {
        let u = share(self.cell.yaw, yaw);
        let mut all = self.coefficients.iter().rev();
        let mut sum = all.next().copied().unwrap_or([[0.0; MOST]; COEFFICIENTS]);
        for powers in all {
            let each = sum.iter_mut().flatten().zip(powers.iter().flatten());
            each.for_each(|(sum, c)| *sum = *sum * u + c);
        }
        sum
    }

    /// Tells whether every quantity is within its tolerance, and monotone in every row where its samples are.
    fn is_fine(&self, quantities: &[TableQuantity], samples: &[Vec<State>], rows: &[BreakRow]) -> bool {
        let accurate = quantities
            .iter()
            .zip(self.errors)
            .all(|(quantity, error)| error <= ACCEPTED * quantity.tolerance);
        let mut each = samples.iter().zip(rows);
        accurate && each.all(|(samples, row)| self.is_monotone(quantities, samples, row.yaw))
    }

    fn is_monotone(&self, quantities: &[TableQuantity], samples: &[State], yaw: f64) -> bool {
        let powers = self.along(yaw);
        let looks: Vec<QuantityValues> = (0..LOOKED_AT).map(|k| at(&powers, node(k, LOOKED_AT))).collect();
        quantities.iter().enumerate().filter(|(_, quantity)| exists(&self.cell, quantity)).all(
            |(q, quantity)| {
                [1.0, -1.0].into_iter().all(|sign| {
                    let back = |pair: [f64; 2]| sign * (pair[0] - pair[1]);
                    let climbs =
                        samples.windows(2).all(|pair| back([pair[0].values[q], pair[1].values[q]]) <= 0.0);
                    let limit = STEP_BACK * quantity.tolerance;
                    !climbs || looks.windows(2).all(|pair| back([pair[0][q], pair[1][q]]) <= limit)
                })
            },
        )
    }
}

/// Interpolates the nodes of a row.
fn through(samples: &[State]) -> Powers {
    let mut sum = [[0.0; MOST]; COEFFICIENTS];
    for (node, powers) in samples.iter().step_by(2).zip(&*POWERS) {
        for (row, power) in sum.iter_mut().zip(powers) {
            row.iter_mut().zip(&node.values).for_each(|(c, value)| *c += power * value);
        }
    }
    sum
}

/// Most by which polynomials are stretched beyond the ends of their row, as a share of half its length.
const MOST_STRETCHED: f64 = 0.5;

/// Turns polynomials of t from −1 to 1 between the ends of a row into those between curves, near which the row ends. `ends` are the
/// places of the curves in the row's t. A row too short for that keeps its polynomials.
fn stretched(powers: &Powers, ends: Interval) -> Powers {
    let (slope, middle) = (ends.width() / 2.0, ends.at(0.5));
    if !((ends.low + 1.0).abs() < MOST_STRETCHED && (ends.high - 1.0).abs() < MOST_STRETCHED) {
        return *powers;
    }
    let mut sum = [[0.0; MOST]; COEFFICIENTS];
    for power in powers.iter().rev() {
        for k in (0..COEFFICIENTS).rev() {
            let below = if k > 0 { sum[k - 1] } else { [0.0; MOST] };
            sum[k].iter_mut().zip(below).for_each(|(c, below)| *c = *c * middle + slope * below);
        }
        sum[0].iter_mut().zip(power).for_each(|(c, own)| *c += own);
    }
    sum
}

/// Interpolates the polynomials of the nodes of the yaw.
fn over_yaw(nodes: &[Powers]) -> Vec<Powers> {
    let of = |j: usize| {
        let mut sum = [[0.0; MOST]; COEFFICIENTS];
        for (node, powers) in nodes.iter().zip(&*YAW_POWERS) {
            let each = sum.iter_mut().flatten().zip(node.iter().flatten());
            each.for_each(|(c, value)| *c += powers[j] * value);
        }
        sum
    };
    (0..YAW_COEFFICIENTS).map(of).collect()
}

fn at([lower @ .., highest]: &Powers, t: f64) -> QuantityValues {
    let mut values = *highest;
    for row in lower.iter().rev() {
        values.iter_mut().zip(row).for_each(|(value, c)| *value = *value * t + c);
    }
    values
}

/// Tells whether a quantity exists over a cell.
pub(super) fn exists(cell: &Cell, quantity: &TableQuantity) -> bool {
    let lacks = quantity.right.map_or(Lacks::Nothing, |right| cell.lacks[usize::from(right)]);
    cell.touches && quantity.needs.code() + lacks.code() <= 2
}
