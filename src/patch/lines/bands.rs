//! The bands of a patch whose lines fall to one lowest place and rise from there.

use super::Lines;
use super::ends::end_between;
use super::laid::lanes;
use super::least::{GapBox, least_in};
use super::open::{OpenRange, open};
use super::ranges::{LeastGap, SHALLOW};
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::patch::band::{Band, ONE_SIDE};
use crate::patch::end::End;
use crate::patch::fibres::Lane;
use crate::patch::outline::Outline;
use crate::patch::window::Window;
use crate::placement::Placement;

/// Finds \[s, ξ, η\] \[mm\] of the least s of a placed pair; `None` where the bodies nowhere lie over each other.
pub(crate) fn least_separation(placement: &Placement) -> Option<[f64; 3]> {
    let reach = placement.rail().section.reach()?;
    let mut outline = Outline::new(placement, 0.0, &Window::UNBOUNDED, Reference::Plane);
    let plain = outline.slicer.least_of_all(reach, Interval::ALL).map(|xi| outline.lowest(xi));
    let at_c = [outline.slicer.separation(0.0, 0.0), 0.0, 0.0];
    let plain = [Some(at_c).filter(|[s, ..]| !s.is_nan()), plain];
    let plain = plain.into_iter().flatten().min_by(|a, b| a[0].total_cmp(&b[0]));
    // Of bodies apart, ranges are open in which they may be nearer than that.
    let level = plain.map_or(0.0, |[least, ..]| least.max(0.0));
    let mut lines = Lines::new(placement, level, Reference::Plane);
    let several = open(&mut lines, reach, Interval::ALL).into_iter().filter(|open| !open.is_plain);
    let boxes = several.map(|open| GapBox { xi: open.xi, eta: open.eta, is_open: true }).collect();
    let known =
        plain.map_or([f64::INFINITY, f64::NAN, f64::NAN], |[least, xi, eta]| [least - level, xi, eta]);
    let [least, xi, eta] = least_in(&mut lines, boxes, known);
    // What is lower by rounding alone leaves C, or what is found more exactly.
    if least >= known[0] - lines.gap.roundings(SHALLOW) {
        return plain;
    }
    let lines = &mut lines;
    let [xi, eta] = LeastGap { lines, over: reach, window: Interval::ALL }.least_near([xi, eta]);
    Some([outline.slicer.separation(xi, eta), xi, eta])
}

/// One end of a band.
#[derive(Debug, Clone, Copy)]
struct BandEnd {
    /// ξ or σ \[mm\].
    xi: f64,
    /// Where its slice is found \[mm\]: the next number right of a step.
    at: f64,
    /// What bounds it; `None` where the component continues.
    end: Option<End>,
}

/// Returns the bands of a patch, by ascending ξ but for those of single lines, which come last with their lanes.
///
/// Method: ranges of ξ whose lines are proved to meet the patch in one slice at most have bands from the least gap; single lines are laid over
/// the others.
pub(in crate::patch) fn bands(outline: &mut Outline<'_>) -> (Vec<Band>, Vec<(Band, Lane)>) {
    let window = outline.window;
    let Some(lines) = &mut outline.slicer.lines else { return (Vec::new(), Vec::new()) };
    let Some(reach) = lines.gap.reach() else { return (Vec::new(), Vec::new()) };
    let over = reach.cut(window.xi);
    if !over.has_width() {
        return (Vec::new(), Vec::new());
    }
    let ranges = open(lines, over, window.eta);
    let step = |xi: f64| if reach.ends().contains(&xi) { End::ProfileEnd } else { End::Window };
    let laid = ranges.iter().filter(|open| !open.is_plain).flat_map(|OpenRange { xi, eta, .. }| {
        let ends = xi.ends().map(|end| if over.ends().contains(&end) { step(end) } else { End::ProfileEnd });
        lanes(lines, *xi, window.eta.cut(*eta), ends)
    });
    let laid: Vec<(Band, Lane)> = laid.collect();
    let plain = ranges.iter().filter(|open| open.is_plain);
    let bands: Vec<Band> = plain.flat_map(|open| plain_bands(outline, open.xi)).collect();
    (bands, laid)
}

/// Returns the bands by ascending ξ over a range whose lines meet the patch in one slice at most.
fn plain_bands(outline: &mut Outline<'_>, over: Interval) -> Vec<Band> {
    let Window { xi: at_window, eta: window } = outline.window;
    let Some(mut least) = outline.slicer.least_gap(over, window) else { return Vec::new() };
    let mut ended: Vec<[BandEnd; 2]> = Vec::new();
    let mut open: Option<BandEnd> = None;
    let mut before = over.low;
    for [a, b] in least.parts() {
        let torn = a.xi != before;
        let step = if before == at_window.low { End::Window } else { End::ProfileEnd };
        let (ends, begins) =
            (|end| BandEnd { xi: before, at: before, end }, |end| BandEnd { xi: before, at: a.xi, end });
        open = match open {
            Some(begin) if !a.is_inside() => {
                ended.push([begin, ends(Some(step))]);
                None
            }
            Some(begin) if torn => {
                ended.push([begin, ends(None)]);
                Some(begins(None))
            }
            None if a.is_inside() => Some(begins(Some(step))),
            open => open,
        };
        if a.is_inside() != b.is_inside() {
            let (xi, end) = end_between(&mut least, [&a, &b]);
            let end = BandEnd { xi, at: xi, end: Some(end) };
            open = match open {
                Some(begin) => {
                    ended.push([begin, end]);
                    None
                }
                None => Some(end),
            };
        }
        before = b.xi;
    }
    let last = if over.high == at_window.high { End::Window } else { End::ProfileEnd };
    ended.extend(open.map(|begin| [begin, BandEnd { xi: over.high, at: over.high, end: Some(last) }]));
    ended.retain(|[begin, end]| begin.xi < end.xi);
    let mut bands: Vec<Band> = Vec::with_capacity(ended.len());
    for next in ended.into_iter().map(|ends| band(outline, ends)) {
        match bands.last_mut().filter(|last| goes_on(last, &next)) {
            Some(last) => {
                (last.xi.high, last.ends[1], last.sides[1]) = (next.xi.high, next.ends[1], next.sides[1])
            }
            None => bands.push(next),
        }
    }
    bands
}

/// Returns whether a band goes on in the next one without a jump: where a profile steps, a skewed wheel does not step all along the line.
fn goes_on(last: &Band, next: &Band) -> bool {
    let ([_, end], [side, _]) = (last.sides, next.sides);
    let apart = (end.low - side.low).abs().max((end.high - side.high).abs());
    last.ends[1].is_none() && last.xi.high == next.xi.low && apart <= ONE_SIDE * end.width()
}

fn band(outline: &mut Outline<'_>, ends: [BandEnd; 2]) -> Band {
    let sides = ends.map(|BandEnd { at, end, .. }| {
        let edges = if end == Some(End::Tip) { None } else { outline.edges(None, at) };
        edges.map_or_else(|| Interval::of(outline.floor(at)), Interval::from)
    });
    let [from, to] = ends.map(|end| end.xi);
    Band::new(Interval::new(from, to), ends.map(|end| end.end), sides, outline.window.eta)
}
