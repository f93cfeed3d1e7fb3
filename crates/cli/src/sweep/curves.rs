//! Draws the usual curves of a sweep.

use super::table::SweepTable;
use crate::answer::counted;
use wheelrail::error::{Error, Result};
use wheelrail::export::{CurvesPanel, CurvesPicture, PlottedCurve, jumps};
use wheelrail::search::{Position, Sweep, SweepRow, TrackSide};

/// Most positions that are drawn, evenly chosen. A page has no more pixels.
const MOST_DRAWN: usize = 2000;

/// Reads one quantity from a row.
type Value = fn(&SweepRow) -> f64;

/// Quantities of a position, which its first row holds. The last entry tells whether the quantity jumps where a contact
/// jumps.
const OF_POSITION: [(&str, &str, Value, bool); 3] = [
    ("Rolling radius difference, right less left", "Δr [mm]", |row| row.delta_r, true),
    (
        "Equivalent conicity at this amplitude",
        "tan γ [1]",
        |row| row.conicity.map_or(f64::NAN, |found| found.conicity),
        false,
    ),
    ("Roll", "roll [mrad]", |row| 1e3 * row.roll, false),
];

/// Quantities of the lowest contact of each side.
const OF_SIDE: [(&str, &str, Value); 3] = [
    ("Contact angle", "θ [°]", |row| row.contact.contact_angle.to_degrees()),
    ("Contact on the rail", "x on the rail [mm]", |row| row.contact.rail_x),
    ("Contact on the wheel", "x on the wheel [mm]", |row| row.contact.wheel_x),
];

/// Makes the picture of a table's positions. Their lateral displacements must ascend.
pub(super) fn picture(table: &SweepTable, title: &str) -> Result<CurvesPicture> {
    let all = &table.positions;
    if let Some(pair) = all.windows(2).find(|pair| pair[0].lateral >= pair[1].lateral) {
        let found = format!("{} mm after {} mm", pair[1].lateral, pair[0].lateral);
        let expected = "lateral displacements that grow from position to position";
        return Err(Error::new("--picture", found, expected, "sort the positions, or use --lateral"));
    }
    let found = lowest(table)?;
    let values = |side: TrackSide, value: Value| -> Vec<f64> {
        let of = |rows: &[SweepRow]| rows.iter().find(|row| row.side == side).map_or(f64::NAN, value);
        found.iter().map(|(_, rows)| of(rows)).collect()
    };
    // A side's contact jumps regardless of the quantity, so that all panels of a side are interrupted at the same
    // positions.
    let jumps_of = |side: TrackSide| {
        jumps(&[&values(side, |row| row.contact.rail_x), &values(side, |row| row.contact.wheel_x)])
    };
    let sides = [("left", TrackSide::Left), ("right", TrackSide::Right)];
    let [left, right] = sides.map(|(_, side)| jumps_of(side));
    let curve = |name: &str, side: TrackSide, value: Value, jumps: &[usize]| {
        let points = found.iter().zip(values(side, value)).map(|((lateral, _), value)| [*lateral, value]);
        PlottedCurve { name: name.into(), points: points.collect(), jumps: jumps.to_vec() }
    };
    let quantity =
        |(title, axis): (&str, &str), curves| CurvesPanel { title: title.into(), axis: axis.into(), curves };
    let either = [left.as_slice(), right.as_slice()].concat();
    let of_position = OF_POSITION.map(|(title, axis, value, jumps)| {
        let jumps = if jumps { either.as_slice() } else { &[] };
        quantity((title, axis), vec![curve("", TrackSide::Right, value, jumps)])
    });
    let of_side = OF_SIDE.map(|(title, axis, value)| {
        let both = sides.into_iter().zip([&left, &right]);
        let curves = both.map(|((name, side), jumps)| curve(name, side, value, jumps)).collect();
        quantity((title, axis), curves)
    });
    Ok(CurvesPicture {
        title: title.into(),
        about: format!(
            "{}; lowest contact of each side, in its own profile axes",
            counted(all.len(), "position")
        ),
        abscissa: "lateral displacement [mm]".into(),
        quantities: of_position.into_iter().chain(of_side).collect(),
    })
}

/// Finds the lateral displacement \[mm\] and the lowest contact of each side, at evenly chosen positions.
fn lowest(table: &SweepTable) -> Result<Vec<(f64, Vec<SweepRow>)>> {
    let stride = table.positions.len().div_ceil(MOST_DRAWN).max(1);
    let mut sweep = Sweep::new(table.system, table.selection, table.conicity.as_ref());
    let mut rows_at = |position: &Position| {
        let mut rows = Vec::new();
        sweep.position(position, &mut rows)?;
        rows.retain(|row| row.number == 0);
        Ok((position.lateral, rows))
    };
    table.positions.iter().step_by(stride).map(&mut rows_at).collect()
}
