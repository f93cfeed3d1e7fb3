//! The bands of a patch whose lines fall to one lowest place and rise from there.

use super::ends::end_between;
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::patch::band::Band;
use crate::patch::end::End;
use crate::patch::outline::Outline;
use crate::patch::window::Window;
use crate::placement::Placement;

/// Share of a slice up to which its ends on both sides of a line count as the same.
const ONE_SIDE: f64 = 1e-9;

/// Finds \[s, ξ, η\] \[mm\] of the least s of a wheel on a roller; `None` where the bodies nowhere lie over each other.
pub(crate) fn least_on_roller(placement: &Placement) -> Option<[f64; 3]> {
    let reach = placement.rail().section.reach()?;
    let mut outline = Outline::new(placement, 0.0, &Window::UNBOUNDED, Reference::Plane);
    let xi = outline.slicer.least_of_all(reach, Interval::ALL)?;
    Some(outline.lowest(None, xi))
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

/// Returns the bands by ascending ξ of a patch whose lines fall to one lowest place and rise from there; `None` where slices are found from
/// valleys.
pub(in crate::patch) fn bands(outline: &mut Outline<'_>) -> Option<Vec<Band>> {
    let Some(reach) = outline.slicer.reach() else { return Some(Vec::new()) };
    let over = reach.cut(outline.window.xi);
    if !over.has_width() {
        return Some(Vec::new());
    }
    let window = outline.window.eta;
    let mut least = outline.slicer.least_gap(over, window)?;
    let mut ended: Vec<[BandEnd; 2]> = Vec::new();
    let mut open: Option<BandEnd> = None;
    let mut before = over.low;
    for [a, b] in least.parts() {
        let torn = a.xi != before;
        let step = if before == over.low && before != reach.low { End::Window } else { End::ProfileEnd };
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
    let last = if over.high == reach.high { End::ProfileEnd } else { End::Window };
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
    Some(bands)
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
        edges.map_or_else(|| Interval::of(outline.floor(None, at)), Interval::from)
    });
    let [from, to] = ends.map(|end| end.xi);
    Band::new(Interval::new(from, to), ends.map(|end| end.end), sides, outline.window.eta)
}
