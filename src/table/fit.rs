//! Fits polynomials over the stretches between breaks.

use std::array::from_fn;
use std::f64::consts::PI;
use std::sync::LazyLock;

use super::breaks::{Break, HOP, Stretch, divide, stretches};
use super::cell::{BREAK, Beginning, COEFFICIENTS, Cell, Lacks, share};
use super::quantity::{MOST, Needs, Quantity, Values};
use super::state::{Sampler, State};
use crate::error::Result;

/// Stated error over the largest difference in the check of a cell. The check is made where the polynomial through the nodes is
/// largest, between them.
pub(super) const MARGIN: f64 = 2.0;

/// Share of the tolerance that the check of a cell may find: with the margin half of the tolerance is left.
const ACCEPTED: f64 = 0.25;

/// Share of the tolerance by which a polynomial may step back where the function does not.
const STEP_BACK: f64 = 1e-3;

/// Width \[mm\] below which a cell is not halved any more; the stated error then shows what is left.
const SHORTEST: f64 = 1e-6;

/// Width \[mm\] of cells in which a jump is looked for that elements do not show: two places on one pair of elements.
const MAY_JUMP: f64 = 1e-3;

/// States over a cell: at the nodes, and at points between each two of them.
const SAMPLES: usize = 2 * COEFFICIENTS - 1;

/// Points at which polynomials are looked at for steps back.
const LOOKED_AT: usize = 33;

/// A cell with its polynomials.
pub(super) struct Fitted {
    pub cell: Cell,
    /// Coefficients of 1, t, … of all quantities.
    pub coefficients: [Values; COEFFICIENTS],
    /// Largest differences in the check.
    pub errors: Values,
}

/// Coefficient of t^i of the polynomial that is 1 at node k and 0 at the others, at \[k\]\[i\]; the nodes are −cos(kπ/8).
static POWERS: LazyLock<[[f64; COEFFICIENTS]; COEFFICIENTS]> = LazyLock::new(|| {
    let last = COEFFICIENTS - 1;
    let mut chebyshev = [[0.0; COEFFICIENTS]; COEFFICIENTS];
    (chebyshev[0][0], chebyshev[1][1]) = (1.0, 1.0);
    for j in 2..COEFFICIENTS {
        for i in 0..=j {
            let twice = if i == 0 { 0.0 } else { 2.0 * chebyshev[j - 1][i - 1] };
            chebyshev[j][i] = twice - chebyshev[j - 2][i];
        }
    }
    let half = |k: usize| if k == 0 || k == last { 0.5 } else { 1.0 };
    let weight = |j: usize, k: usize| {
        2.0 / last as f64 * half(j) * half(k) * (PI * (j * (last - k)) as f64 / last as f64).cos()
    };
    from_fn(|k| from_fn(|i| (0..COEFFICIENTS).map(|j| weight(j, k) * chebyshev[j][i]).sum()))
});

/// Fits a stretch.
///
/// # Errors
/// The errors of the search.
pub(super) fn fit(
    sampler: &mut Sampler<'_>,
    quantities: &[Quantity],
    stretch: &Stretch,
) -> Result<Vec<Fitted>> {
    let mut open = vec![Stretch { ends: stretch.ends.clone(), begins: stretch.begins }];
    let mut done = Vec::new();
    while let Some(Stretch { ends, begins }) = open.pop() {
        let mut cell = Cell {
            lateral: ends.each_ref().map(|state| state.lateral),
            begins,
            touches: false,
            lacks: [Lacks::Nothing; 2],
        };
        let Some(topology) = ends[0].topology else {
            let coefficients = [[f64::NAN; MOST]; COEFFICIENTS];
            done.push(Fitted { cell, coefficients, errors: [0.0; MOST] });
            continue;
        };
        (cell.touches, cell.lacks) = (true, topology.lacks);
        let mut samples = samples(sampler, &ends)?;
        let width = cell.lateral[1] - cell.lateral[0];
        if width <= SHORTEST {
            // Breaks so close to each other are one.
            let others = samples.iter_mut().filter(|sample| sample.topology != ends[0].topology);
            others.for_each(|sample| sample.values = ends[0].values);
            done.push(Fitted::new(cell, quantities, &samples));
            continue;
        }
        let unseen = breaks_between(sampler, &samples)?;
        if !unseen.is_empty() {
            open.extend(stretches(ends, begins, unseen).into_iter().rev());
            continue;
        }
        let fitted = Fitted::new(cell, quantities, &samples);
        if fitted.is_fine(quantities, &samples) {
            done.push(fitted);
            continue;
        }
        let jump = if width <= MAY_JUMP { jump(sampler, &samples)? } else { None };
        let parts = match jump {
            Some(jump) => stretches(ends, begins, vec![jump]),
            None => {
                let middle = samples[SAMPLES / 2].clone();
                let [from, to] = ends;
                vec![
                    Stretch { ends: [from, middle.clone()], begins },
                    Stretch { ends: [middle, to], begins: Beginning::Smooth },
                ]
            }
        };
        open.extend(parts.into_iter().rev());
    }
    Ok(done)
}

/// Searches at all points of a cell.
fn samples(sampler: &mut Sampler<'_>, ends: &Break) -> Result<Vec<State>> {
    let [from, to] = ends.each_ref().map(|state| state.lateral);
    let mut samples = Vec::with_capacity(SAMPLES);
    samples.push(ends[0].clone());
    for k in 1..SAMPLES - 1 {
        let t = -(PI * k as f64 / (SAMPLES - 1) as f64).cos();
        let y = from + (to - from) * (0.5 * (1.0 + t));
        let sample = sampler.near(y.clamp(from, to), 0.0, &samples[k - 1])?;
        samples.push(sample);
    }
    samples.push(ends[1].clone());
    Ok(samples)
}

/// Finds breaks that the search of breaks has not seen: other elements touch at one of the samples.
fn breaks_between(sampler: &mut Sampler<'_>, samples: &[State]) -> Result<Vec<Break>> {
    let mut breaks = Vec::new();
    for pair in samples.windows(2).filter(|pair| pair[0].topology != pair[1].topology) {
        divide(sampler, &pair[0], &pair[1], &mut breaks)?;
    }
    Ok(breaks)
}

/// Finds a jump of a place of contact between the samples: the largest change, halved to the width of a break.
fn jump(sampler: &mut Sampler<'_>, samples: &[State]) -> Result<Option<Break>> {
    let change = |pair: &[State]| pair[0].moved(&pair[1]);
    let Some(pair) = samples.windows(2).max_by(|a, b| change(a).total_cmp(&change(b))) else {
        return Ok(None);
    };
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

impl Fitted {
    fn new(cell: Cell, quantities: &[Quantity], samples: &[State]) -> Self {
        let mut coefficients = [[0.0; MOST]; COEFFICIENTS];
        for (node, powers) in samples.iter().step_by(2).zip(&*POWERS) {
            for (row, power) in coefficients.iter_mut().zip(powers) {
                row.iter_mut().zip(&node.values).for_each(|(c, value)| *c += power * value);
            }
        }
        for (q, quantity) in quantities.iter().enumerate().filter(|(_, quantity)| !exists(&cell, quantity)) {
            debug_assert!(quantity.needs != Needs::Contact);
            coefficients.iter_mut().for_each(|row| row[q] = f64::NAN);
        }
        let mut fitted = Self { cell, coefficients, errors: [0.0; MOST] };
        for sample in samples {
            let values = fitted.at(share(cell.lateral, sample.lateral));
            let found = values.iter().zip(&sample.values).map(|(p, value)| (p - value).abs());
            // `max` leaves out what is not a number: quantities that do not exist.
            fitted.errors.iter_mut().zip(found).for_each(|(error, found)| *error = error.max(found));
        }
        fitted
    }

    fn at(&self, t: f64) -> Values {
        let [lower @ .., highest] = &self.coefficients;
        let mut values = *highest;
        for row in lower.iter().rev() {
            values.iter_mut().zip(row).for_each(|(value, c)| *value = *value * t + c);
        }
        values
    }

    /// Tells whether every quantity is within its tolerance, and monotone where its samples are.
    fn is_fine(&self, quantities: &[Quantity], samples: &[State]) -> bool {
        let accurate = quantities
            .iter()
            .zip(self.errors)
            .all(|(quantity, error)| error <= ACCEPTED * quantity.tolerance);
        accurate && self.is_monotone(quantities, samples)
    }

    fn is_monotone(&self, quantities: &[Quantity], samples: &[State]) -> bool {
        let looks: Vec<Values> =
            (0..LOOKED_AT).map(|k| self.at(-(PI * k as f64 / (LOOKED_AT - 1) as f64).cos())).collect();
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

/// Tells whether a quantity exists over a cell.
pub(super) fn exists(cell: &Cell, quantity: &Quantity) -> bool {
    let lacks = quantity.right.map_or(Lacks::Nothing, |right| cell.lacks[usize::from(right)]);
    cell.touches && quantity.needs.code() + lacks.code() <= 2
}
