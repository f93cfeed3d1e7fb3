//! The tables and the picture of a march.

use std::fmt::Write;

use super::columns::Columns;
use super::curves::over;
use super::doubts::DoubtSet;
use crate::error::Result;
use crate::export::CurvesPicture;
use crate::search::{Contact, Event, Stop};

/// What a march goes along: the column of its places, and the axis of its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MarchCourse {
    /// Name of the column.
    pub column: &'static str,
    /// Name and unit of the axis.
    pub axis: &'static str,
}

/// Along the track.
pub const ALONG: MarchCourse = MarchCourse { column: "along_mm", axis: "along the track [mm]" };

/// Around the axle.
pub const AROUND: MarchCourse = MarchCourse { column: "angle_rad", axis: "pitch of the wheelset [rad]" };

/// First line of the table of stops: the columns of a sweep between the place and the pitch of the common tangent plane.
pub fn march_head(course: MarchCourse) -> String {
    format!("{},{},contact_pitch_rad\n", course.column, Columns::csv_head().trim_end())
}

/// Appends the rows of a stop to the text of the table. `columns` is a buffer.
pub fn append_stop(out: &mut String, stop: &Stop, columns: &mut Columns) {
    columns.clear();
    stop.rows.iter().for_each(|row| columns.push(0, row, None, DoubtSet::default()));
    let mut text = String::new();
    columns.append_csv(&mut text);
    for (line, row) in text.lines().zip(&stop.rows) {
        // Writing to a String cannot fail. 0 without a sign.
        let _ = writeln!(out, "{},{line},{}", stop.along, 0.0 - row.contact.turn);
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

/// First line of the table of events.
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

/// Quantities of each side's lowest contact that the picture shows: heading, axis with unit, column, factor.
const SHOWN: [(&str, &str, &str, f64); 6] = [
    ("Height of the centre", "z [mm]", "z_mm", 1.0),
    ("Rolling radius", "r [mm]", "rolling_radius_mm", 1.0),
    ("Contact on the rail", "x on the rail [mm]", "rail_x_mm", 1.0),
    ("Contact on the wheel", "x on the wheel [mm]", "wheel_x_mm", 1.0),
    ("Contact ahead of the axle", "y [mm]", "y_mm", 1.0),
    ("Contact angle", "θ [°]", "contact_angle_rad", 180.0 / std::f64::consts::PI),
];

/// Makes the picture of a march from its columns over the ascending places of all its stops; `title` and `about` stand above it.
///
/// # Errors
/// Places that do not ascend.
pub fn march_curves(
    columns: &Columns,
    (course, places): (MarchCourse, &[f64]),
    [title, about]: [&str; 2],
) -> Result<CurvesPicture> {
    over(columns, (course.axis, places), &SHOWN, (title, about))
}
