//! The table of a sweep in columns.

use std::fmt::Write;

use super::doubts::{DoubtKind, DoubtSet};
use super::input::ApproachBy;
use crate::load::curvatures_at;
use crate::search::{Contact, SweepRow, TrackSide};

/// A column of the table of a sweep. The command line's text and Python's arrays read the one list, [`COLUMNS`].
pub struct SweepColumn {
    /// Its name, with the unit.
    pub name: &'static str,
    stands: Stands,
    values: ColumnValues,
}

/// Where a column is shown: in the text and the arrays, or in the arrays only.
#[derive(PartialEq)]
enum Stands {
    Both,
    Arrays,
}

/// The values of a column.
enum ColumnValues {
    Position,
    Side,
    Contact,
    Kink,
    Doubt,
    /// Numbers of a row and of the semi-axes of its ellipse, NaN where there is none; the flag tells whether the text then
    /// has an empty cell.
    Number(fn(&SweepRow, [f64; 2]) -> f64, bool),
}

/// The columns of the table, in their order.
pub const COLUMNS: [SweepColumn; 23] = [
    SweepColumn { name: "position", stands: Stands::Arrays, values: ColumnValues::Position },
    number("lateral_mm", |row, _| row.lateral),
    number("yaw_rad", |row, _| row.yaw),
    number("roll_rad", |row, _| row.roll),
    SweepColumn { name: "side", stands: Stands::Both, values: ColumnValues::Side },
    SweepColumn { name: "contact", stands: Stands::Both, values: ColumnValues::Contact },
    number("z_mm", |row, _| row.z),
    number("rail_x_mm", |row, _| row.contact.rail_x),
    number("wheel_x_mm", |row, _| row.contact.wheel_x),
    number("y_mm", |row, _| row.contact.y),
    number("contact_angle_rad", |row, _| row.contact.contact_angle),
    number("rolling_radius_mm", |row, _| row.contact.rolling_radius),
    number("delta_r_mm", |row, _| row.delta_r),
    perhaps("conicity", |row, _| row.conicity.map_or(f64::NAN, |found| found.conicity)),
    SweepColumn {
        stands: Stands::Arrays,
        ..number("conicity_error", |row, _| row.conicity.map_or(f64::NAN, |found| found.error))
    },
    number("gap_mm", |row, _| row.contact.gap),
    number("skew_rad", |row, _| row.contact.skew),
    number("rail_curvature_per_mm", |row, _| row.contact.rail_curvature),
    number("wheel_curvature_per_mm", |row, _| row.contact.wheel_curvature),
    SweepColumn { name: "kink", stands: Stands::Both, values: ColumnValues::Kink },
    perhaps("hertz_xi_mm", |_, [xi, _]| xi),
    perhaps("hertz_eta_mm", |_, [_, eta]| eta),
    SweepColumn { name: "doubt", stands: Stands::Both, values: ColumnValues::Doubt },
];

const fn number(name: &'static str, of: fn(&SweepRow, [f64; 2]) -> f64) -> SweepColumn {
    SweepColumn { name, stands: Stands::Both, values: ColumnValues::Number(of, false) }
}

/// Makes a column of numbers whose cell in the text is empty where there is none.
const fn perhaps(name: &'static str, of: fn(&SweepRow, [f64; 2]) -> f64) -> SweepColumn {
    SweepColumn { name, stands: Stands::Both, values: ColumnValues::Number(of, true) }
}

impl SweepColumn {
    /// Tells whether it holds numbers that are not whole.
    pub fn is_number(&self) -> bool {
        matches!(self.values, ColumnValues::Number(..))
    }
}

/// Contacts of a wheelset at many positions, a row each; all columns have the same length.
///
/// Lengths in mm, angles in rad; x and angles are in the profile axes of the contact's side, the left side mirrored. NaN
/// stands where a quantity does not exist.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SweepColumns {
    /// Number of the position, from 0.
    pub position: Vec<u64>,
    /// Whether the contact is on the right-hand side.
    pub right: Vec<bool>,
    /// Number of the contact on its side, from 1, by ascending gap; 0 where a list of slices defines no surface under the wheel.
    pub contact: Vec<u32>,
    /// Whether a body touches with a kink, step or end.
    pub kink: Vec<bool>,
    /// What is doubtful about the contact.
    pub doubt: Vec<DoubtSet>,
    /// The numbers, in the order of [`COLUMNS`]; empty for columns without.
    pub numbers: [Vec<f64>; COLUMNS.len()],
}

/// One column as an array.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnArray {
    /// Numbers of positions.
    Positions(Vec<u64>),
    /// Yes or no.
    Flags(Vec<bool>),
    /// Numbers of contacts.
    Counts(Vec<u32>),
    /// Sets of doubts.
    Doubts(Vec<DoubtSet>),
    /// Lengths, angles and the like.
    Numbers(Vec<f64>),
}

impl SweepColumns {
    /// Makes room for so many more rows.
    pub fn reserve(&mut self, rows: usize) {
        self.position.reserve(rows);
        self.right.reserve(rows);
        self.contact.reserve(rows);
        self.kink.reserve(rows);
        self.doubt.reserve(rows);
        for (column, numbers) in COLUMNS.iter().zip(&mut self.numbers) {
            numbers.reserve(if column.is_number() { rows } else { 0 });
        }
    }

    /// Gives the number of rows.
    pub fn rows(&self) -> usize {
        self.position.len()
    }

    /// Gives the numbers of a column; `None` of an unknown one.
    pub fn quantity(&self, name: &str) -> Option<&[f64]> {
        let index = COLUMNS.iter().position(|column| column.is_number() && column.name == name)?;
        Some(&self.numbers[index])
    }

    /// Appends the row of a contact at the position with this number. `ellipse` has the approach or load of Hertz's ellipse, and
    /// E* \[N/mm²\]; without it the semi-axes are NaN.
    pub fn push(
        &mut self,
        position: usize,
        row: &SweepRow,
        ellipse: Option<(ApproachBy, f64)>,
        doubt: DoubtSet,
    ) {
        self.position.push(position as u64);
        self.right.push(row.side == TrackSide::Right);
        self.contact.push(row.number as u32 + 1);
        self.kink.push(row.contact.kink());
        self.doubt.push(doubt);
        let axes = ellipse.and_then(|by| semi_axes(&row.contact, row.side == TrackSide::Left, by));
        let axes = axes.unwrap_or([f64::NAN; 2]);
        for (column, numbers) in COLUMNS.iter().zip(&mut self.numbers) {
            if let ColumnValues::Number(of, _) = column.values {
                numbers.push(of(row, axes));
            }
        }
    }

    /// Appends the row of a side without a surface: contact 0, and no numbers but the position's, lateral \[mm\] and yaw \[rad\].
    pub(super) fn push_hole(&mut self, position: usize, side: TrackSide, [lateral, yaw]: [f64; 2]) {
        self.position.push(position as u64);
        self.right.push(side == TrackSide::Right);
        self.contact.push(0);
        self.kink.push(false);
        self.doubt.push(DoubtSet::of(DoubtKind::Hole));
        for (column, numbers) in COLUMNS.iter().zip(&mut self.numbers) {
            if column.is_number() {
                numbers.push(match column.name {
                    "lateral_mm" => lateral,
                    "yaw_rad" => yaw,
                    _ => f64::NAN,
                });
            }
        }
    }

    /// Removes all rows; the room for them stays.
    pub fn clear(&mut self) {
        self.position.clear();
        self.right.clear();
        self.contact.clear();
        self.kink.clear();
        self.doubt.clear();
        self.numbers.iter_mut().for_each(Vec::clear);
    }

    /// Appends the rows of another table.
    pub fn extend(&mut self, other: &Self) {
        self.position.extend_from_slice(&other.position);
        self.right.extend_from_slice(&other.right);
        self.contact.extend_from_slice(&other.contact);
        self.kink.extend_from_slice(&other.kink);
        self.doubt.extend_from_slice(&other.doubt);
        for (numbers, more) in self.numbers.iter_mut().zip(&other.numbers) {
            numbers.extend_from_slice(more);
        }
    }

    /// Gives the first line of the table as CSV: the names of its columns.
    pub fn csv_head() -> String {
        let names = COLUMNS.iter().filter(|column| column.stands != Stands::Arrays);
        format!("{}\n", names.map(|column| column.name).collect::<Vec<_>>().join(","))
    }

    /// Appends all rows as CSV, in the shortest digits that read back as the same numbers.
    pub fn append_csv(&self, out: &mut String) {
        for row in 0..self.rows() {
            let cells = COLUMNS.iter().zip(&self.numbers);
            for (k, (column, numbers)) in
                cells.filter(|(column, _)| column.stands != Stands::Arrays).enumerate()
            {
                if k > 0 {
                    out.push(',');
                }
                // Writing to a String cannot fail.
                let _ = match column.values {
                    ColumnValues::Position => write!(out, "{}", self.position[row]),
                    ColumnValues::Side => out.write_str(if self.right[row] { "right" } else { "left" }),
                    ColumnValues::Contact => write!(out, "{}", self.contact[row]),
                    ColumnValues::Kink => write!(out, "{}", u8::from(self.kink[row])),
                    ColumnValues::Doubt => write!(out, "{}", self.doubt[row]),
                    ColumnValues::Number(_, true) if numbers[row].is_nan() => Ok(()),
                    ColumnValues::Number(..) => write!(out, "{}", numbers[row]),
                };
            }
            out.push('\n');
        }
    }

    /// Gives the columns as arrays with their names, in order; the sides are flags, `right`.
    pub fn into_arrays(mut self) -> Vec<(&'static str, ColumnArray)> {
        let mut out = Vec::new();
        for (column, numbers) in COLUMNS.iter().zip(self.numbers) {
            out.push(match column.values {
                ColumnValues::Position => {
                    (column.name, ColumnArray::Positions(std::mem::take(&mut self.position)))
                }
                ColumnValues::Side => ("right", ColumnArray::Flags(std::mem::take(&mut self.right))),
                ColumnValues::Contact => {
                    (column.name, ColumnArray::Counts(std::mem::take(&mut self.contact)))
                }
                ColumnValues::Kink => (column.name, ColumnArray::Flags(std::mem::take(&mut self.kink))),
                ColumnValues::Number(..) => (column.name, ColumnArray::Numbers(numbers)),
                ColumnValues::Doubt => (column.name, ColumnArray::Doubts(std::mem::take(&mut self.doubt))),
            });
        }
        out
    }
}

/// Gives the semi-axes \[mm\] of Hertz's ellipse nearest to ξ and to η; `None` at kinks, and where s is not convex.
fn semi_axes(contact: &Contact, left: bool, (by, modulus): (ApproachBy, f64)) -> Option<[f64; 2]> {
    let curvatures = curvatures_at(contact);
    let ellipse = match by {
        ApproachBy::Given(approach) => curvatures.under_approach(approach, modulus),
        ApproachBy::WheelLoad(_) | ApproachBy::WheelLoads { .. } | ApproachBy::AxleLoad(_) => {
            curvatures.under_load(by.of_wheel(left)? / contact.upright(), modulus)
        }
    };
    Some(curvatures.along(&ellipse?))
}
