//! Finds the displacements at which other elements touch: hops, joints, edges.

use rayon::prelude::*;

use super::asked::Asked;
use super::cell::{BREAK, Beginning};
use super::state::{Sampler, State};
use crate::error::{Error, ErrorKind, Result, in_order};
use crate::numerics::interval::Interval;
use crate::search::{Roll, WheelsetOnTrack};

/// Distance of the displacements \[mm\] between which breaks are looked for.
const STEP: f64 = 0.02;

/// Gap \[mm\] up to which near misses count for each mm of a step, beside the slope of the contact: the slope of a flange.
const STEEPEST: f64 = 3.0;

/// Width \[mm\] up to which near misses count as not touching, although slopes do not exclude that they touch.
const GRAZING: f64 = 1e-5;

/// Jump \[mm\] of a place of contact across a break above which it is a hop. A place that crosses a joint moves less over the width of
/// the break.
pub(super) const HOP: f64 = 1e-5;

/// Number of steps that are searched one from another. It does not depend on the number of threads, so that the bits do not, either.
const CHUNK: usize = 32;

/// Most breaks within [`CHUNK`] steps: where there are more, bodies touch all over, and rounding decides which elements do.
const MOST: usize = 10_000;

/// A break: the states on both sides of it.
pub(super) type Break = [State; 2];

/// A range of displacements under one yaw, with all breaks in it.
#[derive(Debug, Clone)]
pub(super) struct BreakRow {
    /// The yaw \[rad\].
    pub yaw: f64,
    /// The states at both ends.
    pub ends: Break,
    /// The breaks between them, in ascending order.
    pub breaks: Vec<Break>,
}

/// Gives the displacements \[mm\] between the two states of a break.
pub(super) fn laterals(states: &Break) -> Interval {
    states.each_ref().map(|state| state.lateral).into()
}

/// Finds the states at both ends of a range \[mm\] under a yaw \[rad\], and all breaks in it. A range without width is one state.
pub(super) fn row(system: &WheelsetOnTrack, asked: &Asked, yaw: f64, range: Interval) -> Result<BreakRow> {
    if !range.has_width() {
        let state = Sampler::new(system, asked, yaw).at(range.at(0.5), 0.0)?;
        return Ok(BreakRow { yaw, ends: [state.clone(), state], breaks: Vec::new() });
    }
    let steps = (range.width() / STEP).ceil().max(1.0) as usize;
    let at = |k: usize| if k == steps { range.high } else { range.at(k as f64 / steps as f64) };
    let chunk = |first: usize| -> Result<(Option<State>, State, Vec<Break>)> {
        let mut sampler = Sampler::new(system, asked, yaw);
        let all: Vec<f64> = (first..=(first + CHUNK).min(steps)).map(at).collect();
        let states = states(&mut sampler, &all)?;
        let mut found = Vec::new();
        for pair in states.windows(2) {
            divide(&mut sampler, &pair[0], &pair[1], &mut found)?;
        }
        let mut states = states.into_iter();
        let begin = states.next().filter(|_| first == 0);
        let end = states.next_back().ok_or_else(no_range)?;
        Ok((begin, end, found))
    };
    let firsts: Vec<usize> = (0..steps).step_by(CHUNK).collect();
    let chunks = in_order(firsts.into_par_iter().map(chunk))?;
    let (mut begin, mut end, mut breaks) = (None, None, Vec::new());
    for (first, last, found) in chunks {
        begin = begin.or(first);
        end = Some(last);
        breaks.extend(found);
    }
    let ends = begin.zip(end).map(|(begin, end)| [begin, end]).ok_or_else(no_range)?;
    Ok(BreakRow { yaw, ends, breaks })
}

/// Lists where the roll at which both wheels touch ends over a range of displacements \[mm\] under a yaw \[rad\], in ascending order:
/// displacement \[mm\] and jump of the roll \[rad\], + where it grows. Contact goes on at another roll beyond. Cost: some searches every
/// 0.02 mm, and at each hop and joint on the way.
///
/// # Errors
/// The errors of [`build`](super::build) but for those about tolerances.
pub fn roll_ends(system: &WheelsetOnTrack, yaw: f64, range: Interval) -> Result<Vec<[f64; 2]>> {
    let asked =
        Asked { lateral: range, yaw: Interval::of(yaw), roll: Roll::Solve, tolerance: STEP, pressed: None };
    let found = row(system, &asked, yaw, range)?.breaks;
    let end = |states: &Break| Some([laterals(states).middle(), states[0].turned(&states[1])?]);
    Ok(found.iter().filter_map(end).collect())
}

fn no_range() -> Error {
    Error::new("table: lateral", "no range", "FROM < TO", "correct it")
}

/// Finds the states at ascending displacements, each search beginning from the state before. If a search on its own finds another last
/// state, all are searched for on their own.
fn states(sampler: &mut Sampler<'_>, all: &[f64]) -> Result<Vec<State>> {
    let within = STEEPEST * STEP;
    let mut states: Vec<State> = Vec::with_capacity(all.len());
    for lateral in all {
        let state = match states.last() {
            None => sampler.at(*lateral, within)?,
            Some(before) => sampler.near(*lateral, within, before)?,
        };
        states.push(state);
    }
    if let Some(led) = states.last() {
        let last = sampler.at(led.lateral, 0.0)?;
        if led.topology != last.topology || led.moved(&last) > BREAK {
            return all.iter().map(|lateral| sampler.at(*lateral, within)).collect();
        }
    }
    Ok(states)
}

/// Appends the breaks between two states, in ascending order.
pub(super) fn divide(
    sampler: &mut Sampler<'_>,
    from: &State,
    to: &State,
    breaks: &mut Vec<Break>,
) -> Result<()> {
    let width = to.lateral - from.lateral;
    let same = from.topology == to.topology;
    if same && (width <= GRAZING || from.topology.is_none() || from.alone_until(to)) {
        return Ok(());
    }
    let middle = from.lateral + width / 2.0;
    if breaks.len() > MOST {
        let found = format!("more than {MOST} hops and joints near {} mm", from.lateral);
        let advice = "smooth the profiles, or take another range";
        let error = Error::new("table: lateral", found, "places of contact that can be told apart", advice);
        return Err(error.of_kind(ErrorKind::Limit));
    }
    if width <= BREAK || middle <= from.lateral || middle >= to.lateral {
        breaks.push([from.clone(), to.clone()]);
        return Ok(());
    }
    let steepest = from.steepest().max(to.steepest()).max(STEEPEST);
    let within = (steepest + STEEPEST) * width;
    let mut ends = false;
    if let Some(Interval { low, high }) = sampler.handover(from, to) {
        let (before, after) = (sampler.near(low, within, from)?, sampler.near(high, within, to)?);
        ends = before.turned(&after).is_some();
        if before.topology == from.topology && after.topology == to.topology && !ends {
            divide(sampler, from, &before, breaks)?;
            breaks.push([before.clone(), after.clone()]);
            return divide(sampler, &after, to, breaks);
        }
    }
    // Where a roll at which both wheels touch may end, followed places may be those of a roll that no search on its own finds.
    let middle = if ends { sampler.at(middle, within)? } else { sampler.near(middle, within, from)? };
    divide(sampler, from, &middle, breaks)?;
    divide(sampler, &middle, to, breaks)
}

/// Tells what happens at a break.
pub(super) fn kind_of([before, after]: &Break) -> Beginning {
    if before.topology.is_none() || after.topology.is_none() {
        return Beginning::Edge;
    }
    if before.moved(after) > HOP { Beginning::Hop } else { Beginning::Joint }
}
