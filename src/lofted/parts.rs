//! The parts of slices without features: what neighbours have in common, what only one of them shows, and where a list defines no surface.

use super::slice::{LoftSlice, SPACING};
use crate::numerics::interval::Interval;
use crate::profile::{Mark, beside};

/// Jump of a slice's length, as a share of it, across which a list without features defines no surface: the slices do not show the
/// same parts.
const JUMP_OF_LENGTH: f64 = 0.06;

/// Jump of a slice's end, as a share of its length, across which a list without features defines no surface.
const JUMP_OF_ENDS: f64 = 0.1;

/// Height \[mm\] by which measured points may rise where a flank goes on downward: noise.
const NOISE: f64 = 0.05;

/// Successive slices that have a part, with the arc lengths \[mm\] between which each has it.
pub(super) struct PartRun {
    pub part: usize,
    /// Index of the first slice.
    pub first: usize,
    pub spans: Vec<Interval>,
}

/// The parts of a list.
#[derive(Default)]
pub(super) struct ListParts {
    pub runs: Vec<PartRun>,
    /// Where between two slices the list defines no surface \[mm\].
    pub holes: Vec<Interval>,
    /// Why there is none.
    pub warnings: Vec<String>,
}

/// Arc lengths \[mm\] between which two neighbouring slices show the same.
type Common = [Interval; 2];

/// Divides slices without features, given their marks.
///
/// An instrument may see a flank of one slice deeper down than that of its neighbour. What only one of them shows is a part of its own,
/// which begins or ends there; its edge is followed through the other slices at equal shares of arc length, as their points are. Where
/// slices differ otherwise, the list defines no surface between them.
pub(super) fn without_features(slices: &[LoftSlice], marks: &[&[Mark]]) -> ListParts {
    let (mut parts, mut from, mut commons) = (ListParts::default(), 0, Vec::new());
    for k in 1..=slices.len() {
        let how = match marks.get(k).map(|next| common([marks[k - 1], next])) {
            Some(Ok(common)) => {
                commons.push(common);
                continue;
            }
            Some(Err(how)) => Some(how),
            None => None,
        };
        let lengths: Vec<f64> = marks[from..k].iter().map(|marks| length(marks)).collect();
        parts.runs.extend(runs(from, &lengths, std::mem::take(&mut commons)));
        if let Some(how) = how {
            let [a, b] = [&slices[k - 1], &slices[k]];
            let [from, to] = [a, b].map(|slice| format!("{} at {:.2} mm", slice.name, slice.at));
            let why = format!("no surface between {from} and {to}: {how}, and the list gives no features");
            parts.warnings.push(why);
            match parts.holes.last_mut().filter(|hole| hole.high == a.at) {
                Some(hole) => hole.high = b.at,
                None => parts.holes.push(Interval::new(a.at, b.at)),
            }
        }
        from = k;
    }
    parts
}

/// Makes the runs of slices of which all neighbours have something in common; the first one has the index `first`.
fn runs(first: usize, lengths: &[f64], mut commons: Vec<Common>) -> Vec<PartRun> {
    // Ascending arc lengths at which parts begin and end.
    let mut edges: Vec<Vec<f64>> = lengths.iter().map(|length| vec![0.0, *length]).collect();
    for k in 0..commons.len() {
        ends_as_edges(&mut edges, &mut commons, k);
        let [own, next] = commons[k];
        let inside = edges[k].iter().filter(|s| own.low < **s && **s < own.high);
        let seen = inside.map(|s| carried(*s, [own, next])).collect::<Vec<_>>();
        for s in seen.into_iter().chain(next.ends()) {
            insert(&mut edges[k + 1], s);
        }
    }
    // Numbers of each slice's first part, such that parts in common have one number.
    let place = |slice: usize, s: f64| edges[slice].partition_point(|edge| *edge < s) as i64;
    let mut firsts = vec![0];
    for (k, [own, next]) in commons.iter().enumerate() {
        firsts.push(firsts[k] + place(k, own.low) - place(k + 1, next.low));
    }
    let least = firsts.iter().copied().min().unwrap_or(0);
    let span = |slice: usize, part: i64| {
        let k = usize::try_from(part - firsts[slice]).ok()?;
        Some(Interval::new(*edges[slice].get(k)?, *edges[slice].get(k + 1)?))
    };
    let last = (0..lengths.len()).map(|k| firsts[k] + edges[k].len() as i64 - 1).max().unwrap_or(0);
    let mut found = Vec::new();
    for part in least..last {
        let mut spans = Vec::new();
        for k in 0..=lengths.len() {
            match (k < lengths.len()).then(|| span(k, part)).flatten() {
                Some(span) => spans.push(span),
                None => {
                    let spans = std::mem::take(&mut spans);
                    if spans.len() > 1 {
                        let (part, first) = ((part - least) as usize, first + k - spans.len());
                        found.push(PartRun { part, first, spans });
                    }
                }
            }
        }
    }
    found
}

/// Puts the ends of what slice k has in common with the next one onto it as edges, and onto the slices before, as far as these have them.
/// An end within a cell of an edge is that edge.
fn ends_as_edges(edges: &mut [Vec<f64>], commons: &mut [Common], k: usize) {
    let ends = commons[k][0].ends().map(|end| {
        if let Some(known) = edges[k].iter().find(|edge| (*edge - end).abs() <= SPACING) {
            return *known;
        }
        let mut s = end;
        insert(&mut edges[k], s);
        for i in (0..k).rev() {
            let [own, next] = commons[i];
            if s <= next.low || s >= next.high {
                break;
            }
            s = carried(s, [next, own]);
            insert(&mut edges[i], s);
        }
        end
    });
    commons[k][0] = ends.into();
}

/// Carries an arc length \[mm\] from a slice to its neighbour, at an equal share of what they have in common.
fn carried(s: f64, [from, to]: Common) -> f64 {
    to.at((s - from.low) / from.width())
}

fn insert(edges: &mut Vec<f64>, s: f64) {
    if !edges.contains(&s) {
        let at = edges.partition_point(|edge| *edge < s);
        edges.insert(at, s);
    }
}

fn length(marks: &[Mark]) -> f64 {
    marks.last().map_or(0.0, |mark| mark.s)
}

/// Finds what two neighbouring slices have in common.
///
/// # Errors
/// How they differ too much to be joined.
fn common(marks: [&[Mark]; 2]) -> Result<Common, String> {
    let mut common = marks.map(|marks| Interval::new(0.0, length(marks)));
    let Some(how) = difference(marks, common) else { return Ok(common) };
    for high in [false, true] {
        let [own, other] = [deeper(marks, high), deeper([marks[1], marks[0]], high)];
        let extra = |k: usize, s: f64| if high { length(marks[k]) - s } else { s };
        let (k, s) = match (own, other) {
            (Some(own), Some(other)) if extra(0, own) < extra(1, other) => (1, other),
            (Some(own), _) => (0, own),
            (None, Some(other)) => (1, other),
            (None, None) => continue,
        };
        *(if high { &mut common[k].high } else { &mut common[k].low }) = s;
    }
    let both = common.iter().all(|own| own.has_width());
    if both && difference(marks, common).is_none() { Ok(common) } else { Err(how) }
}

/// Says how two slices differ too much to be joined over these arc lengths \[mm\]; `None` where they do not.
fn difference(marks: [&[Mark]; 2], common: Common) -> Option<String> {
    let ends = [0, 1].map(|k| common[k].ends().map(|s| point(marks[k], s)));
    let moved = [0, 1].map(|end| {
        let [a, b] = [ends[0][end], ends[1][end]];
        (a[0] - b[0]).hypot(a[1] - b[1])
    });
    let (moved, [own, other]) = (moved[0].max(moved[1]), common.map(Interval::width));
    let shorter = own.min(other);
    if (own - other).abs() > JUMP_OF_LENGTH * shorter {
        Some(format!("their lengths are {own:.1} and {other:.1} mm"))
    } else if moved > JUMP_OF_ENDS * shorter {
        Some(format!("an end moves by {moved:.1} mm"))
    } else {
        None
    }
}

/// Returns the arc length \[mm\] at which the first of two slices has the end of the second one, if from there on it shows more of the
/// same flank: what is steeper than 45° there, and goes down by more than it goes sideways. Heights count from the top of each slice, so
/// that a rail may rise.
fn deeper([marks, other]: [&[Mark]; 2], high: bool) -> Option<f64> {
    let top = |marks: &[Mark]| marks.iter().map(|mark| mark.station.z).fold(f64::NEG_INFINITY, f64::max);
    let end = if high { other.last()? } else { other.first()? }.station;
    let [x, z] = [end.x, end.z + top(marks) - top(other)];
    let far = |mark: &Mark| (mark.station.x - x).hypot(mark.station.z - z);
    let foot = (0..marks.len()).min_by(|&a, &b| far(&marks[a]).total_cmp(&far(&marks[b])))?;
    let extra = if high { &marks[foot..] } else { &marks[..=foot] };
    let (top, bottom) = if high { (extra.first()?, extra.last()?) } else { (extra.last()?, extra.first()?) };
    let down = top.station.z - bottom.station.z;
    let below = extra.iter().all(|mark| mark.station.z <= top.station.z + NOISE);
    let steep = top.station.sin.abs() > top.station.cos.abs();
    let goes_on = steep && below && down > (top.station.x - bottom.station.x).abs();
    let s = beside(marks, [x, z], foot)?.s;
    (goes_on && (s - bottom.s).abs() > SPACING).then_some(s)
}

/// Gives the point \[x, z\] of the mark at an arc length \[mm\], or the next one.
fn point(marks: &[Mark], s: f64) -> [f64; 2] {
    let k = marks.partition_point(|mark| mark.s < s).min(marks.len() - 1);
    [marks[k].station.x, marks[k].station.z]
}
