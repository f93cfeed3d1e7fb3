//! Draws the usual curves of a sweep.

use super::table::SweepTable;
use crate::answer::counted;
use wheelrail::case::{Columns, MOST_DRAWN, ascending, curves};
use wheelrail::error::{Error, Result};
use wheelrail::export::CurvesPicture;
use wheelrail::search::Position;

/// Makes the picture of a table's positions, evenly chosen; their lateral displacements have to ascend.
pub(super) fn picture(table: &SweepTable, title: &str) -> Result<CurvesPicture> {
    let all = &table.positions;
    let lateral_of = |positions: &[Position]| -> Vec<f64> { positions.iter().map(|p| p.lateral).collect() };
    let of_picture = |error: Error| error.at("--picture");
    ascending(&lateral_of(all)).map_err(of_picture)?;
    let stride = all.len().div_ceil(MOST_DRAWN).max(1);
    let drawn: Vec<Position> = all.iter().step_by(stride).copied().collect();
    let mut columns = Columns::default();
    table.sweep(&drawn).blocks(
        |chunk: &mut Columns, position, rows| {
            rows.iter().for_each(|row| chunk.push(position, row, None));
            Ok(())
        },
        |_, chunks| {
            chunks.iter().for_each(|chunk| columns.extend(chunk));
            Ok(true)
        },
    )?;
    let about =
        format!("{}; lowest contact of each side, in its own profile axes", counted(all.len(), "position"));
    curves(&columns, &lateral_of(&drawn), title, &about).map_err(of_picture)
}
