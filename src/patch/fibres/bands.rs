//! Joins the slices of successive lines to bands.

use super::sampled::BySamples;
use super::slices::{Lane, LaneRow, LineSlice, SlicedLine};
use crate::numerics::interval::Interval;
use crate::patch::band::Band;
use crate::patch::end::End;
use crate::patch::window::Window;
use crate::placement::Placement;

/// Largest depth \[mm\] of the last interval of a band that counts as ending at a tip and not where a body ends: lines a rounding apart
/// differ by so much.
const SHALLOW: f64 = 1e-9;

/// Width \[mm\] below which the last interval of a band counts as ending at a tip whatever its depth: the bottom of a crease is found
/// less exactly.
const NARROW: f64 = 1e-3;

/// Width \[mm\] of the last interval of a band from which on its tip is blunt, as on a flat along which s is level: that of a relative
/// radius of a kilometre along the track.
const BLUNT: f64 = 0.1;

/// The end of a band at an unmatched slice.
pub(in crate::patch) struct LaneEnd {
    /// ξ or σ \[mm\].
    pub(in crate::patch) xi: f64,
    /// Interval of η \[mm\].
    pub(in crate::patch) side: Interval,
    pub(in crate::patch) end: End,
}

/// Joins the slices of successive lines to bands, each with its lane. `saddles` gives ξ or σ and η \[mm\] at which two slices meet
/// between a line and the next one, where that is known. `bound` finds the end of a band at a slice without a partner on the line before (0) or the
/// next one (1).
pub(in crate::patch) fn joined(
    (lines, saddles): (&[SlicedLine], &[Vec<[f64; 2]>]),
    window: Interval,
    mut bound: impl FnMut(f64, &LineSlice, usize) -> LaneEnd,
) -> Vec<(Band, Lane)> {
    let mut lanes: Vec<(Band, Lane)> = Vec::new();
    // The lane of every slice of the line before.
    let mut current: Vec<usize> = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let before = number.checked_sub(1).map(|k| &lines[k]);
        let links = before.map_or_else(Vec::new, |before| line.links(before));
        let alone = |side: usize, k: usize| links.iter().filter(|link| link[side] == k).count() == 1;
        let mut next = Vec::with_capacity(line.slices.len());
        // Bands that join or divide meet at one ξ.
        let saddles = number.checked_sub(1).and_then(|k| saddles.get(k)).map_or(&[][..], Vec::as_slice);
        let at = saddles.first().map_or(line.xi, |[xi, _]| *xi);
        let meeting = |slices: &[LineSlice], k: usize| {
            let side = saddles.iter().fold(slices[k].eta, |side, [_, eta]| reaching(side, slices, (k, *eta)));
            LaneEnd { xi: at, side, end: End::ProfileEnd }
        };
        for (j, slice) in line.slices.iter().enumerate() {
            let from = links.iter().find(|[i, other]| *other == j && alone(0, *i) && alone(1, j));
            let lane = from.map_or_else(
                || {
                    let joins = links.iter().any(|link| link[1] == j);
                    let LaneEnd { xi, side, end } =
                        if joins { meeting(&line.slices, j) } else { bound(line.xi, slice, 0) };
                    let ends = [(!joins).then_some(end), None];
                    lanes.push((Band::new(Interval::of(xi), ends, [side; 2], window), Lane::default()));
                    lanes.len() - 1
                },
                |[i, _]| current[*i],
            );
            let lane_of = &mut lanes[lane].1;
            let follows = line.follows && from.is_some();
            lane_of.rows.push(LaneRow { xi: line.xi, slice: *slice, follows });
            next.push(lane);
        }
        for (i, &lane) in current.iter().enumerate().filter(|(_, lane)| !next.contains(lane)) {
            let Some(before) = before else { break };
            let slice = &before.slices[i];
            let joins = links.iter().any(|link| link[0] == i);
            let LaneEnd { xi, side, end } =
                if joins { meeting(&before.slices, i) } else { bound(before.xi, slice, 1) };
            let band = &mut lanes[lane].0;
            (band.xi.high, band.ends[1], band.sides[1]) = (xi, (!joins).then_some(end), side);
        }
        current = next;
    }
    if let Some(last) = lines.last() {
        for (slice, &lane) in last.slices.iter().zip(&current) {
            let LaneEnd { xi, side, end } = bound(last.xi, slice, 1);
            let band = &mut lanes[lane].0;
            (band.xi.high, band.ends[1], band.sides[1]) = (xi, Some(end), side);
        }
    }
    lanes.retain(|(band, _)| band.xi.has_width());
    lanes
}

/// Returns an interval of η of a slice, lengthened up to a saddle at η between it and a neighbour on its line \[mm\].
fn reaching(side: Interval, slices: &[LineSlice], (k, eta): (usize, f64)) -> Interval {
    let before = k.checked_sub(1).map_or(f64::NEG_INFINITY, |k| slices[k].eta.high);
    let after = slices.get(k + 1).map_or(f64::INFINITY, |slice| slice.eta.low);
    match slices[k].eta {
        own if before <= eta && eta < own.low => Interval::new(eta, side.high),
        own if own.high < eta && eta <= after => Interval::new(side.low, eta),
        _ => side,
    }
}

/// Returns the bands in a window, and ξ \[mm\] of the least s of each.
pub(in crate::patch) fn bands(
    by_samples: &mut BySamples<'_>,
    placement: &Placement,
    window: &Window,
) -> Vec<(Band, Lane)> {
    let lines = by_samples.lines(placement, window);
    let ends = [lines.first(), lines.last()].map(|line| line.map_or(f64::NAN, |line| line.xi));
    let approach = by_samples.approach;
    joined((&lines, &[]), window.eta, |xi, found, side| {
        let is_tip = approach - found.lowest[1] <= SHALLOW || found.eta.width() < NARROW;
        let end = match () {
            () if xi == window.xi[side] => End::Window,
            () if xi != ends[side] && is_tip => End::Tip,
            () => End::ProfileEnd,
        };
        let sharp = end == End::Tip && found.eta.width() < BLUNT;
        LaneEnd { xi, side: if sharp { Interval::of(found.lowest[0]) } else { found.eta }, end }
    })
}
