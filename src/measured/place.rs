//! Turns points from the file's axes into those of the profile: x to the field side, z up, mm, right-hand, points from left
//! to right.

use serde::Serialize;

use super::Format;
use super::clean::checks::{Finding, no_order, wrong_unit};
use super::options::{NamedOrigin, Options, Origin, Repair};
use super::read::points::{DesignElement, ElementShape, Point, Points};
use super::shape::{
    flange_side, gauge_depth, gauge_side, has_flange_back, head_up, reach, running_head, top,
};
use crate::error::{Error, Result};
use crate::profile::Side;

/// Least number of points that have a shape.
const LEAST_POINTS: usize = 3;

/// A decision on the way from the file to the profile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Step {
    /// What is decided: "unit", "mirror", "flip_z", "origin" or "order".
    pub what: &'static str,
    /// What was done.
    pub done: String,
    /// Reason: an option, the definition of the format, or a proof from the shape.
    pub because: String,
}

/// The whole transformation: x = scale\[0\]·first + shift\[0\], z = scale\[1\]·second + shift\[1\].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Transform {
    /// Length of the file's unit \[mm\] for each axis, negative where the axis is reversed.
    pub scale: [f64; 2],
    /// Shift of each axis \[mm\].
    pub shift: [f64; 2],
    /// Whether the order of the points is reversed.
    pub reversed: bool,
    /// The decisions, in order.
    pub steps: Vec<Step>,
}

/// Returns the axes that the format defines: whether x = −first, and whether z = −second. `None` means that the format
/// defines nothing. The sources are in `src/docs/measured-files.md`.
fn definition(format: Format, side: Side) -> [Option<bool>; 2] {
    match (format, side) {
        // Instruments and converters write rails with either sign.
        (Format::MiniProf, Side::Rail) => [None, None],
        (Format::MiniProf, Side::Wheel) => [Some(false), Some(true)],
        (Format::Simpack, _) => [Some(false), Some(true)],
        (Format::Gensys, _) => [Some(true), Some(true)],
        (Format::Text | Format::Csv, _) => [None, None],
    }
}

/// Finds the transformation from options, format and shape. An option always decides; without it the definition of the
/// format decides; the shape decides only what the format leaves open. The findings are definitions that the shape
/// contradicts, each with the option that would reverse it; they change nothing.
///
/// # Errors
/// A body other than the file's own. Fewer than three points, a width that does not fit the unit, points in no order. An orientation
/// that neither option, format nor shape decides; the error lists the choices. An origin that the points do not reach.
pub fn resolve(points: &Points, side: Side, options: &Options) -> Result<(Transform, Vec<Finding>)> {
    if let Some(body) = points.body.filter(|body| *body != side) {
        let (found, expected) = (format!("a {} profile", name(body)), format!("a {} profile", name(side)));
        return Err(Error::new("type", found, expected, "give the other file"));
    }
    if points.at.len() < LEAST_POINTS {
        let place = points.at.last().map_or_else(String::new, Point::place);
        let found = format!("{} points in all", points.at.len());
        let expected = format!("{LEAST_POINTS} points or more: fewer have no shape");
        return Err(Error::new(place, found, expected, "give a file with the whole profile"));
    }
    let mut transform = Transform { scale: [1.0; 2], shift: [0.0; 2], reversed: false, steps: Vec::new() };
    let unit = unit(points, options, &mut transform.steps)?;
    transform.scale = [unit; 2];
    let stated = options.unit.is_some() || points.unit.is_some();
    let wrong = wrong_unit(&transform.points(&points.at), unit, stated);
    // Further questions are found in the likeliest unit.
    let unit = wrong.as_ref().map_or(unit, |(_, likeliest)| *likeliest);
    transform.scale = [unit; 2];
    let (findings, open) = transform.turn(points, side, options);
    match (wrong, open.as_slice()) {
        (Some((mut error, _)), open) => {
            for question in open {
                error.advice += &format!("; and {}", question.choices);
            }
            return Err(error);
        }
        (None, open) => {
            let placed = transform.points(&points.at);
            let sorted = open.is_empty() && options.repair.contains(&Repair::Sort);
            if let Some(error) = no_order(&placed).filter(|_| !sorted) {
                return Err(error);
            }
            if !open.is_empty() {
                return Err(asked(open, &placed, side, stated));
            }
        }
    }
    transform.reverse(&points.at);
    transform.shift_origin(&points.at, side, options)?;
    Ok((transform, findings))
}

/// A question that neither option, format nor shape answers.
struct OpenQuestion {
    what: &'static str,
    /// What the shape does not show.
    found: &'static str,
    choices: String,
}

/// Returns the error that asks all open questions at once; a shape that looks like the other body comes first.
fn asked(open: &[OpenQuestion], points: &[Point], side: Side, stated: bool) -> Error {
    let list = |part: fn(&OpenQuestion) -> &str, between: &str| {
        open.iter().map(part).collect::<Vec<_>>().join(between)
    };
    let mut advice =
        if open.len() > 1 { "give both options".to_owned() } else { "give the option".to_owned() };
    if !stated {
        advice += &format!(", and `unit` unless it is {:.1} mm wide", reach(points).width());
    }
    let other = if side == Side::Rail { Side::Wheel } else { Side::Rail };
    let mut found = list(|question| question.found, "; ");
    if let Some((_, why)) = head_up(points, other) {
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

fn name(side: Side) -> &'static str {
    match side {
        Side::Rail => "rail",
        Side::Wheel => "wheel",
    }
}

/// Returns the length of the file's unit \[mm\].
fn unit(points: &Points, options: &Options, steps: &mut Vec<Step>) -> Result<f64> {
    let (unit, because) = match (options.unit, points.unit) {
        (Some(option), Some(stated)) if option.millimetres() != stated => {
            let expected = "the unit that the format states, mm after reading";
            return Err(Error::new("unit", option.name(), expected, "delete the option"));
        }
        (Some(option), _) => (option.millimetres(), "option `unit`"),
        (None, Some(stated)) => (stated, "the format"),
        (None, None) => (1.0, "the default"),
    };
    steps.push(Step { what: "unit", done: format!("{unit} mm"), because: because.into() });
    Ok(unit)
}

/// One of the two questions about the orientation: `mirror` or `flip_z`.
struct Orientation {
    what: &'static str,
    option: Option<bool>,
    format: Format,
    definition: Option<bool>,
}

impl Orientation {
    /// Decides the question; `None` leaves it open.
    fn decide(&self, proof: Option<(bool, String)>, steps: &mut Vec<Step>) -> Option<bool> {
        let (turn, because) = match (self.option, self.definition, proof) {
            (Some(option), ..) => (option, format!("option `{}`", self.what)),
            (None, Some(defined), _) => {
                (defined, format!("definition of the format ({})", self.format.title()))
            }
            (None, None, proof) => proof?,
        };
        let done = match (self.what, turn) {
            ("mirror", true) => "x = −first axis",
            ("mirror", false) => "x = first axis",
            (_, true) => "z = −second axis",
            (_, false) => "z = second axis",
        };
        steps.push(Step { what: self.what, done: done.into(), because });
        Some(turn)
    }

    /// Returns a finding if the shape contradicts the format's definition that was followed. There is none if an option
    /// decided, because the user knows better.
    fn contradiction(&self, proof: Option<&(bool, String)>, at: &[Point]) -> Option<Finding> {
        let defined = self.definition.filter(|_| self.option.is_none())?;
        let (proven, why) = proof.filter(|(proven, _)| *proven != defined)?;
        let found = format!(
            "{why}: by that the definition of the format ({}) turns the profile the wrong way; it is kept, `{} = {proven}` \
             would change it",
            self.format.title(),
            self.what
        );
        Some(Finding::orientation(at.first()?, found))
    }

    fn question(&self, side: Side) -> OpenQuestion {
        let (found, yes, no) = match (self.what, side) {
            ("mirror", Side::Rail) => (
                "a rail whose gauge side nothing proves (not just one side face)",
                "gauge corner at the larger values of the first axis",
                "at the smaller",
            ),
            ("mirror", Side::Wheel) => (
                "a wheel whose flange is not plainly at one end",
                "flange at the larger values of the first axis",
                "at the smaller",
            ),
            (_, Side::Rail) => (
                "a rail that does not show where its foot is (no side faces at both ends, no plain crown)",
                "foot at the larger values of the second axis",
                "at the smaller",
            ),
            (_, Side::Wheel) => (
                "a wheel without a flange tip that shows where down is",
                "flange tip at the larger values of the second axis",
                "at the smaller",
            ),
        };
        let choices = format!("`{0} = true` ({yes}) or `{0} = false` ({no})", self.what);
        OpenQuestion { what: self.what, found, choices }
    }
}

impl Transform {
    /// Turns the axes upright and to the right hand; returns the definitions that the shape contradicts, and what is left open.
    fn turn(&mut self, points: &Points, side: Side, options: &Options) -> (Vec<Finding>, Vec<OpenQuestion>) {
        let [mirror, flip] = definition(points.format, side);
        let (mut findings, mut open) = (Vec::new(), Vec::new());
        let flipped =
            Orientation { what: "flip_z", option: options.flip_z, format: points.format, definition: flip };
        let proof = head_up(&self.points(&points.at), side).map(|(up, why)| (!up, why));
        findings.extend(flipped.contradiction(proof.as_ref(), &points.at));
        let turned = flipped.decide(proof, &mut self.steps);
        if turned == Some(true) {
            self.scale[1] = -self.scale[1];
        }
        let mirrored =
            Orientation { what: "mirror", option: options.mirror, format: points.format, definition: mirror };
        // A profile that may be on its head has no sides.
        let proof = turned.and_then(|_| {
            let upright = self.points(&points.at);
            match side {
                Side::Rail => gauge_side(&upright),
                Side::Wheel => flange_side(&upright),
            }
        });
        let proof = proof.map(|(left, why)| (!left, why));
        findings.extend(mirrored.contradiction(proof.as_ref(), &points.at));
        let mirror = mirrored.decide(proof, &mut self.steps);
        if mirror == Some(true) {
            self.scale[0] = -self.scale[0];
        }
        open.extend(turned.is_none().then(|| flipped.question(side)));
        open.extend(mirror.is_none().then(|| mirrored.question(side)));
        (findings, open)
    }

    /// Turns a point of the file into profile axes.
    pub fn apply(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        [self.scale[0] * x + self.shift[0], self.scale[1] * z + self.shift[1]]
    }

    /// Turns points into profile axes, in order from left to right.
    pub fn points(&self, at: &[Point]) -> Vec<Point> {
        let place = |point: &Point| {
            let [x, z] = self.apply(point.xz());
            Point { x, z, ..*point }
        };
        if self.reversed { at.iter().rev().map(place).collect() } else { at.iter().map(place).collect() }
    }

    /// Turns a design element into profile axes. An arc stays counter-clockwise.
    pub fn element(&self, element: &DesignElement) -> DesignElement {
        let shape = match element.shape {
            ElementShape::Line { from, to } => {
                ElementShape::Line { from: self.apply(from), to: self.apply(to) }
            }
            ElementShape::Arc { center, radius, mut angles } => {
                if self.scale[0] < 0.0 {
                    angles = [std::f64::consts::PI - angles[1], std::f64::consts::PI - angles[0]];
                }
                if self.scale[1] < 0.0 {
                    angles = [-angles[1], -angles[0]];
                }
                let radius = radius * self.scale[0].abs();
                ElementShape::Arc { center: self.apply(center), radius, angles }
            }
        };
        DesignElement { shape, line: element.line }
    }

    /// Reverses the order of the points if they go from right to left.
    fn reverse(&mut self, at: &[Point]) {
        if let [first, .., last] = at
            && self.apply(last.xz())[0] < self.apply(first.xz())[0]
        {
            self.reversed = true;
            let because = "the last point lies left of the first".into();
            self.steps.push(Step { what: "order", done: "reversed".into(), because });
        }
    }

    fn shift_origin(&mut self, at: &[Point], side: Side, options: &Options) -> Result<()> {
        let points = self.points(at);
        let (origin, because) = match (options.origin, side) {
            (None | Some(Origin::Named(NamedOrigin::AsIs)), _) => return Ok(()),
            (Some(Origin::At(point)), _) => (point, "option `origin`".to_owned()),
            (Some(Origin::Named(NamedOrigin::GaugePoint)), Side::Rail) => {
                gauge_point(&points, options.gauge_height())?
            }
            (Some(Origin::Named(NamedOrigin::TapeLine)), Side::Wheel) => {
                tape_line(&points, options.tape_distance())?
            }
            (Some(Origin::Named(_)), side) => {
                let expected = "\"gauge-point\" for rails, \"tape-line\" for wheels";
                let advice = "choose another origin";
                return Err(Error::new(
                    "origin",
                    format!("the other one for a {}", name(side)),
                    expected,
                    advice,
                ));
            }
        };
        self.shift = [0.0 - origin[0], 0.0 - origin[1]];
        let done = format!("shifted by [{}, {}] mm", self.shift[0], self.shift[1]);
        self.steps.push(Step { what: "origin", done, because });
        Ok(())
    }
}

/// Returns the gauge point: x of the innermost point of the running head down to `depth` \[mm\] below its top, and z of the
/// top.
fn gauge_point(points: &[Point], depth: f64) -> Result<([f64; 2], String)> {
    let measured = gauge_depth(points);
    let points = running_head(points);
    let top = top(points);
    let level = top - depth;
    if measured < depth {
        let found = format!("a gauge face measured down to {measured:.3} mm below the top");
        let expected = format!("{depth} mm at least");
        return Err(Error::new("origin = \"gauge-point\"", found, expected, "give the origin as [x, z]"));
    }
    let mut innermost = f64::INFINITY;
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        for p in pair.iter().filter(|p| p.z >= level) {
            innermost = innermost.min(p.x);
        }
        if (a.z - level) * (b.z - level) < 0.0 {
            innermost = innermost.min(a.x + (b.x - a.x) * ((level - a.z) / (b.z - a.z)));
        }
    }
    let because = format!("gauge point: innermost within {depth} mm of the top, at x = {innermost}");
    Ok(([innermost, top], because))
}

/// Returns the point of the tread at `distance` \[mm\] from the flange back.
fn tape_line(points: &[Point], distance: f64) -> Result<([f64; 2], String)> {
    let back = points.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
    let x = back + distance;
    let heights = points.windows(2).filter(|pair| (pair[0].x - x) * (pair[1].x - x) <= 0.0).map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        if b.x == a.x { a.z.min(b.z) } else { a.z + (b.z - a.z) * ((x - a.x) / (b.x - a.x)) }
    });
    // The material of a wheel is above, so that the tread is the lowest surface there.
    let z = heights.fold(f64::INFINITY, f64::min);
    if !has_flange_back(points) || z.is_infinite() {
        let found = format!("no flange back, or no tread {distance} mm from it");
        let expected = "points from the flange back over the taping line";
        return Err(Error::new("origin = \"tape-line\"", found, expected, "give the origin as [x, z]"));
    }
    Ok(([x, z], format!("taping line: {distance} mm from the flange back at x = {back}")))
}
