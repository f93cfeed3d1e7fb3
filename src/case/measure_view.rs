//! What the page of measured profiles shows.

use crate::export::{MeasuredPage, MeasuresPage};
use crate::files::short_names;
use crate::measure::{MeasureOptions, MeasureRow, Overlay, Quantity, RowColumns, in_micrometres, overlay};
use crate::profile::{Profile, trace};

/// Distance of the points of a profile without a nominal \[mm\].
const STEP: f64 = 0.25;

/// Makes the page of rows, each with its profile, if it could be read, over the nominal one.
pub fn measures_page(
    rows: &[(MeasureRow, Option<&Profile>)],
    nominal: Option<&Profile>,
    options: &MeasureOptions,
    columns: RowColumns,
) -> MeasuresPage {
    let about = nominal
        .map_or_else(|| "without a nominal".to_owned(), |nominal| format!("nominal {}", nominal.title()));
    let about =
        columns.spread.map_or_else(|| about.clone(), |spread| format!("{about}; intervals: {spread}"));
    let names = short_names(&rows.iter().map(|(row, _)| row.file.as_str()).collect::<Vec<_>>());
    let title = match names.as_slice() {
        [name] => (*name).to_owned(),
        _ => format!("{} profiles", rows.len()),
    };
    MeasuresPage {
        title,
        about,
        version: env!("CARGO_PKG_VERSION").into(),
        files: rows
            .iter()
            .zip(&names)
            .map(|((row, profile), name)| file(name, row, *profile, nominal, options, columns))
            .collect(),
    }
}

fn file(
    name: &str,
    row: &MeasureRow,
    profile: Option<&Profile>,
    nominal: Option<&Profile>,
    options: &MeasureOptions,
    columns: RowColumns,
) -> MeasuredPage {
    let measures = row.measured.as_ref().ok();
    let over = profile.zip(nominal).zip(row.side);
    // The reason for a missing overlay is a finding of the row.
    let over = over.and_then(|((profile, nominal), side)| overlay(profile, side, nominal, options).ok());
    let alone = || {
        let marks = profile.map_or_else(Vec::new, |profile| trace(profile, STEP));
        marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect()
    };
    let (drawn, measured, differences) = match over {
        Some(Overlay { nominal, measured, differences, .. }) => (nominal, measured, differences),
        None => (Vec::new(), alone(), Vec::new()),
    };
    let alignment = measures.and_then(|measures| measures.alignment.as_ref());
    let alignment = alignment.map_or_else(String::new, |of| {
        let rms = of.residual.map_or_else(String::new, |rms| format!("; residual {rms:.4} mm"));
        format!("{}: {}{rms}", of.align.word(), of.text)
    });
    // No line breaks within a number and its sign or unit.
    let values = Quantity::ALL.into_iter().filter_map(|quantity| {
        let value = measures?.value(quantity)?;
        let off = measures?.if_off(quantity).map_or_else(String::new, |off| format!("±\u{a0}{off:.3}"));
        let interval = measures?.spread(quantity).map_or_else(String::new, |of| {
            let error = of.low_error.max(of.high_error);
            let [low, high] = [of.low, of.high].map(in_micrometres);
            format!("{low} to\u{a0}{high} (±\u{a0}{error:.3})")
        });
        let value = format!("{}\u{a0}{}", in_micrometres(value), quantity.unit());
        Some([quantity.text().into(), value, off, interval])
    });
    let shown = |text: String| if row.file.is_empty() { text } else { text.replace(&row.file, name) };
    MeasuredPage {
        name: name.to_owned(),
        nominal: drawn.into_iter().flatten().collect(),
        measured: measured.into_iter().flatten().collect(),
        differences: differences.into_iter().flatten().flatten().collect(),
        alignment,
        measures: values.collect(),
        broken: columns.limits.map_or_else(Vec::new, |limits| row.broken(limits)),
        findings: row.findings().into_iter().map(shown).collect(),
    }
}
