//! Reads SIMPACK profiles: `.prr` rails and `.prw` wheels.
//!
//! A file has a `header` with the body's type (0 rail, 1 wheel), a `spline` with keys that change the points, and the
//! points (y, z, optional weight). Lengths are in a unit of which `units.len.f` make a metre. Axes: y to the right, z down
//! (comments of SIMPACK's own files; reader and guide of CONTACT). The keys act in the order of the numbers in those
//! comments:
//!
//! 1. `point.dist.min`: a point nearer than this to the last kept point is dropped;
//! 2. `shift.y`, `shift.z`;
//! 3. `rotate` about the origin, from y to z;
//! 4. `bound.*`: points outside are dropped, where min < max;
//! 5. `mirror.y`, `mirror.z`;
//! 6. `inversion` of the order;
//! 7. units: the points become mm.
//!
//! `approx.smooth` is SIMPACK's own smoothing and is not used; see `cutoff_wavelength`.

use std::collections::BTreeMap;

use super::dialect::is_missing;
use super::points::{Point, Points};
use super::scan::{Line, last_place, lines};
use crate::error::{Error, Result};
use crate::measured::Format;
use crate::measured::unit::Unit;
use crate::numerics::interval::Interval;
use crate::profile::Side;

/// Keys of the spline that are read, each at most once. All but the first one have an effect.
const KEYS: [&str; 16] = [
    "approx.smooth",
    "point.dist.min",
    "shift.y",
    "shift.z",
    "rotate",
    "bound.y.min",
    "bound.y.max",
    "bound.z.min",
    "bound.z.max",
    "mirror.y",
    "mirror.z",
    "inversion",
    "units.len",
    "units.ang",
    "units.len.f",
    "units.ang.f",
];
/// Keys that do not change the points.
const SILENT: [&str; 5] = ["version", "file", "file.mtime", "comment", "type"];
/// Beginning of the header's keys for measuring positions on the wheel. They do not change the points.
const MEASURING: &str = "meas.pos.";

#[derive(Debug, Default)]
struct Keys<'a> {
    values: BTreeMap<String, (Line<'a>, &'a str)>,
}

/// Reads a SIMPACK file and applies its keys: y to the right, z down, mm.
///
/// # Errors
/// Unknown sections; keys outside a section; values and points that are not numbers; a missing end. The error gives the
/// line.
pub(in crate::measured) fn read(text: &str) -> Result<Points> {
    // The points are in mm after step 7.
    let mut points = Points::new(Format::Simpack, Some(1.0));
    let mut keys = Keys::default();
    let mut open: Vec<&str> = Vec::new();
    for line in lines(text).map(without_comment) {
        if line.text.is_empty() {
            continue;
        }
        if let Some(name) = line.text.strip_suffix(".begin") {
            begin(line, name, &mut open)?;
        } else if let Some(name) = line.text.strip_suffix(".end") {
            if open.pop() != Some(name) {
                return Err(line.error(line.text, "the end of the section that is open", "correct the line"));
            }
        } else if let Some((key, value)) = line.key_value() {
            let inside = open.last().copied();
            keys.set(line, inside, key, value, &mut points)?;
        } else if open == ["spline", "point"] {
            push(&mut points, line)?;
        } else {
            return Err(line.error(line.text, "`key = value`, or points inside `point.begin`", "delete it"));
        }
    }
    if let Some(name) = open.last() {
        let expected = format!("{name}.end");
        return Err(Error::new(last_place(text), "the end of the file", expected, "give the whole file"));
    }
    keys.apply(&mut points)?;
    points.finish(text)
}

/// Returns the line up to the first `!` outside quotes. Files of CONTACT also have comment lines, which begin with `%`, `#`
/// or `"`.
fn without_comment(line: Line) -> Line {
    if line.text.starts_with(['%', '#', '"']) {
        return Line { text: "", ..line };
    }
    let mut quoted = false;
    let end = line.text.find(|c| {
        quoted ^= c == '\'';
        c == '!' && !quoted
    });
    Line { text: line.text[..end.unwrap_or(line.text.len())].trim_end(), ..line }
}

fn begin<'a>(line: Line<'a>, name: &'a str, open: &mut Vec<&'a str>) -> Result<()> {
    let known = match open[..] {
        [] => matches!(name, "header" | "spline"),
        ["spline"] => name == "point",
        _ => false,
    };
    if !known {
        let expected = "header, spline, and point inside spline";
        return Err(line.error(line.text, expected, "correct or delete the section"));
    }
    open.push(name);
    Ok(())
}

fn push(points: &mut Points, line: Line) -> Result<()> {
    let fields = line.fields()?;
    if !(2..=3).contains(&fields.len()) {
        return Err(line.error(line.text, "y, z and perhaps a weight", "correct or delete the line"));
    }
    if fields[..2].iter().any(|field| !field.is_empty() && is_missing(field)) {
        points.no_value(line);
        return Ok(());
    }
    let weight = fields.get(2).map_or(Ok(1.0), |field| line.number(field, "weight"))?;
    if weight <= 0.0 {
        let advice = "delete the point, or weigh it";
        return Err(line.error(format!("weight {weight}"), "a positive weight", advice));
    }
    points.push(line, [line.number(fields[0], "y")?, line.number(fields[1], "z")?], weight)
}

impl<'a> Keys<'a> {
    fn set(
        &mut self,
        line: Line<'a>,
        section: Option<&str>,
        key: &str,
        value: &'a str,
        points: &mut Points,
    ) -> Result<()> {
        let Some(section) = section.filter(|&section| section != "point") else {
            let expected = "keys inside header or spline only";
            return Err(line.error(line.text, expected, "move or delete the line"));
        };
        if section == "header" && key == "type" {
            points.body = match value {
                "0" => Some(Side::Rail),
                "1" => Some(Side::Wheel),
                _ => return Err(line.error(line.text, "type = 0 (rail) or 1 (wheel)", "correct it")),
            };
        }
        if section == "spline" && KEYS.contains(&key) {
            if self.values.insert(key.to_owned(), (line, value)).is_some() {
                return Err(line.error(line.text, "each key once", "delete the line that is wrong"));
            }
        } else if !SILENT.contains(&key) && !key.starts_with(MEASURING) {
            points.note(line.number, format!("key `{key}` is not known and changes nothing"));
        }
        Ok(())
    }

    fn number(&self, key: &str, default: f64) -> Result<f64> {
        self.values.get(key).map_or(Ok(default), |(line, value)| line.number(value, key))
    }

    fn flag(&self, key: &str) -> Result<bool> {
        match self.values.get(key) {
            None | Some((_, "0")) => Ok(false),
            Some((_, "1")) => Ok(true),
            Some((line, _)) => Err(line.error(line.text, "0 or 1", "correct the value")),
        }
    }

    /// Returns the length of the file's unit \[mm\].
    fn length_unit(&self) -> Result<f64> {
        let per_metre = self.number("units.len.f", 1.0)?;
        let stated = self.values.get("units.len.f");
        if let Some((line, _)) = stated.filter(|_| per_metre <= 0.0) {
            return Err(line.error(line.text, "a positive factor", "correct it"));
        }
        let Some((line, name)) = self.values.get("units.len") else {
            return Ok(1e3 / per_metre);
        };
        let unit = Unit::named(name)
            .ok_or_else(|| line.error(line.text, "m, cm, mm, um, in or ft", "correct the unit"))?
            .millimetres();
        // Largest relative error of a factor that still names the unit. Files with six figures must pass.
        const ROUNDED: f64 = 1e-5;
        if stated.is_some() && (unit * per_metre - 1e3).abs() > ROUNDED * 1e3 {
            let found = format!("units.len = {name} with units.len.f = {per_metre}");
            let expected = format!("the factor {} for this unit", 1e3 / unit);
            return Err(line.error(found, expected, "correct the one that is wrong"));
        }
        Ok(unit)
    }

    fn apply(&self, points: &mut Points) -> Result<()> {
        let before = points.at.len();
        drop_near(&mut points.at, self.number("point.dist.min", 0.0)?);
        self.note_dropped(points, before, "point.dist.min");
        let shift = [self.number("shift.y", 0.0)?, self.number("shift.z", 0.0)?];
        let (sin, cos) = self.angle()?.sin_cos();
        let bounds = |axis: &str| -> Result<Interval> {
            let low = self.number(&format!("bound.{axis}.min"), 1.0)?;
            let high = self.number(&format!("bound.{axis}.max"), 0.0)?;
            Ok(if low < high { Interval::new(low, high) } else { Interval::ALL })
        };
        let (y_bounds, z_bounds) = (bounds("y")?, bounds("z")?);
        for point in &mut points.at {
            let (y, z) = (point.x + shift[0], point.z + shift[1]);
            (point.x, point.z) = (y * cos - z * sin, y * sin + z * cos);
        }
        let before = points.at.len();
        points.at.retain(|point| y_bounds.contains(point.x) && z_bounds.contains(point.z));
        self.note_dropped(points, before, "bound.");
        self.turn_and_scale(points)
    }

    /// Adds a note on how many points were dropped by the keys that begin with `keys`. Its line is that of the first such
    /// key.
    fn note_dropped(&self, points: &mut Points, before: usize, keys: &str) {
        let dropped = before - points.at.len();
        let of_keys = self.values.iter().filter(|(key, _)| key.starts_with(keys));
        let first = of_keys.map(|(_, (line, _))| line.number).min();
        if let (Some(line), true) = (first, dropped > 0) {
            let plural = if dropped == 1 { "" } else { "s" };
            let all = if keys.ends_with('.') { "*" } else { "" };
            points.note(line, format!("{dropped} point{plural} dropped by {keys}{all}"));
        }
    }

    /// Returns the angle of rotation \[rad\].
    fn angle(&self) -> Result<f64> {
        let factor = self.number("units.ang.f", 1.0)?;
        let degrees = self.values.get("units.ang").is_some_and(|(_, unit)| unit.starts_with("deg"));
        if degrees && !self.values.contains_key("units.ang.f") {
            return Ok(self.number("rotate", 0.0)?.to_radians());
        }
        if let (true, Some((line, _))) = (factor <= 0.0, self.values.get("units.ang.f")) {
            return Err(line.error(line.text, "a positive factor", "correct it"));
        }
        Ok(self.number("rotate", 0.0)? / factor)
    }

    fn turn_and_scale(&self, points: &mut Points) -> Result<()> {
        let signs = [self.flag("mirror.y")?, self.flag("mirror.z")?].map(|on| if on { -1.0 } else { 1.0 });
        let unit = self.length_unit()?;
        points.applied = unit;
        for point in &mut points.at {
            (point.x, point.z) = (signs[0] * point.x * unit, signs[1] * point.z * unit);
        }
        if self.flag("inversion")? {
            points.at.reverse();
        }
        if let Some((line, _)) = self.values.get("approx.smooth")
            && self.number("approx.smooth", 0.0)? != 0.0
        {
            points.note(line.number, "approx.smooth is SIMPACK's own smoothing: not used");
        }
        Ok(())
    }
}

fn drop_near(points: &mut Vec<Point>, least: f64) {
    if least > 0.0 {
        points.dedup_by(|b, a| (b.x - a.x).hypot(b.z - a.z) < least);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHEEL: &str = include_str!("../../../tests/profiles/wheel.prw");

    #[test]
    fn keys_act_in_their_order() -> Result<()> {
        let plain = read(WHEEL)?;
        assert_eq!(plain.body, Some(Side::Wheel));
        assert_eq!(plain.at[3].weight, 0.5);
        let shifted = read(&WHEEL.replace("shift.y        =  0.0", "shift.y        =  0.001"))?;
        assert!((shifted.at[0].x - plain.at[0].x - 1.0).abs() < 1e-12);
        let mirrored = read(
            &WHEEL
                .replace("shift.y        =  0.0", "shift.y        =  0.001")
                .replace("mirror.y       =  0", "mirror.y       =  1")
                .replace("inversion      =  0", "inversion      =  1"),
        )?;
        let last = mirrored.at.last().map(Point::xz).unwrap_or_default();
        assert!((last[0] + plain.at[0].x + 1.0).abs() < 1e-12);
        let bounds = "bound.y.min    = -0.05\n    bound.y.max    =  0.02";
        let bounded = read(
            &WHEEL.replace("bound.y.min    =  1.0", bounds).replace("    bound.y.max    =  0.0", "! max"),
        )?;
        assert!(bounded.at.iter().all(|p| -50.0 <= p.x && p.x <= 20.0) && bounded.at.len() > 20);
        let thinned = read(&WHEEL.replace("point.dist.min =  0.0", "point.dist.min =  0.004"))?;
        assert!(thinned.at.len() < plain.at.len() && thinned.notes.len() == 1);
        for (text, key) in [
            (WHEEL.replace("point.dist.min =  0.0", "point.dist.min =  0.004"), "point.dist.min"),
            (
                WHEEL.replace("bound.y.min    =  1.0", bounds).replace("    bound.y.max    =  0.0", "! max"),
                "bound.",
            ),
        ] {
            let note = read(&text)?.notes.pop().unwrap_or_else(|| unreachable!("{key}"));
            let line = 1 + text.lines().position(|line| line.contains(key)).unwrap_or_default();
            assert!(note.line == line && note.text.contains(key), "{note:?} is not at line {line}");
        }
        Ok(())
    }

    #[test]
    fn contradictions_are_errors_with_their_line() {
        for (from, to, line) in [
            ("units.len.f    =  1.0", "units.len.f    =  1000.0", "units.len "),
            ("mirror.y       =  0", "mirror.y       =  2", "mirror.y"),
            ("point.begin", "knot.begin", "knot.begin"),
            ("header.end", "spline.end", "spline.end"),
            ("rotate         =  0.0", "rotate         =  x", "rotate"),
            ("rotate         =  0.0", "shift.y        =  0.1", "shift.y        =  0.1"),
        ] {
            let text = WHEEL.replacen(from, to, 1);
            let number = 1 + text.lines().position(|l| l.contains(line)).unwrap_or_default();
            let place = read(&text).err().map(|e| e.place);
            assert_eq!(place, Some(format!("line {number}")), "{to}");
        }
        let truncated = &WHEEL[..WHEEL.find("point.end").unwrap_or_default()];
        assert!(read(truncated).is_err_and(|e| e.expected == "point.end"));
    }
}
