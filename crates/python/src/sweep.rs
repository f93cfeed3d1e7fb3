//! Sweeps over many positions.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::case::{
    ApproachBy, COLUMNS, ColumnArray, ContactDoubts, DoubtSet, MOST_DRAWN, RollEnds, SideLandmarks,
    SweepColumns, Tally, curves, doubts_of_conicities,
};
use wheelrail::search::{
    ONE_CONTACT, ParallelSweep, Position, Selection, TrackSide, WheelsetOnTrack, conicity_over,
};

use crate::arrays::values;
use crate::errors::{OrRaise, say};
use crate::long::{Watch, watched};
use crate::positions::Positions;

/// What to do where the roll ends.
pub(crate) const ROLL_ENDS: &str = "interpolate between rows of one side of it only";

/// What is asked of every position.
pub(crate) struct AskedOfSweep {
    /// Largest vertical gap of a near miss that is reported \[mm\].
    pub(crate) within: f64,
    pub(crate) conicity: bool,
    /// Approach or load, and E* \[N/mm²\], of Hertz's ellipses.
    pub(crate) ellipses: Option<(ApproachBy, f64)>,
}

/// Sweeps, and makes `wheelrail.Table` of the columns.
pub(crate) fn sweep<'py>(
    py: Python<'py>,
    (system, landmarks, radii): (Arc<WheelsetOnTrack>, Arc<SideLandmarks>, [f64; 2]),
    positions: Positions,
    asked: AskedOfSweep,
    progress: Option<&Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let AskedOfSweep { within, conicity, ellipses } = asked;
    let count = positions.count;
    let radius = move |side| radii[usize::from(side == TrackSide::Right)];
    let (columns, tally, doubts, ends) =
        watched(py, progress.map(|shown| (shown, "positions")), move |watch| {
            watch.at(0, positions.count);
            let positions = listed(&positions, watch)?;
            let conicity = if conicity { conicity_over(&system, &positions, &mut |_, _| {})? } else { None };
            let selection = Selection { within, apart: ONE_CONTACT };
            let doubts = match &conicity {
                Some(table) => doubts_of_conicities(&system, table, &positions, &landmarks, radius)?,
                None => Vec::new(),
            };
            let conicity = conicity.as_ref();
            let sweep = ParallelSweep { system: &system, selection, conicity, positions: &positions };
            let mut all = (SweepColumns::default(), Tally::default(), RollEnds::default());
            all.0.reserve(2 * positions.len());
            sweep.blocks(
                |(columns, tally, ends): &mut (SweepColumns, Tally, RollEnds), number, rows| {
                    let push = |(row, doubts): &(&_, ContactDoubts)| {
                        columns.push(number, row, ellipses, doubts.kinds())
                    };
                    tally.add(landmarks.of_rows(rows).inspect(push));
                    ends.add(&positions[number], rows);
                    watch.go_on()
                },
                |done, chunks: Vec<(SweepColumns, Tally, RollEnds)>| {
                    for (columns, tally, ends) in &chunks {
                        all.0.extend(columns);
                        all.1.join(tally);
                        all.2.join(ends);
                    }
                    watch.at(done, positions.len());
                    Ok(true)
                },
            )?;
            let (columns, tally, ends) = all;
            Ok((columns, tally, doubts, ends.lines(&system, || watch.go_on())?))
        })?;
    for doubt in &doubts {
        say(py, "conicity", doubt, "see `wheelrail.conicity`")?;
    }
    if let Some(line) = tally.line(count, radius) {
        say(py, "contacts", &line, "the column `doubt` says where")?;
    }
    for end in &ends {
        say(py, "roll", end, ROLL_ENDS)?;
    }
    let table = py.import("wheelrail._table")?.getattr("Table")?;
    table.call1((arrays_of(py, columns)?,))
}

/// Lists the positions; ten million take half a second.
fn listed(positions: &Positions, watch: &Watch) -> wheelrail::Result<Vec<Position>> {
    /// Positions between two calls of [`Watch::go_on`].
    const PART: usize = 1 << 16;
    let mut list = Vec::with_capacity(positions.count);
    while list.len() < positions.count {
        watch.go_on()?;
        let end = positions.count.min(list.len() + PART);
        list.extend((list.len()..end).map(|k| positions.at(k)));
    }
    Ok(list)
}

/// Gives the columns as NumPy arrays, which take over their memory.
pub(crate) fn arrays_of(py: Python<'_>, columns: SweepColumns) -> PyResult<Bound<'_, PyDict>> {
    let arrays = PyDict::new(py);
    for (name, array) in columns.into_arrays() {
        match array {
            ColumnArray::Positions(numbers) => arrays.set_item(name, PyArray1::from_vec(py, numbers))?,
            ColumnArray::Flags(flags) => arrays.set_item(name, PyArray1::from_vec(py, flags))?,
            ColumnArray::Counts(numbers) => arrays.set_item(name, PyArray1::from_vec(py, numbers))?,
            ColumnArray::Doubts(sets) => {
                let codes = sets.into_iter().map(DoubtSet::code).collect();
                arrays.set_item(name, PyArray1::from_vec(py, codes))?;
            }
            ColumnArray::Numbers(numbers) => arrays.set_item(name, PyArray1::from_vec(py, numbers))?,
        }
    }
    Ok(arrays)
}

/// Return the words of every set of doubts, by its code in the column `doubt`: a space between two, none for the empty set.
#[pyfunction]
pub(crate) fn doubt_words() -> Vec<String> {
    DoubtSet::all().map(|set| set.to_string()).collect()
}

/// Draw the usual curves of a table's columns over the lateral displacements of its positions, as SVG.
///
/// Raises InputError for displacements that do not ascend.
#[pyfunction]
pub(crate) fn sweep_picture(columns: &Bound<'_, PyDict>, title: &str) -> PyResult<String> {
    let DrawnPositions { columns, lateral, about } = DrawnPositions::of(columns)?;
    Ok(curves(&columns, &lateral, title, &about).or_raise()?.svg())
}

/// The positions of a table that a picture shows.
pub(crate) struct DrawnPositions {
    pub(crate) columns: SweepColumns,
    /// Lateral displacements of the positions \[mm\].
    pub(crate) lateral: Vec<f64>,
    /// Text below the title.
    pub(crate) about: String,
}

impl DrawnPositions {
    /// Chooses positions from the columns of a table, arrays by their names.
    pub(crate) fn of(columns: &Bound<'_, PyDict>) -> PyResult<Self> {
        let column = |name: &str| -> PyResult<Vec<f64>> {
            let column = columns.get_item(name)?.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
            values(name, &column)
        };
        let [position, right, contact, kink] = ["position", "right", "contact", "kink"].map(column);
        let (position, right, contact, kink) = (position?, right?, contact?, kink?);
        let lateral = column("lateral_mm")?;
        let mut numbers = Vec::new();
        for known in &COLUMNS {
            numbers.push(if known.is_number() { column(known.name)? } else { Vec::new() });
        }
        // Positions without contact are not in the table; the others are numbered anew, and evenly chosen.
        let mut touching = position.clone();
        touching.dedup();
        let stride = touching.len().div_ceil(MOST_DRAWN).max(1);
        let drawn: Vec<f64> = touching.iter().step_by(stride).copied().collect();
        let mut chosen = SweepColumns::default();
        let mut laterals = Vec::new();
        let mut next = 0;
        for row in 0..position.len() {
            while next < drawn.len() && drawn[next] < position[row] {
                next += 1;
            }
            if drawn.get(next) != Some(&position[row]) {
                continue;
            }
            if laterals.len() <= next {
                laterals.push(lateral[row]);
            }
            chosen.position.push(next as u64);
            chosen.right.push(right[row] != 0.0);
            chosen.contact.push(contact[row] as u32);
            chosen.kink.push(kink[row] != 0.0);
            for (to, from) in chosen.numbers.iter_mut().zip(&numbers) {
                to.extend(from.get(row));
            }
        }
        let about =
            format!("{} positions; lowest contact of each side, in its own profile axes", touching.len());
        Ok(Self { columns: chosen, lateral: laterals, about })
    }
}
