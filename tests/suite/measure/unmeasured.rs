//! What lies in a gap, noise on a tread, other nominals.

use super::*;
use wheelrail::internal::Random;

use crate::campaign::scenes;

/// Points of a profile every 0.2 mm, moved across it by noise.
fn noisy(profile: &Profile, sigma: f64, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random::stream(2, seed);
    let mut next = 0.0;
    let mut points = Vec::new();
    for mark in trace(profile, 0.02) {
        if mark.s >= next {
            next = mark.s + 0.2;
            let (at, off) = (mark.station, sigma * random.normal());
            points.push([at.x - off * at.sin, at.z + off * at.cos]);
        }
    }
    points
}

fn drawn(points: &[[f64; 2]], side: Side) -> Result<Profile> {
    drawn_by(CurveKind::Interpolation, points, side)
}

fn drawn_by(curve: CurveKind, points: &[[f64; 2]], side: Side) -> Result<Profile> {
    let options = measured::Options {
        curve: Some(curve),
        cutoff_wavelength: (curve == CurveKind::Smoothing).then_some(5.0),
        mirror: Some(false),
        flip_z: Some(false),
        ..measured::Options::default()
    };
    Ok(measured::of_points("points", points, side, &options)?.profile)
}

#[test]
fn what_lies_in_a_gap_has_no_value() -> Result<()> {
    let nominal = standards::wheel("S1002")?;
    let whole = measure(&nominal, Side::Wheel, None, &MeasureOptions::default())?;
    for number in 0..scenes() {
        let mut random = Random::stream(24, number);
        let (middle, half) = (random.between(-68.0, 55.0), random.between(4.0, 13.0));
        let mut points = noisy(&nominal, 0.0, number);
        // The back and the face share their abscissas, so that the gap is cut along the path.
        let from = points.iter().position(|at| at[0] > middle - half).unwrap_or(0).max(1);
        let to = points.iter().position(|at| at[0] > middle + half).unwrap_or(points.len());
        points.drain(from..to.min(points.len() - 1));
        let cut = drawn(&points, Side::Wheel)?;
        for nominal in [None, Some(&nominal)] {
            let measures = measure(&cut, Side::Wheel, nominal, &MeasureOptions::default())?;
            for quantity in
                [Quantity::FlangeHeight, Quantity::FlangeThickness, Quantity::Qr, Quantity::Hollow]
            {
                match measures.value(quantity) {
                    Some(own) => assert!(
                        (own - value(&whole, quantity)).abs() < 0.02,
                        "{number}: {middle} {half} {quantity:?} {own}"
                    ),
                    None => {
                        assert!(measures.findings.iter().any(|text| text.contains("gap")), "{measures:?}")
                    }
                }
            }
        }
    }
    // The tip, of the file of the form.
    let mut points = noisy(&nominal, 0.0, 0);
    points.retain(|at| (at[0] + 56.0).abs() > 11.0 || at[1] > -14.0);
    let measures =
        measure(&drawn(&points, Side::Wheel)?, Side::Wheel, Some(&nominal), &MeasureOptions::default())?;
    assert!(measures.value(Quantity::FlangeHeight).is_none() && measures.value(Quantity::Qr).is_none());
    assert!(measures.value(Quantity::TreadWear).is_some(), "{measures:?}");
    Ok(())
}

#[test]
fn noise_makes_no_hollow_tread_and_no_other_crown() -> Result<()> {
    let [wheel, rail] = [standards::wheel("S1002")?, standards::rail("60E1")?];
    let mut fits = 0;
    for number in 0..scenes() {
        let sigma = [0.005, 0.01, 0.02, 0.03][number as usize % 4];
        // Whoever smooths the points before takes no noise away: half of them do.
        let kind = if number / 4 % 2 == 0 { CurveKind::Interpolation } else { CurveKind::Smoothing };
        let own = drawn_by(kind, &noisy(&wheel, sigma, number), Side::Wheel)?;
        let measures = measure(&own, Side::Wheel, Some(&wheel), &MeasureOptions::default())?;
        let (hollow, off) = (value(&measures, Quantity::Hollow), measures.if_off(Quantity::Hollow));
        assert!(hollow < 0.03 && off.is_some_and(|off| hollow <= 3.0 * off), "{number}: {hollow} {off:?}");
        fits += usize::from(measures.value(Quantity::TreadWear).is_some());
        let own = drawn_by(kind, &noisy(&rail, sigma, number), Side::Rail)?;
        let measures = measure(&own, Side::Rail, Some(&rail), &MeasureOptions::default())?;
        let (radius, off) = (value(&measures, Quantity::CrownRadius), measures.if_off(Quantity::CrownRadius));
        assert!(off.is_some_and(|off| (radius - 300.0).abs() <= 3.0 * off), "{number}: {radius} {off:?}");
    }
    assert_eq!(fits, scenes() as usize, "a fit does not settle");
    Ok(())
}

#[test]
fn another_built_in_that_fits_better_is_named_with_both_residuals() -> Result<()> {
    for (name, wrong) in [("60E1", "60E2"), ("60E2", "60E1"), ("54E1", "60E1"), ("60E1", "49E1")] {
        let rail = standards::rail(name)?;
        for sigma in [0.0, 0.02] {
            let own = drawn(&noisy(&rail, sigma, 1), Side::Rail)?;
            let measures =
                measure(&own, Side::Rail, Some(&standards::rail(wrong)?), &MeasureOptions::default())?;
            assert!(measures.value(Quantity::W1).is_none(), "{name} on {wrong}: {measures:?}");
            assert!(!measures.findings.is_empty());
            let right = measure(&own, Side::Rail, Some(&rail), &MeasureOptions::default())?;
            assert!(
                value(&right, Quantity::W1).abs() < 0.01 && right.findings.is_empty(),
                "{name}: {right:?}"
            );
        }
    }
    let measures = measure(
        &standards::rail("60E1")?,
        Side::Rail,
        Some(&standards::rail("60E2")?),
        &MeasureOptions::default(),
    )?;
    let finding = &measures.findings[0];
    assert!(finding.starts_with("60E1 fits better, with a residual of 0.000 mm over "), "{finding}");
    assert!(finding.contains("than the nominal 60E2 with "), "{finding}");
    Ok(())
}
