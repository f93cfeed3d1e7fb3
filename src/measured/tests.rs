//! Tests what lies between the bytes of a file and its profile: readers, repairs, and what a file says of itself. Whole files are
//! tested in tests/suite.

use super::*;
use crate::profile::standards;

mod mutations;

const FILES: [(&str, &[u8], Side); 9] = [
    ("new-style.ban", include_bytes!("../../tests/profiles/new-style.ban"), Side::Rail),
    ("old-style.whl", include_bytes!("../../tests/profiles/old-style.whl"), Side::Wheel),
    ("sections.mpt", include_bytes!("../../tests/profiles/sections.mpt"), Side::Rail),
    ("design.ban", include_bytes!("../../tests/profiles/design.ban"), Side::Rail),
    ("wheel.prw", include_bytes!("../../tests/profiles/wheel.prw"), Side::Wheel),
    ("wheel.wheel", include_bytes!("../../tests/profiles/wheel.wheel"), Side::Wheel),
    ("rail.csv", include_bytes!("../../tests/profiles/rail.csv"), Side::Rail),
    ("rail.txt", include_bytes!("../../tests/profiles/rail.txt"), Side::Rail),
    ("rail.prr", include_bytes!("../../tests/profiles/rail.prr"), Side::Rail),
];

#[test]
fn simpack_files_have_the_material_to_the_right_of_their_path_and_points_apart() -> Result<()> {
    for (side, drawn) in [(Side::Wheel, standards::wheel("S1002")?), (Side::Rail, standards::rail("60E1")?)] {
        for step in [0.05, 0.2, 1.7] {
            let points = write::spaced(&write::sample(&drawn, step)?);
            let text = write::points(&points, Format::Simpack, side, "");
            assert!(text.contains("inversion      =  0"));
            let read = read::reader::read(text.as_bytes(), Format::Simpack, None)?.at;
            // The path of a wheel goes to smaller y where its surface faces the other body; the path of a rail goes to
            // larger y.
            let lowest = match side {
                Side::Wheel => (1..read.len() - 1).max_by(|&a, &b| read[a].z.total_cmp(&read[b].z)),
                Side::Rail => (1..read.len() - 1).min_by(|&a, &b| read[a].z.total_cmp(&read[b].z)),
            };
            let Some(k) = lowest else { unreachable!("points") };
            assert_eq!(read[k + 1].x < read[k - 1].x, side == Side::Wheel);
            let near = |pair: &[Point]| clean::checks::distance(&pair[0], &pair[1]) < write::LEAST_DISTANCE;
            assert!(!read.windows(2).any(near), "{side:?} {step}");
            let options = Options { curve: Some(CurveKind::Interpolation), ..Options::default() };
            let name = if side == Side::Wheel { "a.prw" } else { "a.prr" };
            let back = profile(name, text.as_bytes(), side, &options)?;
            let back: Vec<[f64; 2]> = back.points.iter().map(|p| p.xz()).collect();
            assert_eq!(back, points, "{side:?} {step}");
        }
    }
    let close = [[0.0, 0.0], [0.005, 0.0], [1.0, 0.0], [1.995, 0.0], [2.0, 0.0]];
    assert_eq!(write::spaced(&close), [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]);
    Ok(())
}

/// Returns points of a wave on a crown of 100 mm radius, 60 mm wide.
fn flat(wave: impl Fn(f64) -> f64) -> Vec<Point> {
    (0..300)
        .map(|k| {
            let x = -30.0 + 0.2 * f64::from(k);
            Point {
                x,
                z: wave(x) - 0.005 * x * x,
                weight: 1.0,
                number: k as usize + 1,
                line: k as usize + 10,
            }
        })
        .collect()
}

fn checked(points: &[Point]) -> Vec<(Check, String)> {
    clean::findings::findings(points, Side::Rail, 14.0)
        .into_iter()
        .filter(|f| f.check != Check::MissingSideFace)
        .map(|f| (f.check, f.place))
        .collect()
}

#[test]
fn each_defect_is_named_at_its_place_and_mended_by_its_repair() {
    let clean = flat(|_| 0.0);
    assert_eq!(checked(&clean), []);
    let place = |k: usize| clean[k].place();
    let mut twice = clean.clone();
    twice.insert(100, twice[99]);
    let mut swapped = clean.clone();
    swapped.swap(150, 151);
    let mut spiked = clean.clone();
    spiked[200].z += 0.15;
    let mut folded = clean.clone();
    let back = |p: &Point| Point { x: p.x + 0.05, z: p.z + 0.01, ..*p };
    folded.splice(80..80, clean[70..80].iter().rev().map(back));
    let mut looped = clean.clone();
    for (k, p) in looped[120..140].iter_mut().enumerate() {
        let angle = std::f64::consts::TAU * k as f64 / 20.0;
        (p.x, p.z) =
            (clean[120].x + 0.6 * angle.sin() + 0.01 * k as f64, clean[120].z + 0.6 * (1.0 - angle.cos()));
    }
    for (points, expected, repair) in [
        (twice, (Check::Duplicate, place(99)), Repair::DropDuplicates),
        (swapped, (Check::OutOfOrder, place(151)), Repair::Sort),
        (spiked, (Check::Spike, place(200)), Repair::RemoveSpikes),
        (folded, (Check::ZigZag, place(79)), Repair::Sort),
        (looped, (Check::Loop, place(121)), Repair::CutLoops),
    ] {
        let found = checked(&points);
        assert!(found.contains(&expected), "{expected:?} not in {found:?}");
        let mut mended = points.clone();
        assert!(clean::repairs::repair(&mut mended, &[]).is_empty() && mended == points);
        let done = clean::repairs::repair(&mut mended, &[repair]);
        assert_eq!(done.len(), 1, "{expected:?}");
        assert!(done[0].repair == repair && done[0].points > 0);
        assert!(
            !checked(&mended).iter().any(|(check, _)| *check == expected.0),
            "{expected:?}: {:?}",
            checked(&mended)
        );
    }
    assert_eq!(checked(&[&clean[..100], &clean[160..]].concat())[0].0, Check::Gap);
}

#[test]
fn every_format_gives_back_the_points_it_was_given() -> Result<()> {
    for (side, profile) in [(Side::Wheel, standards::wheel("S1002")?), (Side::Rail, standards::rail("60E1")?)]
    {
        let points = write::sample(&profile, 0.7)?;
        for format in Format::ALL {
            let text = write::points(&points, format, side, "round 'trip' = \"1\"!\n");
            let mut read = read::reader::read(text.as_bytes(), format, None)?;
            let mirror = matches!((format, side), (Format::MiniProf, Side::Rail) | (Format::Gensys, _));
            let options = Options { mirror: Some(mirror), ..Options::default() };
            let place::Placing { transform, findings, .. } = place::resolve(&mut read, side, &options)?;
            assert!(findings.is_empty(), "{format:?}: {findings:?}");
            let back: Vec<[f64; 2]> = transform.points(&read.at).iter().map(Point::xz).collect();
            // Vampire's heads set the origin: a rail's at its gauge point, 36 mm from its middle.
            let shift = if format == Format::Vampire { back[0][0] - points[0][0] } else { 0.0 };
            let off = |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0] - shift).hypot(p[1] - q[1]);
            let largest = back.iter().zip(&points).map(off).fold(0.0, f64::max);
            assert!(
                back.len() == points.len() && largest <= if format == Format::Vampire { 1e-9 } else { 0.0 },
                "{format:?}"
            );
            let expected = if side == Side::Rail { 36.0 } else { 0.0 };
            assert!(format != Format::Vampire || (shift - expected).abs() < 0.05, "{shift}");
        }
    }
    Ok(())
}

#[test]
fn files_name_their_body() -> Result<()> {
    for (name, bytes, side) in FILES {
        let free = ["sections.mpt", "rail.csv", "rail.txt"].contains(&name);
        let expected = (!free).then_some(side);
        assert_eq!(body(&name.to_uppercase(), bytes, &Options::default())?, expected, "{name}");
    }
    let header = Options { format: Some(Format::Simpack), ..Options::default() };
    assert_eq!(
        body("wheel.txt", include_bytes!("../../tests/profiles/wheel.prw"), &header)?,
        Some(Side::Wheel)
    );
    Ok(())
}

#[test]
fn rows_of_nan_are_gaps_as_in_files() -> Result<()> {
    let truth = write::sample(&standards::wheel("S1002")?, 0.5)?;
    let rows = |k: usize| if (100..104).contains(&k) { [truth[k][0], f64::NAN] } else { truth[k] };
    let rows: Vec<[f64; 2]> = (0..truth.len()).map(rows).collect();
    let text: String = rows.iter().map(|[x, z]| format!("{x} {z}\n")).collect();
    let options = Options { mirror: Some(false), flip_z: Some(false), ..Options::default() };
    let of_rows = of_points("rows", &rows, Side::Wheel, &options)?;
    let of_text = profile("rows.txt", text.as_bytes(), Side::Wheel, &options)?;
    let ends = |of: &Measured| -> Vec<_> {
        of.profile.segments().iter().map(|own| (own.start(), own.end(), own.is_gap())).collect()
    };
    assert_eq!(ends(&of_rows), ends(&of_text));
    let gaps = |of: &Measured| -> Vec<String> {
        let gaps = of.record.warnings.iter().filter(|finding| finding.check == Check::Gap);
        gaps.map(|finding| format!("{}: {}", finding.place, finding.found)).collect()
    };
    assert!(
        matches!(&gaps(&of_rows)[..], [only] if only.starts_with("point 100: no value in points 101 to 104:")
            && only.ends_with("up to point 105")),
        "{:?}",
        gaps(&of_rows)
    );
    assert_eq!(gaps(&of_text).len(), 1);
    let infinite = of_points("rows", &[[0.0, 0.0], [1.0, f64::INFINITY]], Side::Wheel, &options).err();
    assert!(infinite.is_some_and(|error| error.to_string().contains("rows: point 2")));
    Ok(())
}
