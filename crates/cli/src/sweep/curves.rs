//! Draws the usual curves of a sweep, as a picture and as a page.

use super::table::SweepTable;
use crate::answer::counted;
use wheelrail::case::{Case, SweepColumns, curves, joined_pair, sweep_page};
use wheelrail::error::Result;
use wheelrail::export::{CurvesPicture, SweepPage};

/// Makes the picture of a table's drawn positions, with the right-hand pair below; their lateral displacements have to ascend.
/// `gauge` is that of the track \[mm\], if it is known.
pub(super) fn picture(
    table: &SweepTable,
    drawn: &SweepColumns,
    case: &Case,
    gauge: Option<f64>,
) -> Result<CurvesPicture> {
    let right = &case.profiles().right;
    let picture = curves(drawn, &table.drawn_lateral(), &right.names(), &about(table))?;
    let gauge_line = gauge.map(|gauge| gauge / 2.0 - table.system.right().track().rail_x());
    Ok(CurvesPicture { pair: Some(joined_pair(&right.pair, drawn, gauge_line)), ..picture })
}

/// Makes the page of a table's drawn positions; their lateral displacements have to ascend.
pub(super) fn page(table: &SweepTable, drawn: &SweepColumns, case: &Case) -> Result<SweepPage> {
    sweep_page(case, table.system, drawn, &table.drawn_lateral(), &about(table))
}

fn about(table: &SweepTable) -> String {
    let positions = counted(table.positions.len(), "position");
    format!("{positions}; lowest contact of each side, in its own profile axes")
}
