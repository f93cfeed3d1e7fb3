//! The quantities of rails, with the gauge side at smaller x.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::{Matrix3, Vector3};

use super::curve::{CurvePoint, MarkedCurve};
use super::found::FoundValues;
use super::nominal::{Nominal, running_head};
use super::options::{GaugeFrom, MeasureOptions};
use super::quantity::Quantity;
use crate::numerics::interval::Interval;

/// Half width \[mm\] of the crown whose radius is fitted, that of the MiniProf's own calculation.
const CROWN: f64 = 10.0;
/// Rounding \[mm\] of both ends of the fitted crown. All of it has to be measured: wear leaves ridges at its ends, without which the radius
/// is another one.
const CROWN_ROUNDING: f64 = 1e-6;
/// Height \[mm\] of the gauge face through which a line is fitted: through less of a worn face it is another line.
const FACE: f64 = 10.0;
/// Depth \[mm\] below the top to which flow is sought: deeper, the fillet to the underside of a head begins.
const LIP_DEPTH: f64 = 25.0;
/// Height \[mm\] above the end of a face from which the head's area counts, so that rounding does not take the end away.
const ABOVE_END: f64 = 0.01;
/// Farthest distance \[mm\] of a worn gauge corner from the nominal one.
const FARTHEST: f64 = 25.0;

const EVERYWHERE: Interval = Interval::new(f64::NEG_INFINITY, f64::INFINITY);

/// A running head with its top, and the groove beside it.
struct Head<'a> {
    whole: &'a MarkedCurve,
    /// From the bottom of the groove, if there is one, to the field side.
    curve: MarkedCurve,
    top: CurvePoint,
    /// Index of the groove's bottom in `whole`.
    groove: Option<usize>,
}

impl<'a> Head<'a> {
    fn new(whole: &'a MarkedCurve) -> Result<Self, String> {
        let (curve, groove) = running_head(whole);
        let top = curve.highest(1.0).ok_or("no points")?;
        if top.mark == 0 || top.mark + 1 >= curve.marks.len() {
            return Err(format!(
                "no top of rail: the points are highest where they end, at x = {:.3} mm",
                top.x
            ));
        }
        let top = top.known().map_err(|why| format!("no top of rail: {why}"))?;
        Ok(Self { whole, curve, top, groove })
    }

    /// Returns the gauge face at a height \[mm\]: the place nearest to the top.
    fn face(&self, z: f64) -> Result<CurvePoint, String> {
        let all = self.curve.at_z(z);
        let face = all.iter().rfind(|place| place.mark <= self.top.mark && place.x <= self.top.x);
        face.ok_or_else(|| format!("no gauge face {:.3} mm below the top of rail", self.top.z - z))
            .and_then(|place| place.known().map_err(|why| format!("no gauge face: {why}")))
    }

    /// Returns x of the keeper's face at a height \[mm\]; `None` without a groove.
    fn keeper(&self, z: f64) -> Option<Result<f64, String>> {
        let groove = self.groove?;
        let all = self.whole.at_z(z);
        let face = all.iter().rfind(|place| place.mark < groove);
        let face = face.ok_or_else(|| format!("no keeper {:.3} mm below the top of rail", self.top.z - z));
        let known = face.and_then(|place| place.known().map_err(|why| format!("no keeper: {why}")));
        Some(known.map(|place| place.x))
    }

    /// Returns the depth \[mm\] of the groove's lowest point below the top.
    fn depth(&self) -> Result<f64, String> {
        let bottom = self.curve.marks.first().map_or(f64::NAN, |mark| mark.station.z);
        let beside = self.groove.unwrap_or(0).checked_sub(1);
        let gap = beside.is_some_and(|k| self.whole.unknown[k]) || self.curve.unknown.first() == Some(&true);
        if gap {
            Err("the points of the groove have a gap at its bottom".into())
        } else {
            Ok(self.top.z - bottom)
        }
    }

    /// Returns the lowest height \[mm\] that the gauge and the field side both reach.
    fn reach(&self) -> f64 {
        let sides = [self.curve.up_to(self.top.mark), self.curve.from(self.top.mark)];
        sides
            .iter()
            .filter_map(|side| side.highest(-1.0))
            .map(|place| place.z)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the area \[mm²\] of the head above a height that both sides reach.
    fn area(&self, z: f64) -> Result<f64, String> {
        let all = self.curve.at_z(z);
        let left = all.iter().rfind(|place| place.mark <= self.top.mark);
        let right = all.iter().find(|place| place.mark >= self.top.mark);
        let (Some(a), Some(b)) = (left, right) else {
            return Err("no faces at both sides of the head".into());
        };
        if self.curve.up_to(b.mark + 1).from(a.mark).has_gap([0.0, 1.0], EVERYWHERE) {
            return Err("the points of the head have a gap".into());
        }
        let inner = self.curve.marks[a.mark + 1..=b.mark].iter().map(|mark| [mark.station.x, mark.station.z]);
        let ring: Vec<[f64; 2]> = [[a.x, a.z]].into_iter().chain(inner).chain([[b.x, b.z]]).collect();
        Ok(ring
            .windows(2)
            .map(|pair| 0.5 * (pair[1][0] - pair[0][0]) * (pair[0][1] + pair[1][1] - 2.0 * z))
            .sum())
    }
}

/// Measures a rail in any axes.
pub(super) fn measure(curve: &MarkedCurve, options: &MeasureOptions) -> FoundValues {
    let mut found = FoundValues::default();
    let head = match Head::new(curve) {
        Ok(head) => head,
        Err(why) => {
            found.lack(&[Quantity::CrownRadius, Quantity::SideFaceAngle, Quantity::Lip], &why);
            return found;
        }
    };
    let level = head.top.z - options.gauge_level;
    found.put(Quantity::SideFaceAngle, side_face_angle(&head, level));
    found.put(Quantity::Lip, head.face(level).and_then(|_| lip(&head)));
    if let Some(keeper) = head.keeper(level) {
        found.put(Quantity::GrooveWidth, keeper.and_then(|keeper| Ok(head.face(level)?.x - keeper)));
        found.put(Quantity::GrooveDepth, head.depth());
    }
    found.put(Quantity::CrownRadius, crown_radius(&head));
    found
}

/// Measures the wear of a rail in the axes of its nominal.
pub(super) fn wear(curve: &MarkedCurve, nominal: &Nominal, options: &MeasureOptions) -> FoundValues {
    let mut found = FoundValues::default();
    let drawn = Head::new(&nominal.curve).map_err(|why| format!("in the nominal: {why}"));
    match Head::new(curve).and_then(|head| Ok((head, drawn?))) {
        Ok((head, drawn)) => lost(&mut found, &head, &drawn, options),
        Err(why) => {
            found.lack(&[Quantity::W1, Quantity::W2, Quantity::W3, Quantity::HeadAreaLost], &why);
        }
    }
    found
}

/// Measures what a head has lost of the nominal one.
fn lost(found: &mut FoundValues, head: &Head, drawn: &Head, options: &MeasureOptions) {
    let over = head.curve.at_x(drawn.top.x).into_iter().max_by(|a, b| a.z.total_cmp(&b.z));
    let crown = over.ok_or_else(|| format!("no points over the nominal's top, x = {:.3} mm", drawn.top.x));
    found.put(Quantity::W1, crown.and_then(|place| Ok(drawn.top.z - place.known()?.z)));
    let top = if options.gauge_from == GaugeFrom::Measured { head.top.z } else { drawn.top.z };
    let level = top - options.gauge_level;
    let in_nominal = |why: String| format!("in the nominal: {why}");
    let w2 = head.face(level).and_then(|at| Ok(at.x - drawn.face(level).map_err(in_nominal)?.x));
    found.put(Quantity::W2, w2);
    found.put(Quantity::W3, w3(head, drawn));
    let deepest = head.reach().max(drawn.reach()) + ABOVE_END;
    let area = if drawn.top.z - deepest < options.gauge_level {
        let depth = drawn.top.z - deepest;
        Err(format!(
            "both faces reach {depth:.3} mm below the nominal top, less than {}",
            options.gauge_level
        ))
    } else {
        head.area(deepest).and_then(|area| Ok(100.0 * (1.0 - area / drawn.area(deepest)?)))
    };
    found.put(Quantity::HeadAreaLost, area);
    if let Some(nominal) = drawn.keeper(level) {
        let keeper = head.keeper(level).unwrap_or_else(|| Err("no groove beside the head".into()));
        found.put(Quantity::KeeperWear, keeper.and_then(|x| Ok(nominal.map_err(in_nominal)? - x)));
    }
}

/// Returns the wear \[mm\] along the normal of the nominal where its gauge corner rises at 45°. If that is an arc, the line goes
/// through its centre.
fn w3(head: &Head, drawn: &Head) -> Result<f64, String> {
    let marks = &drawn.curve.marks[..=drawn.top.mark];
    let over = |k: usize| marks[k].station.sin - marks[k].station.cos;
    let at = (1..marks.len()).rfind(|&k| over(k - 1) >= 0.0 && over(k) < 0.0);
    let k = at.ok_or("in the nominal: no gauge corner that rises at 45°")?;
    let share = over(k - 1) / (over(k - 1) - over(k));
    let [a, b] = [marks[k - 1].station, marks[k].station];
    let along = |x: f64, z: f64| FRAC_1_SQRT_2 * (x + z);
    // Positive into the head.
    let inside = |x: f64, z: f64| FRAC_1_SQRT_2 * (x - z);
    let (x, z) = (a.x + share * (b.x - a.x), a.z + share * (b.z - a.z));
    let depth = |head: &Head| {
        let all = head.curve.crossings([FRAC_1_SQRT_2; 2], along(x, z)).into_iter();
        let depths = all.map(|place| (inside(place.x, place.z) - inside(x, z), place));
        let near = depths.filter(|(depth, _)| depth.abs() <= FARTHEST);
        let nearest = near.min_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()));
        let none = "no points on the 45° line through the nominal's gauge corner at";
        let (depth, place) = nearest.ok_or_else(|| format!("{none} ({x:.3}, {z:.3}) mm"))?;
        place.known().map(|_| depth)
    };
    Ok(depth(head)? - depth(drawn)?)
}

/// Returns the radius \[mm\] of the circle that fits the crown about its top; an error if the crown does not bulge up.
///
/// Method: κ(x² + z²)/2 + bx + a = z by least squares. The residual is the distance from a nearly level arc times 1 − κz.
fn crown_radius(head: &Head) -> Result<f64, String> {
    let (curve, about) = (&head.curve, head.top.x);
    if curve.has_gap([1.0, 0.0], Interval::symmetric(CROWN) + about) {
        return Err("the points of the crown have a gap".into());
    }
    let crown = curve.within([1.0, 0.0], Interval::symmetric(CROWN) + about, head.top.mark);
    let inside = || {
        let all = crown.marks.iter().zip(crown.lengths());
        all.map(|(mark, weight)| (mark.station.x - about, mark.station.z - head.top.z, weight))
    };
    let Interval { low: from, high: to } = inside().map(|(x, ..)| x).fold(Interval::of(0.0), Interval::with);
    if from > CROWN_ROUNDING - CROWN || to < CROWN - CROWN_ROUNDING {
        return Err(format!(
            "the crown is measured from {from:.3} to {to:.3} mm about its top, not over {CROWN}"
        ));
    }
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (x, z, weight) in inside() {
        // Of one size, so that nothing cancels.
        let row = Vector3::new((x * x + z * z) / (2.0 * CROWN * CROWN), x / CROWN, 1.0);
        normal += weight * row * row.transpose();
        right += weight * z * row;
    }
    let found = normal.cholesky().ok_or("the crown has no circle")?.solve(&right);
    let (curvature, slope, height) = (found[0] / (CROWN * CROWN), found[1] / CROWN, found[2]);
    if curvature >= 0.0 {
        return Err("the crown is hollow or flat".into());
    }
    Ok((1.0 + slope * slope - 2.0 * height * curvature).sqrt() / -curvature)
}

/// Returns the angle \[deg\] of a line through the gauge face, from `level` \[mm\] down, against the vertical; + if it widens downwards.
fn side_face_angle(head: &Head, level: f64) -> Result<f64, String> {
    let (range, from) = (Interval::new(level - FACE, level), head.face(level)?.mark);
    head.face(range.low)?;
    let face = head.curve.up_to(head.top.mark);
    if face.has_gap([0.0, 1.0], range) {
        return Err("the points of the gauge face have a gap".into());
    }
    let face = face.within([0.0, 1.0], range, from);
    let all = face.marks.iter().zip(face.lengths());
    let own: Vec<(f64, f64, f64)> =
        all.map(|(mark, weight)| (mark.station.x, mark.station.z - level, weight)).collect();
    let weight: f64 = own.iter().map(|(.., weight)| weight).sum();
    let mean =
        |of: fn(&(f64, f64, f64)) -> f64| own.iter().map(|place| place.2 * of(place)).sum::<f64>() / weight;
    let [x, z] = [mean(|place| place.0), mean(|place| place.1)];
    let moment =
        |of: &dyn Fn(&(f64, f64, f64)) -> f64| own.iter().map(|place| place.2 * of(place)).sum::<f64>();
    let slope = moment(&|place| (place.0 - x) * (place.1 - z)) / moment(&|place| (place.1 - z).powi(2));
    Ok(slope.atan().to_degrees())
}

/// Returns how far \[mm\] the gauge face recedes below its outermost point.
fn lip(head: &Head) -> Result<f64, String> {
    let range = Interval::new(head.top.z - LIP_DEPTH, head.top.z);
    if head.curve.up_to(head.top.mark).has_gap([0.0, 1.0], range) {
        return Err("the points of the gauge face have a gap".into());
    }
    let (mut outermost, mut lip) = (f64::INFINITY, 0.0f64);
    let face = head.curve.marks.iter().take(head.top.mark).rev();
    for mark in face.take_while(|mark| head.top.z - mark.station.z <= LIP_DEPTH) {
        outermost = outermost.min(mark.station.x);
        lip = lip.max(mark.station.x - outermost);
    }
    Ok(lip)
}
