//! Intervals of noise and of repeats.

use super::*;
use wheelrail::measured::noise::{Deviates, POINT_STEP, Remeasured, Spread};

const SIGMA: f64 = 0.02;

fn noisy(samples: usize) -> PointNoise {
    PointNoise { sigma: SIGMA, samples, ..PointNoise::default() }
}

/// The deviation that one profile and its noise predict is that of profiles that were measured again and again.
#[test]
fn noise_predicts_the_scatter_of_repeats() -> Result<()> {
    // Noise of a fit is that of all points, and slower to sample.
    for (name, side, align, quantities) in [
        (
            "S1002",
            Side::Wheel,
            Align::Back,
            [Quantity::FlangeHeight, Quantity::FlangeThickness, Quantity::Qr],
        ),
        ("60E1", Side::Rail, Align::None, [Quantity::W1, Quantity::W2, Quantity::CrownRadius]),
    ] {
        let nominal = if side == Side::Wheel { standards::wheel(name)? } else { standards::rail(name)? };
        let options = MeasureOptions { align: Some(align), ..MeasureOptions::default() };
        let noise = noisy(160);
        let predicted = measure_noisy(&nominal, side, Some(&nominal), &options, &noise)?;
        let again = Remeasured::new(&nominal, side, POINT_STEP)?.drawn_by(&noise.curve);
        let mut deviates = Deviates::new(77, 0);
        let repeats: Result<Vec<Measures>> = (0..40)
            .map(|_| measure(&again.sample(SIGMA, &mut deviates)?, side, Some(&nominal), &options))
            .collect();
        let repeats = repeats?;
        let found = repeated(&repeats.iter().collect::<Vec<_>>())?;
        let findings: Vec<&String> = repeats.iter().flat_map(|of| &of.findings).collect();
        assert!(findings.is_empty(), "{name}: {findings:?}");
        for quantity in quantities {
            let (Some(noise), Some(repeats)) = (predicted.spread(quantity), found.spread(quantity)) else {
                panic!("{quantity:?}: {predicted:?}");
            };
            // Four standard errors of both deviations.
            let most = 4.0 * noise.deviation_error.hypot(repeats.deviation_error);
            assert!(
                (noise.deviation - repeats.deviation).abs() < most,
                "{quantity:?}: {noise:?} {repeats:?}"
            );
            assert!(
                repeats.low < noise.mean && noise.mean < repeats.high,
                "{quantity:?}: {noise:?} {repeats:?}"
            );
            assert!(noise.low_error > 0.0 && noise.low_error < noise.high - noise.low, "{noise:?}");
            assert_eq!((noise.samples, repeats.samples), (160, 40));
        }
    }
    Ok(())
}

#[test]
fn samples_are_the_same_bits_on_any_number_of_threads() -> Result<()> {
    let wheel = standards::wheel("S1002")?;
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let measured = || measure_noisy(&wheel, Side::Wheel, None, &MeasureOptions::default(), &noisy(40));
        pool.expect("threads").install(measured)
    };
    assert_eq!(on(1)?, on(3)?);
    Ok(())
}

/// A rail lowered by known steps: mean, deviation and Student's interval are closed forms.
#[test]
fn repeats_have_the_mean_and_the_interval_of_their_values() -> Result<()> {
    let nominal = standards::rail("60E1")?;
    let options = MeasureOptions { align: Some(Align::None), ..MeasureOptions::default() };
    let one = |down: f64| measure(&nominal.clone().shifted(0.0, -down), Side::Rail, Some(&nominal), &options);
    let repeats = [one(0.9)?, one(1.0)?, one(1.1)?];
    let mean = repeated(&repeats.iter().collect::<Vec<_>>())?;
    let Some(spread) = mean.spread(Quantity::W1) else { panic!("{mean:?}") };
    assert!((value(&mean, Quantity::W1) - 1.0).abs() < 1e-9 && (spread.deviation - 0.1).abs() < 1e-9);
    // t = 4.3027 of two degrees of freedom.
    let reach = 4.302_653 * 0.1 * (4.0f64 / 3.0).sqrt();
    assert!((spread.low - (1.0 - reach)).abs() < 1e-5 && (spread.high - (1.0 + reach)).abs() < 1e-5);
    assert!(mean.findings.is_empty() && mean.alignment.is_none(), "{mean:?}");
    // One of them has no gauge face 14 below the top.
    let cut = worn(&nominal, Side::Rail, |_| [0.0; 2], frame(0.0, 0.0, 0.0), |at| at.z > -10.0);
    let short = measure(&cut, Side::Rail, Some(&nominal), &options)?;
    let mean = repeated(&[&repeats[0], &repeats[1], &short])?;
    assert!(mean.findings.iter().any(|text| text == "w2_mm in 2 of 3 measurements only"), "{mean:?}");
    assert!(repeated(&[&short]).is_err());
    let wheel = measure(&standards::wheel("S1002")?, Side::Wheel, None, &MeasureOptions::default())?;
    assert!(repeated(&[&short, &wheel]).is_err());
    Ok(())
}

#[test]
fn noise_without_meaning_is_refused_and_what_cannot_be_sampled_is_a_finding() -> Result<()> {
    let wheel = standards::wheel("S1002")?;
    let options = MeasureOptions::default();
    let of = |noise: PointNoise| measure_noisy(&wheel, Side::Wheel, None, &options, &noise);
    for (wrong, place) in [
        (PointNoise { sigma: 0.0, ..noisy(40) }, "noise: found 0"),
        (PointNoise { sigma: f64::NAN, ..noisy(40) }, "noise"),
        (PointNoise { step: -0.2, ..noisy(40) }, "noise: step"),
        (PointNoise { step: 500.0, ..noisy(40) }, "noise: step"),
        (noisy(39), "noise: samples"),
    ] {
        let error = of(wrong).expect_err("no meaning").to_string();
        assert!(error.starts_with(place), "{error}");
    }
    // Noise of the size of the flange leaves no curve in any sample.
    let lost = of(PointNoise { sigma: 20.0, ..noisy(40) })?;
    assert!(lost.findings.iter().any(|text| text.contains("noise: every sample")), "{:?}", lost.findings);
    assert!(lost.value(Quantity::FlangeHeight).is_some() && lost.spread(Quantity::FlangeHeight).is_none());
    Ok(())
}

#[test]
fn a_lost_sample_does_not_empty_an_interval() {
    let all = |lost: i32| (0..40).map(move |k| if k < lost { f64::NAN } else { f64::from(k) });
    for lost in [0, 1, 20] {
        let spread = Spread::of(all(lost)).expect("an interval");
        assert_eq!(spread.samples, 40 - lost as usize);
        assert!(spread.low < spread.high && spread.low_error > 0.0, "{spread:?}");
    }
    assert!(Spread::of(all(21)).is_none());
}
