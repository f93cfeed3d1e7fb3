//! Sections between slices: lists in CONTACT's grammar, interpolation between features, and what bad lists get.

use super::*;

const LIST: &str =
    "0 1 offset, scale\n3\n2\n1\n0 'a.txt'\n100 'b.txt'\n200 'a.txt'\n0 0 999\n100 0 999\n200 0 999\n";

fn options(text: &str) -> Options {
    toml::from_str(text).unwrap_or_default()
}

/// Returns the file of a rail of one arc over a chord of 80 mm, in this many steps, lowered by z \[mm\].
fn arc(radius: f64, steps: i32, z: f64) -> Vec<u8> {
    let point = |k: i32| {
        let x = 80.0 * f64::from(k) / f64::from(steps) - 40.0;
        format!("{x:.12} {:.12}\n", (radius * radius - x * x).sqrt() - radius - z)
    };
    (0..=steps).map(point).collect::<String>().into_bytes()
}

/// Cuts a section of a list whose slices are these.
fn cut(list: &str, along: f64, files: &[(&str, Vec<u8>)], more: &str) -> Result<Measured> {
    let options =
        Options { along: Some(along), ..options(&format!("mirror = false\nflip_z = false\n{more}")) };
    let list = SliceList::read(list.as_bytes(), Side::Rail)?;
    let cut = SectionOfList::new(&list, &options)?;
    let contents: Vec<_> = files.iter().filter(|file| cut.files().contains(&file.0)).cloned().collect();
    section("list.slcs", &cut, &contents, Side::Rail, &options)
}

#[test]
fn a_section_at_a_slice_is_that_slice() -> Result<()> {
    let files = [("a.txt", arc(300.0, 160, 0.0)), ("b.txt", arc(250.0, 200, 1.0))];
    for (along, (name, bytes)) in [(0.0, &files[0]), (100.0, &files[1]), (200.0, &files[0])] {
        let section = cut(LIST, along, &files, "")?;
        let own = profile(name, bytes, Side::Rail, &options("mirror = false\nflip_z = false"))?;
        assert_eq!(section.points, own.points, "at {along}");
        assert_eq!(section.profile.segments(), own.profile.segments(), "at {along}");
        assert_eq!(section.record.cut.map(|cut| cut.points_of).as_deref(), Some(*name));
    }
    Ok(())
}

#[test]
fn midway_between_equal_slices_nothing_changes() -> Result<()> {
    let files = [("a.txt", arc(300.0, 160, 0.0)), ("b.txt", arc(300.0, 160, 0.0))];
    let (section, own) = (cut(LIST, 50.0, &files, "")?, cut(LIST, 0.0, &files, "")?);
    assert_eq!(section.points.len(), own.points.len());
    for (p, q) in section.points.iter().zip(&own.points) {
        assert!((p.x - q.x).hypot(p.z - q.z) < 1e-12, "{p:?} {q:?}");
    }
    Ok(())
}

/// Between two slices of one shape at different heights, the height of a section is in proportion, whatever the spacing of their
/// points, to within the polygon's sagitta.
#[test]
fn between_slices_points_move_in_straight_lines() -> Result<()> {
    let files = [("a.txt", arc(300.0, 160, 0.0)), ("b.txt", arc(300.0, 100, 2.0))];
    let section = cut(LIST, 25.0, &files, "curve = 'interpolation'")?;
    assert_eq!(section.points.len(), 161, "the points of the denser slice");
    // A chord of 0.8 mm in x, inclined by up to 0.134.
    let sagitta = 0.8_f64.powi(2) / (8.0 * 300.0) / 0.134_f64.cos().powi(3);
    for p in &section.points {
        let expected = (300.0_f64.powi(2) - p.x * p.x).sqrt() - 300.0 - 0.5;
        assert!((p.z - expected).abs() <= 0.25 * sagitta + 1e-6, "{p:?}: {expected}");
    }
    let record = section.record.cut.map(|cut| cut.slices).unwrap_or_default();
    let shares: Vec<_> = record.iter().map(|slice| (slice.file.as_str(), slice.at, slice.share)).collect();
    assert_eq!(shares, [("a.txt", 0.0, 0.75), ("b.txt", 100.0, 0.25)]);
    Ok(())
}

#[test]
fn features_keep_their_parts_together_and_a_missing_one_ends_the_profile() -> Result<()> {
    let flat = |corner: f64, end: f64| {
        let xs = [0.0, corner / 2.0, corner, (corner + end) / 2.0, end].map(|x| format!("{x} 0\n"));
        xs.concat().into_bytes()
    };
    let files = [("a.txt", flat(20.0, 60.0)), ("b.txt", flat(30.0, 60.0))];
    let list = LIST.replacen("2\n", "3\n", 1);
    let list = list.replace("\n0 0 999", "\n0 0 20 60").replace("\n100 0 999", "\n100 0 30 60");
    let list = list.replace("\n200 0 999", "\n200 -1 20 60");
    let xs = |along: f64| -> Result<Vec<f64>> {
        Ok(cut(&list, along, &files, "kink_angle = 3.0")?.points.iter().map(|p| p.x).collect())
    };
    assert_eq!(xs(50.0)?, [0.0, 12.5, 25.0, 42.5, 60.0]);
    assert_eq!(xs(150.0)?, [25.0, 42.5, 60.0], "the first part ends at 100 mm");
    assert_eq!(xs(200.0)?, [20.0, 40.0, 60.0]);
    Ok(())
}

#[test]
fn the_grammar_is_contacts() -> Result<()> {
    let text = "% a comment\n 0.5 , 1000. U_OFFSET [usr], U_SCALE\n\n2 NSLC\n3 1 1 NFEAT\n2 0 TH\n\
                -0.5 'with blank % name.txt' ! a comment\n0.5\n'b.txt'\n1\n1\n-0.5 0. 1.\n2d0\n.5 -1 -1 3 and more\n";
    let list = SliceList::read(text.as_bytes(), Side::Rail)?;
    let slices: Vec<_> = list.slices.iter().map(|slice| (slice.at, slice.file.as_str())).collect();
    assert_eq!(slices, [(0.0, "with blank % name.txt"), (1000.0, "b.txt")]);
    assert_eq!(list.slices[0].features, [0.0, 1.0, 2.0]);
    assert_eq!(list.notes.len(), 3, "{:?}", list.notes);
    Ok(())
}

#[test]
fn a_wheel_is_periodic_and_round_outside_its_list() -> Result<()> {
    use std::f64::consts::TAU;
    let text = "0 1\n2\n0\n2\n0.3 'round.txt'\n0.4 'flat.txt'\n";
    let list = SliceList::read(text.as_bytes(), Side::Wheel)?;
    let files = |angle: f64| -> Result<Vec<String>> {
        let cut = SectionOfList::new(&list, &Options { angle: Some(angle), ..Options::default() })?;
        Ok(cut.files().into_iter().map(String::from).collect())
    };
    assert_eq!(files(0.0)?, ["round.txt"]);
    assert_eq!(files(3.0)?, ["flat.txt"]);
    assert_eq!(files(-3.0)?, ["flat.txt"]);
    assert_eq!(files(-2.0)?, ["round.txt"]);
    assert_eq!(files(0.35 - TAU)?, ["round.txt", "flat.txt"]);
    assert_eq!(files(0.35 + 2.0 * TAU)?, ["round.txt", "flat.txt"]);
    Ok(())
}

#[test]
fn bad_lists_say_what_is_wrong() {
    let files = [("a.txt", arc(300.0, 160, 0.0)), ("b.txt", arc(250.0, 200, 1.0))];
    for (from, to, expected) in [
        ("0 1 offset", "0 x", "line 1: found a scale \"x\"; expected a number; correct"),
        ("0 1 offset", "0 -1", "line 1: found a scale of -1; expected a positive one; correct it"),
        ("3\n", "0\n", "line 2: found \"0\"; expected a number of slices from 1 to 10000; correct it"),
        ("2\n1\n", "2\n7\n", "line 4: found \"7\"; expected a method of interpolation from 1 to 2;"),
        ("2\n1\n", "2\n1 2\n", "line 4: found perturbations of kind 2; expected slices alone"),
        ("0 'a.txt'\n", "0 17\n", "line 5: found \"17\"; expected the file of the slice, in single quotes"),
        ("100 'b", "-100 'b", "line 6: found a slice at -100 mm after one at 0 mm; expected ascending"),
        (
            "100 0 999",
            "90 0 999",
            "line 9: found those of one at 90; expected the features of the slice at 100",
        ),
        (
            "200 0 999\n",
            "200 0\n",
            "line 11: found the end of the file after 2 of 3 values; expected the features",
        ),
        ("0 0 999", "0 -1 -1", "list.slcs: a.txt: found 0 features; expected two features at least"),
        (
            "0 0 999",
            "0 9 5",
            "list.slcs: a.txt: found feature 2 at 5 mm after one at 9 mm; expected ascending",
        ),
    ] {
        let list = LIST.replacen(from, to, 1);
        assert_ne!(list, LIST, "{from}");
        let error = cut(&list, 50.0, &files, "").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.starts_with(expected), "{to}: {error}");
    }
    for (along, more, expected) in [
        (
            250.0,
            "",
            "along: found 250 mm; expected a place from 0 to 200 mm; choose one that the slices cover",
        ),
        (f64::NAN, "", "along: found NaN; expected a finite number;"),
        (50.0, "angle = 1.0", "angle: found an option without effect; expected `along` for these slices"),
        (50.0, "origin = 'gauge-point'", "list.slcs: origin: found an origin that each slice finds;"),
        (50.0, "unit = 'm'", "list.slcs: a.txt: unit: found a width of 80000 mm;"),
    ] {
        let error = cut(LIST, along, &files, more).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.starts_with(expected), "{more}: {error}");
    }
    let error = cut(LIST, 50.0, &files[..1], "").err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.starts_with("list.slcs: b.txt: found no content;"), "{error}");
    let parts =
        LIST.replacen("2\n", "3\n", 1).replace(" 0 999", " 0 9 -1").replace("100 0 9 -1", "100 -1 9 20");
    let error = cut(&parts, 50.0, &files, "").err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("found no part that both a.txt and b.txt have;"), "{error}");
    let wheel =
        SliceList::read(b"0 1\n2\n0\n1\n-1 'a'\n4 'b'\n", Side::Wheel).err().map(|error| error.to_string());
    assert!(
        wheel.as_deref().is_some_and(|e| e.starts_with("line 5: found slices from -1 to 4 rad;")),
        "{wheel:?}"
    );
}
