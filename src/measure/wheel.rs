//! The quantities of wheels. X counts from the flange back to the field side, Y = −z.

use super::curve::{CurvePoint, MarkedCurve};
use super::found::FoundValues;
use super::nominal::Nominal;
use super::options::MeasureOptions;
use super::quantity::Quantity;
use crate::numerics::interval::Interval;

/// Least length \[mm\] of tread beyond X = 70 over which hollow wear has a meaning.
const LEAST_TREAD: f64 = 20.0;
/// Sine of the inclination up to which a surface is tread, 30°.
const TREAD: f64 = 0.5;

/// Measures a wheel whose X = 0 is at x = `back`; `no_back` says why it has no flange back there.
pub(super) fn measure(
    curve: &MarkedCurve,
    (back, no_back): (f64, Option<&str>),
    options: &MeasureOptions,
) -> FoundValues {
    let mut found = FoundValues::default();
    let tread = tread(curve, back, options);
    // Faces beside the tip need its place only, which may lie in a gap.
    let lowest = lowest(curve, back, options);
    let tip = lowest.clone().and_then(tip);
    let face = |over: f64| face(curve, lowest.clone()?, tread.clone()? - over, back + options.tread_at);
    let thickness = face(options.flange_level).map(|x| x - back);
    found.put(Quantity::FlangeHeight, tread.clone().and_then(|z| Ok(z - tip.clone()?.z)));
    found
        .put(Quantity::FlangeThickness, no_back.map_or_else(|| thickness.clone(), |why| Err(why.to_owned())));
    found
        .put(Quantity::Qr, thickness.and_then(|thickness| qr(curve, tip.clone()?, thickness, back, options)));
    found.put(
        Quantity::FlangeWidth,
        face(options.width_level)
            .and_then(|x| Ok(x - behind(curve, lowest.clone()?, tread.clone()? - options.width_level)?)),
    );
    let begin = |tip: &CurvePoint| face(options.flange_level).unwrap_or(tip.x);
    let hollow = tip.clone().and_then(|tip| hollow(curve, tip, begin(&tip), back, options));
    found.put(Quantity::Hollow, hollow);
    found
}

/// Measures the wear of a wheel in the axes of its nominal.
pub(super) fn wear(curve: &MarkedCurve, nominal: &Nominal, options: &MeasureOptions) -> FoundValues {
    let mut found = FoundValues::default();
    let at = tread(&nominal.curve, nominal.back, options).map_err(|why| format!("in the nominal: {why}"));
    found.put(Quantity::TreadWear, tread(curve, nominal.back, options).and_then(|z| Ok(z - at?)));
    found.put(Quantity::TreadWearMax, most_worn(curve, nominal, options));
    found
}

/// Returns z of the tread at the taping line \[mm\]: the lowest surface there.
///
/// # Errors
/// No points there.
pub(super) fn tread(curve: &MarkedCurve, back: f64, options: &MeasureOptions) -> Result<f64, String> {
    let places = curve.at_x(back + options.tread_at);
    if let Some(lowest) = places.iter().min_by(|a, b| a.z.total_cmp(&b.z)) {
        return lowest.known().map(|place| place.z).map_err(|why| format!("no tread: {why}"));
    }
    let [from, to] = curve.extent().map(|x| x - back).ends();
    Err(format!("no tread at X = {} mm: the points go from X = {from:.3} to {to:.3}", options.tread_at))
}

/// Returns the lowest place, that of the flange's tip.
fn lowest(curve: &MarkedCurve, back: f64, options: &MeasureOptions) -> Result<CurvePoint, String> {
    let tip = curve.highest(-1.0).ok_or("no points")?;
    let x = tip.x - back;
    if tip.mark == 0 || tip.mark + 1 >= curve.marks.len() {
        return Err(format!("no flange tip: the points are lowest where they end, at X = {x:.3} mm"));
    }
    if x > options.tread_at {
        let at = options.tread_at;
        return Err(format!("no flange tip: the points are lowest at X = {x:.3} mm, beyond X = {at}"));
    }
    Ok(tip)
}

/// Returns the tip of the flange, if it was measured.
fn tip(lowest: CurvePoint) -> Result<CurvePoint, String> {
    lowest.known().map_err(|why| format!("no flange tip: {why}"))
}

/// Returns x of the flange's face at a height \[mm\]: the nearest to the tread.
fn face(curve: &MarkedCurve, tip: CurvePoint, z: f64, tread_x: f64) -> Result<f64, String> {
    let all = curve.at_z(z);
    let beyond = |place: &&CurvePoint| place.mark >= tip.mark && place.x > tip.x && place.x < tread_x;
    all.iter()
        .rfind(beyond)
        .ok_or_else(|| format!("no flange face {:.3} mm over the flange's tip", z - tip.z))
        .and_then(|place| place.known().map_err(|why| format!("no flange face: {why}")))
        .map(|place| place.x)
}

/// Returns x of the flange back at a height \[mm\].
fn behind(curve: &MarkedCurve, tip: CurvePoint, z: f64) -> Result<f64, String> {
    let all = curve.at_z(z);
    all.iter()
        .rfind(|place| place.mark <= tip.mark && place.x < tip.x)
        .ok_or_else(|| format!("no flange back {:.3} mm over the flange's tip", z - tip.z))
        .and_then(|place| place.known().map_err(|why| format!("no flange back: {why}")))
        .map(|place| place.x)
}

fn qr(
    curve: &MarkedCurve,
    tip: CurvePoint,
    thickness: f64,
    back: f64,
    options: &MeasureOptions,
) -> Result<f64, String> {
    let upper = face(curve, tip, tip.z + options.tip_depth, back + options.tread_at)?;
    Ok(thickness - (upper - back))
}

/// Returns the largest rise of Y towards the field side \[mm\] on the way from the tip; the tread begins at x = `face`.
fn hollow(
    curve: &MarkedCurve,
    tip: CurvePoint,
    face: f64,
    back: f64,
    options: &MeasureOptions,
) -> Result<f64, String> {
    let end = curve.extent().high - back;
    if end < options.tread_at + LEAST_TREAD {
        let least = options.tread_at + LEAST_TREAD;
        return Err(format!("the tread is measured to X = {end:.3} mm only, and hollow wear needs {least}"));
    }
    if curve.has_gap([1.0, 0.0], Interval::new(face, f64::INFINITY)) {
        return Err("the points of the tread have a gap".into());
    }
    let (mut top, mut rise, mut last) = (tip.z, 0.0f64, 0.0);
    for mark in curve.marks.iter().skip(tip.mark + 1) {
        top = top.max(mark.station.z);
        last = top - mark.station.z;
        rise = rise.max(last);
    }
    if last > 0.0 && last >= rise {
        return Err(format!("Y of the tread still rises where the points end, at X = {end:.3} mm"));
    }
    Ok(rise)
}

/// Returns the largest vertical distance \[mm\] of the tread above that of the nominal, over the nominal tread from the flange's face.
fn most_worn(curve: &MarkedCurve, nominal: &Nominal, options: &MeasureOptions) -> Result<f64, String> {
    let own = &nominal.curve;
    let tip = lowest(own, nominal.back, options)?;
    let level = tread(own, nominal.back, options)? - options.flange_level;
    let from = face(own, tip, level, nominal.back + options.tread_at)?;
    let measured = lowest(curve, nominal.back, options).map_or(0, |tip| tip.mark);
    let surface = curve.from(measured);
    let mut pairs = surface.marks.windows(2).peekable();
    if curve.has_gap([1.0, 0.0], Interval::new(from, own.extent().high)) {
        return Err("the points of the tread have a gap".into());
    }
    let mut most = f64::NEG_INFINITY;
    for mark in own.marks.iter().skip(tip.mark) {
        let at = mark.station;
        if at.x < from || at.sin.abs() > TREAD {
            continue;
        }
        while pairs.peek().is_some_and(|pair| pair[1].station.x < at.x) {
            pairs.next();
        }
        let Some([a, b]) = pairs.peek().map(|pair| [pair[0].station, pair[1].station]) else { break };
        if a.x <= at.x && a.x < b.x {
            most = most.max(a.z + (b.z - a.z) * ((at.x - a.x) / (b.x - a.x)) - at.z);
        }
    }
    if most.is_finite() { Ok(most) } else { Err("no tread over that of the nominal".into()) }
}
