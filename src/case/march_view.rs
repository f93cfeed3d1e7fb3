//! The picture and the page of a march.

use super::curves::over;
use super::march::{AROUND, MarchCase, MarchCourse};
use super::march_table::{MARCH_NUMBERS, MarchColumns, event_numbers};
use super::sweep_view::{Shown, page_of};
use super::view::with_minus;
use crate::error::Result;
use crate::export::{CurvesPicture, PageEvent, PageEvents, SEPARATOR, SweepPage};
use crate::numerics::interval::Interval;
use crate::search::Event;

/// Quantities of each side's lowest contact that the picture shows: heading, axis with unit, column, factor.
const SHOWN: [(&str, &str, &str, f64); 6] = [
    ("Height of the centre", "z [mm]", "z_mm", 1.0),
    ("Rolling radius", "r [mm]", "rolling_radius_mm", 1.0),
    ("Contact on the rail", "x on the rail [mm]", "rail_x_mm", 1.0),
    ("Contact on the wheel", "x on the wheel [mm]", "wheel_x_mm", 1.0),
    ("Contact ahead of the axle", "y [mm]", "y_mm", 1.0),
    ("Contact angle", "θ [°]", "contact_angle_rad", 180.0 / std::f64::consts::PI),
];

/// Quantities of the region of each side's lowest contact under a load: heading, axis with unit, column, factor.
const CARRIED: [(&str, &str, &str, f64); 2] = [
    ("Approach of the lowest contact", "δ [mm]", MARCH_NUMBERS[1], 1.0),
    ("Normal force of the lowest contact", "F [kN]", MARCH_NUMBERS[2], 1e-3),
];

/// Largest number of events that a page lists; the others are counted.
const MOST_LISTED: usize = 400;

/// Largest number of holes that a picture names; the others are counted.
const MOST_NAMED: usize = 6;

/// The events of a march that its page lists.
#[derive(Debug, Clone, Default)]
pub struct ListedEvents {
    events: Vec<Event>,
    more: usize,
}

impl ListedEvents {
    /// Takes an event, or counts it where there are too many.
    pub fn push(&mut self, event: &Event) {
        if self.events.len() < MOST_LISTED { self.events.push(*event) } else { self.more += 1 }
    }

    fn on_page(&self, course: MarchCourse) -> PageEvents {
        let columns = [course.axis, "side", "event", "x on the rail [mm]", "x on the wheel [mm]", "y [mm]"];
        let numbers = ["change of r [mm]", "impact angle [mrad]", "gap [mm]"];
        PageEvents {
            columns: columns.into_iter().chain(numbers).map(Into::into).collect(),
            rows: self.events.iter().map(|event| page_event(event, course)).collect(),
            more: self.more,
        }
    }
}

/// Gives the row of an event in the list of a page.
fn page_event(event: &Event, course: MarchCourse) -> PageEvent {
    let number = |value: f64, decimals: usize| match format!("{value:.decimals$}") {
        _ if value.is_nan() => String::new(),
        // 0 without a sign.
        text if !text.contains(|c| ('1'..='9').contains(&c)) => text.replace('-', ""),
        text => text.replace('-', "\u{2212}"),
    };
    let [rail, rail_after, wheel, wheel_after, y, y_after, jump, _, _, impact, gap] = event_numbers(event);
    let both = |[before, after]: [f64; 2]| match [number(before, 2), number(after, 2)] {
        [before, after] if before == after => before,
        [before, after] => format!("{before} → {after}").trim().into(),
    };
    PageEvent {
        at: event.along,
        cells: vec![
            number(event.along, course.decimals),
            event.side.name().into(),
            event.kind.name().into(),
            both([rail, rail_after]),
            both([wheel, wheel_after]),
            both([y, y_after]),
            number(jump, 3),
            number(1e3 * impact, 2),
            number(gap, 4),
        ],
    }
}

/// A march at the stops that are drawn.
pub struct DrawnMarch<'a> {
    /// The march; bodies that vary are cut anew at every stop.
    pub case: &'a MarchCase,
    /// What it goes along.
    pub course: MarchCourse,
    /// Its contacts at the stops.
    pub columns: &'a MarchColumns,
    /// Ascending places of the stops on the course \[mm\], or \[rad\].
    pub places: &'a [f64],
    /// Title, and the line below it.
    pub headings: [&'a str; 2],
}

impl DrawnMarch<'_> {
    /// Makes the picture.
    ///
    /// # Errors
    /// Places that do not ascend.
    pub fn picture(&self) -> Result<CurvesPicture> {
        let [title, about] = self.headings;
        let ends = [self.places.first(), self.places.last()].map(|end| end.copied().unwrap_or_default());
        let holes = self.case.march.holes(ends.into());
        let hole_between =
            |pair: &[f64]| holes.iter().any(|hole| hole.overlaps(Interval::new(pair[0], pair[1])));
        let parted: Vec<usize> = (1..self.places.len())
            .filter(|&k| hole_between(&self.places[k - 1..=k]))
            .map(|k| k - 1)
            .collect();
        let about = [about, &self.without_surface(&holes)].concat();
        let carried = self.columns.carried();
        let beside: Vec<(&str, &[f64])> =
            MARCH_NUMBERS[1..].iter().copied().zip(carried.into_iter().flatten()).collect();
        let shown = [SHOWN.as_slice(), if carried.is_some() { &CARRIED } else { &[] }].concat();
        let abscissa = (self.course.axis, self.places);
        over((&self.columns.columns, &beside), &parted, abscissa, &shown, (title, &about))
    }

    /// Says where no surface is defined; nothing without holes.
    fn without_surface(&self, holes: &[Interval]) -> String {
        let decimals = self.course.decimals;
        let list: Vec<String> = holes
            .iter()
            .take(MOST_NAMED)
            .map(|hole| with_minus(&format!("{:.decimals$} to {:.decimals$}", hole.low, hole.high)))
            .collect();
        let more = match holes.len().saturating_sub(MOST_NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        if list.is_empty() {
            more
        } else {
            format!("{SEPARATOR}holes without a surface: {}{more}", list.join(", "))
        }
    }

    /// Makes the page: the curves of the picture over a slider along the course, with the sections of rails and wheels at every stop.
    ///
    /// # Errors
    /// Places that do not ascend.
    pub fn page(&self, events: &ListedEvents) -> Result<SweepPage> {
        let pitch = self.case.march.pitch;
        let stands = |at: f64| if self.course == AROUND { [0.0, at] } else { [at, pitch] };
        let shown = Shown {
            profiles: &self.case.profiles,
            scene: &self.case.echo.scene,
            system: &self.case.march.system,
            columns: &self.columns.columns,
            positions: self.places,
            stands: &stands,
            loads: self.columns.carried().map(|[_, loads]| loads),
            table: "march",
        };
        Ok(SweepPage { events: events.on_page(self.course), ..page_of(&shown, self.picture()?) })
    }
}
