//! The table of a sweep in columns.

use super::doubts::DoubtSet;
use super::input::ApproachBy;
use crate::load::curvatures_at;
use crate::search::{Contact, SweepRow, TrackSide};

/// Contacts of a wheelset at many positions, a row each; all columns have the same length.
///
/// Lengths in mm, angles in rad; x and angles are in the profile axes of the contact's side, the left side mirrored. NaN
/// stands where a quantity does not exist.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// Number of the position, from 0.
    pub position: Vec<u64>,
    /// Whether the contact is on the right-hand side.
    pub right: Vec<bool>,
    /// Number of the contact on its side, from 1, by ascending gap.
    pub contact: Vec<u32>,
    /// Whether a body touches with a kink, step or end.
    pub kink: Vec<bool>,
    /// What is doubtful about the contact.
    pub doubt: Vec<DoubtSet>,
    /// The quantities, in the order of [`Columns::QUANTITIES`].
    pub quantities: [Vec<f64>; Columns::QUANTITIES.len()],
}

/// What a row says of a contact, in the order of the columns.
type Quantities = [f64; Columns::QUANTITIES.len()];

impl Columns {
    /// Names of the quantities, each with its unit.
    pub const QUANTITIES: [&'static str; 18] = [
        "lateral_mm",
        "yaw_rad",
        "roll_rad",
        "z_mm",
        "rail_x_mm",
        "wheel_x_mm",
        "y_mm",
        "contact_angle_rad",
        "rolling_radius_mm",
        "delta_r_mm",
        "conicity",
        "conicity_error",
        "gap_mm",
        "skew_rad",
        "rail_curvature_per_mm",
        "wheel_curvature_per_mm",
        "hertz_xi_mm",
        "hertz_eta_mm",
    ];

    /// Makes room for so many more rows.
    pub fn reserve(&mut self, rows: usize) {
        self.position.reserve(rows);
        self.right.reserve(rows);
        self.contact.reserve(rows);
        self.kink.reserve(rows);
        self.doubt.reserve(rows);
        self.quantities.iter_mut().for_each(|column| column.reserve(rows));
    }

    /// Gives the number of rows.
    pub fn rows(&self) -> usize {
        self.position.len()
    }

    /// Gives the column of a quantity; `None` of an unknown one.
    pub fn quantity(&self, name: &str) -> Option<&[f64]> {
        let index = Self::QUANTITIES.iter().position(|known| *known == name)?;
        Some(&self.quantities[index])
    }

    /// Appends the row of a contact at the position with this number; `ellipse` is approach or load, and E* \[N/mm²\], of
    /// Hertz's ellipses.
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
        for (column, value) in self.quantities.iter_mut().zip(quantities(row, ellipse)) {
            column.push(value);
        }
    }

    /// Removes all rows; the room for them stays.
    pub fn clear(&mut self) {
        self.position.clear();
        self.right.clear();
        self.contact.clear();
        self.kink.clear();
        self.doubt.clear();
        self.quantities.iter_mut().for_each(Vec::clear);
    }

    /// Appends the rows of another table.
    pub fn extend(&mut self, other: &Self) {
        self.position.extend_from_slice(&other.position);
        self.right.extend_from_slice(&other.right);
        self.contact.extend_from_slice(&other.contact);
        self.kink.extend_from_slice(&other.kink);
        self.doubt.extend_from_slice(&other.doubt);
        for (column, more) in self.quantities.iter_mut().zip(&other.quantities) {
            column.extend_from_slice(more);
        }
    }
}

fn quantities(row: &SweepRow, ellipse: Option<(ApproachBy, f64)>) -> Quantities {
    let c = &row.contact;
    let [conicity, error] = row.conicity.map_or([f64::NAN; 2], |found| [found.conicity, found.error]);
    let [xi, eta] =
        ellipse.and_then(|by| semi_axes(c, row.side == TrackSide::Left, by)).unwrap_or([f64::NAN; 2]);
    [
        row.lateral,
        row.yaw,
        row.roll,
        row.z,
        c.rail_x,
        c.wheel_x,
        c.y,
        c.contact_angle,
        c.rolling_radius,
        row.delta_r,
        conicity,
        error,
        c.gap,
        c.skew,
        c.rail_curvature,
        c.wheel_curvature,
        xi,
        eta,
    ]
}

/// Gives the semi-axes \[mm\] of Hertz's ellipse nearest to ξ and to η; `None` at kinks, and where s is not convex.
fn semi_axes(contact: &Contact, left: bool, (by, modulus): (ApproachBy, f64)) -> Option<[f64; 2]> {
    let curvatures = curvatures_at(contact);
    let ellipse = match by {
        ApproachBy::Given(approach) => curvatures.under_approach(approach, modulus),
        ApproachBy::WheelLoad(_) | ApproachBy::WheelLoads { .. } | ApproachBy::AxleLoad(_) => {
            curvatures.under_load(by.of_wheel(left)? / contact.contact_angle.cos(), modulus)
        }
    };
    Some(curvatures.along(&ellipse?))
}
