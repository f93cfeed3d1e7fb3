//! Tests the whole way from bytes to a profile, on the samples in tests/profiles.

use crate::common::repository;
use wheelrail::internal::Random;
use wheelrail::measured::{
    Check, CurveKind, Format, Measured, Options, Repair, SectionOfList, SliceList, Unit, body, profile,
    section, write,
};
use wheelrail::profile::Section;
use wheelrail::{Error, Profile, Result, Side, standards};

mod curves;
mod outliers;
mod questions;
mod slices;
mod texts;

/// Returns the bytes of a sample in tests/profiles.
fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(repository("tests/profiles").join(name)).expect(name)
}

/// Makes the profile of a sample: of a rail where the file names no body.
fn measured(name: &str, options: &str) -> Result<Measured> {
    let (bytes, options) = (bytes(name), toml::from_str(options).expect(options));
    let side = body(name, &bytes, &options)?.unwrap_or(Side::Rail);
    profile(name, &bytes, side, &options)
}

/// Returns the largest difference in height of two profiles over a range of x.
fn difference(a: &Profile, b: &Profile, side: Side, [from, to]: [f64; 2]) -> f64 {
    let [a, b] = [a, b].map(|p| Section::own_axes(p, side));
    let at = |k: i32| from + (to - from) * f64::from(k) / 500.0;
    (0..=500)
        .map(|k| (a.height(at(k)) - b.height(at(k))).abs())
        .fold(0.0, |m: f64, d| if d > m || d.is_nan() { d } else { m })
}

fn s1002(step: f64) -> Result<(Profile, Vec<[f64; 2]>)> {
    let profile = standards::wheel("S1002")?;
    let points = write::sample(&profile, step)?;
    Ok((profile, points))
}

#[test]
fn every_wheel_file_becomes_the_same_right_hand_wheel() -> Result<()> {
    let wheel = standards::wheel("S1002")?;
    for (name, options, flip, mirror) in [
        ("wheel.prw", "curve = 'interpolation'", -1e0, 1.0),
        ("wheel.wheel", "curve = 'interpolation'", -1.0, -1.0),
        ("old-style.whl", "curve = 'interpolation'\norigin = 'tape-line'", -1.0, 1.0),
    ] {
        let found = measured(name, options)?;
        assert_eq!(found.record.transform.scale, [mirror, flip], "{name}");
        assert!(found.record.warnings.is_empty(), "{name}: {:?}", found.record.warnings);
        // The points are 3 mm apart and the curvature jumps by 1/13 per mm: the error is h²Δκ/16.
        let worst = difference(&found.profile, &wheel, Side::Wheel, [-69.0, 59.0]);
        assert!(worst < 0.05, "{name}: {worst}");
    }
    Ok(())
}

#[test]
fn every_rail_file_becomes_the_same_right_hand_rail() -> Result<()> {
    let rail = standards::rail("60E1")?;
    for (name, options) in [
        ("new-style.ban", "mirror = true"),
        ("sections.mpt", "mirror = false\nrepair = ['sort']"),
        ("design.ban", "mirror = true"),
        ("rail.txt", "mirror = false\nunit = 'in'\ncolumns = [1, 2]"),
        ("rail.csv", "unit = 'm'\ncolumns = ['y', 'z']"),
        ("new-style.ban", "mirror = false\ncurve = 'interpolation'"),
    ] {
        let found = measured(name, options)?;
        let worst = difference(&found.profile, &rail, Side::Rail, [-35.0, 25.0]);
        assert!(worst < 0.1, "{name}: {worst}");
    }
    let exact = measured("design.ban", "mirror = false")?;
    assert_eq!(exact.record.curve.kind, CurveKind::Elements);
    let worst = difference(&exact.profile, &rail, Side::Rail, [-36.0, 36.0]);
    assert!(worst < 1e-7, "{worst}");
    Ok(())
}

#[test]
fn what_the_file_does_not_prove_is_an_error_with_the_choices() {
    let worn =
        String::from_utf8_lossy(&bytes("new-style.ban")).replace("-30.3950   -5.7330", "-30.3950   -5.8330");
    let error = profile("new-style.ban", worn.as_bytes(), Side::Rail, &Options::default())
        .map(drop)
        .unwrap_err()
        .to_string();
    assert!(error.contains("mirror = true") && error.contains("mirror = false"), "{error}");
    // SIMPACK's definition decides what the symmetric head leaves open. Only the single side face decides for rail.csv.
    assert!(measured("rail.prr", "").is_ok_and(|m| m.record.transform.steps.len() == 3));
    let one_sided = measured("rail.csv", "unit = 'm'\ncolumns = [2, 3]");
    assert!(one_sided.is_ok_and(|m| m.record.transform.scale == [-1e3, 1e3]));
    // Its second section begins beside points of the first one.
    let stitched = measured("sections.mpt", "mirror = true");
    assert!(stitched.is_ok_and(|m| matches!(&m.record.repairs[..], [only] if only.repair == Repair::Sort)));
    let wheel = bytes("wheel.prw");
    assert!(profile("wheel.prw", &wheel, Side::Rail, &Options::default()).is_err());
    for (name, options, part) in [
        ("rail.csv", "columns = [2, 3]", "\"m\" would do"),
        ("rail.csv", "unit = 'm'", "columns"),
        ("wheel.prw", "unit = 'mm'", "unit"),
        ("wheel.prw", "origin = 'gauge-point'", "origin"),
        ("sections.mpt", "section = 3", "section"),
        ("wheel.prw", "curve = 'elements'", "elements"),
    ] {
        let error = measured(name, options).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.starts_with(name) && error.contains(part), "{name} {options}: {error}");
    }
}

/// Returns a rail on its head, with both side faces, as a file of this format.
fn upside_down(format: Format) -> String {
    let head = [[-36.0, -30.0], [-36.0, -3.0], [0.0, 0.0], [34.0, -3.0], [34.0, -30.0]];
    write::points(&head.map(|[x, z]| [x, -z]), format, Side::Rail, "on its head")
}

#[test]
fn an_option_holds_then_the_definition_and_the_shape_only_where_neither_says() -> Result<()> {
    let turned = |format: Format, name: &str, flip_z: Option<bool>| {
        let mirror = matches!(format, Format::MiniProf | Format::Text).then_some(false);
        let curve = Some(CurveKind::Interpolation);
        let options = Options { mirror, flip_z, curve, ..Options::default() };
        profile(name, upside_down(format).as_bytes(), Side::Rail, &options)
    };
    // SIMPACK and GENSYS define z, so that the profile stays on its head, and the finding names the option.
    for (format, name, sign) in [(Format::Simpack, "a.prr", -1.0), (Format::Gensys, "a.rail", -1.0)] {
        let found = turned(format, name, None)?;
        assert_eq!(found.record.transform.scale[1], sign, "{name}");
        let told = found.record.warnings.iter().filter(|f| f.check == Check::Orientation).collect::<Vec<_>>();
        assert!(told.len() == 1 && told[0].found.contains("`flip_z = false` would"), "{told:?}");
        // The user's own option is always accepted, whatever its value.
        for flip in [false, true] {
            let given = turned(format, name, Some(flip))?.record;
            assert!(!given.warnings.iter().any(|f| f.check == Check::Orientation), "{:?}", given.warnings);
            assert_eq!(given.transform.scale[1], if flip { -1.0 } else { 1.0 });
        }
    }
    // MiniProf and text files define no sign for rails, so that the side faces decide.
    for (format, name) in [(Format::MiniProf, "a.ban"), (Format::Text, "a.txt")] {
        assert_eq!(turned(format, name, None)?.record.transform.scale[1], -1.0, "{name}");
    }
    Ok(())
}

#[test]
fn an_inclined_plane_is_not_mirrored_nor_a_groove_turned() -> Result<()> {
    let plane: Vec<[f64; 2]> = (-50..=50).map(|k| [f64::from(k), 0.2 * f64::from(k)]).collect();
    let groove: Vec<[f64; 2]> = (-40..=40)
        .map(|k| 0.5 * f64::from(k))
        .map(|x| [x, if x.abs() < 10.0 { -(100.0 - x * x).sqrt() } else { 0.0 }])
        .collect();
    for points in [plane, groove] {
        let text = write::points(&points, Format::Simpack, Side::Rail, "");
        let found = profile("a.prr", text.as_bytes(), Side::Rail, &Options::default())?;
        let back: Vec<[f64; 2]> = found.points.iter().map(|p| p.xz()).collect();
        assert_eq!(back, points);
        assert!(!found.record.warnings.iter().any(|f| f.check == Check::Orientation));
        // A text file defines nothing, and its shape proves nothing.
        let text = write::points(&points, Format::Text, Side::Rail, "");
        let error = profile("a.txt", text.as_bytes(), Side::Rail, &Options::default()).err();
        let error = error.map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains("flip_z = true") && error.contains("flip_z = false"), "{error}");
    }
    Ok(())
}

#[test]
fn the_gauge_point_of_a_grooved_rail_is_on_its_head() -> Result<()> {
    let rail = "-92 -30\n-92 -1\n-76 -1\n-70 -47\n-40 -47\n-36 -3\n-30 -0.5\n0 0\n34 -1\n34 -30\n";
    let options = "mirror = false\norigin = 'gauge-point'\ncurve = 'interpolation'";
    let options = toml::from_str(options).map_err(|e| Error::new("options", e.to_string(), "", ""))?;
    let found = profile("rail.txt", rail.as_bytes(), Side::Rail, &options)?;
    // 11 mm down a gauge face that is 44 mm high and runs 4 mm out.
    assert_eq!(found.record.transform.shift, [37.0, 0.0]);
    Ok(())
}

#[test]
fn origins_go_where_they_are_asked() -> Result<()> {
    let gauge = measured("new-style.ban", "mirror = false\norigin = 'gauge-point'\ncurve = 'interpolation'")?;
    let section = Section::own_axes(&gauge.profile, Side::Rail);
    let inner = gauge.points.iter().filter(|p| p.z >= -14.0).map(|p| p.x).fold(f64::INFINITY, f64::min);
    assert!(section.height(36.0).abs() < 0.02 && (0.0..0.35).contains(&inner), "{inner}");
    let given = measured("new-style.ban", "mirror = false\norigin = [1.0, 2.0]")?;
    assert_eq!(given.record.transform.shift, [-1.0, -2.0]);
    Ok(())
}

#[test]
fn a_tall_spike_among_dense_noisy_points_is_one_and_goes() -> Result<()> {
    let rail = standards::rail("60E1")?;
    let mut random = Random::new(7);
    // The noise is nearly normal, with a deviation of 8 µm.
    let mut noise = || 0.008 * ((0..12).map(|_| random.below(1_000_000) as f64 / 1e6).sum::<f64>() - 6.0);
    let points: Vec<[f64; 2]> =
        write::sample(&rail, 0.1)?.into_iter().map(|[x, z]| [x + noise(), z + noise()]).collect();
    // At the corners a small spike reaches as far along the path as across it, and its neighbour looks like a spike, too.
    let crown: Vec<usize> = (0..points.len()).filter(|&k| points[k][0].abs() < 25.0).collect();
    for (n, &at) in crown.iter().step_by(23).enumerate() {
        for height in [0.2, 0.5, 1.0, -0.7] {
            let mut spiked = points.clone();
            spiked[at][1] += height;
            let text = write::points(&spiked, Format::Csv, Side::Rail, "");
            let mut options = Options { mirror: Some(false), ..Options::default() };
            let error = profile("rail.csv", text.as_bytes(), Side::Rail, &options).err();
            let (place, advice) = error.map(|e| (e.place, e.advice)).unwrap_or_default();
            let number = format!("point {} ", at + 1);
            assert!(
                place.contains(&number) && advice.contains("remove-spikes"),
                "{at} {height}: {place}: {advice}"
            );
            // The fit takes most of the time, so that only every tenth round makes it.
            if n % 10 == 0 {
                options.repair = vec![Repair::RemoveSpikes];
                let repairs = profile("rail.csv", text.as_bytes(), Side::Rail, &options)?.record.repairs;
                assert!(repairs.len() == 1 && repairs[0].points == 1, "{at} {height}: {repairs:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn options_without_effect_are_named() {
    for (name, options, idle) in [
        ("wheel.prw", "columns = [1, 2]", "columns"),
        ("wheel.wheel", "columns = [1, 2]", "columns"),
        ("old-style.whl", "columns = [1, 2]", "columns"),
        ("wheel.prw", "section = 1", "section"),
        ("wheel.prw", "gauge_height = 14.0", "gauge_height"),
        ("wheel.prw", "already_inclined = true", "already_inclined"),
        ("wheel.prw", "tape_distance = 70.0", "tape_distance"),
        ("rail.prr", "tape_distance = 70.0", "tape_distance"),
        ("design.ban", "mirror = true\nkink_angle = 0.5", "kink_angle"),
        ("design.ban", "mirror = true\nrepair = ['sort']", "repair"),
        ("design.ban", "mirror = true\ncutoff_wavelength = 5.0", "cutoff_wavelength"),
        ("design.ban", "mirror = true\ncurve = 'elements'\nkink_angle = 0.5", "kink_angle"),
    ] {
        let error = measured(name, options).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(
            error.contains(&format!("{idle}: found an option without effect")),
            "{name} {options}: {error}"
        );
    }
    for (name, options) in [
        ("old-style.whl", "origin = 'tape-line'\ntape_distance = 70.0"),
        ("rail.prr", "gauge_height = 12.0\nalready_inclined = true"),
        ("design.ban", "mirror = true\ncurve = 'arcs'\nkink_angle = 0.5\nrepair = ['sort']"),
    ] {
        let error = measured(name, options).err();
        assert_eq!(error, None, "{name} {options}");
    }
}

#[test]
fn segments_written_are_segments_read() -> Result<()> {
    #[derive(serde::Deserialize)]
    struct Scene {
        segments: Vec<wheelrail::profile::SegmentData>,
    }
    let (wheel, points) = s1002(0.25)?;
    let text = write::points(&points, Format::Csv, Side::Wheel, "");
    let options = Options { curve: Some(CurveKind::Arcs), ..Options::default() };
    let arcs = profile("s1002.csv", text.as_bytes(), Side::Wheel, &options)?.profile;
    let radius = |segment: &wheelrail::profile::Segment| match &segment.shape {
        wheelrail::profile::Shape::Arc(arc) if arc.radius().is_finite() => arc.radius().abs(),
        _ => 0.0,
    };
    let largest = arcs.segments().iter().map(radius).fold(0.0, f64::max);
    // The drawn profile comes back to rounding, because the arcs that close it start from rounded ends. A fitted arc is
    // written by its rounded centre.
    for (profile, bound) in [(&wheel, 2e-15), (&arcs, 0.5 * f64::EPSILON * largest)] {
        let (written, cut) = write::chain(profile)?;
        // The fit turns the vertical back of the flange by a rounding of its tangent.
        assert!(cut.len() <= 1, "{cut:?}");
        let scene: Scene = toml::from_str(&written).map_err(|e| Error::new("toml", e.to_string(), "", ""))?;
        let back = wheelrail::profile::drawn_profile("back", "", None, &scene.segments)?;
        let worst = difference(profile, &back, Side::Wheel, [-69.9, 59.9]);
        assert!(worst <= bound, "{worst:e} of {bound:e}");
    }
    let spline = profile("s1002.csv", text.as_bytes(), Side::Wheel, &Options::default())?.profile;
    assert!(write::segments(&spline).is_err_and(|e| e.place == "segment 1"));
    Ok(())
}
