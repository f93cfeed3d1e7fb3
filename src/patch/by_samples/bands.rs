//! Joins the intervals of sampled lines to bands.

use super::lines::{BySamples, LineSlice, SlicedLine, TO_LOWEST, links};
use crate::numerics::interval::Interval;
use crate::numerics::roots::change;
use crate::patch::band::{Band, Turn};
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

/// Returns the bands in a window, and places at which s may be least.
pub(in crate::patch) fn bands(
    by_samples: &mut BySamples<'_>,
    placement: &Placement,
    window: &Window,
) -> (Vec<Band>, Vec<Turn>) {
    let lines = by_samples.lines(placement, window);
    let (mut bands, mut turns) = joined(by_samples, &lines, window);
    for (lane, xi) in &mut turns {
        *xi = turn(by_samples, *lane, *xi);
        bands[*lane].valleys = vec![(bands[*lane].xi.high, vec![*lane])];
    }
    let turns = turns.into_iter().map(|(lane, xi)| Turn { valley: Some(lane), xi, depth: f64::NAN });
    (bands.into_iter().filter(|band| band.xi.has_width()).collect(), turns.collect())
}

/// Joins the intervals of successive lines to bands.
fn joined(
    by_samples: &mut BySamples<'_>,
    lines: &[SlicedLine],
    window: &Window,
) -> (Vec<Band>, Vec<(usize, f64)>) {
    let ends = [lines.first(), lines.last()].map(|line| line.map_or(f64::NAN, |line| line.xi));
    let (mut bands, mut lanes): (Vec<Band>, Vec<Vec<(f64, LineSlice)>>) = (Vec::new(), Vec::new());
    // The band of every interval of the previous line.
    let mut current: Vec<usize> = Vec::new();
    let nothing = SlicedLine { xi: ends[0], slices: Vec::new() };
    let pairs = std::iter::once(&nothing).chain(lines).zip(lines);
    for (before, line) in pairs {
        let links = links(before, line);
        let alone = |side: usize, k: usize| links.iter().filter(|link| link[side] == k).count() == 1;
        let mut next = Vec::with_capacity(line.slices.len());
        for (j, found) in line.slices.iter().enumerate() {
            let from = links.iter().find(|[i, other]| *other == j && alone(0, *i) && alone(1, j));
            let band = from.map_or_else(
                || {
                    let joins = links.iter().any(|link| link[1] == j);
                    let end = (!joins)
                        .then(|| bound(found, line.xi, [window.xi.low, ends[0]], by_samples.approach));
                    let side = side(found, end);
                    bands.push(Band::new(Interval::of(line.xi), [end, None], [side; 2], window.eta));
                    lanes.push(Vec::new());
                    bands.len() - 1
                },
                |[i, _]| current[*i],
            );
            lanes[band].push((line.xi, *found));
            next.push(band);
        }
        for (i, &band) in current.iter().enumerate() {
            if next.contains(&band) {
                continue;
            }
            let found = &before.slices[i];
            let joins = links.iter().any(|link| link[0] == i);
            let end = (!joins).then(|| bound(found, before.xi, [f64::NAN; 2], by_samples.approach));
            // Bands that join or divide meet at one ξ.
            close(&mut bands[band], if joins { line.xi } else { before.xi }, end, side(found, end));
        }
        current = next;
    }
    if let Some(last) = lines.last() {
        for (found, &band) in last.slices.iter().zip(&current) {
            let end = Some(bound(found, last.xi, [window.xi.high, ends[1]], by_samples.approach));
            close(&mut bands[band], last.xi, end, side(found, end));
        }
    }
    let deepest = |rows: &Vec<(f64, LineSlice)>| {
        let least = |p: &&(f64, LineSlice), q: &&(f64, LineSlice)| p.1.lowest[1].total_cmp(&q.1.lowest[1]);
        rows.iter().min_by(least).map_or(f64::NAN, |row| row.0)
    };
    let turns = lanes.iter().map(deepest).enumerate().collect();
    by_samples.lanes = lanes;
    (bands, turns)
}

/// Finds where s turns along a lane, near the deepest of its lines.
fn turn(by_samples: &mut BySamples<'_>, lane: usize, xi: f64) -> f64 {
    let rows = &by_samples.lanes[lane];
    let at = rows.partition_point(|row| row.0 < xi);
    let (Some(from), Some(to)) = (at.checked_sub(1).map(|k| rows[k].0), rows.get(at + 1).map(|row| row.0))
    else {
        return xi;
    };
    let depth = rows[at].1.lowest[1];
    let slope = |xi: f64| {
        let eta = by_samples.lowest(xi, Some(lane));
        by_samples.level.gradient(xi, eta)[0]
    };
    let turn = change(slope, [from, to], TO_LOWEST);
    // A crease, where s does not turn, may be deeper.
    let eta = by_samples.lowest(turn, Some(lane));
    if by_samples.separation(turn, eta) < depth { turn } else { xi }
}

fn close(band: &mut Band, xi: f64, end: Option<End>, side: Interval) {
    (band.xi.high, band.ends[1], band.sides[1]) = (xi, end, side);
}

/// Returns what bounds an interval at its ξ: the window if ξ is its end, the end of a body, or a tip.
fn bound(found: &LineSlice, xi: f64, [window, reach]: [f64; 2], approach: f64) -> End {
    match () {
        () if xi == window => End::Window,
        () if xi == reach => End::ProfileEnd,
        () if approach - found.lowest[1] <= SHALLOW || found.eta.width() < NARROW => End::Tip,
        () => End::ProfileEnd,
    }
}

/// Returns the side of a band: without width at a tip that is not blunt.
fn side(found: &LineSlice, end: Option<End>) -> Interval {
    let sharp = end == Some(End::Tip) && found.eta.width() < BLUNT;
    if sharp { Interval::of(found.lowest[0]) } else { found.eta }
}
