//! Scans of one side of a whole rail, as laser cars have them, fitted by the web.

use super::*;
use wheelrail::internal::Random;

use crate::campaign::scenes;
use crate::common::repository;
use crate::whole_rails::{Scan, built_in, drawn_at_random, motion};

/// Least distance of the points of a profile \[mm\].
const NEAREST: f64 = 0.18;
/// What an alignment may be off \[mm\] and \[deg\]; three times that is allowed.
const OFF: f64 = 0.1;

fn drawn(points: &[[f64; 2]]) -> Result<Profile> {
    let options = measured::Options {
        curve: Some(CurveKind::Interpolation),
        mirror: Some(false),
        flip_z: Some(false),
        unit: Some(measured::Unit::Millimetre),
        ..measured::Options::default()
    };
    let mut own: Vec<[f64; 2]> = Vec::new();
    for at in points {
        if own.last().is_none_or(|last| (last[0] - at[0]).hypot(last[1] - at[1]) > NEAREST) {
            own.push(*at);
        }
    }
    Ok(measured::of_points("scan", &own, Side::Rail, &options)?.profile)
}

#[test]
fn one_side_of_a_whole_rail_is_fitted_by_its_web() -> Result<()> {
    let web = MeasureOptions { align: Some(Align::Web), ..MeasureOptions::default() };
    let none = MeasureOptions { align: Some(Align::None), ..MeasureOptions::default() };
    let (mut read, mut refused, mut unread, mut worst, mut wrong) = (0, 0, 0, [0f64; 3], Vec::new());
    let count = scenes().div_ceil(4);
    for number in 0..count {
        let mut random = Random::stream(657, number);
        let name = *random.pick(&["60E1", "60E2", "UIC60", "", "", ""]);
        let outline = if name.is_empty() { drawn_at_random(&mut random) } else { built_in(name)? };
        let nominal = if name.is_empty() { drawn(&outline)? } else { standards::rail(name)? };
        let scan = Scan::random(&mut random);
        let Ok(own) = drawn(&scan.points(&outline, &mut random)) else {
            unread += 1;
            continue;
        };
        let measures = measure(&own, Side::Rail, Some(&nominal), &web)?;
        let what = || format!("{number}: {name} {scan:?}: {measures:?}");
        let by = measures.alignment.as_ref().filter(|by| by.align == Align::Web);
        let Some(found) = by.and_then(|by| motion(&by.text)) else {
            refused += 1;
            if measures.findings.is_empty() || measures.value(Quantity::W1).is_some() {
                wrong.push(what());
            }
            continue;
        };
        read += 1;
        let off = [0, 1, 2].map(|k| (found[k] - scan.motion[k]).abs());
        let worn: Vec<[f64; 2]> = outline.iter().map(|at| scan.worn(*at)).collect();
        let exact = measure(&drawn(&worn)?, Side::Rail, Some(&nominal), &none)?;
        let kept = [Quantity::W1, Quantity::W2, Quantity::W3].into_iter().all(|quantity| {
            let pair = measures.value(quantity).zip(exact.value(quantity));
            pair.is_none_or(|(own, exact)| {
                measures.if_off(quantity).is_some_and(|off| (own - exact).abs() <= 3.0 * off)
            })
        });
        worst = std::array::from_fn(|k| worst[k].max(off[k]));
        // The origin lies as far from the web as the top does: a turn moves it.
        if !kept || off[2] > OFF || off[0].max(off[1]) > 3.0 * OFF {
            wrong.push(format!("{off:?} {}", what()));
        }
    }
    println!(
        "{read} read, {refused} refused, {unread} not read as points; off by up to {worst:?} mm, mm, deg"
    );
    assert!(wrong.is_empty(), "{} wrong: {:#?}", wrong.len(), &wrong[..wrong.len().min(8)]);
    assert!(10 * read >= 9 * count, "{refused} refused");
    Ok(())
}

#[test]
fn a_web_of_another_drawing_is_told_of() -> Result<()> {
    let web = MeasureOptions { align: Some(Align::Web), ..MeasureOptions::default() };
    let (mut random, mut read) = (Random::new(540), 0);
    for number in 0..scenes().div_ceil(4) {
        let [own, other] = [drawn_at_random(&mut random), drawn_at_random(&mut random)];
        let scan = Scan::random(&mut random);
        let Ok(own) = drawn(&scan.points(&own, &mut random)) else { continue };
        let measures = measure(&own, Side::Rail, Some(&drawn(&other)?), &web)?;
        assert!(!measures.findings.is_empty(), "{number}: {scan:?} {measures:?}");
        read += 1;
    }
    assert!(2 * read > scenes().div_ceil(4), "{read} read");
    Ok(())
}

#[test]
fn the_scan_of_a_laser_car_is_read() -> Result<()> {
    // One side of a UIC60 whose web is the standard's, and whose foot and underside of the head are not. The motion and W1 that made
    // it are (−2.571, 45.040) mm, −0.800° and 0.8 mm. Noise of 20 µm leaves the fit of a web alone these uncertainties.
    let bytes = std::fs::read(repository("tests/defects/one-sided-scan-worn-moved.txt")).expect("a scan");
    let options = measured::Options {
        curve: Some(CurveKind::Interpolation),
        mirror: Some(false),
        flip_z: Some(false),
        ..measured::Options::default()
    };
    let scan = measured::profile("scan.txt", &bytes, Side::Rail, &options)?.profile;
    let web = MeasureOptions { align: Some(Align::Web), ..MeasureOptions::default() };
    let measures = measure(&scan, Side::Rail, Some(&standards::rail("UIC60")?), &web)?;
    let text = &measures.alignment.as_ref().expect("an alignment").text;
    let [x, z, turn] = motion(text).expect(text);
    assert!((x + 2.571).abs() < 0.06 && (z - 45.040).abs() < 0.06 && (turn + 0.8).abs() < 0.02, "{text}");
    assert!((value(&measures, Quantity::W1) - 0.8).abs() < 0.06, "{measures:?}");
    assert!(
        measures.findings.iter().any(|text| text.contains("the rest is off the nominal")),
        "{measures:?}"
    );
    Ok(())
}
