//! The pressures of a run: against Hertz's closed form, and in what every output says of them.

use wheelrail::case::{self, OutputFormat, Part, Run, SILENT, summaries};
use wheelrail::error::{ErrorKind, Result};
use wheelrail::scene;

/// A crown of 300 mm under a cylinder of 460 mm, over which Hertz's formulas hold.
const CROWN: &str = r#"
rail.segments = [{ arc = { center = [0.0, -300.0], radius = 300.0, half = "upper", x = [-40.0, 40.0] } }]
wheel = { radius = 460.0, segments = [{ line = { from = [-60.0, 0.0], to = [60.0, 0.0] } }] }
contact = { rail_x = 0.0, wheel_x = 0.0 }
"#;

/// S1002 on 60E1 at 1:40, near its flange.
const WHEELSET: &str = r#"
rail = { profile = "60E1", rotate = "1:40" }
wheel = { profile = "S1002", radius = 460.0 }
track.gauge = 1435.0
wheelset = { back_to_back = 1360.0, flange_back_x = -70.0, lateral = 3.0 }
"#;

fn run(text: &str) -> Result<Run> {
    Run::new(scene::resolve(&scene::parse(text, false)?, ".".as_ref(), "pressures")?, SILENT)
}

fn near(found: f64, expected: f64, bound: f64) {
    assert!((found / expected - 1.0).abs() <= bound, "{found} is not {expected}");
}

/// Parts of a cell along each axis over which its mean is taken.
const PARTS: i32 = 9;

/// The bounds are those of the documentation, over the automatic grid.
#[test]
fn pressures_over_the_grid_are_those_of_hertz() -> Result<()> {
    let run = run(&format!("{CROWN}patch = {{ approach = 0.09, pressure = true }}"))?;
    let Part { site, analysis, warnings } = &run.parts[0];
    let (found, hertz) =
        (analysis.pressure.as_ref().expect("pressures"), site.contact.ellipse.expect("an ellipse"));
    near(found.largest.pressure_n_per_mm2, hertz.pressure_n_per_mm2, 0.005);
    near(found.load, hertz.load_n, 0.003);
    near(found.contact_area, std::f64::consts::PI * hertz.a_mm * hertz.b_mm, 0.01);
    let error = (found.largest.pressure_n_per_mm2 - hertz.pressure_n_per_mm2).abs();
    assert!(error < found.largest_error, "{error} of {}", found.largest_error);
    assert!(warnings.is_empty(), "{warnings:?}");
    // The crown is rounder than the wheel: the ellipse is long along η.
    let place =
        |[xi, eta]: [f64; 2]| (xi / hertz.a_mm.min(hertz.b_mm)).hypot(eta / hertz.a_mm.max(hertz.b_mm));
    let field = found.field.as_ref().expect("a field");
    let points = site.grid.xi.iter().flat_map(|xi| site.grid.eta.iter().map(move |eta| [*xi, *eta]));
    // Values are means over cells.
    let [wide, long] = [&site.grid.xi, &site.grid.eta].map(|axis| axis[1] - axis[0]);
    let share = |k: i32| f64::from(k - PARTS / 2) / f64::from(PARTS);
    let parts = || (0..PARTS).flat_map(|i| (0..PARTS).map(move |j| [share(i) * wide, share(j) * long]));
    for (at, p) in points.zip(field).filter(|(at, _)| (place(*at) - 1.0).abs() > 0.1) {
        let shape = |[xi, eta]: [f64; 2]| (1.0 - place([at[0] + xi, at[1] + eta]).powi(2)).max(0.0).sqrt();
        let exact = hertz.pressure_n_per_mm2 * parts().map(shape).sum::<f64>() / f64::from(PARTS * PARTS);
        assert!((p - exact).abs() < 0.01 * hertz.pressure_n_per_mm2, "{at:?}: {p} is not {exact}");
    }
    for at in found.outline.iter().flatten() {
        near(place(*at), 1.0, 0.03);
    }
    Ok(())
}

#[test]
fn loads_tell_their_largest_pressure_and_every_output_has_it() -> Result<()> {
    let loaded = |rest: &str| run(&format!("{WHEELSET}patch = {{ load = 60e3{rest} }}"));
    let (coarse, fine) = (loaded("")?, loaded(", pressure = true")?);
    for (coarse, fine) in coarse.parts.iter().zip(&fine.parts) {
        let [estimate, found] =
            [coarse, fine].map(|part| part.analysis.pressure.as_ref().expect("pressures"));
        assert!(estimate.field.is_none() && found.field.is_some());
        let [p, exact] = [estimate, found].map(|found| found.largest.pressure_n_per_mm2);
        assert!((p - exact).abs() <= estimate.largest_error + found.largest_error, "{p}, {exact}");
        near(found.load, fine.site.normal_load.expect("a load"), 0.003);
        near(estimate.contact_area, found.contact_area, 0.08);
    }
    assert!(loaded("")?.parts.iter().all(|part| part.hertz_pressure().is_none()));
    let summary = &summaries(&fine)?[0];
    let found = fine.parts[0].analysis.pressure.as_ref().expect("pressures");
    assert_eq!(summary["pressure"]["largest_n_per_mm2"], found.largest.pressure_n_per_mm2);
    assert_eq!(summary["pressure"]["contact_area_mm2"], found.contact_area);
    let names = |run: &Run, format| {
        let files = case::files(run, Some(format))?;
        Ok::<_, wheelrail::Error>(files.into_iter().map(|(name, _)| name).collect::<Vec<_>>())
    };
    assert!(names(&fine, OutputFormat::Npy)?.contains(&"pressure.npy".into()));
    assert!(!names(&coarse, OutputFormat::Npy)?.contains(&"pressure.npy".into()));
    for format in [OutputFormat::Netcdf, OutputFormat::Vtk, OutputFormat::Html] {
        let holds = |run: &Run| {
            let files = case::files(run, Some(format))?;
            let has = |bytes: &[u8]| bytes.windows(8).any(|word| word == b"pressure");
            Ok::<_, wheelrail::Error>(
                files.iter().filter(|(name, _)| !name.ends_with("view.py")).any(|(_, bytes)| has(bytes)),
            )
        };
        assert!(holds(&fine)?, "{format:?}");
    }
    let pictures = case::files(&fine, None)?;
    let (_, picture) = pictures.iter().find(|(name, _)| name == "patch.svg").expect("a picture");
    assert!(String::from_utf8_lossy(picture).contains("true contact"));
    Ok(())
}

/// A place that other contacts of its wheel press down carries what is left, as its load was found.
#[test]
fn what_other_contacts_press_down_is_theirs() -> Result<()> {
    let text = r#"
rail = { profile = "UIC60", rotate = "1:20" }
wheel = { profile = "S1002", radius = 460.0 }
contact = { offset = 3.5 }
patch = { load = 60e3, pressure = true }
"#;
    let run = run(text)?;
    assert!(run.parts.len() > 1, "{} contacts", run.parts.len());
    for part in &run.parts {
        let found = part.analysis.pressure.as_ref().expect("pressures");
        near(found.load, part.site.normal_load.expect("a load"), 0.005);
    }
    Ok(())
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let cases = [
        (
            "patch = { pressure = true }",
            "patch: found neither; expected exactly one of `approach` and `load`",
        ),
        ("patch = { approach = 0.05, pressure_cell = 0.1 }", "pressure_cell: found 0.1 without pressures"),
        (
            "patch = { approach = 0.05, pressure = true, pressure_cell = 0 }",
            "pressure_cell: found 0; expected a positive",
        ),
        (
            "patch = { approach = 0.05, pressure = true }\ngrid = { reference = \"rail\" }",
            "patch: pressure: found grid.reference = \"rail\"",
        ),
        (
            "patch = { approach = 0.05, pressure = true }\ngrid = { xi = { values = [-1.0, 0.0, 2.0] } }",
            "equal steps for pressures; give grid.xi as from, to, n",
        ),
        (
            "patch = { approach = 0.05, pressure = true, pressure_cell = 1e-7 }",
            "cells; expected at most 1000000",
        ),
    ];
    for (rest, message) in cases {
        let error = run(&format!("{CROWN}{rest}")).expect_err("an error");
        assert!(error.to_string().contains(message), "{rest}: {error}");
        assert_eq!(error.kind == ErrorKind::Limit, rest.contains("1e-7"), "{rest}");
    }
}

/// Nothing is pressed without an approach, by an approach of 0, and where no pressures are asked for.
#[test]
fn what_is_not_pressed_has_no_pressures() -> Result<()> {
    let grid = "grid = { xi = { from = -5.0, to = 5.0, n = 11 }, eta = { from = -5.0, to = 5.0, n = 11 } }";
    for rest in
        ["", "patch.approach = 0.0", "patch = { approach = 0.0, pressure = true }", "patch.approach = 0.05"]
    {
        let run = run(&format!("{CROWN}{grid}\n{rest}"))?;
        assert!(run.parts[0].analysis.pressure.is_none(), "{rest}");
        assert!(!case::files(&run, Some(OutputFormat::Npy))?.iter().any(|(name, _)| name == "pressure.npy"));
    }
    Ok(())
}
