//! Makes the surface of a list of slices.

use rayon::prelude::*;

use super::joining::Joining;
use super::parts::{ListParts, PartRun, without_features};
use super::slice::{LoftSlice, SPACING};
use super::strip::{Bay, LoftStrip};
use crate::error::{Error, ErrorKind, Result, in_order};
use crate::numerics::interval::Interval;
use crate::profile::{Mark, trace};

/// Distance \[mm\] of the marks by which a slice is divided: cubics between them are off by 1e-5 nm on a 13 mm radius.
const MARKS: f64 = 0.05;

/// Most points of a surface; each takes 130 bytes.
const MOST_POINTS: usize = 4_000_000;

/// The surface of a rail that varies along the track, or of a wheel that varies, developed and upside down.
#[derive(Debug, Clone)]
pub struct Loft {
    /// The parts of its surface.
    pub strips: Vec<LoftStrip>,
    /// Where between two slices the list defines no surface at all \[mm\], in order. What a list with features leaves out is no hole: it
    /// says that there is nothing.
    pub holes: Vec<Interval>,
    /// Where the slices leave the surface undefined, and why; where a cubic surface folds over.
    pub warnings: Vec<String>,
    reach: Interval,
}

/// A slice with its marks, and the arc lengths at the ends of its parts; `None` for parts that it does not have.
struct Divided {
    marks: Vec<Mark>,
    parts: Vec<Option<Interval>>,
}

impl Loft {
    /// Makes the surface through slices at ascending positions.
    ///
    /// Cost: some 2 µs a point, on all threads.
    ///
    /// # Errors
    /// Fewer than two slices; positions that do not ascend; different numbers of features, or features that do not ascend; no part
    /// that two successive slices have; a monotone surface that folds over between two slices; more points than memory should hold.
    pub fn new(slices: &[LoftSlice], joining: Joining) -> Result<Self> {
        check(slices)?;
        let divided = in_order(slices.par_iter().map(divide))?;
        let ListParts { runs, holes, mut warnings } = if slices[0].features.len() < 2 {
            without_features(slices, &divided.iter().map(|slice| slice.marks.as_slice()).collect::<Vec<_>>())
        } else {
            ListParts { runs: of_features(&divided), ..ListParts::default() }
        };
        let (mut strips, mut total) = (Vec::new(), 0);
        for run in runs {
            let points = spread_all(&run, &divided, &mut total)?;
            let own = &slices[run.first..run.first + run.spans.len()];
            let at = own.iter().map(|slice| slice.at).collect();
            let strip = LoftStrip::new(run.part, at, &points, joining);
            match fold(&strip, own) {
                Some(found) if joining == Joining::Monotone => {
                    let advice = "give features, or slices that show the same parts";
                    return Err(Error::new("slices", found, "slices that correspond", advice));
                }
                found => warnings.extend(found),
            }
            strips.push(strip);
        }
        if strips.is_empty() {
            let expected = "a part that two successive slices have";
            return Err(Error::new("slices", "no such part", expected, "correct the features"));
        }
        let reach = Interval::new(slices[0].at, slices[slices.len() - 1].at);
        Ok(Self { strips, holes, warnings, reach })
    }

    /// Makes the surface of strips that cover a range of y \[mm\].
    pub(super) fn of_strips(strips: Vec<LoftStrip>, reach: Interval) -> Self {
        Self { strips, holes: Vec::new(), warnings: Vec::new(), reach }
    }

    /// Gives the interval from the first slice to the last \[mm\].
    pub fn reach(&self) -> Interval {
        self.reach
    }

    /// Returns the index of the strip with most cells at y \[mm\], the running rail's in most cases; `None` where there is none.
    pub fn widest(&self, y: f64) -> Option<usize> {
        let strips = self.strips.iter().enumerate();
        let here = strips.filter(|(_, strip)| strip.holds(y));
        here.max_by_key(|(_, strip)| strip.cells()).map(|(k, _)| k)
    }
}

fn check(slices: &[LoftSlice]) -> Result<()> {
    if slices.len() < 2 {
        let found = format!("{} slice", slices.len());
        let advice = "list more, or give `along` for a section of it";
        return Err(Error::new("slices", found, "two slices or more", advice));
    }
    for pair in slices.windows(2) {
        if pair[1].at <= pair[0].at || (pair[1].at - pair[0].at).is_nan() {
            let found = format!("a slice at {} mm after one at {} mm", pair[1].at, pair[0].at);
            return Err(Error::new(&pair[1].name, found, "ascending positions", "sort the slices"));
        }
        let [own, other] = [&pair[1], &pair[0]].map(|slice| slice.features.len());
        if own != other {
            let (found, expected) = (format!("{own} features"), format!("{other}, as the slice before has"));
            return Err(Error::new(
                &pair[1].name,
                found,
                expected,
                "write −1 for what a slice does not have",
            ));
        }
    }
    Ok(())
}

/// Finds the parts of a slice on its curve.
fn divide(slice: &LoftSlice) -> Result<Divided> {
    let marks = trace(&slice.profile, MARKS);
    let length = marks.last().map_or(0.0, |mark| mark.s);
    if slice.features.len() < 2 {
        return Ok(Divided { marks, parts: vec![Some(Interval::new(0.0, length))] });
    }
    let last = slice.features.iter().rposition(|s| *s >= 0.0);
    let scale = slice.measured_along.map_or(1.0, |polygon| length / polygon);
    let feature = |k: usize| {
        let s = scale * slice.features[k];
        (s >= 0.0).then(|| if Some(k) == last { s.min(length) } else { s })
    };
    let parts = (1..slice.features.len()).map(|k| {
        let Some((from, to)) = feature(k - 1).zip(feature(k)) else { return Ok(None) };
        if from < to && to <= length {
            return Ok(Some(Interval::new(from, to)));
        }
        let found = format!("feature {} at {to} mm after one at {from} mm", k + 1);
        let expected = format!("ascending arc lengths within the {length:.3} mm of the slice");
        Err(Error::new(&slice.name, found, expected, "correct the list, or check the unit"))
    });
    let parts = parts.collect::<Result<_>>()?;
    Ok(Divided { marks, parts })
}

/// Finds the runs of successive slices that have a part, two at least.
fn of_features(divided: &[Divided]) -> Vec<PartRun> {
    let mut runs = Vec::new();
    let parts = divided.first().map_or(0, |slice| slice.parts.len());
    for part in 0..parts {
        let mut first = 0;
        for run in divided.chunk_by(|a, b| a.parts[part].is_some() == b.parts[part].is_some()) {
            let spans: Vec<Interval> = run.iter().filter_map(|slice| slice.parts[part]).collect();
            if spans.len() > 1 {
                runs.push(PartRun { part, first, spans });
            }
            first += run.len();
        }
    }
    runs
}

/// Lists the points \[x, z\] of a part on the slices of a run, at equal shares of its arc length; `total` counts those of all parts.
fn spread_all(run: &PartRun, divided: &[Divided], total: &mut usize) -> Result<Vec<Vec<[f64; 2]>>> {
    let longest = run.spans.iter().map(|span| span.width()).fold(0.0, f64::max);
    let cells = (longest / SPACING).ceil().max(1.0) as usize;
    *total += (cells + 1) * run.spans.len();
    if *total > MOST_POINTS {
        let expected = format!("{MOST_POINTS} points at most, {SPACING} mm apart on all slices");
        let advice = "list the slices near the place that you look at";
        return Err(Error::new("slices", "more points", expected, advice).of_kind(ErrorKind::Limit));
    }
    let slices = divided[run.first..].iter().zip(&run.spans);
    Ok(slices.map(|(slice, span)| spread(&slice.marks, *span, cells)).collect())
}

/// Lists the points \[x, z\] at equal shares of an arc length along a curve.
fn spread(marks: &[Mark], span: Interval, cells: usize) -> Vec<[f64; 2]> {
    let mut k = 1;
    let at = |share: usize| {
        let s = span.at(share as f64 / cells as f64);
        while k + 1 < marks.len() && marks[k].s < s {
            k += 1;
        }
        let (a, b) = (&marks[k - 1], &marks[k]);
        let length = b.s - a.s;
        a.between(b, if length > 0.0 { ((s - a.s) / length).clamp(0.0, 1.0) } else { 1.0 })
    };
    (0..=cells).map(at).collect()
}

/// Says where a section runs backward halfway between two slices that run alike; `None` if none does.
fn fold(strip: &LoftStrip, slices: &[LoftSlice]) -> Option<String> {
    let folds = |bay: Bay<'_>, cell: usize| {
        let (y, middle) = (bay.y(), bay.y().middle());
        let across = [y.low, middle, y.high].map(|y| bay.cell(cell).point(0.5, y).across);
        let dot = |a: usize, b: usize| across[a][0] * across[b][0] + across[a][1] * across[b][1];
        let [x, z] = bay.cell(cell).point(0.5, middle).at;
        let names = [0, 1].map(|k| &slices[bay.index() + k].name);
        (dot(0, 2) > 0.0 && dot(0, 1) < 0.0 && dot(1, 2) < 0.0).then(|| {
            format!("a surface that folds over between {} and {}, at [{x:.1}, {z:.1}]", names[0], names[1])
        })
    };
    strip.bays().find_map(|bay| (0..strip.cells()).find_map(|cell| folds(bay, cell)))
}
