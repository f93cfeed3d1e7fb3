//! Finds the approach δ under a load: the root of a load that grows with δ.

/// First estimate of d ln N/d ln δ: the load of an ellipse grows with δ^3/2 (Hertz). Secant slopes stay within 0.5 to 4 times this.
const USUAL_SLOPE: f64 = 1.5;

/// Lower end of the search \[mm\].
const LEAST: f64 = 1e-9;

/// Finds the approach \[mm\] up to `most` at which `total`, a load that grows with it from 0, is `load`; `None` if none is.
///
/// Method: secants of ln N over ln δ, nearly a line, from `guess` on; a bisection where two of them did not halve the miss, as
/// where N jumps. As long as every trial carried more than the load, a secant that did not halve the miss is followed by the least
/// approach: bodies that overlap at rest carry more at any. Accuracy: `accuracy`, relative, of the load or of the approach of a jump; 1e-9 mm
/// where all carry more. Cost: some three evaluations for 1e-4,
/// five for 1e-6.
pub fn under_total(
    mut total: impl FnMut(f64) -> f64,
    load: f64,
    guess: f64,
    most: f64,
    accuracy: f64,
) -> Option<f64> {
    let range = [LEAST, most].map(f64::ln);
    let ([mut low, mut high], mut here, mut slope) = (range, guess.ln(), USUAL_SLOPE);
    if !(here >= low && here < high) {
        here = low + (high - low) / 2.0;
    }
    let (mut before, mut misses): (Option<[f64; 2]>, [f64; 2]) = (None, [f64::INFINITY; 2]);
    let mut carries_less = false;
    while high - low > accuracy {
        let miss = (load / total(here.exp())).ln();
        if miss.abs() <= accuracy {
            return Some(here.exp());
        }
        *(if miss > 0.0 { &mut low } else { &mut high }) = here;
        carries_less |= miss > 0.0;
        if let Some([there, missed]) = before.filter(|[_, missed]| missed.is_finite() && miss.is_finite()) {
            slope = ((missed - miss) / (here - there)).clamp(0.5 * USUAL_SLOPE, 4.0 * USUAL_SLOPE);
        }
        before = Some([here, miss]);
        let secant = here + miss / slope;
        let halved = miss.abs() <= 0.5 * misses[usize::from(!carries_less)];
        let inside = secant > low && secant < high && halved;
        here = match inside {
            true => secant,
            false if carries_less => low + (high - low) / 2.0,
            false => low,
        };
        misses = if inside { [misses[1], miss.abs()] } else { [f64::INFINITY; 2] };
    }
    (high < range[1]).then(|| high.exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn approaches_of_growing_loads_are_found() {
        for load in [1e-3, 1.0, 4e4, 1e9] {
            let found =
                under_total(|u| 3e6 * u.powf(1.5) + 1e7 * (u - 0.1).max(0.0), load, 0.05, 100.0, 1e-6);
            let miss = found.map(|u| (3e6 * u.powf(1.5) + 1e7 * (u - 0.1).max(0.0)) / load - 1.0);
            assert!(miss.is_some_and(|miss| miss.abs() < 1e-5), "{load}: {found:?} {miss:?}");
        }
        assert_eq!(under_total(|u| u, 11.0, 0.05, 10.0, 1e-6), None);
        // Bodies that overlap at rest carry more than is asked for at any approach.
        let mut trials = 0;
        let overlap = |u: f64| {
            trials += 1;
            5.0 + u
        };
        assert!(under_total(overlap, 1.0, 0.05, 10.0, 1e-6).is_some_and(|u| u <= LEAST * (1.0 + 1e-12)));
        // From there on one trial is enough.
        assert!(trials <= 3, "{trials}");
        assert_eq!(under_total(|u| 5.0 + u, 1.0, LEAST, 10.0, 1e-6), Some(LEAST.ln().exp()));
        // A load that jumps over the one that is asked for gives the approach of the jump.
        let jump = under_total(|u| if u < 0.2 { u } else { 2.0 + u }, 1.0, 0.05, 10.0, 1e-6);
        assert!(jump.is_some_and(|u| (u - 0.2).abs() < 1e-5), "{jump:?}");
    }
}
