//! The usual curves of a sweep as a picture.

use super::columns::SweepColumns;
use crate::error::{Error, Result};
use crate::export::{CurvesPanel, CurvesPicture, PlottedCurve, SEPARATOR, jumps};
use crate::numerics::interval::Interval;
use crate::search::AMPLITUDE;

/// Most positions that are drawn: more than a page has pixels.
pub const MOST_DRAWN: usize = 2000;

/// A quantity of a position: heading, axis with unit, column, factor, whether it jumps where a contact does.
type OfPosition = (&'static str, &'static str, &'static str, f64, bool);

/// Quantities of a position, as its first row has them.
const OF_POSITION: [OfPosition; 3] = [
    ("Rolling radius difference, right less left", "Δr [mm]", "delta_r_mm", 1.0, true),
    ("Equivalent conicity at this amplitude", "tan γ [1]", "conicity", 1.0, false),
    ("Roll", "roll [mrad]", "roll_rad", 1e3, false),
];

/// Quantities of each side's lowest contact: heading, axis with unit, column, and whether it is an angle, shown in degrees.
const OF_SIDE: [(&str, &str, &str, bool); 3] = [
    ("Contact angle", "θ [°]", "contact_angle_rad", true),
    ("Contact on the rail", "x on the rail [mm]", "rail_x_mm", false),
    ("Contact on the wheel", "x on the wheel [mm]", "wheel_x_mm", false),
];

/// Rejects lateral displacements \[mm\] that do not grow from position to position: they have no curves.
///
/// # Errors
/// The first that does not, with the place "sweep".
pub fn ascending(lateral: &[f64]) -> Result<()> {
    let Some(pair) = lateral.windows(2).find(|pair| pair[0] >= pair[1]) else { return Ok(()) };
    let found = format!("{} mm after {} mm", pair[1], pair[0]);
    let expected = "lateral displacements that grow from position to position";
    Err(Error::new("sweep", found, expected, "sort the positions, or sweep over a range"))
}

/// Makes the picture of a sweep from its columns, the lowest contact of each side, over the lateral displacements \[mm\] of
/// all its positions; these have to ascend, and `columns` may lack those without contact. `about` stands below the title.
///
/// # Errors
/// The error of [`ascending`].
pub fn curves(columns: &SweepColumns, lateral: &[f64], title: &str, about: &str) -> Result<CurvesPicture> {
    ascending(lateral)?;
    let lowest = Lowest::new(columns, lateral.len());
    // A side's contact jumps or not whatever quantity is drawn: all its panels are parted at the same positions.
    let jumps_of = |right| {
        jumps(
            &["rail_x_mm", "wheel_x_mm"].map(|name| lowest.values(right, name)).each_ref().map(Vec::as_slice),
        )
    };
    let sides = [("left", false), ("right", true)];
    let [left, right] = sides.map(|(_, right)| jumps_of(right));
    let curve = |name: &str, values: Vec<f64>, jumps: &[usize]| {
        let points = lateral.iter().zip(values).map(|(&lateral, value)| [lateral, value]).collect();
        PlottedCurve { name: name.into(), points, jumps: jumps.to_vec() }
    };
    let tread = lowest.tread();
    let quantity = |title: &str, axis: &str, curves: Vec<PlottedCurve>, flat: bool| {
        let shown = tread.as_deref().filter(|_| flat).and_then(|tread| tread_range(&curves, tread));
        CurvesPanel { title: title.into(), axis: axis.into(), curves, shown }
    };
    let either = [left.as_slice(), right.as_slice()].concat();
    let of_position = OF_POSITION.map(|(title, axis, name, factor, jumps)| {
        let values = lowest.values(true, name).into_iter().map(|value| factor * value).collect();
        quantity(title, axis, vec![curve("", values, if jumps { &either } else { &[] })], true)
    });
    let of_side = OF_SIDE.map(|(title, axis, name, angle)| {
        let shown = |value: f64| if angle { value.to_degrees() } else { value };
        let values = |right| lowest.values(right, name).into_iter().map(shown).collect();
        let both = sides.into_iter().zip([&left, &right]);
        let curves = both.map(|((name, right), jumps)| curve(name, values(right), jumps)).collect();
        quantity(title, axis, curves, false)
    });
    let conicity = lowest.values(true, "conicity");
    let at_usual = conicity_at(lateral, &conicity, AMPLITUDE);
    let conicity = at_usual.map_or_else(String::new, |conicity| {
        format!("{SEPARATOR}equivalent conicity {conicity:.3} at {AMPLITUDE} mm")
    });
    Ok(CurvesPicture {
        title: title.into(),
        about: format!("{about}{conicity}"),
        abscissa: "lateral displacement [mm]".into(),
        quantities: of_position.into_iter().chain(of_side).collect(),
        pair: None,
        map: None,
    })
}

/// Draws quantities of both sides' lowest contacts (heading, axis with unit, column, factor) over an abscissa with its name. `beside` are
/// columns that a sweep does not have, `parted` the values after which no curve goes on.
///
/// # Errors
/// Values of the abscissa that do not ascend.
pub(super) fn over(
    (columns, beside): (&SweepColumns, &[(&str, &[f64])]),
    parted: &[usize],
    (name, abscissa): (&str, &[f64]),
    quantities: &[(&str, &str, &str, f64)],
    (title, about): (&str, &str),
) -> Result<CurvesPicture> {
    ascending(abscissa)?;
    let lowest = Lowest { beside, ..Lowest::new(columns, abscissa.len()) };
    let sides = [("left", false), ("right", true)];
    let jumps = sides.map(|(_, right)| {
        let places = ["rail_x_mm", "wheel_x_mm", "y_mm"].map(|name| lowest.values(right, name));
        [parted, &jumps(&places.each_ref().map(Vec::as_slice))].concat()
    });
    let panel = |&(title, axis, column, factor): &(&str, &str, &str, f64)| {
        let curve = |((name, right), jumps): ((&str, bool), &Vec<usize>)| {
            let values = lowest.values(right, column);
            let points = abscissa.iter().zip(values).map(|(&at, value)| [at, factor * value]).collect();
            PlottedCurve { name: name.into(), points, jumps: jumps.clone() }
        };
        let curves = sides.into_iter().zip(&jumps).map(curve).collect();
        CurvesPanel { title: title.into(), axis: axis.into(), curves, shown: None }
    };
    Ok(CurvesPicture {
        title: title.into(),
        about: about.into(),
        abscissa: name.into(),
        quantities: quantities.iter().map(panel).collect(),
        pair: None,
        map: None,
    })
}

/// Contact angles beyond this \[rad\] are those of flanges and their roots: 30°.
const FLANGE: f64 = 0.52;

/// Least share of positions on treads at which panels are scaled by these positions.
const MOSTLY: f64 = 0.2;

/// Ratio of the range of all values to that on treads above which a panel shows the range on treads only.
const FLATTENED: f64 = 3.0;

/// Gives the conicity at an amplitude \[mm\], from the line between two positions; `None` outside.
fn conicity_at(lateral: &[f64], conicity: &[f64], amplitude: f64) -> Option<f64> {
    let after = lateral.iter().position(|&lateral| lateral >= amplitude)?;
    let before = after.checked_sub(1).unwrap_or(after);
    let run = lateral[after] - lateral[before];
    let share = if run > 0.0 { (amplitude - lateral[before]) / run } else { 0.0 };
    let value = conicity.get(before)? + share * (conicity.get(after)? - conicity.get(before)?);
    (value.is_finite() && lateral[before] <= amplitude).then_some(value)
}

/// Gives the range of the curves over the positions on treads, if that of all positions is far longer.
fn tread_range(curves: &[PlottedCurve], tread: &[bool]) -> Option<Interval> {
    let range = |all: bool| {
        let points = curves.iter().flat_map(|curve| curve.points.iter().zip(tread));
        let points = points.filter(|(point, tread)| point[1].is_finite() && (all || **tread));
        Interval::around(points.map(|(point, _)| point[1]))
    };
    let (on_tread, all) = (range(false), range(true));
    (on_tread.has_width() && all.width() > FLATTENED * on_tread.width()).then_some(on_tread)
}

/// The rows of the lowest contacts, by position and side.
struct Lowest<'a> {
    columns: &'a SweepColumns,
    /// Columns beside those of a sweep, with their names.
    beside: &'a [(&'a str, &'a [f64])],
    /// Rows of the left and the right side of every position.
    rows: Vec<[Option<usize>; 2]>,
}

impl<'a> Lowest<'a> {
    fn new(columns: &'a SweepColumns, positions: usize) -> Self {
        let mut rows = vec![[None; 2]; positions];
        for row in (0..columns.rows()).filter(|&row| columns.contact[row] == 1) {
            if let Some(sides) = rows.get_mut(columns.position[row] as usize) {
                sides[usize::from(columns.right[row])] = Some(row);
            }
        }
        Self { columns, beside: &[], rows }
    }

    /// Tells for every position whether both sides touch on treads; `None` if too few do.
    fn tread(&self) -> Option<Vec<bool>> {
        let angles = [false, true].map(|right| self.values(right, "contact_angle_rad"));
        let on_tread = |k: usize| angles.iter().all(|angles| angles[k].abs() < FLANGE);
        let tread: Vec<bool> = (0..self.rows.len()).map(on_tread).collect();
        let count = tread.iter().filter(|tread| **tread).count();
        (count as f64 >= MOSTLY * tread.len() as f64).then_some(tread)
    }

    /// Gives a quantity at every position; NaN where a side has no contact.
    fn values(&self, right: bool, name: &str) -> Vec<f64> {
        let beside = || self.beside.iter().find(|column| column.0 == name).map(|column| column.1);
        let column = self.columns.quantity(name).or_else(beside).unwrap_or_default();
        let value = |row: Option<usize>| row.and_then(|row| column.get(row)).copied().unwrap_or(f64::NAN);
        self.rows.iter().map(|sides| value(sides[usize::from(right)])).collect()
    }
}
