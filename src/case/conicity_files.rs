//! The contact geometry of a wheelset as text, CSV, JSON, a picture and a page.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::columns::SweepColumns;
use super::conicity::{ConicityReport, DOUBT, FUNCTIONS, KEY_FIGURES};
use super::conicity_noise::{UNCERTAIN, Uncertainty};
use super::curves::curves;
use super::doubts::DoubtSet;
use super::input::{Arrangement, Case};
use super::sweep_view::{Shown, page_of, swept};
use crate::error::{Error, Result};
use crate::export::{
    CurvesMap, CurvesPanel, CurvesPicture, PageFigure, PageMap, PlottedCurve, SEPARATOR, SweepPage,
};
use crate::measured::noise::spread_text;
use crate::search::{ONE_CONTACT, ParallelSweep, Position, Roll, Selection, WheelsetOnTrack};

/// Writes the functions over the displacement as CSV: a row a displacement, empty cells where there is no value.
pub fn conicity_csv(report: &ConicityReport) -> String {
    let mut text = format!("{},{}\n", FUNCTIONS.map(|(name, _)| name).join(","), DOUBT.0);
    for (row, doubts) in report.doubts.iter().enumerate() {
        for (k, column) in report.functions.iter().enumerate() {
            let comma = if k == 0 { "" } else { "," };
            // Writing to a String cannot fail.
            let _ = match column[row] {
                value if value.is_nan() => write!(text, "{comma}"),
                value => write!(text, "{comma}{value}"),
            };
        }
        let _ = writeln!(text, ",{doubts}");
    }
    text
}

/// Gives key figures, functions, map, uncertainty and findings as one JSON object, with the definitions of all columns; null where there
/// is no value.
pub fn conicity_values(report: &ConicityReport) -> Value {
    let definitions: Map<String, Value> = KEY_FIGURES
        .iter()
        .chain(&FUNCTIONS)
        .chain([&DOUBT])
        .map(|&(name, text)| (name.into(), text.into()))
        .collect();
    let figures: Map<String, Value> = KEY_FIGURES
        .iter()
        .zip(report.key_figures)
        .map(|(&(name, _), value)| (name.into(), value.into()))
        .collect();
    let mut functions: Map<String, Value> = FUNCTIONS
        .iter()
        .zip(&report.functions)
        .map(|(&(name, _), values)| (name.into(), values.clone().into()))
        .collect();
    let doubts: Vec<String> = report.doubts.iter().map(ToString::to_string).collect();
    functions.insert(DOUBT.0.into(), doubts.into());
    json!({
        "program": "wheelrail",
        "version": env!("CARGO_PKG_VERSION"),
        "roll": if report.roll == Roll::Solve { "solve" } else { "neglect" },
        "definitions": definitions,
        "key_figures": figures,
        "functions": functions,
        "map": report.map,
        "uncertainty": report.uncertainty.as_ref().map(uncertainty_values),
        "findings": report.findings,
    })
}

/// Gives the uncertainty as a JSON object: the noise, the number of failed samples, and the spread of each quantity with the number of
/// samples that have it not.
pub fn uncertainty_values(uncertainty: &Uncertainty) -> Value {
    let spreads: Map<String, Value> = UNCERTAIN
        .iter()
        .zip(&uncertainty.spreads)
        .map(|(&name, spread)| (name.into(), json!(spread)))
        .collect();
    let lost: Map<String, Value> =
        UNCERTAIN.iter().zip(uncertainty.lost).map(|(&name, lost)| (name.into(), lost.into())).collect();
    json!({ "noise": uncertainty.noise, "failed": uncertainty.failed, "spreads": spreads, "lost": lost })
}

/// Writes key figures, their spread and the findings as a text for people.
pub fn conicity_text(report: &ConicityReport) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    for figure in figures(report) {
        let _ = writeln!(text, "{:<24} {:>12}  {}", figure.name, figure.value, figure.meaning);
    }
    if let Some(uncertainty) = &report.uncertainty {
        let noise = uncertainty.noise;
        let _ = writeln!(
            text,
            "\nnoise: points {} mm every {} mm, radius {} mm, gauge {} mm; {} samples of seed {}, {} failed",
            noise.points,
            noise.step,
            noise.radius,
            noise.gauge,
            noise.samples,
            noise.seed,
            uncertainty.failed
        );
        text += &spread_text(UNCERTAIN.into_iter().zip(uncertainty.spreads.iter().map(Option::as_ref)));
    }
    for finding in &report.findings {
        let _ = writeln!(text, "finding: {finding}");
    }
    text
}

/// Gives the key figures with their values as text and their definitions.
fn figures(report: &ConicityReport) -> Vec<PageFigure> {
    let figure = |((name, meaning), value): (&(&str, &str), f64)| PageFigure {
        name: (*name).into(),
        value: if value.is_nan() { "–".into() } else { rounded(value) },
        meaning: (*meaning).into(),
    };
    KEY_FIGURES.iter().zip(report.key_figures).map(figure).collect()
}

/// Writes a number with four decimals, a small one with two digits.
fn rounded(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 { format!("{value:.1e}") } else { format!("{value:.4}") }
}

/// Makes the picture: the usual curves of a sweep, both integrations, Δ tan γ and the map over the gauge.
///
/// # Errors
/// A case without wheelset.
pub fn conicity_picture(case: &Case, report: &ConicityReport) -> Result<CurvesPicture> {
    drawn(case, report).map(|(picture, _)| picture)
}

/// Makes the page: the curves of [`conicity_picture`] linked to the profiles, the map and the key figures with their definitions.
///
/// # Errors
/// A case without wheelset.
pub fn conicity_page(case: &Case, report: &ConicityReport) -> Result<SweepPage> {
    let (picture, columns) = drawn(case, report)?;
    let map = picture.map.as_ref().map(|map| PageMap {
        title: map.title.clone(),
        across: map.across.clone(),
        up: map.up.clone(),
        gauges: map.u.clone(),
        amplitudes: map.v.clone(),
        values: map.values.concat(),
    });
    let of_sweep = swept(case, wheelset(case)?, &columns, report.function("lateral_mm"));
    let mut page = page_of(&Shown { table: "conicity", ..of_sweep }, picture);
    page.map = map;
    page.figures = figures(report);
    page.findings = report.findings.clone();
    Ok(page)
}

fn wheelset(case: &Case) -> Result<&WheelsetOnTrack> {
    match &case.setup().arrangement {
        Arrangement::Wheelset { system, .. } => Ok(system),
        Arrangement::Points { .. } | Arrangement::Wheel { .. } | Arrangement::OnSlices { .. } => {
            let expected = "[track] and [wheelset]";
            Err(Error::new("", "a single wheel", expected, "conicity is that of a wheelset on its track"))
        }
    }
}

/// Makes the picture, and the contacts that it shows.
fn drawn(case: &Case, report: &ConicityReport) -> Result<(CurvesPicture, SweepColumns)> {
    let lateral = report.function("lateral_mm");
    let positions: Vec<Position> =
        lateral.iter().map(|&lateral| Position { lateral, yaw: 0.0, roll: report.roll }).collect();
    let selection = Selection { within: 0.0, apart: ONE_CONTACT };
    let system = wheelset(case)?;
    let sweep = ParallelSweep { system, selection, conicity: Some(&report.table), positions: &positions };
    let mut columns = SweepColumns::default();
    let rows = |chunk: &mut SweepColumns, position, rows: &[_]| {
        rows.iter().for_each(|row| chunk.push(position, row, None, DoubtSet::default()));
        Ok(())
    };
    sweep.blocks(rows, |_, chunks: Vec<SweepColumns>| {
        chunks.iter().for_each(|chunk| columns.extend(chunk));
        Ok(true)
    })?;
    let about = if report.roll == Roll::Solve { "roll solved" } else { "roll neglected" };
    let mut about = format!("EN 15302, {about}");
    if let Some(value) = report.key_figure("nonlinearity_per_mm") {
        let _ = write!(about, "{SEPARATOR}nonlinearity parameter {value:.3}/mm");
    }
    let mut picture = curves(&columns, lateral, &case.profiles().right.names(), &about)?;
    let jumps = picture.quantities[0].curves[0].jumps.clone();
    let curve = |name: &str, values: &[f64], jumps: &[usize]| PlottedCurve {
        name: name.into(),
        points: lateral.iter().zip(values).map(|(&y, &value)| [y, value]).collect(),
        jumps: jumps.to_vec(),
    };
    let both = [("energy", "conicity"), ("two-step", "conicity_two_step")];
    picture.quantities[1].title = "Equivalent conicity".into();
    picture.quantities[1].curves =
        both.map(|(name, column)| curve(name, report.function(column), &[])).into();
    let panel = CurvesPanel {
        title: "Contact angle difference, right less left".into(),
        axis: "Δ tan γ [1]".into(),
        curves: vec![curve("", report.function("delta_tan_gamma"), &jumps)],
        shown: None,
    };
    picture.quantities.insert(2, panel);
    picture.map = map(report);
    Ok((picture, columns))
}

/// Gives the map as it is drawn; `None` of a single gauge or amplitude, which gives a curve and no map.
fn map(report: &ConicityReport) -> Option<CurvesMap> {
    let of = &report.map;
    let known = of.gauge_mm.iter().all(|gauge| gauge.is_finite());
    let (across, u) =
        if known { ("gauge [mm]", &of.gauge_mm) } else { ("change of gauge [mm]", &of.gauge_change_mm) };
    (u.len() > 1 && of.amplitude_mm.len() > 1).then(|| CurvesMap {
        title: "Equivalent conicity over gauge and amplitude".into(),
        across: across.into(),
        up: "amplitude [mm]".into(),
        u: u.clone(),
        v: of.amplitude_mm.clone(),
        values: of.conicity.clone(),
    })
}
