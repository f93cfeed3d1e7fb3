//! What is said of a scene that is wrong, key by key: where → found → expected → what to do.

use wheelrail::scene::{parse, resolve};
use wheelrail::separation::Method;
use wheelrail::{Result, Scene};

const SCENE: &str = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                     [contact]\nrail_x = 0.0\nwheel_x = 0.0\n";

#[test]
fn a_misspelt_key_is_named_with_its_line_and_the_nearest_one() {
    let text = SCENE.replace("wheel_x", "wheel_z");
    let error = parse::<Scene>(&text, false).err().map(|e| e.to_string());
    let expected = "line 8: found `wheel_z`; expected one of rail_x, wheel_x, offset, roll, yaw, within, along, pitch; perhaps `wheel_x` is meant";
    assert_eq!(error.as_deref(), Some(expected));
}

#[test]
fn the_same_keys_work_in_json() -> Result<()> {
    let scene: Scene = parse(SCENE, false)?;
    let json = serde_json::to_string(&scene).unwrap_or_default();
    assert_eq!(parse::<Scene>(&json, true)?, scene);
    Ok(())
}

#[test]
fn an_array_that_is_too_long_is_not_cut_short() {
    let text = SCENE.replace("[wheel]", "shift = [0.0, 0.0, 99.0]\n[wheel]");
    let error = parse::<Scene>(&text, false).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(error.starts_with("rail: shift: found a list of 3; expected a list of 2;"), "{error}");
}

#[test]
fn a_list_is_no_table() {
    for (text, json, place) in [
        (format!("{SCENE}[grid]\nxi = [-1.0, 1.0, 3]\n"), false, "grid: xi"),
        (format!("patch = [0.05]\n{SCENE}"), false, "patch"),
        (
            SCENE.replace("profile = \"60E1\"", "segments = [{ line = [[0, 0], [1, 0]] }]"),
            false,
            "rail: segments: line",
        ),
        ("[null, {}, {}, null, null, null, null, {}, {}, {}]".into(), true, ""),
        ("[]".into(), true, ""),
    ] {
        let error = parse::<Scene>(&text, json).err().map(|e| e.to_string()).unwrap_or_default();
        let expected = format!("{place}: found a list; expected a table of keys and values;");
        assert!(error.starts_with(&expected), "{text}: {error}");
    }
}

#[test]
fn a_method_is_one_of_the_ladder_or_auto() -> Result<()> {
    for (word, method) in [("auto", None), ("report-newton", Some(Method::ReportNewton))] {
        let scene: Scene = parse(&format!("{SCENE}[grid]\nmethod = \"{word}\"\n"), false)?;
        assert_eq!(scene.grid.method, method);
        assert_eq!(
            serde_json::to_value(&scene).map_or_else(|_| "".into(), |s| s["grid"]["method"].clone()),
            word
        );
    }
    let error = parse::<Scene>(&format!("{SCENE}[grid]\nmethod = \"spectrl\"\n"), false).err();
    assert_eq!(error.map(|e| e.advice).as_deref(), Some("perhaps `spectral` is meant"));
    Ok(())
}

#[test]
fn keys_with_several_forms_say_what_was_found() {
    let cases = [
        (
            "[rail]\nrotate = true",
            false,
            "line 2: found true; expected an angle in rad, or a ratio such as \"1:40\";",
        ),
        (
            "[grid]\nxi = { from = 1,\n  m = 3 }",
            false,
            "line 2: found { from = 1, m = 3 }; expected \"auto\", { from = …, to = …, n = … } or",
        ),
        ("[output]\nformats = [1]", false, "line 2: found 1; expected string"),
        (
            "{\"grid\":\n{\"spacing\": \"fine\"}}",
            true,
            "line 2, column 19: found `{\"spacing\": \"fine\"}` up to there; expected a step in mm, or [Δξ, Δη];",
        ),
    ];
    for (text, json, expected) in cases {
        let error = parse::<Scene>(text, json).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn decimal_commas_are_told() {
    for (text, json, number) in [
        ("[wheel]\nradius = 460,5", false, "460.5"),
        ("[wheel]\nradius = \"46,25\"", false, "46.25"),
        ("{\"rail\": {\"rotate\": 0,025}}", true, "0.025"),
    ] {
        let error = parse::<Scene>(text, json).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.ends_with(&format!("write numbers with a decimal point: {number}")), "{error}");
    }
}

#[test]
fn names_need_quotes_and_numbers_none() {
    for (text, json, expected) in [
        (
            "[rail]\nprofile = 60E1 # inclined",
            false,
            "line 2: found 60E1; expected a name in quotes; a name needs quotes: \"60E1\"",
        ),
        ("[wheel]\nprofile = S1002", false, "line 2: found S1002; expected a name in quotes; a name needs"),
        ("[rail]\nrotate = 1:40", false, "line 2: found 1:40; expected a name in quotes; a name needs"),
        ("[rail]\nrotate = 1/40", false, "line 2: found 1/40; expected a name in quotes; a name needs"),
        (
            "{\"rail\": {\"profile\": 60E1}}",
            true,
            "line 1, column 26: found 60E1; expected a name in quotes; a name",
        ),
        (
            "[patch]\nload = 80 kN",
            false,
            "line 2: found 80 kN; expected a number, or words in quotes; write the number alone, in the unit of its key: 80",
        ),
        (
            "[patch]\nload = \"80 kN\"",
            false,
            "line 2: found invalid type: string \"80 kN\"; expected a number; write the number alone, without quotes",
        ),
    ] {
        let error = parse::<Scene>(text, json).err().map(|e| e.to_string()).unwrap_or_default();
        let from = if json { "found" } else { "line" };
        let [error, expected] =
            [error.as_str(), expected].map(|text| text.split_once(from).map_or("", |(_, rest)| rest));
        assert!(error.starts_with(expected) && !expected.is_empty(), "{error}");
    }
}

#[test]
fn wrong_types_and_missing_keys_are_named() {
    for (bad, found) in [("radius = \"big\"", "invalid type: string \"big\""), ("radios = 1.0", "`radios`")] {
        let error = parse::<Scene>(&SCENE.replace("radius = 460.0", bad), false).err();
        assert_eq!(error.map(|e| e.found).as_deref(), Some(found));
    }
}

/// Returns the error text of a scene with these tables.
fn complaint(rail: &str, rest: &str) -> Result<String> {
    let text = format!("[rail]\n{rail}\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n{rest}");
    let scene: Scene = parse(&text, false)?;
    Ok(resolve(&scene, ".".as_ref(), "").err().map(|e| e.to_string()).unwrap_or_default())
}

#[test]
fn complaints_say_what_was_found() -> Result<()> {
    let rails = [
        ("profile = \"60e1\"", "perhaps `60E1` is meant"),
        ("profile = \"S1002\"", "rail: profile: found \"S1002\", a wheel; expected a rail profile;"),
        ("profile = \"60E1\"\nunit = \"m\"\nrepair = [\"sort\"]", "rail: found `unit`, `repair`; expected"),
        ("profile = \"60E1\"\nfile = \"x.ban\"", "rail: found `profile` and `file`; expected exactly one"),
        ("", "rail: found none of `profile`, `file`, `segments`; expected exactly one"),
        ("profile = \"60E1\"\nstart = [1, 2]", "rail: start: found [1, 2]; expected"),
        ("file = \"none.toml\"", "none.toml: found no such file; expected a readable file"),
        ("file = \"none.ban\"", "none.ban: found no such file; expected a readable file"),
    ];
    for (rail, message) in rails {
        let found = complaint(rail, "[contact]\noffset = 0.0\n")?;
        assert!(found.contains(message), "{rail}: {found}");
    }
    let rests = [
        ("[track]\ngauge = 1435.0", "found `track` alone; expected either [contact]"),
        ("[contact]\nrail_x = 1.0\nyaw = 0.1", "contact: found `rail_x` and `yaw`; expected either"),
        ("[track]\n[wheelset]\nspacing = 1500.0", "track: found none of `gauge`, `gauge_height`, `spacing`;"),
        (
            "[track]\ngauge = 1435.0\n[wheelset]\nspacing = 1.0\nback_to_back = 2.0",
            "wheelset: found `back_to_back` and",
        ),
        ("[contact]\noffset = 0.0\n[grid]\nxi = { values = [1.0, 5.0, 3.0] }", "grid: xi: found 3 after 5;"),
        ("[contact]\noffset = 0.0\n[grid]\nxi = { values = [] }", "grid: xi: found no values;"),
        (
            "[contact]\noffset = 0.0\n[patch]\nload = 0",
            "patch: load: found 0; expected a positive load in N; leave the load out",
        ),
        (
            "[track]\ngauge = 1.435\n[wheelset]\nspacing = 1500.0",
            "track: gauge: found 1.435; expected a distance in mm; give it in mm: 1.435 m are 1435 mm",
        ),
        (
            "[track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1.36\nflange_back_x = -70.0",
            "wheelset: back_to_back: found 1.36; expected a distance in mm; give it in mm: 1.36 m are 1360 mm",
        ),
        (
            "[track]\nspacing = 59.0\n[wheelset]\nspacing = 1500.0",
            "track: spacing: found 59; expected a distance in mm; give it in mm: 59 in are 1498.6 mm",
        ),
    ];
    for (rest, message) in rests {
        let found = complaint("profile = \"60E1\"", rest)?;
        assert!(found.contains(message), "{rest}: {found}");
    }
    Ok(())
}
