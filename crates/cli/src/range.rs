//! Reads FROM:TO, a range, and FROM:TO:STEP, the places of a sweep or a march.

use wheelrail::Interval;
use wheelrail::error::{Error, Result};

/// Most positions of one sweep or march. They and their results take a GiB.
pub(super) const MOST_POSITIONS: usize = 10_000_000;

/// Largest displacement \[mm\] or angle \[rad\]. It is far beyond any track, and its sums do not overflow.
pub(super) const FARTHEST: f64 = 1e9;

/// Most decimals with which a number is treated as a decimal one. Doubles of a millimetre and more have no more digits.
const MOST_DECIMALS: i32 = 15;

/// Reads FROM:TO; `example` is what an error advises.
pub(super) fn interval((unit, example): (&str, &str), option: &str, text: &str) -> Result<Interval> {
    let bad =
        || Error::new(option, text, format!("FROM:TO in {unit}"), format!("for example {option} {example}"));
    numbers::<2>(text).map(Interval::from).ok_or_else(bad)
}

/// Reads N numbers with colons between; `None` of anything else.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parts = text.split(':').map(|part| part.trim().parse().ok()).collect::<Option<Vec<f64>>>()?;
    parts.try_into().ok()
}

/// Reads FROM:TO:STEP in mm: FROM and every step up to TO, which is included if a step ends there. Each position is the
/// double nearest to its decimal number, so that it is printed as that number.
pub(super) fn range(option: &str, text: &str) -> Result<Vec<f64>> {
    range_in(("mm", "-8:8:0.1"), option, text)
}

/// Reads FROM:TO:STEP in `unit`; `example` is what an error advises.
pub(super) fn range_in((unit, example): (&str, &str), option: &str, text: &str) -> Result<Vec<f64>> {
    let bad = || {
        let expected = format!("FROM:TO:STEP in {unit} with FROM <= TO within ±{FARTHEST:e} and STEP > 0");
        Error::new(option, text, expected, format!("for example {option} {example}"))
    };
    let Some([from, to, step]) = numbers(text) else { return Err(bad()) };
    if !(-FARTHEST <= from && from <= to && to <= FARTHEST && step.is_finite() && step > 0.0) {
        return Err(bad());
    }
    // A last step that ends within a millionth of TO ends at TO.
    let steps = ((to - from) / step + 1e-6).floor();
    check_count(option, steps + 1.0)?;
    let at = positions_of(from, step, to);
    Ok((0..=steps as usize).map(|k| at(k as f64).min(to)).collect())
}

/// Returns the function k ↦ from + k·step. If both are decimal numbers, it is one division of whole numbers, so that no
/// rounding shows. If they have too many digits, it is the rounded sum.
fn positions_of(from: f64, step: f64, to: f64) -> impl Fn(f64) -> f64 {
    /// Whole numbers below this are exact doubles.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let decimal = |scale: f64| {
        let small = [from, step, to].iter().all(|v| (v * scale).abs() < EXACT);
        small && [from, step].iter().all(|v| (v * scale).round() / scale == *v)
    };
    let scale = (0..=MOST_DECIMALS).map(|decimals| 10f64.powi(decimals)).find(|&scale| decimal(scale));
    move |k| match scale {
        Some(scale) => ((from * scale).round() + k * (step * scale).round()) / scale,
        None => from + step * k,
    }
}

pub(super) fn check_count(place: &str, count: f64) -> Result<()> {
    if count <= MOST_POSITIONS as f64 {
        return Ok(());
    }
    let expected = format!("at most {MOST_POSITIONS} positions");
    Err(Error::new(place, format!("{count:e} positions"), expected, "take a larger step, or several sweeps"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_printed_as_they_were_asked_for() -> Result<()> {
        let printed = |text: &str| -> Result<Vec<String>> {
            Ok(range("--lateral", text)?.iter().map(f64::to_string).collect())
        };
        assert_eq!(printed("0:1:0.3")?, ["0", "0.3", "0.6", "0.9"]);
        assert_eq!(printed("1e-3:0.004:1e-3")?, ["0.001", "0.002", "0.003", "0.004"]);
        assert_eq!(printed("-0.1:0.2:0.1")?, ["-0.1", "0", "0.1", "0.2"]);
        assert_eq!(printed("0.25:0.25:7")?, ["0.25"]);
        for text in ["-6:6:0.01", "-8:8:0.1", "-0.7:0.7:0.007"] {
            let all = range("--lateral", text)?;
            assert!(all.iter().zip(all.iter().rev()).all(|(a, b)| *a == -b), "{text}");
            assert!(all.iter().all(|v| v.to_string().len() <= 6), "{text}: {all:?}");
        }
        // A third has too many decimals. The range ends at TO all the same.
        let third = range("--lateral", "0:1:0.33333333333333333")?;
        assert!(third.len() == 4 && third[3] == 1.0 && (third[2] - 2.0 / 3.0).abs() < 1e-15, "{third:?}");
        Ok(())
    }

    #[test]
    fn too_many_positions_and_bad_ranges_are_errors() {
        for bad in ["0:1:1e-9", "0:1:1e-300"] {
            assert!(
                range("--lateral", bad).is_err_and(|e| e.expected == "at most 10000000 positions"),
                "{bad}"
            );
        }
        for bad in [
            "",
            "0:1",
            "0:1e10:1e9",
            "0:1:0",
            "1:0:1",
            "0:1:x:0.5",
            "nan:1:1",
            "0:inf:1",
            "0:1:inf",
            "0:1:0.5:2",
        ] {
            assert!(range("--lateral", bad).is_err_and(|e| e.expected.starts_with("FROM:TO:STEP")), "{bad}");
        }
    }
}
