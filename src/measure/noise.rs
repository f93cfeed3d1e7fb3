//! How far noise of the points spreads the quantities of a profile: seeded samples of the whole measurement.

use super::measures::Measures;
use super::measuring::{laid, measure};
use super::nominal::{Nominal, sized};
use super::options::MeasureOptions;
use super::quantity::Quantity;
use crate::error::{Error, Result, finite};
use crate::measured::noise::{Deviates, POINT_STEP, Remeasured, Sampled, check_samples, sampled};
use crate::measured::{CurveKind, Options};
use crate::profile::{Profile, Side};

/// Noise of the points of a profile, and how it is sampled.
#[derive(Debug, Clone, PartialEq)]
pub struct PointNoise {
    /// Standard deviation of the points across the profile \[mm\].
    pub sigma: f64,
    /// Distance of the points \[mm\]; 0.2.
    pub step: f64,
    /// Number of samples; 400.
    pub samples: usize,
    /// Seed of the samples; 1.
    pub seed: u64,
    /// How the curve of each sample is drawn: kind of curve, cut-off wavelength \[mm\], kink angle and tolerance of these options count.
    /// Give those of the profile itself, so that the interval is of the same curve as the value. Interpolation by default.
    pub curve: Options,
}

impl Default for PointNoise {
    fn default() -> Self {
        let curve = Options { curve: Some(CurveKind::Interpolation), ..Options::default() };
        Self { sigma: 0.0, step: POINT_STEP, samples: 400, seed: 1, curve }
    }
}

impl PointNoise {
    /// Rejects noise without meaning.
    ///
    /// # Errors
    /// A deviation or a step that is not positive; a number of samples that gives no interval.
    pub fn validate(&self) -> Result<()> {
        for (name, value) in [("noise", self.sigma), ("noise: step", self.step)] {
            if finite(name, value)? <= 0.0 {
                return Err(Error::new(name, value.to_string(), "a positive number of mm", "give 0.02"));
            }
        }
        check_samples(self.samples)
    }
}

/// Measures a profile as [`measure`] does, and finds how far noise of its points spreads each quantity, its alignment included: the
/// profile is taken as points at equal distances, which are moved across it at random, drawn through and measured anew.
///
/// The interval of [`Measures::spread`] holds 95 % of the samples; any number of threads gives the same bits. Systematic errors of
/// an instrument are not in it. Cost: the samples times about 10 ms, with a fit 100 ms, over the threads of the current rayon pool.
///
/// # Errors
/// Options or noise without meaning; a profile shorter than two steps. Samples that cannot be measured are a finding.
///
/// # Examples
/// ```
/// use wheelrail::measure::{MeasureOptions, PointNoise, Quantity, measure_noisy};
/// use wheelrail::{Side, standards};
///
/// let noise = PointNoise { sigma: 0.02, samples: 40, ..PointNoise::default() };
/// let wheel = standards::wheel("S1002")?;
/// let measures = measure_noisy(&wheel, Side::Wheel, None, &MeasureOptions::default(), &noise)?;
/// let width = measures.spread(Quantity::FlangeWidth).expect("a spread");
/// assert!(width.low < 30.35 && 30.35 < width.high && width.high - width.low < 0.15);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn measure_noisy(
    profile: &Profile,
    side: Side,
    nominal: Option<&Profile>,
    options: &MeasureOptions,
    noise: &PointNoise,
) -> Result<Measures> {
    noise.validate()?;
    let mut measures = measure(profile, side, nominal, options)?;
    if measures.alignment.is_none() {
        return Ok(measures);
    }
    // A bad nominal has ended above: it leaves no alignment.
    let nominal = nominal.and_then(|nominal| Nominal::new(nominal, side).ok());
    let again = Remeasured::new(profile, side, noise.step).map_err(|error| error.within("noise"))?;
    let again = again.drawn_by(&noise.curve);
    let sample = |deviates: &mut Deviates| {
        quantities(&again.sample(noise.sigma, deviates)?, side, nominal.as_ref(), options)
    };
    let Sampled { failed, spreads } = match sampled(noise.samples, noise.seed, sample) {
        Ok(sampled) => sampled,
        Err(error) => {
            measures.findings.push(error.to_string());
            return Ok(measures);
        }
    };
    let all = noise.samples;
    if failed > 0 {
        measures.findings.push(format!("noise: {failed} of {all} samples cannot be measured"));
    }
    for quantity in Quantity::ALL {
        let have = spreads[quantity as usize].map_or(0, |spread| spread.samples);
        if have + failed < all && measures.value(quantity).is_some() {
            let key = quantity.key();
            measures.findings.push(format!("noise: {} of {all} samples have no {key}", all - failed - have));
        }
    }
    measures.spreads = spreads;
    Ok(measures)
}

/// Gives the quantities of a sample; NaN where there is none.
fn quantities(
    sample: &Profile,
    side: Side,
    nominal: Option<&Nominal>,
    options: &MeasureOptions,
) -> Result<[f64; Quantity::ALL.len()]> {
    let error = |why| Error::new("", why, "a profile that can be measured", "give less noise");
    let laid = sized(sample).and_then(|curve| laid(&curve, side, nominal, options)).map_err(error)?;
    Ok(laid.found(options).values().map(|value| value.unwrap_or(f64::NAN)))
}
