//! The tables of a march.

use std::fmt::Write;

use super::columns::SweepColumns;
use super::march::{MarchCourse, MarchRow, MarchStop};
use crate::search::{Contact, Event, TrackSide};

/// Gives the first line of the table of stops: the columns of a sweep between the place and [`MARCH_NUMBERS`].
pub fn march_head(course: MarchCourse) -> String {
    format!("{},{},{}\n", course.column, SweepColumns::csv_head().trim_end(), MARCH_NUMBERS.join(","))
}

/// Names of what a row has beside the columns of a sweep: pitch of the common tangent plane, approach and normal force.
pub const MARCH_NUMBERS: [&str; 3] = ["contact_pitch_rad", "approach_mm", "normal_load_n"];

/// The rows of a march's table.
#[derive(Debug, Clone, Default)]
pub struct MarchColumns {
    /// Where each row stands on the course \[mm\], or \[rad\].
    pub along: Vec<f64>,
    /// The columns of a sweep, stops being its positions.
    pub columns: SweepColumns,
    /// The values of [`MARCH_NUMBERS`]; approach and normal force are NaN where a place has no region of its own.
    pub numbers: [Vec<f64>; MARCH_NUMBERS.len()],
}

impl MarchColumns {
    /// Appends the rows of a stop with this number; over a hole each wheel there has one without numbers, with the doubt `hole`.
    pub fn push(&mut self, number: usize, stop: &MarchStop) {
        for (side, _) in
            [TrackSide::Left, TrackSide::Right].into_iter().zip(stop.holes).filter(|(_, hole)| *hole)
        {
            self.along.push(stop.along);
            self.columns.push_hole(number, side, stop.stands);
            self.numbers.iter_mut().for_each(|column| column.push(f64::NAN));
        }
        for MarchRow { row, approach, normal_load, doubts, .. } in &stop.rows {
            self.along.push(stop.along);
            self.columns.push(number, row, None, doubts.kinds());
            // 0 without a sign.
            let numbers = [0.0 - row.contact.turn, *approach, *normal_load];
            self.numbers.iter_mut().zip(numbers).for_each(|(column, number)| column.push(number));
        }
    }

    /// Gives the approaches and the normal forces; `None` where no row carries.
    pub(super) fn carried(&self) -> Option<[&[f64]; 2]> {
        let [_, approach, normal_load] = &self.numbers;
        normal_load.iter().any(|load| load.is_finite()).then_some([approach, normal_load])
    }

    /// Removes all rows; the room for them stays.
    pub fn clear(&mut self) {
        self.along.clear();
        self.columns.clear();
        self.numbers.iter_mut().for_each(Vec::clear);
    }

    /// Appends all rows as CSV, in the shortest digits that read back as the same numbers.
    pub fn append_csv(&self, out: &mut String) {
        let mut text = String::new();
        self.columns.append_csv(&mut text);
        for (row, line) in text.lines().enumerate() {
            // Writing to a String cannot fail.
            let _ = write!(out, "{},{line}", self.along[row]);
            for column in &self.numbers {
                let number = column[row];
                let _ = if number.is_nan() { write!(out, ",") } else { write!(out, ",{number}") };
            }
            out.push('\n');
        }
    }
}

/// Names of an event's numbers, in the order of [`event_numbers`].
pub const EVENT_NUMBERS: [&str; 11] = [
    "rail_x_before_mm",
    "rail_x_after_mm",
    "wheel_x_before_mm",
    "wheel_x_after_mm",
    "y_before_mm",
    "y_after_mm",
    "radius_jump_mm",
    "slope_before",
    "slope_after",
    "impact_angle_rad",
    "gap_mm",
];

/// Gives the numbers of an event; NaN where there is no contact, or no second place.
pub fn event_numbers(event: &Event) -> [f64; EVENT_NUMBERS.len()] {
    let both = |of: fn(&Contact) -> f64| {
        [event.before, event.after].map(|contact| contact.as_ref().map_or(f64::NAN, of))
    };
    let [rail, wheel, y] = [both(|c| c.rail_x), both(|c| c.wheel_x), both(|c| c.y)];
    let slope = event.slopes;
    let (jump, impact, gap) = (event.radius_jump(), event.impact_angle(), event.gap.unwrap_or(f64::NAN));
    [rail[0], rail[1], wheel[0], wheel[1], y[0], y[1], jump, slope[0], slope[1], impact, gap]
}

/// Gives the first line of the table of events.
pub fn events_head(course: MarchCourse) -> String {
    format!("{},side,event,{}\n", course.column, EVENT_NUMBERS.join(","))
}

/// Appends the row of an event to the text of the table; cells without a number are empty.
pub fn append_event(out: &mut String, event: &Event) {
    // Writing to a String cannot fail.
    let _ = write!(out, "{},{},{}", event.along, event.side, event.kind.name());
    for number in event_numbers(event) {
        let _ = if number.is_nan() { write!(out, ",") } else { write!(out, ",{number}") };
    }
    out.push('\n');
}
