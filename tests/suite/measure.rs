//! Closed forms of drawings, and known wear under a known displacement.

mod headers;
mod known_wear;
mod page;
mod rail;
mod spread;
mod unmeasured;
mod web;

use wheelrail::error::Result;
use wheelrail::measure::*;
use wheelrail::measured::{self, CurveKind};
use wheelrail::nalgebra;
use wheelrail::profile::{Arc, Profile, Section, Segment, Side, Station, standards, trace};

/// Accuracy \[mm\] to which known wear has to be recovered.
const RECOVERED: f64 = 0.01;

fn value(measures: &Measures, quantity: Quantity) -> f64 {
    measures.value(quantity).unwrap_or_else(|| panic!("{quantity:?}: {:?}", measures.findings))
}

/// Moves each point of a nominal that is to be kept by `by`, then turns and moves them all by `frame`.
fn worn(
    nominal: &Profile,
    side: Side,
    by: impl Fn(Station) -> [f64; 2],
    frame: Station,
    keep: impl Fn(Station) -> bool,
) -> Profile {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for mark in trace(nominal, 0.1).into_iter().filter(|mark| keep(mark.station)) {
        let [dx, dz] = by(mark.station);
        let own = mark.station;
        let at = Station { x: own.x + dx, z: own.z + dz, ..own }.placed_by(&frame);
        if points.last().is_none_or(|last| (last[0] - at.x).hypot(last[1] - at.z) > 0.02) {
            points.push([at.x, at.z]);
        }
    }
    let options = measured::Options {
        curve: Some(CurveKind::Interpolation),
        mirror: Some(false),
        flip_z: Some(false),
        ..measured::Options::default()
    };
    measured::of_points("worn", &points, side, &options).expect("points of a profile").profile
}

fn frame(x: f64, z: f64, degrees: f64) -> Station {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Station { x, z, cos, sin }
}

/// A wear of `most` that fades out smoothly between two ends.
fn bump(x: f64, [low, high]: [f64; 2], most: f64) -> f64 {
    if x <= low || x >= high {
        return 0.0;
    }
    most * (std::f64::consts::PI * (x - low) / (high - low)).sin().powi(4)
}

#[test]
fn drawings_have_the_flange_of_their_name() -> Result<()> {
    // EN 13715: S1002 has e = 32.5 and h = 28; EN 15302's drawings have the same flange, except C.
    let measures = measure(&standards::wheel("S1002")?, Side::Wheel, None, &MeasureOptions::default())?;
    assert!((value(&measures, Quantity::FlangeHeight) - 28.0).abs() < 1e-6);
    assert!((value(&measures, Quantity::FlangeThickness) - 32.5).abs() < 1e-3, "{measures:?}");
    assert!(value(&measures, Quantity::Hollow) < 1e-9);
    assert!(measures.findings.is_empty(), "{measures:?}");
    let named = standards::wheel_names().filter(|name| name.starts_with("EN13715"));
    for name in named {
        let [h, e] = ["-h", "-e"].map(|key| {
            let rest = name.split(key).nth(1).expect("a flange in the name");
            rest.split('-').next().and_then(|text| text.parse::<f64>().ok()).expect("a number")
        });
        let measures = measure(&standards::wheel(name)?, Side::Wheel, None, &MeasureOptions::default())?;
        assert!((value(&measures, Quantity::FlangeHeight) - h).abs() < 1e-3, "{name}: {measures:?}");
        assert!((value(&measures, Quantity::FlangeThickness) - e).abs() < 2e-3, "{name}: {measures:?}");
    }
    Ok(())
}

#[test]
fn a_flange_of_lines_has_its_closed_form() -> Result<()> {
    // Back, a tip of 10 mm, a face at 1:2 and a cone of 1:20, in a file's axes with X = 0 at the back.
    let line = |from, to| Arc::line(from, to).map(Segment::arc);
    let wheel = Profile::new(
        "lines",
        "test",
        vec![
            line([0.0, 20.0], [0.5, -25.0])?,
            line([0.5, -25.0], [10.0, -28.0])?,
            line([10.0, -28.0], [20.0, -24.0])?,
            line([20.0, -24.0], [32.0, 0.0])?,
            line([32.0, 0.0], [132.0, 5.0])?,
        ],
    )?;
    let measures = measure(&wheel, Side::Wheel, None, &MeasureOptions::default())?;
    // z(70) = 1.9.
    assert!((value(&measures, Quantity::FlangeHeight) - 29.9).abs() < 1e-9);
    let at = |z: f64| 20.0 + (z + 24.0) / 2.0;
    assert!((value(&measures, Quantity::FlangeThickness) - at(1.9 - 10.0)).abs() < 1e-9);
    assert!((value(&measures, Quantity::Qr) - (at(-8.1) - 15.0)).abs() < 1e-9);
    let back = 0.5 * (20.0 - (1.9 - 14.0)) / 45.0;
    assert!((value(&measures, Quantity::FlangeWidth) - (at(-12.1) - back)).abs() < 1e-9);
    // A turn by 0.1° moves Sh by 60 mm × 0.1°; a shift along x moves it by a twentieth.
    let off = measures.if_off(Quantity::FlangeHeight).expect("a bound");
    assert!((off - 60.0 * 0.1f64.to_radians()).abs() < 1e-3, "{off}");
    Ok(())
}

#[test]
fn known_wear_of_a_wheel_is_recovered() -> Result<()> {
    let nominal = standards::wheel("S1002")?;
    let by = |at: Station| [0.0, bump(at.x, [-32.0, 40.0], 2.5)];
    let exact = bump(0.0, [-32.0, 40.0], 2.5);
    for (x, z, degrees) in [(0.0, 0.0, 0.0), (70.3, -1.2, 0.4), (-20.0, 3.0, -0.9)] {
        let wheel = worn(&nominal, Side::Wheel, by, frame(x, z, degrees), |_| true);
        for align in [Align::BackAndTread, Align::BestFit] {
            let options = MeasureOptions { align: Some(align), ..MeasureOptions::default() };
            let measures = measure(&wheel, Side::Wheel, Some(&nominal), &options)?;
            let [tread, most] = [Quantity::TreadWear, Quantity::TreadWearMax].map(|q| value(&measures, q));
            assert!((tread - exact).abs() < RECOVERED, "{align:?} {degrees}: {tread} {exact} {measures:?}");
            assert!((most - 2.5).abs() < RECOVERED, "{align:?} {degrees}: {most}");
            // The fit moves neither Sh nor Sd nor qR; a turn beyond that of instruments is a finding, and is in what they may be off.
            let own = measure(&wheel, Side::Wheel, None, &MeasureOptions::default())?;
            let unmoved = worn(&nominal, Side::Wheel, by, Station::AXES, |_| true);
            let exact = measure(&unmoved, Side::Wheel, None, &MeasureOptions::default())?;
            for quantity in [Quantity::FlangeHeight, Quantity::FlangeThickness, Quantity::Qr] {
                let [found, alone, truth] = [&measures, &own, &exact].map(|of| value(of, quantity));
                let off = measures.if_off(quantity).expect("a bound");
                assert!(
                    found == alone && (found - truth).abs() < 1.1 * off,
                    "{quantity:?}: {found} {off} {truth}"
                );
            }
            let turned =
                measures.findings.iter().filter(|finding| finding.starts_with("alignment by a turn"));
            assert_eq!(turned.count(), usize::from(f64::abs(degrees) > 0.3), "{:?}", measures.findings);
        }
    }
    Ok(())
}

#[test]
fn hollow_wear_is_the_depth_below_the_field_side() -> Result<()> {
    let nominal = standards::wheel("S1002")?;
    let by = |at: Station| [0.0, bump(at.x, [-25.0, 40.0], 3.0)];
    let wheel = worn(&nominal, Side::Wheel, by, Station::AXES, |_| true);
    let measures = measure(&wheel, Side::Wheel, None, &MeasureOptions::default())?;
    // The highest and the lowest place of the same heights, over points every 0.1 mm.
    let section = Section::own_axes(&nominal, Side::Wheel);
    let height = |x: f64| section.height(x) + bump(x, [-25.0, 40.0], 3.0);
    let (mut top, mut rise) = (f64::NEG_INFINITY, 0.0f64);
    for k in -250..590 {
        let z = height(f64::from(k) * 0.1);
        top = top.max(z);
        rise = rise.max(top - z);
    }
    assert!(rise > 1.0 && (value(&measures, Quantity::Hollow) - rise).abs() < 2e-3, "{rise} {measures:?}");
    Ok(())
}

#[test]
fn a_wheel_that_is_moved_but_not_turned_is_put_on_its_back() -> Result<()> {
    // An upright back above the drawn flange, over which a line is fitted.
    let drawn = standards::wheel("S1002")?;
    let start = drawn.segments()[0].start();
    let mut all = vec![Segment::arc(Arc::line([start.x, 15.0], [start.x, start.z])?)];
    all.extend(drawn.segments().iter().cloned());
    let nominal = Profile::new("S1002 with back", "test", all)?;
    // The flange's face moves in by 1.5 mm; the tread at X = 70 does not.
    let by = |at: Station| [-bump(at.z, [-24.0, -3.0], 1.5) * f64::from(u8::from(at.x > -50.0)), 0.0];
    let exact = measure(
        &worn(&nominal, Side::Wheel, by, Station::AXES, |_| true),
        Side::Wheel,
        Some(&nominal),
        &MeasureOptions { align: Some(Align::Back), ..MeasureOptions::default() },
    )?;
    let thickness = value(&exact, Quantity::FlangeThickness);
    assert!((32.5 - thickness - bump(-10.0, [-24.0, -3.0], 1.5)).abs() < 0.2, "{exact:?}");
    let wheel = worn(&nominal, Side::Wheel, by, frame(70.4, -2.0, 0.0), |_| true);
    for align in [Align::Back, Align::TreadPoint] {
        let measures = measure(
            &wheel,
            Side::Wheel,
            Some(&nominal),
            &MeasureOptions { align: Some(align), ..MeasureOptions::default() },
        )?;
        for quantity in [Quantity::FlangeThickness, Quantity::FlangeHeight, Quantity::Qr] {
            let [own, to] = [&measures, &exact].map(|measures| value(measures, quantity));
            assert!((own - to).abs() < RECOVERED, "{align:?} {quantity:?}: {own} {to}");
        }
        // Heights are the file's by `back`, and those of the nominal's tread by `tread-point`.
        let lowered = if align == Align::Back { -2.0 } else { 0.0 };
        assert!(
            (value(&measures, Quantity::TreadWear) - lowered).abs() < RECOVERED,
            "{align:?}: {measures:?}"
        );
    }
    Ok(())
}

#[test]
fn what_is_not_measured_is_missing_and_says_so() -> Result<()> {
    let nominal = standards::wheel("S1002")?;
    let cut = |low: f64, high: f64| {
        worn(&nominal, Side::Wheel, |_| [0.0; 2], Station::AXES, move |at| at.x >= low && at.x <= high)
    };
    // Without its back there is no Sd, and no X unless x = 0 is at the taping line.
    let measures = measure(&cut(-62.0, 60.0), Side::Wheel, None, &MeasureOptions::default())?;
    assert!((value(&measures, Quantity::FlangeHeight) - 28.0).abs() < 1e-3, "{measures:?}");
    assert!(measures.value(Quantity::FlangeThickness).is_none() && measures.value(Quantity::Qr).is_some());
    let [why, width] = measures.findings.as_slice() else { panic!("{measures:?}") };
    assert!(why.starts_with("no flange back: ") && why.ends_with(": no flange_thickness_mm"), "{why}");
    assert!(width.ends_with(": no flange_width_mm"), "{width}");
    let elsewhere = cut(-62.0, 60.0).shifted(30.0, 0.0);
    let measures = measure(&elsewhere, Side::Wheel, None, &MeasureOptions::default())?;
    assert!(measures.alignment.is_none() && measures.findings[0].contains("no flange back"), "{measures:?}");
    // Without the tread there is no Sh; without the field side no fit.
    let measures = measure(&cut(-70.0, -20.0), Side::Wheel, None, &MeasureOptions::default())?;
    assert!(measures.value(Quantity::FlangeHeight).is_none(), "{measures:?}");
    assert!(measures.findings[0].contains("no tread at X = 70 mm"), "{measures:?}");
    let measures = measure(&cut(-70.0, 30.0), Side::Wheel, Some(&nominal), &MeasureOptions::default())?;
    assert!(measures.findings[0].starts_with("no alignment by flange back and outer tread"), "{measures:?}");
    // What needs no nominal is measured all the same.
    let own = measure(&cut(-70.0, 30.0), Side::Wheel, None, &MeasureOptions::default())?;
    assert!(own.value(Quantity::FlangeThickness).is_some(), "{own:?}");
    for quantity in Quantity::ALL {
        assert_eq!(measures.value(quantity), own.value(quantity), "{quantity:?}");
    }
    // Where the back turns upright 0.4 mm farther left, its place is doubted.
    let measures = measure(&cut(-69.6, 60.0), Side::Wheel, None, &MeasureOptions::default())?;
    assert!(measures.value(Quantity::FlangeThickness).is_some(), "{measures:?}");
    assert!(measures.findings[0].contains("the flange back may lie farther left"), "{measures:?}");
    // A rail with neither field side nor gauge face.
    let rail = standards::rail("60E1")?;
    let crown = worn(&rail, Side::Rail, |_| [0.0; 2], Station::AXES, |at| at.x.abs() < 25.0);
    let measures = measure(&crown, Side::Rail, Some(&rail), &MeasureOptions::default())?;
    assert!(
        measures.value(Quantity::W1).is_none() && measures.findings[0].contains("field side"),
        "{measures:?}"
    );
    assert!(measures.value(Quantity::CrownRadius).is_some(), "{measures:?}");
    let measures = measure(&crown, Side::Rail, None, &MeasureOptions::default())?;
    assert!(
        measures.value(Quantity::CrownRadius).is_some() && measures.value(Quantity::SideFaceAngle).is_none()
    );
    assert!(measures.findings[0].starts_with("no gauge face 14.000 mm below"), "{measures:?}");
    // The other body.
    for (profile, side) in [(&nominal, Side::Rail), (&rail, Side::Wheel)] {
        let measures = measure(profile, side, None, &MeasureOptions::default())?;
        assert!(!measures.findings.is_empty(), "{measures:?}");
    }
    Ok(())
}

#[test]
fn a_worn_field_side_leaves_a_finding() -> Result<()> {
    let nominal = standards::wheel("S1002")?;
    let by = |at: Station| [0.0, if at.x > 44.0 { 0.6 * ((at.x - 50.0) / 2.0).sin() } else { 0.0 }];
    let measures = measure(
        &worn(&nominal, Side::Wheel, by, Station::AXES, |_| true),
        Side::Wheel,
        Some(&nominal),
        &MeasureOptions::default(),
    )?;
    assert!(
        measures.findings.iter().any(|finding| finding.contains("worn, or another nominal")),
        "{measures:?}"
    );
    // Another nominal, with its flange and tread elsewhere.
    let other = standards::wheel("APTA-120")?;
    let measures = measure(&other, Side::Wheel, Some(&nominal), &MeasureOptions::default())?;
    assert!(!measures.findings.is_empty(), "{measures:?}");
    // As if metal had been put on the tread.
    let by = |at: Station| [0.0, -bump(at.x, [-30.0, 40.0], 2.0)];
    let wheel = worn(&nominal, Side::Wheel, by, Station::AXES, |_| true);
    let measures = measure(&wheel, Side::Wheel, Some(&nominal), &MeasureOptions::default())?;
    assert!(measures.findings[0].starts_with("tread_wear_mm is negative"), "{measures:?}");
    Ok(())
}

#[test]
fn a_profile_in_another_unit_is_a_finding() -> Result<()> {
    let crown = Arc::line([-4e3, 0.0], [4e3, 10.0]).map(Segment::arc)?;
    let rail = Profile::new("metres", "test", vec![crown])?;
    let measures = measure(&rail, Side::Rail, Some(&standards::rail("60E1")?), &MeasureOptions::default())?;
    assert!(measures.findings[0].starts_with("the profile is 8000 mm large"), "{measures:?}");
    Ok(())
}

#[test]
fn options_without_meaning_are_refused() -> Result<()> {
    let wheel = standards::wheel("S1002")?;
    let complaint = |options: MeasureOptions, nominal| {
        measure(&wheel, Side::Wheel, nominal, &options).err().map(|error| error.place).unwrap_or_default()
    };
    assert_eq!(complaint(MeasureOptions { tread_at: -70.0, ..MeasureOptions::default() }, None), "tread_at");
    assert_eq!(
        complaint(MeasureOptions { align: Some(Align::Web), ..MeasureOptions::default() }, Some(&wheel)),
        "align"
    );
    assert_eq!(
        complaint(MeasureOptions { align: Some(Align::BestFit), ..MeasureOptions::default() }, None),
        "align"
    );
    assert_eq!(
        complaint(
            MeasureOptions { unworn: vec![[0.0, 1.0].into()], ..MeasureOptions::default() },
            Some(&wheel)
        ),
        "unworn"
    );
    assert_eq!(complaint(MeasureOptions::default(), Some(&wheel)), "");
    Ok(())
}

/// Sd, Sh and qR that instruments wrote beside their points, in files of the repository that `WHEELRAIL_CONTACT` names.
const INSTRUMENTS: [(&str, [f64; 3]); 4] = [
    ("left-wheel-v1-pre-dry.whl", [36.1416, 27.8749, 9.0991]),
    ("right-wheel-v1-pre-dry.whl", [36.3244, 27.9698, 9.1947]),
    ("whl_left_iter288.whl", [36.4023, 28.3512, 5.4454]),
    ("whl_left_iter795.whl", [34.3347, 34.9985, 10.0658]),
];

/// Turn \[rad\] after which the right wheel has the instrument's values, 0.18°: the instrument turns a profile to its reference
/// before it calculates, and writes the points as they were.
const RIGHT_TURNED_BY: f64 = 0.0032;

#[test]
fn instruments_have_the_same_values() -> Result<()> {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT") else { return Ok(()) };
    let profiles = std::path::Path::new(&contact).join("testbank/profiles");
    for (file, expected) in INSTRUMENTS {
        let bytes = wheelrail::files::read_bytes(&profiles.join(file), measured::LARGEST_FILE)?;
        let curve =
            measured::Options { curve: Some(CurveKind::Interpolation), ..measured::Options::default() };
        let read = measured::profile(file, &bytes, Side::Wheel, &curve)?.profile;
        let turn = if file.starts_with("right") { RIGHT_TURNED_BY } else { 0.0 };
        let read = read.rotated(nalgebra::UnitComplex::new(turn));
        let measures = measure(&read, Side::Wheel, None, &MeasureOptions::default())?;
        let found =
            [Quantity::FlangeThickness, Quantity::FlangeHeight, Quantity::Qr].map(|q| value(&measures, q));
        println!("{file}: {found:.4?}, the instrument has {expected:?}");
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 0.05),
            "{file}: {found:?}"
        );
    }
    Ok(())
}
