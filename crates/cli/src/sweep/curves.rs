//! Draws the usual curves of a sweep, as a picture and as a page.

use super::table::SweepTable;
use crate::answer::counted;
use wheelrail::case::{Case, Columns, DoubtSet, MOST_DRAWN, ascending, curves, joined_pair, sweep_page};
use wheelrail::error::{Error, Result};
use wheelrail::export::{CurvesPicture, SweepPage};
use wheelrail::search::Position;

/// The positions of a table that are drawn, evenly chosen.
struct Drawn {
    columns: Columns,
    /// Lateral displacements \[mm\] of the drawn positions, ascending.
    lateral: Vec<f64>,
    about: String,
}

impl Drawn {
    /// Computes the drawn positions of a table; their lateral displacements have to ascend.
    fn new(table: &SweepTable) -> Result<Self> {
        let all = &table.positions;
        let lateral_of =
            |positions: &[Position]| -> Vec<f64> { positions.iter().map(|p| p.lateral).collect() };
        ascending(&lateral_of(all))?;
        let stride = all.len().div_ceil(MOST_DRAWN).max(1);
        let drawn: Vec<Position> = all.iter().step_by(stride).copied().collect();
        let mut columns = Columns::default();
        table.sweep(&drawn).blocks(
            |chunk: &mut Columns, position, rows| {
                rows.iter().for_each(|row| chunk.push(position, row, None, DoubtSet::default()));
                Ok(())
            },
            |_, chunks| {
                chunks.iter().for_each(|chunk| columns.extend(chunk));
                Ok(true)
            },
        )?;
        let about = format!(
            "{}; lowest contact of each side, in its own profile axes",
            counted(all.len(), "position")
        );
        Ok(Self { columns, lateral: lateral_of(&drawn), about })
    }
}

/// Makes the picture of a table's positions, with the right-hand pair below; their lateral displacements have to ascend. `gauge`
/// is that of the track \[mm\], if it is known.
pub(super) fn picture(table: &SweepTable, case: &Case, gauge: Option<f64>) -> Result<CurvesPicture> {
    let drawn = Drawn::new(table).map_err(|error: Error| error.at("--picture"))?;
    let right = &case.profiles().right;
    let picture = curves(&drawn.columns, &drawn.lateral, &right.names(), &drawn.about)?;
    let gauge_line = gauge.map(|gauge| gauge / 2.0 - table.system.right().track().rail_x());
    Ok(CurvesPicture { pair: Some(joined_pair(&right.pair, &drawn.columns, gauge_line)), ..picture })
}

/// Makes the page of a table's positions; their lateral displacements have to ascend.
pub(super) fn page(table: &SweepTable, case: &Case) -> Result<SweepPage> {
    let drawn = Drawn::new(table).map_err(|error: Error| error.at("--html"))?;
    sweep_page(case, table.system, &drawn.columns, &drawn.lateral, &drawn.about)
}
