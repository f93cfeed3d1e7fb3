//! What repeated measurements of one profile tell.

use super::measures::Measures;
use super::quantity::Quantity;
use crate::error::{Error, Result};
use crate::measured::noise::Spread;

/// Gives the mean of each quantity over repeated measurements of one profile, and its spread: the interval in which a further
/// measurement lies with 95 %, by Student's t. Differences of alignment are part of the spread. `if_off` is the
/// largest of all.
///
/// A quantity that some measurements do not have is the mean of the others, with a finding; if only one has it, there is no spread.
///
/// # Errors
/// Fewer than two measurements; two bodies.
///
/// # Examples
/// ```
/// use wheelrail::measure::{MeasureOptions, Quantity, measure, repeated};
/// use wheelrail::{Side, standards};
///
/// let of = |name| measure(&standards::wheel(name)?, Side::Wheel, None, &MeasureOptions::default());
/// let both = [of("EN13715-S1002-h28-e32.5-6.7%")?, of("EN13715-S1002-h30-e32.5-6.7%")?];
/// let mean = repeated(&both.iter().collect::<Vec<_>>())?;
/// assert!((mean.value(Quantity::FlangeHeight).expect("a mean") - 29.0).abs() < 1e-3);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn repeated(measures: &[&Measures]) -> Result<Measures> {
    let [first, _, ..] = measures else {
        let found = format!("{} that can be measured", measures.len());
        return Err(Error::new("repeats", found, "two measurements or more", "give the others, too"));
    };
    if measures.iter().any(|own| own.side != first.side) {
        return Err(Error::new("repeats", "wheels and rails", "one profile", "give the files of one"));
    }
    let mut out = Measures::empty(first.side);
    for quantity in Quantity::ALL {
        let values: Vec<f64> = measures.iter().filter_map(|own| own.value(quantity)).collect();
        if values.is_empty() {
            continue;
        }
        let k = quantity as usize;
        out.values[k] = Some(values.iter().sum::<f64>() / values.len() as f64);
        out.spreads[k] = Spread::of_repeats(values.iter().copied());
        out.if_off[k] = measures.iter().filter_map(|own| own.if_off(quantity)).reduce(f64::max);
        if values.len() < measures.len() {
            let (some, all) = (values.len(), measures.len());
            out.findings.push(format!("{} in {some} of {all} measurements only", quantity.key()));
        }
    }
    Ok(out)
}
