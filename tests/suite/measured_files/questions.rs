//! What a file leaves open is asked at once, the likeliest cause first.

use super::*;

fn complaint(name: &str, points: &[[f64; 2]], side: Side, options: &Options) -> String {
    let text: String = points.iter().map(|[x, z]| format!("{x},{z}\n")).collect();
    profile(name, text.as_bytes(), side, options).err().map(|error| error.to_string()).unwrap_or_default()
}

/// Returns a rail whose corner at smaller x is worn by 0.4 mm, so that its mirror image is another one.
fn worn(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    points.iter().map(|&[x, z]| [x, z - 0.4 * (-(x + 20.0).powi(2) / 60.0).exp()]).collect()
}

fn scaled(points: &[[f64; 2]], unit: f64) -> Vec<[f64; 2]> {
    points.iter().map(|point| point.map(|value| value / unit)).collect()
}

#[test]
fn a_file_in_inches_is_asked_for_its_unit_and_for_what_else_is_open() -> Result<()> {
    let (_, wheel) = s1002(0.3)?;
    let rail = worn(&write::sample(&standards::rail("60E1")?, 0.3)?);
    let found = complaint("w.csv", &scaled(&wheel, 25.4), Side::Wheel, &Options::default());
    let expected = "w.csv: unit: found a width of 5.11811 mm; expected 60 to 150 mm, as rails and wheels have, or a `unit`; \
                    give the right `unit`: \"in\" or \"cm\" would do";
    assert_eq!(found, expected);
    let found = complaint("r.csv", &scaled(&rail, 25.4), Side::Rail, &Options::default());
    assert!(found.contains("`unit`: \"in\" would do; and `mirror = true` (gauge corner"), "{found}");
    assert!(!found.contains("flip_z"), "{found}");
    // Options for the axes do not hide that 5 mm are no wheel; a unit that is given does.
    let axes = Options { mirror: Some(false), flip_z: Some(false), ..Options::default() };
    let found = complaint("w.csv", &scaled(&wheel, 25.4), Side::Wheel, &axes);
    assert_eq!(found, expected);
    let stated = Options { unit: Some(Unit::Millimetre), ..axes };
    assert_eq!(complaint("w.csv", &scaled(&wheel, 25.4), Side::Wheel, &stated), "");
    let found = complaint("w.csv", &scaled(&wheel, 10.0), Side::Wheel, &Options::default());
    assert!(found.contains("a width of 13 mm;") && found.contains("`unit`: \"cm\" would do"), "{found}");
    // 18.35 mm: neither 183 nor 466 mm are the width of a profile.
    let part: Vec<[f64; 2]> = rail.iter().copied().filter(|[x, _]| (-32.0..-13.65).contains(x)).collect();
    let found = complaint("p.csv", &part, Side::Rail, &Options::default());
    assert!(!found.contains("\"cm\"") && !found.contains("\"in\""), "{found}");
    Ok(())
}

#[test]
fn points_in_no_order_are_said_to_be_so() -> Result<()> {
    let mut random = Random::new(14);
    let bodies = [(Side::Wheel, s1002(0.5)?.1), (Side::Rail, write::sample(&standards::rail("60E1")?, 0.5)?)];
    for (side, mut points) in bodies {
        for k in (1..points.len()).rev() {
            points.swap(k, random.below(k + 1));
        }
        let found = complaint("s.csv", &points, side, &Options::default());
        assert!(found.contains("points in no order: the path turns back at"), "{found}");
        assert!(found.ends_with("sort the rows of the file"), "{found}");
    }
    Ok(())
}

#[test]
fn the_other_body_is_named_before_the_axes_are_asked_for() -> Result<()> {
    let rail = worn(&write::sample(&standards::rail("60E1")?, 0.5)?);
    let found = complaint("r.csv", &rail, Side::Wheel, &Options::default());
    assert!(found.starts_with("r.csv: flip_z, mirror: found the shape of a rail (side faces:"), "{found}");
    assert!(found.contains("give it as a rail; or give both options"), "{found}");
    let (_, wheel) = s1002(0.5)?;
    let found = complaint("w.csv", &wheel, Side::Rail, &Options::default());
    assert!(found.contains("found the shape of a wheel (flange tip,"), "{found}");
    let error = profile("r.ban", b"", Side::Wheel, &Options::default()).err().map(|error| error.to_string());
    let expected =
        "r.ban: found the extension of a rail; expected a wheel; give the other file, or say its `format`";
    assert_eq!(error.as_deref(), Some(expected));
    Ok(())
}

#[test]
fn all_open_questions_are_one_message() {
    let plane: Vec<[f64; 2]> = (-40..=40).map(|k| [f64::from(k), 0.1 * f64::from(k)]).collect();
    let found = complaint("p.csv", &plane, Side::Rail, &Options::default());
    for part in [
        "flip_z, mirror: found",
        "`flip_z = true`",
        "`mirror = true`",
        "and `unit` unless it is 80.0 mm wide",
    ] {
        assert!(found.contains(part), "{part}: {found}");
    }
    let found = complaint("p.csv", &plane[..2], Side::Rail, &Options::default());
    assert!(found.contains("point 2 (line 2): found 2 points in all; expected 3 points or more"), "{found}");
}

#[test]
fn an_overhang_at_an_end_is_named_as_the_file_has_it_whatever_the_axes() {
    let crown = |x: f64| [x, -x * x / 300.0 - if x > 30.0 { 3.0 * (x - 30.0) } else { 0.0 }];
    let mut points: Vec<[f64; 2]> = (-35..=35).map(|k| crown(f64::from(k))).collect();
    // Two points in the wrong order, and a last one that somebody added.
    points.swap(10, 11);
    let last = points[points.len() - 1];
    points.push([last[0] + 2.0, last[1] + 3.0]);
    for mirror in [false, true] {
        let options = |repair: &[Repair]| Options {
            mirror: Some(mirror),
            flip_z: Some(false),
            repair: repair.to_vec(),
            ..Options::default()
        };
        let found = complaint("o.csv", &points, Side::Rail, &options(&[]));
        // Each is a fault of its own; the first one from the left is told.
        let told = if mirror { "beyond it lies point 72" } else { "the wrong order with point 1" };
        assert!(found.contains(told), "{mirror}: {found}");
        let found = complaint("o.csv", &points, Side::Rail, &options(&[Repair::Sort]));
        let expected = "o.csv: point 71 (line 71): found a path that turns back and does not return: beyond it lies point 72 (line 72); \
                        expected a path that ends where the profile does; \
                        delete what lies beyond it, or give `repair = [\"sort\", \"remove-spikes\"]`";
        assert_eq!(found, expected, "{mirror}");
        assert_eq!(
            complaint("o.csv", &points, Side::Rail, &options(&[Repair::Sort, Repair::RemoveSpikes])),
            ""
        );
        points.pop();
        assert_eq!(complaint("o.csv", &points, Side::Rail, &options(&[Repair::Sort])), "", "{mirror}");
        points.push([last[0] + 2.0, last[1] + 3.0]);
    }
}

#[test]
fn the_real_file_with_an_added_point_says_which_one_it_is() -> Result<()> {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT") else { return Ok(()) };
    let path = std::path::Path::new(&contact).join("testbank/profiles/avg_low2.ban");
    let bytes = wheelrail::files::read_bytes(&path, wheelrail::measured::LARGEST_FILE)?;
    for mirror in [false, true] {
        let options = Options { mirror: Some(mirror), repair: vec![Repair::Sort], ..Options::default() };
        let error =
            profile("avg_low2.ban", &bytes, Side::Rail, &options).err().map(|error| error.to_string());
        let error = error.unwrap_or_default();
        assert!(error.contains("beyond it lies point 526 (line 578);"), "{mirror}: {error}");
    }
    Ok(())
}
