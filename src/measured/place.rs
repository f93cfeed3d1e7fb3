//! Turns points from the file's axes into those of the profile: x to the field side, z up, mm, right-hand, points from left
//! to right.

use serde::Serialize;

use super::Format;
use super::ask::{OpenQuestion, name, wrong_unit};
use super::clean::checks::{Finding, SAME_POINT, same};
use super::clean::reversals::no_order;
use super::clean::runs::Path;
use super::options::{NamedOrigin, Options, Origin, Repair};
use super::read::points::{DesignElement, ElementShape, Point, Points};
use super::shape::{
    flange_side, gauge_depth, gauge_side, has_flange_back, head_up, outline, reach, running_head, symmetric,
    top,
};
use crate::error::{Error, Result};
use crate::numerics::interval::Interval;
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
        // Heights of Vampire are up on rails and down on wheels.
        (Format::Vampire, side) => [Some(false), Some(side == Side::Wheel)],
        (Format::Text | Format::Csv, _) => [None, None],
    }
}

/// How the points of a file lie, and what that leaves open.
pub(super) struct Placing {
    /// The transformation; by the likeliest answers where questions are open.
    pub transform: Transform,
    /// Definitions of the format that the shape contradicts.
    pub findings: Vec<Finding>,
    /// Questions about the axes.
    pub open: Vec<OpenQuestion>,
    /// What is wrong with the unit.
    pub wrong_unit: Option<Error>,
    /// Whether the file or an option states the unit.
    pub stated: bool,
}

/// Finds the transformation from options, format and shape. An option always decides; without it the definition of the
/// format decides; the shape decides only what the format leaves open. The findings are definitions that the shape
/// contradicts, each with the option that would reverse it; they change nothing. A closed outline is begun anew at its foot.
///
/// # Errors
/// A body other than the file's own. Fewer than three points, points in no order. An origin that the points do not reach, where nothing
/// is left open.
pub(super) fn resolve(points: &mut Points, side: Side, options: &Options) -> Result<Placing> {
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
    let unit = unit(points, options, &mut transform.steps);
    transform.scale = [unit; 2];
    let stated = options.unit.is_some() || points.unit.is_some();
    // Rows that the instrument did not measure, and noise, tell nothing of axes and origin.
    let judged = Points { at: Path::judged(&points.at, unit), ..points.clone() };
    let wrong = wrong_unit(&transform.points(&judged.at), points.applied * unit, stated);
    // Further questions are found in the likeliest unit.
    let unit = wrong.as_ref().map_or(unit, |(_, likeliest)| *likeliest / points.applied);
    transform.scale = [unit; 2];
    let (findings, open) = transform.turn(&judged, side, options);
    let wrong_unit = wrong.map(|(error, _)| error);
    let placed = transform.points(&judged.at);
    let sorted = open.is_empty() && options.repair.contains(&Repair::Sort);
    if let Some(error) = no_order(&placed).filter(|_| wrong_unit.is_none() && !sorted) {
        return Err(error);
    }
    let mut judged = judged;
    if outline(&placed).is_some() {
        transform.begin_at_foot(points, side);
        judged.at = Path::judged(&points.at, unit);
    } else {
        transform.reverse(&judged.at);
    }
    if open.is_empty() && wrong_unit.is_none() {
        transform.shift_origin(&judged.at, side, options)?;
    }
    Ok(Placing { transform, findings, open, wrong_unit, stated })
}

/// Returns the length \[mm\] by which coordinates are multiplied.
fn unit(points: &Points, options: &Options, steps: &mut Vec<Step>) -> f64 {
    let (unit, because) = match (options.unit, points.unit) {
        (Some(option), _) => (option.millimetres() / points.applied, "option `unit`".to_owned()),
        (None, Some(stated)) => (
            stated,
            match points.unit_line {
                Some(line) => format!("line {line} of the file"),
                None => "the format".to_owned(),
            },
        ),
        (None, None) => (1.0, "the default".to_owned()),
    };
    steps.push(Step { what: "unit", done: format!("{unit} mm"), because });
    unit
}

/// One of the two questions about the orientation: `mirror` or `flip_z`.
struct Orientation {
    what: &'static str,
    option: Option<bool>,
    format: Format,
    definition: Option<bool>,
}

impl Orientation {
    /// Tells whether neither option nor definition decides.
    fn is_open(&self) -> bool {
        self.option.is_none() && self.definition.is_none()
    }

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
        OpenQuestion { what: self.what, found: found.to_owned(), choices }
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
        let mut proof = proof.map(|(left, why)| (!left, why));
        findings.extend(mirrored.contradiction(proof.as_ref(), &points.at));
        if proof.is_none() && turned.is_some() && mirrored.is_open() && side == Side::Rail {
            let upright = self.points(&points.at);
            // An origin that is found anew lies on the other side of a mirror image.
            let own = matches!(
                options.origin,
                Some(Origin::Named(NamedOrigin::GaugePoint | NamedOrigin::TapeLine))
            );
            let axis = if own { reach(&upright).middle() } else { 0.0 };
            proof =
                symmetric(&upright, axis).then(|| (false, "its mirror image is the same profile".to_owned()));
        }
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

    /// Begins a closed outline at the end that no other body meets: a rail's foot, the inside of a wheel; a point that is there twice
    /// goes. The material of a rail lies right of the path from there, that of a wheel left of it.
    fn begin_at_foot(&mut self, points: &mut Points, side: Side) {
        let at = &mut points.at;
        if let ([first, .., last], true) = (at.as_slice(), at.len() > LEAST_POINTS)
            && same(first, last)
        {
            at.pop();
        }
        let placed = self.points(at);
        let depth = |p: &Point| if side == Side::Rail { p.z } else { -p.z };
        let foot = placed.iter().map(depth).fold(f64::INFINITY, f64::min);
        let lowest = || (0..placed.len()).filter(|&k| depth(&placed[k]) <= foot + SAME_POINT);
        let middle = Interval::around(lowest().map(|k| placed[k].x)).middle();
        let off = |k: &usize| (placed[*k].x - middle).abs();
        let begin = lowest().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        at.rotate_left(begin);
        self.reversed = outline(&self.points(at)).is_some_and(|area| (area > 0.0) == (side == Side::Rail));
        if self.reversed {
            // The path still begins at that point.
            at.rotate_left(1);
        }
        let done =
            format!("{}begun at {}", if self.reversed { "reversed, " } else { "" }, placed[begin].place());
        let because = "the points go around a closed outline".into();
        self.steps.push(Step { what: "order", done, because });
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
