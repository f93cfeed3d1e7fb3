//! The section of a lofted surface across the track.

use super::build::Loft;
use super::strip::LoftStrip;
use crate::error::{Error, Result};
use crate::profile::{Polynomial, Profile, Segment, Shape};

/// Largest distance \[mm\] between the ends of two neighbouring parts that join: more than the rounding of slices.
const STEP: f64 = 1e-3;

/// Returns the section at y \[mm\] through one of the strips, as far as its neighbours join it: exactly the cut of the surface, one
/// cubic a cell.
///
/// # Errors
/// A place where the strip has no surface.
pub fn section(loft: &Loft, strip: usize, y: f64) -> Result<Profile> {
    let strips = &loft.strips;
    if !strips[strip].holds(y) {
        let [from, to] = strips[strip].reach().ends();
        let expected = format!("a place from {from} to {to} mm, where this part of the rail is");
        return Err(Error::new("along", format!("{y:?} mm"), expected, "choose another place"));
    }
    let run = joined(loft, strip, y);
    let segments = run.into_iter().flat_map(|k| spans(&strips[k], y)).collect::<Result<Vec<_>>>()?;
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

/// Makes the segments of a strip's cells at y \[mm\]; cells without length are left out.
fn spans(strip: &LoftStrip, y: f64) -> Vec<Result<Segment>> {
    let node = |k: usize| strip.point(k as f64, y);
    let mut from = node(0);
    let mut out = Vec::with_capacity(strip.cells());
    for k in 1..=strip.cells() {
        let to = node(k);
        let cubic = |axis: usize| {
            let (rise, [a, b]) = (to.at[axis] - from.at[axis], [from.across[axis], to.across[axis]]);
            [from.at[axis], a, 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise]
        };
        if from.at != to.at {
            let shape = Polynomial::span(&cubic(0), &cubic(1), [0.0, 1.0]).map(Shape::Polynomial);
            out.push(shape.map(|shape| Segment { label: String::new(), shape }));
        }
        from = to;
    }
    out
}
