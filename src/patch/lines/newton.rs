//! Newton's steps to an edge from a guess.

/// Most Newton steps to s = δ.
const NEWTON_STEPS: usize = 6;

/// Newton step, as a share of η's distance from the start, after which iteration ends: the error is its square.
pub(in crate::patch) const QUADRATIC: f64 = 1e-8;

/// Distance from a guessed edge, as a share of the slice, up to which a root is the edge that was guessed: another interval is farther
/// away.
pub(in crate::patch) const NEAR_GUESS: f64 = 0.1;

/// Returns η \[mm\] of one end of a slice by Newton's steps from a guess. `miss` gives the gap less δ \[mm\] and its slope along η. Returns
/// `None` unless the steps settle no farther than `near` \[mm\] from the guess, and the gap rises in the direction `outward` there.
pub(in crate::patch) fn newton_from(
    mut miss: impl FnMut(f64) -> Option<[f64; 2]>,
    guess: f64,
    outward: f64,
    near: f64,
) -> Option<f64> {
    let mut eta = guess;
    for _ in 0..NEWTON_STEPS {
        let [over, slope] = miss(eta)?;
        let step = over / slope;
        eta -= step;
        // NaN ends the steps, too.
        if !(slope * outward > 0.0 && (eta - guess).abs() <= near) {
            return None;
        }
        if step.abs() <= QUADRATIC * near {
            return Some(eta);
        }
    }
    None
}
