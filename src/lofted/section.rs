//! The section of a lofted surface across the track.

use super::build::Loft;
use super::strip::LoftStrip;
use crate::error::{Error, Result};
use crate::profile::{Polynomial, Profile, Segment, Shape};

/// Largest distance \[mm\] between the ends of two neighbouring parts that join: more than the rounding of slices.
const STEP: f64 = 1e-3;

/// Least share of a cell at which it is divided: a tangent changes by far less than rounding over a shorter one.
const SLIVER: f64 = 1e-9;

/// Returns the section at y \[mm\] through one of the strips, as far as its neighbours join it: the cut of the surface, one cubic a
/// cell. Of a profile that keeps its shape the cubics are off by [`LoftStrip::off`].
///
/// # Errors
/// A place where the strip has no surface.
pub fn section(loft: &Loft, strip: usize, y: f64) -> Result<Profile> {
    section_through(loft, strip, [f64::NAN, y])
}

/// Returns the section at y \[mm\] as [`section`] does, whose cubics have the surface's own point and tangent at u of the strip, too.
///
/// # Errors
/// Those of [`section`].
pub(crate) fn section_through(loft: &Loft, strip: usize, [u, y]: [f64; 2]) -> Result<Profile> {
    let strips = &loft.strips;
    if !strips[strip].holds(y) {
        let [from, to] = strips[strip].reach().ends();
        let expected = format!("a place from {from} to {to} mm, where this part of the rail is");
        return Err(Error::new("along", format!("{y:?} mm"), expected, "choose another place"));
    }
    let run = joined(loft, strip, y);
    let own = |k: usize| if k == strip { u } else { f64::NAN };
    let segments = run.into_iter().flat_map(|k| spans(&strips[k], own(k), y)).collect::<Result<Vec<_>>>()?;
    Profile::new(format!("section at {y:.3} mm"), "a cut of a list of slices", segments)
}

/// Lists the strips that join each other across at y \[mm\], one of which is given, by ascending x.
pub fn joined(loft: &Loft, strip: usize, y: f64) -> Vec<usize> {
    let strips = &loft.strips;
    let ends = |k: usize| [0.0, strips[k].cells() as f64].map(|u| strips[k].point(u, y).at);
    let meets = |left: usize, right: usize| {
        let ([_, a], [b, _]) = (ends(left), ends(right));
        (a[0] - b[0]).hypot(a[1] - b[1]) <= STEP
    };
    let beside = |part: Option<usize>| {
        part.and_then(|part| (0..strips.len()).find(|&k| strips[k].part == part && strips[k].holds(y)))
    };
    let left = |&k: &usize| beside(strips[k].part.checked_sub(1)).filter(|&other| meets(other, k));
    let right = |&k: &usize| beside(strips[k].part.checked_add(1)).filter(|&other| meets(k, other));
    let mut run: Vec<usize> = std::iter::successors(Some(strip), left).collect();
    run.reverse();
    run.extend(std::iter::successors(Some(strip), right).skip(1));
    run
}

/// Lists the points (x, z) \[mm\] at y \[mm\] at which the surface ends across; an end of several parts may come several times.
pub fn ends(loft: &Loft, y: f64) -> Vec<[f64; 2]> {
    let here = (0..loft.strips.len()).filter(|&k| loft.strips[k].holds(y));
    let both = here.filter_map(|k| {
        let run = joined(loft, k, y);
        let (first, last) = (&loft.strips[*run.first()?], &loft.strips[*run.last()?]);
        Some([first.point(0.0, y).at, last.point(last.cells() as f64, y).at])
    });
    both.flatten().collect()
}

/// Makes the segments of a strip's cells at y \[mm\]; cells without length are left out. Where the cubics are not the surface itself, one
/// begins at u, too.
fn spans(strip: &LoftStrip, u: f64, y: f64) -> Vec<Result<Segment>> {
    let divided = strip.off() > 0.0;
    let shares = |cell: usize| {
        let share = u - cell as f64;
        if divided && share > SLIVER && share < 1.0 - SLIVER {
            vec![[0.0, share], [share, 1.0]]
        } else {
            vec![[0.0, 1.0]]
        }
    };
    let ranges = (0..strip.cells()).flat_map(|cell| shares(cell).into_iter().map(move |ends| (cell, ends)));
    let segment = |(cell, ends): (usize, [f64; 2])| {
        let [from, to] = ends.map(|share| strip.point_of(cell, share, y));
        let cubic = |axis: usize| {
            let rise = to.at[axis] - from.at[axis];
            let [a, b] = [from, to].map(|end| end.across[axis] * (ends[1] - ends[0]));
            [from.at[axis], a, 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise]
        };
        let shape = || Polynomial::span(&cubic(0), &cubic(1), [0.0, 1.0]).map(Shape::Polynomial);
        (from.at != to.at).then(|| shape().map(|shape| Segment { label: String::new(), shape }))
    };
    ranges.filter_map(segment).collect()
}
