//! Measures of rails: of drawings, of known wear, of grooves.

use super::*;

#[test]
fn known_wear_of_a_rail_is_recovered() -> Result<()> {
    let nominal = standards::rail("60E1")?;
    // The crown sinks, and the gauge side moves in; both fade out before the field side.
    let by = |at: Station| {
        let side = 2.0 / (1.0 + ((at.x + 20.0) / 2.0).exp());
        let crown = 1.5 / (1.0 + ((at.x - 18.0) / 1.5).exp());
        let upper = 1.0 / (1.0 + ((-20.0 - at.z) / 1.0).exp());
        [side, -crown * upper]
    };
    let straight = worn(&nominal, Side::Rail, by, Station::AXES, |_| true);
    let options = |align| MeasureOptions { align: Some(align), ..MeasureOptions::default() };
    let exact = measure(&straight, Side::Rail, Some(&nominal), &options(Align::None))?;
    assert!((value(&exact, Quantity::W1) - by(Station::AXES)[1].abs()).abs() < 1e-4, "{exact:?}");
    assert!((value(&exact, Quantity::W2) - 2.0).abs() < 0.1);
    for (x, z, degrees) in [(0.0, 0.0, 0.0), (3.0, -2.0, 1.2), (-50.0, 20.0, -1.5)] {
        let rail = worn(&nominal, Side::Rail, by, frame(x, z, degrees), |_| true);
        for align in [Align::FieldSide, Align::BestFit] {
            let measures = measure(&rail, Side::Rail, Some(&nominal), &options(align))?;
            for quantity in [Quantity::W1, Quantity::W2, Quantity::W3] {
                let [own, to] = [&measures, &exact].map(|measures| value(measures, quantity));
                assert!(
                    (own - to).abs() < RECOVERED,
                    "{align:?} {degrees} {quantity:?}: {own} {to} {:?}",
                    measures.alignment
                );
            }
            let area = value(&measures, Quantity::HeadAreaLost);
            assert!((area - value(&exact, Quantity::HeadAreaLost)).abs() < 0.03, "{area} {exact:?}");
            assert!(measures.findings.is_empty(), "{:?}", measures.findings);
        }
    }
    Ok(())
}

#[test]
fn rails_have_the_measures_of_their_drawing() -> Result<()> {
    for name in standards::rail_names() {
        let rail = standards::rail(name)?;
        let measures = measure(
            &rail,
            Side::Rail,
            Some(&rail),
            &MeasureOptions { align: Some(Align::None), ..MeasureOptions::default() },
        )?;
        for quantity in [Quantity::W1, Quantity::W2, Quantity::W3, Quantity::HeadAreaLost, Quantity::Lip] {
            if let Some(value) = measures.value(quantity) {
                assert!(value.abs() < 1e-9, "{name}: {quantity:?} {value}");
            }
        }
    }
    let measures = measure(&standards::rail("60E1")?, Side::Rail, None, &MeasureOptions::default())?;
    assert!((value(&measures, Quantity::CrownRadius) - 300.0).abs() < 1e-6, "{measures:?}");
    // The flank is 1:20; the corner's end at its top changes the line a little.
    assert!(
        (value(&measures, Quantity::SideFaceAngle) - 0.05f64.atan().to_degrees()).abs() < 0.05,
        "{measures:?}"
    );
    Ok(())
}

/// 60E1 with a plain underside and web at both sides.
fn with_web() -> Result<Profile> {
    let head = standards::rail("60E1")?;
    let line = |from, to| Arc::line(from, to).map(Segment::arc);
    let ends = head.segments().first().zip(head.segments().last());
    let (left, right) = ends.map(|(first, last)| (first.start(), last.end())).expect("segments");
    let (under, foot) = ([-12.0, -48.0], [-8.5, -90.0]);
    let mirrored = |[x, z]: [f64; 2]| [-x, z];
    let mut all = vec![line(foot, under)?, line(under, [left.x, left.z])?];
    all.extend(head.segments().iter().cloned());
    all.push(line([right.x, right.z], mirrored(under))?);
    all.push(line(mirrored(under), mirrored(foot))?);
    Profile::new("60E1 with web", "test", all)
}

#[test]
fn known_wear_of_a_head_worn_at_both_sides_is_recovered_by_its_web_and_by_given_ranges() -> Result<()> {
    let nominal = with_web()?;
    // The whole head above its flanks sinks, and both faces move in.
    let by = |at: Station| {
        let upper = 1.0 / (1.0 + ((-25.0 - at.z) / 1.0).exp());
        [-1.2 * upper * (at.x / 5.0).tanh(), -2.0 * upper]
    };
    let none = MeasureOptions { align: Some(Align::None), ..MeasureOptions::default() };
    let straight = worn(&nominal, Side::Rail, by, Station::AXES, |_| true);
    let exact = measure(&straight, Side::Rail, Some(&nominal), &none)?;
    assert!((value(&exact, Quantity::W1) - 2.0).abs() < 1e-3, "{exact:?}");
    let rail = worn(&nominal, Side::Rail, by, frame(4.0, -3.0, 1.0), |_| true);
    let web = MeasureOptions { align: Some(Align::Web), ..MeasureOptions::default() };
    let measures = measure(&rail, Side::Rail, Some(&nominal), &web)?;
    for quantity in [Quantity::W1, Quantity::W2, Quantity::W3] {
        let [own, to] = [&measures, &exact].map(|measures| value(measures, quantity));
        assert!((own - to).abs() < RECOVERED, "{quantity:?}: {own} {to} {:?}", measures.alignment);
    }
    // A turn by 1° is neither an instrument's nor an inclination in use.
    let [finding] = measures.findings.as_slice() else { panic!("{:?}", measures.findings) };
    assert!(finding.starts_with("alignment by a turn of -1.000 deg"), "{finding}");
    // Ranges of a head that is worn at its gauge side only.
    let by = |at: Station| [2.0 / (1.0 + ((at.x + 15.0) / 1.5).exp()), 0.0];
    let head = standards::rail("60E1")?;
    let exact =
        measure(&worn(&head, Side::Rail, by, Station::AXES, |_| true), Side::Rail, Some(&head), &none)?;
    let rail = worn(&head, Side::Rail, by, frame(-6.0, 2.0, -0.8), |_| true);
    let ranges = MeasureOptions {
        align: Some(Align::Unworn),
        unworn: vec![[5.0, 40.0].into()],
        ..MeasureOptions::default()
    };
    let measures = measure(&rail, Side::Rail, Some(&head), &ranges)?;
    for quantity in [Quantity::W1, Quantity::W2, Quantity::W3] {
        let [own, to] = [&measures, &exact].map(|measures| value(measures, quantity));
        assert!((own - to).abs() < RECOVERED, "{quantity:?}: {own} {to} {:?}", measures.alignment);
    }
    Ok(())
}

#[test]
fn a_grooved_rail_has_its_groove_and_its_lip() -> Result<()> {
    let line = |from, to| Arc::line(from, to).map(Segment::arc);
    // A keeper 5 mm below the top, a groove of 40 mm, a face with 1 mm of flow over it, a flat crown.
    let grooved = |keeper: f64| -> Result<Profile> {
        Profile::new(
            "grooved",
            "test",
            vec![
                line([-100.0, -30.0], [-99.0, -5.0])?,
                line([-99.0, -5.0], [keeper - 1.0, -5.0])?,
                line([keeper - 1.0, -5.0], [keeper + 1.0, -47.0])?,
                line([keeper + 1.0, -47.0], [-36.0, -46.0])?,
                line([-36.0, -46.0], [-36.0, -12.0])?,
                line([-36.0, -12.0], [-37.0, -10.0])?,
                line([-37.0, -10.0], [-20.0, -0.5])?,
                line([-20.0, -0.5], [0.0, 0.0])?,
                line([0.0, 0.0], [36.0, -2.0])?,
                line([36.0, -2.0], [36.5, -30.0])?,
            ],
        )
    };
    let keeper = |x: f64| x - 1.0 + 2.0 * 9.0 / 42.0;
    let measures = measure(
        &grooved(-77.0)?,
        Side::Rail,
        Some(&grooved(-76.0)?),
        &MeasureOptions { align: Some(Align::None), ..MeasureOptions::default() },
    )?;
    assert!((value(&measures, Quantity::GrooveWidth) - (-36.0 - keeper(-77.0))).abs() < 1e-9, "{measures:?}");
    assert!((value(&measures, Quantity::GrooveDepth) - 47.0).abs() < 1e-9);
    assert!((value(&measures, Quantity::KeeperWear) - 1.0).abs() < 1e-9);
    assert!((value(&measures, Quantity::Lip) - 1.0).abs() < 1e-9);
    Ok(())
}
