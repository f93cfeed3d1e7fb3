//! Asks in one message for all that a file leaves open and needs, in the words of a scene; other surfaces turn them into their own.

use super::clean::checks::{self, Finding};
use super::clean::findings;
use super::clean::repairs;
use super::options::{Options, Repair};
use super::read::points::{Point, Points};
use super::shape::{head_up, reach};
use super::unit::Unit;
use crate::error::Error;
use crate::profile::Side;
use std::ops::RangeInclusive;

/// Widths \[mm\] that a profile may have. Other widths mean a wrong unit (0.14: metres; 5500: thousandths of an inch).
const WIDTHS: RangeInclusive<f64> = 5.0..=500.0;
/// Least width \[mm\] of a profile whose unit nothing states: rails and wheels in inches have 2.8 to 6, in cm 7 to 14.
const PLAIN_WIDTH: f64 = 20.0;
/// Widths \[mm\] of whole rail heads and wheels.
const USUAL_WIDTHS: RangeInclusive<f64> = 50.0..=150.0;
/// Widths \[mm\] of parts of them, and of rails with a keeper or a check rail.
const POSSIBLE_WIDTHS: RangeInclusive<f64> = 20.0..=250.0;

/// A question that neither option, format nor shape answers, or a repair that the points need.
#[derive(Debug)]
pub(super) struct OpenQuestion {
    /// Name of the option.
    pub what: &'static str,
    /// What was found.
    pub found: String,
    /// What may be given.
    pub choices: String,
}

/// Returns the error that asks all open questions at once; a shape that looks like the other body comes first.
pub(super) fn asked(open: &[OpenQuestion], points: &[Point], side: Side, stated: bool) -> Error {
    let list = |part: fn(&OpenQuestion) -> &str, between: &str| {
        open.iter().map(part).collect::<Vec<_>>().join(between)
    };
    let mut advice = match open.len() {
        1 => "give the option",
        2 => "give both options",
        _ => "give all these options",
    }
    .to_owned();
    let turned = |question: &OpenQuestion| ["mirror", "flip_z"].contains(&question.what);
    if !stated && open.iter().any(turned) {
        advice += &format!(", and `unit` unless it is {:.1} mm wide", reach(points).width());
    }
    let other = if side == Side::Rail { Side::Wheel } else { Side::Rail };
    let mut found = list(|question| &question.found, "; ");
    if let Some((_, why)) = head_up(points, other).filter(|_| open.iter().any(turned)) {
        found = format!("the shape of a {} ({why}); as a {}: {found}", name(other), name(side));
        advice = format!("give it as a {}; or {advice}", name(other));
    }
    Error::new(
        list(|question| question.what, ", "),
        found,
        list(|question| &question.choices, ", and "),
        advice,
    )
}

/// Returns the name of a body.
pub(super) fn name(side: Side) -> &'static str {
    match side {
        Side::Rail => "rail",
        Side::Wheel => "wheel",
    }
}

/// Returns the error of points whose width in a unit \[mm\] means that the unit is wrong, and the length \[mm\] of the unit that is
/// likeliest meant; `stated` tells whether the file or an option names the unit. `None` for a possible width. A unit is advised only
/// where the width would be that of a profile.
pub(super) fn wrong_unit(points: &[Point], unit: f64, stated: bool) -> Option<(Error, f64)> {
    let wide = reach(points).width();
    let as_if = |other: &Unit| wide / unit * other.millimetres();
    let fitting = |widths: &RangeInclusive<f64>| -> Vec<Unit> {
        let others = Unit::ALL.into_iter().filter(|other| other.millimetres() != unit);
        let mut all: Vec<Unit> = others.filter(|other| widths.contains(&as_if(other))).collect();
        // The likeliest one first: that of a width near a head's or a tread's.
        let off = |unit: &Unit| (as_if(unit) / USUAL_WIDTHS.end()).ln().abs();
        all.sort_by(|a, b| off(a).total_cmp(&off(b)));
        all
    };
    let possible = WIDTHS.contains(&wide);
    let mut likely = fitting(&USUAL_WIDTHS);
    if possible && (stated || wide >= PLAIN_WIDTH || likely.is_empty()) {
        return None;
    }
    if likely.is_empty() {
        likely = fitting(&POSSIBLE_WIDTHS);
    }
    let names: Vec<_> = likely.iter().map(|other| format!("\"{}\"", other.name())).collect();
    let advice = match names.len() {
        0 => "give another file".to_owned(),
        _ => format!("give the right `unit`: {} would do", names.join(" or ")),
    };
    let expected =
        if possible { "60 to 150 mm, as rails and wheels have, or a `unit`" } else { "5 to 500 mm" };
    let error = Error::new("unit", format!("a width of {} mm", shown(wide)), expected, advice);
    Some((error, likely.first().map_or(unit, |likeliest| likeliest.millimetres())))
}

/// Returns a length to six digits, for messages.
fn shown(length: f64) -> f64 {
    format!("{length:.5e}").parse().unwrap_or(length)
}

/// Returns the questions about the content of a file: which columns, and which of several profiles.
pub(super) fn of_content(points: &Points, starts: &[usize], options: &Options) -> Vec<OpenQuestion> {
    let mut open = Vec::new();
    if let Some(choice) = &points.columns {
        let names =
            if choice.names.is_empty() { String::new() } else { format!(" ({})", choice.names.join(", ")) };
        let found = format!("{} columns{names} from line {}", choice.count, choice.line);
        let likely = choice.likely.as_ref().map(|[a, b]| format!("`columns = [{a}, {b}]`, or two others"));
        let choices = likely
            .unwrap_or_else(|| "`columns = [m, n]`, numbers from 1 or names of the first row".to_owned());
        open.push(OpenQuestion { what: "columns", found, choices });
    }
    if starts.len() > 1 && options.section.is_none() {
        let place = |k: &usize| points.at[*k].line.to_string();
        let lines: Vec<_> = starts.iter().take(5).map(place).collect();
        let more = if starts.len() > 5 { ", …" } else { "" };
        let found = format!("{} profiles, which begin in lines {}{more}", starts.len(), lines.join(", "));
        let choices = format!("`section = 1` to `section = {}`", points.sections.len());
        open.push(OpenQuestion { what: "section", found, choices });
    }
    open
}

/// What points need before a curve can go through them.
pub(super) struct Needed {
    /// The faults that they have with the repairs that are allowed.
    pub findings: Vec<Finding>,
    /// All repairs that they need, those that are allowed included.
    pub repairs: Vec<Repair>,
    /// What is wrong with them after these repairs.
    pub left: Vec<Finding>,
}

/// Finds the repairs that points need: each fault names its repair, until none is left that has one.
pub(super) fn needed(points: &[Point], side: Side, options: &Options) -> Needed {
    let mut allowed = options.repair.clone();
    let checked = |allowed: &[Repair]| {
        let mut mended = points.to_vec();
        repairs::repair(&mut mended, allowed);
        findings::findings(&mended, side, options.gauge_height())
    };
    let findings = checked(&allowed);
    let mut left = findings.clone();
    loop {
        let next: Vec<Repair> =
            left.iter().filter(|finding| finding.fatal).filter_map(Finding::repair).collect();
        let before = allowed.len();
        for repair in next {
            if !allowed.contains(&repair) {
                allowed.push(repair);
            }
        }
        if allowed.len() == before {
            return Needed { findings, repairs: allowed, left };
        }
        left = checked(&allowed);
    }
}

/// Returns the question for the repairs that points need; `None` if they need none beyond the allowed ones.
pub(super) fn of_repairs(points: &[Point], side: Side, options: &Options) -> Option<OpenQuestion> {
    let needed = needed(points, side, options);
    let error = checks::reject(&needed.findings).err()?;
    let left = checks::reject(&needed.left).err();
    let choices = match left {
        None => written(&needed.repairs),
        Some(left) => format!("{} ({}: {})", left.expected, left.place, by_hand(&left)),
    };
    Some(OpenQuestion { what: "repair", found: format!("{}: {}", error.place, error.found), choices })
}

/// Rejects points with a fatal finding, and names all repairs that they need.
///
/// # Errors
/// At least one finding is fatal.
pub(super) fn reject(
    points: &[Point],
    findings: &[Finding],
    side: Side,
    options: &Options,
) -> crate::error::Result<()> {
    let Err(mut error) = checks::reject(findings) else { return Ok(()) };
    let needed = needed(points, side, options);
    match checks::reject(&needed.left) {
        Ok(()) => {
            let by_hand = by_hand(&error).to_owned();
            let others = needed.repairs.len() > 1 + options.repair.len();
            let by_hand = if others || by_hand.starts_with("allow") {
                "give".to_owned()
            } else {
                format!("{by_hand}, or give")
            };
            error.advice = format!("{by_hand} {}", written(&needed.repairs));
        }
        Err(left) if left.place != error.place || left.found != error.found => {
            error.advice = format!(
                "{}; then {} has {}: {}",
                written(&needed.repairs),
                left.place,
                left.found,
                by_hand(&left)
            );
        }
        Err(_) => error.advice = by_hand(&error).to_owned(),
    }
    Err(error)
}

/// Returns what an error advises besides a repair: none mends what is left after all of them.
fn by_hand(error: &Error) -> &str {
    error.advice.split(", or allow").next().unwrap_or_default()
}

/// Writes repairs as a scene has them.
fn written(repairs: &[Repair]) -> String {
    let names: Vec<_> = repairs.iter().map(|repair| format!("\"{}\"", repair.name())).collect();
    format!("`repair = [{}]`", names.join(", "))
}
