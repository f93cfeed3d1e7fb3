//! Tests what curves through or near measured points do to waves, noise and corners.

use super::*;

#[test]
fn a_step_that_takes_too_many_points_is_an_error() -> Result<()> {
    for profile in [standards::rail("60E1")?, standards::wheel("EN15302-A")?] {
        let error = write::sample(&profile, 1e-9).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.starts_with("step: found 0.000000001 mm, which takes "), "{error}");
    }
    Ok(())
}

#[test]
fn smoothing_halves_a_wave_of_the_cutoff_length_whatever_the_spacing() -> Result<()> {
    for spacing in [0.05, 0.2, 0.8] {
        let points: Vec<[f64; 2]> = (0..=(100.0 / spacing) as usize)
            .map(|k| {
                let x = spacing * k as f64 - 50.0;
                [x, 0.01 * (std::f64::consts::TAU * x / 5.0).cos() - x * x / 600.0]
            })
            .collect();
        let text = write::points(&points, Format::Text, Side::Rail, "wave");
        let options = Options { mirror: Some(false), cutoff_wavelength: Some(5.0), ..Options::default() };
        let smooth = profile("wave.txt", text.as_bytes(), Side::Rail, &options)?.profile;
        let section = Section::own_axes(&smooth, Side::Rail);
        // The height between crest and trough, 2.5 mm apart, without the drop of the parabola.
        let height = section.height(0.0) - section.height(2.5) - 2.5f64.powi(2) / 600.0;
        assert!((height / 0.02 - 0.5).abs() < 0.015, "{spacing}: {height}");
    }
    Ok(())
}

#[test]
fn interpolation_passes_through_every_point_and_joins_to_rounding() -> Result<()> {
    let (_, points) = s1002(0.5)?;
    let text = write::points(&points, Format::Csv, Side::Wheel, "");
    let options = Options { curve: Some(CurveKind::Interpolation), ..Options::default() };
    let found = profile("s1002.csv", text.as_bytes(), Side::Wheel, &options)?;
    assert_eq!(found.profile.segments().len(), points.len() - 1);
    for (segment, point) in found.profile.segments().iter().zip(&points) {
        assert_eq!([segment.start().x, segment.start().z], *point);
    }
    for joint in found.profile.continuity() {
        assert!(
            joint.gap < 1e-13 && joint.kink.abs() < 1e-12 && joint.curvature_jump.abs() < 1e-10,
            "{joint:?}"
        );
    }
    Ok(())
}

#[test]
fn smoothing_keeps_clean_points_and_a_chain_of_arcs_its_tolerance() -> Result<()> {
    let (wheel, points) = s1002(0.25)?;
    let text = write::points(&points, Format::Csv, Side::Wheel, "");
    let smooth = profile("s1002.csv", text.as_bytes(), Side::Wheel, &Options::default())?;
    assert!(smooth.record.curve.corners.is_empty(), "{:?}", smooth.record.curve);
    // The curvature jumps by 1/13 + 1/20 mm⁻¹ on the 70° flank, and (λ_c/2π)² = 0.63 mm².
    let worst = difference(&smooth.profile, &wheel, Side::Wheel, [-60.0, 50.0]);
    assert!(worst < 0.03, "{worst} {:?}", smooth.record.curve);
    for tolerance in [0.001, 0.01, 0.05] {
        let options =
            Options { curve: Some(CurveKind::Arcs), arc_tolerance: Some(tolerance), ..Options::default() };
        let found = profile("s1002.csv", text.as_bytes(), Side::Wheel, &options)?;
        let residual = found.record.curve.residual.as_ref().map_or(f64::NAN, |r| r.largest);
        assert!(residual <= tolerance, "{residual}");
        let worst = difference(&found.profile, &wheel, Side::Wheel, [-69.0, 59.0]);
        // A difference in height is the distance over the cosine of the slope, here that of a 70° flank.
        assert!(worst < 4.0 * tolerance, "{tolerance}: {worst}");
        let n = found.profile.segments().len();
        assert!(n <= if tolerance < 0.002 { 60 } else { 30 }, "{tolerance}: {n} segments");
        for joint in found.profile.continuity() {
            assert!(joint.gap < 1e-12 && joint.kink.abs() < 1e-12, "{joint:?}");
        }
    }
    Ok(())
}

#[test]
fn noise_is_smoothed_and_the_corner_of_a_new_wheel_stays() -> Result<()> {
    // A roof of 40° with noise of 5 µm from a linear congruential generator.
    let mut seed = 12_345u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.005 * ((seed >> 11) as f64 / 2f64.powi(52) - 1.0)
    };
    let points: Vec<[f64; 2]> = (-200..=200)
        .map(|k| {
            let x = 0.1 * f64::from(k);
            [x, -x.abs() * 20f64.to_radians().tan() + noise()]
        })
        .collect();
    let text = write::points(&points, Format::Text, Side::Rail, "roof");
    let options = Options { mirror: Some(false), ..Options::default() };
    let found = profile("roof.txt", text.as_bytes(), Side::Rail, &options)?;
    let corners = &found.record.curve.corners;
    assert_eq!(corners.len(), 1, "{corners:?}");
    assert!(corners[0].point[0].abs() < 0.11 && (corners[0].angle + 40f64.to_radians()).abs() < 0.03);
    let kinks: Vec<_> = found.profile.continuity().into_iter().filter(|j| j.kink.abs() > 0.01).collect();
    assert!(kinks.len() == 1 && kinks[0].gap < 1e-13, "{kinks:?}");
    Ok(())
}
