//! Puts a measured profile on its nominal one, or finds what its axes are without one.

use serde::Serialize;

use super::curve::{CurvePoint, MarkedCurve};
use super::fit::{FITS, FittedMotion, NominalFit, is_same};
use super::nominal::{Back, Nominal, back_of, from_tip, is_from_back, own_back};
use super::options::{Align, MeasureOptions};
use super::quantity::in_micrometres;
use crate::numerics::interval::Interval;
use crate::profile::{Profile, Side, Station, standards};

/// Share of the parts over which places have to be found; for parts of both sides, of which one may be measured alone.
const LEAST_PART: f64 = 0.5;
const LEAST_OF_BOTH: f64 = 0.25;
/// Distance of marks \[mm\] of curves that are fitted.
const STEP: f64 = 0.25;
/// That of a measured web \[mm\]: it is longer, and is fitted from many starts.
const WEB_STEP: f64 = 1.0;
/// Sine of 60°.
const SIXTY: f64 = 0.866_025_403_784_438_6;
/// Ends \[mm\] of the outer tread, from where the nominal tread ends at its chamfer: 10 mm, as the MiniProf's own alignment has it.
const OUTER: Interval = Interval::new(-15.0, -5.0);
/// Sine of the inclination at which a tread ends, 30°.
const TREAD_END: f64 = 0.5;
/// Vertical wear \[mm\] from which fits of a rail start; the best fit counts.
const STARTS: [f64; 5] = [0.0, 4.0, 8.0, 12.0, 16.0];
/// Largest number of pairs of marks that are compared, a second's work; two profiles of 1000 points have up to four millions.
const MOST_WORK: usize = 200_000_000;
/// Root mean square \[mm\] above which fitted parts are probably worn.
const LARGEST_RESIDUAL: f64 = 0.1;
/// Distance \[mm\] by which what fits may be turned over its length.
const TURNED_BY: f64 = 0.05;
/// Least length \[mm\] of what fits: a shorter base leaves a turn by [`TURNED_BY`] over it, which are 0.4 mm at the other end of a wheel. A
/// best fit that turns the profile by more than an instrument, and than the base leaves, needs a third of the profile.
const LEAST_BASE: f64 = 20.0;

/// Share of what is measured of fitted parts that has to fit: at the ends of parts, places belong to what lies beside them.
const NEARLY_ALL: f64 = 0.9;

/// Turn \[deg\] by which instruments are put on at most; beside it rails lie inclined.
const MOST_TURNED: f64 = 0.3;
/// Turn \[deg\] from which on a profile is not upright.
const NOT_UPRIGHT: f64 = 45.0;
/// Inclinations of rails: 1 in so many.
const INCLINED: [f64; 4] = [f64::INFINITY, 40.0, 30.0, 20.0];
/// Depth \[mm\] below the top of rail at which faces are brought to each other.
const FACE: f64 = 14.0;
/// Width \[mm\] by which an outline recedes below a head.
const RECEDES: f64 = 5.0;
/// Distance \[mm\] of first guesses that lead to one fit.
const ONE_START: f64 = 1.0;

/// How a profile was aligned.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alignment {
    /// The alignment that was used.
    pub align: Align,
    /// The alignment in words, with what was fitted and moved.
    pub text: String,
    /// Root mean square of the distances \[mm\] of what was fitted; `None` if nothing was.
    pub residual: Option<f64>,
    /// A doubt about the alignment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub doubt: Option<String>,
}

/// A measured curve in the axes in which it is measured.
pub(super) struct Aligned {
    pub curve: MarkedCurve,
    /// x of the flange back, from which X counts \[mm\]; 0 for rails.
    pub back: f64,
    /// Why no flange back was found, if `back` follows from x = 0 as the taping line instead.
    pub no_back: Option<String>,
    /// How far the flange back may lie from `back` \[mm\], besides what an instrument is put on by.
    pub reach: f64,
    /// The motion from the axes of the points.
    pub frame: Station,
    /// Why no wear follows from it.
    pub refused: Option<String>,
    /// Whether the parts that wear spares fit, so that it shows how the profile lies.
    pub parts_fit: bool,
    pub alignment: Alignment,
}

impl Aligned {
    /// Returns the same alignment of another curve.
    pub fn with(&self, curve: MarkedCurve) -> Self {
        let (no_back, alignment) = (self.no_back.clone(), self.alignment.clone());
        Self { curve, no_back, refused: None, alignment, ..*self }
    }

    fn with_back(mut self, back: &Back) -> Self {
        self.alignment.doubt.clone_from(&back.doubt);
        self.reach = back.reach;
        self
    }
}

/// Aligns a measured profile.
///
/// # Errors
/// What the alignment needs and the profile does not have, as text.
pub(super) fn align(
    curve: &MarkedCurve,
    side: Side,
    nominal: Option<&Nominal>,
    options: &MeasureOptions,
) -> Result<Aligned, String> {
    let chosen = options.align.or(nominal.map(|_| Align::BestFit));
    match (side, nominal) {
        (Side::Rail, None) => Ok(moved(curve, [0.0; 2], 0.0, Align::None, "the file's axes")),
        (Side::Wheel, None) => {
            let own = match options.align {
                Some(Align::None) => {
                    Ok(Back { x: 0.0, how: "the file's x = 0".into(), reach: 0.0, doubt: None })
                }
                Some(_) => back_of(curve),
                None => own_back(curve),
            };
            let back = match own {
                Ok(own) => own,
                Err(why) if options.align.is_none() => return from_taping_line(curve, why, options),
                Err(why) => return Err(why),
            };
            let from_back = back.x != 0.0 || options.align == Some(Align::Back);
            let align = if from_back { Align::Back } else { Align::None };
            Ok(moved(curve, [0.0; 2], back.x, align, &format!("X = 0 is {}", back.how)).with_back(&back))
        }
        (_, Some(nominal)) => with_nominal(curve, side, nominal, chosen.unwrap_or(Align::None), options),
    }
}

/// Aligns a wheel without its back whose flange's tip shows that x = 0 is the taping line.
fn from_taping_line(curve: &MarkedCurve, why: String, options: &MeasureOptions) -> Result<Aligned, String> {
    let back = -options.tread_at;
    let tip = curve
        .highest(-1.0)
        .map(|tip| tip.x - back)
        .filter(|tip| is_from_back(*tip))
        .ok_or_else(|| why.clone())?;
    let text = format!("the file's x = 0 is X = {}", options.tread_at);
    let reach = from_tip(tip);
    Ok(Aligned { no_back: Some(why), reach, ..moved(curve, [0.0; 2], back, Align::None, &text) })
}

fn with_nominal(
    curve: &MarkedCurve,
    side: Side,
    nominal: &Nominal,
    align: Align,
    options: &MeasureOptions,
) -> Result<Aligned, String> {
    match (align, side) {
        (Align::None, Side::Rail) => Ok(moved(curve, [0.0; 2], 0.0, align, "the file's axes")),
        (Align::None, Side::Wheel) => {
            let text = "the file's x = 0 is the flange back, its height that of the nominal";
            Ok(moved(curve, [nominal.back, 0.0], nominal.back, align, text))
        }
        (Align::Back, _) => {
            let back = back_of(curve)?;
            let text = format!("X = 0 is {}; heights are the file's", back.how);
            Ok(moved(curve, [nominal.back - back.x, 0.0], nominal.back, align, &text).with_back(&back))
        }
        (Align::TreadPoint, _) => {
            let back = back_of(curve)?;
            let tread = super::wheel::tread(curve, back.x, options)?;
            let to = super::wheel::tread(&nominal.curve, nominal.back, options)?;
            let text =
                format!("X = 0 is {}; the tread at X = {} is the nominal's", back.how, options.tread_at);
            let by = [nominal.back - back.x, to - tread];
            Ok(moved(curve, by, nominal.back, align, &text).with_back(&back))
        }
        _ => fitted(curve, side, nominal, align, options),
    }
}

/// Moves a curve without turning it.
fn moved(curve: &MarkedCurve, [x, z]: [f64; 2], back: f64, align: Align, text: &str) -> Aligned {
    let frame = Station { x, z, ..Station::AXES };
    let alignment = Alignment { align, text: text.into(), residual: None, doubt: None };
    let curve = curve.placed(&frame);
    Aligned { curve, back, no_back: None, reach: 0.0, frame, refused: None, parts_fit: true, alignment }
}

fn fitted(
    curve: &MarkedCurve,
    side: Side,
    nominal: &Nominal,
    align: Align,
    options: &MeasureOptions,
) -> Result<Aligned, String> {
    let is_web = align == Align::Web;
    let apart = if is_web { WEB_STEP } else { STEP };
    let (measured, onto) = (curve.thinned(apart), onto(nominal.profile, align, STEP));
    let work = measured.marks.len().saturating_mul(onto.marks.len());
    if work > MOST_WORK {
        return Err(format!(
            "no alignment: {work} pairs of marks, more than {MOST_WORK}: thin the points out"
        ));
    }
    let (parts, what) = parts(&onto, side, align, options);
    let least_part = if is_web { LEAST_OF_BOTH } else { LEAST_PART };
    let fit = NominalFit { measured: &measured, nominal: &onto, parts: &parts, least_part };
    let all = by_parts(&fit, side, is_web);
    let best = all.iter().flatten().min_by(|a, b| a.rms.total_cmp(&b.rms)).copied();
    let none = || all.iter().find_map(|found| found.as_ref().err().cloned()).unwrap_or_default();
    let of_parts = best.ok_or_else(|| format!("no alignment by {what}: {}", none()))?;
    let (found, by) = if align == Align::BestFit {
        let fits = (3.0 * of_parts.rms).clamp(FITS.low, FITS.high);
        let found =
            fit.of_all(of_parts, fits).map_err(|why| format!("no alignment by all that fits: {why}"))?;
        (found, format!("all that fits, from {what}"))
    } else {
        (of_parts, what)
    };
    let FittedMotion { motion, rms, length, .. } = found;
    let turn = motion.angle().to_degrees();
    let left = (TURNED_BY / length).to_degrees();
    let is_turned = align == Align::BestFit && turned(turn, side, left).is_some();
    let least = if is_turned { (measured.lengths().sum::<f64>() / 3.0).max(LEAST_BASE) } else { LEAST_BASE };
    let refused = refused(of_parts, found, least);
    let parts_fit = of_parts.rms <= LARGEST_RESIDUAL;
    let doubt =
        refused.clone().or_else(|| is_web.then(|| off(found)).flatten()).or_else(|| turned(turn, side, 0.0));
    let [x, z, by_turn] = [motion.x, motion.z, turn].map(in_micrometres);
    let text = format!("{by}, over {length:.0} mm; moved by ({x}, {z}) mm, turned by {by_turn} deg");
    let alignment = Alignment { align, text, residual: Some(rms), doubt };
    let curve = curve.placed(&motion);
    Ok(Aligned {
        curve,
        back: nominal.back,
        no_back: None,
        reach: 0.0,
        frame: motion,
        refused,
        parts_fit,
        alignment,
    })
}

/// Returns what a curve is fitted to: the nominal, with the web of a built-in rail where that is wanted.
pub(super) fn onto(nominal: &Profile, align: Align, step: f64) -> MarkedCurve {
    let whole = (align == Align::Web).then(|| standards::with_web(nominal)).flatten();
    MarkedCurve::drawn(whole.as_ref().unwrap_or(nominal), step)
}

/// Fits a curve to another as to a nominal: by the parts that wear spares, or by the web, whichever start fits them best, then by all that
/// fits. Of a worn head more may fit where it is shifted.
pub(super) fn consensus(
    measured: &MarkedCurve,
    onto: &MarkedCurve,
    side: Side,
    align: Align,
) -> Option<FittedMotion> {
    let is_web = align == Align::Web;
    let by = if is_web { align } else { Align::BestFit };
    let (parts, _) = parts(onto, side, by, &MeasureOptions::default());
    let fit = NominalFit { measured, nominal: onto, parts: &parts, least_part: LEAST_OF_BOTH };
    let all = by_parts(&fit, side, is_web).into_iter().flatten();
    let best = all.min_by(|a, b| a.rms.total_cmp(&b.rms))?;
    fit.of_all(best, 0.5 * FITS.high).ok()
}

/// Fits a curve by parts from all first guesses. Of a web some parts may be off the nominal: it is fitted by those that are not.
///
/// A fit that turns the profile by more than 45° is an error: the points are upright, and such a fit has put the web on the foot.
fn by_parts(fit: &NominalFit, side: Side, is_web: bool) -> Vec<Result<FittedMotion, String>> {
    let mut all: Vec<Result<FittedMotion, String>> = Vec::new();
    for start in starts(fit.measured, fit.nominal, side) {
        let found = fit.of_parts(start);
        let known = found.as_ref().is_ok_and(|found| all.iter().flatten().any(|of| is_same(of, found)));
        if !known {
            all.push(found);
        }
    }
    let upright = |found: FittedMotion| {
        let turn = found.motion.angle().to_degrees();
        if turn.abs() > NOT_UPRIGHT {
            Err(format!("it fits where it is turned by {turn:.0} deg"))
        } else {
            Ok(found)
        }
    };
    let fitted = |found: Result<FittedMotion, String>| if is_web { fit.of_most(found?) } else { found };
    all.into_iter().map(|found| upright(fitted(found)?)).collect()
}

/// Tells why a fit gives no wear: its parts are off the nominal, or its base is shorter than `least` \[mm\].
fn refused(of_parts: FittedMotion, found: FittedMotion, least: f64) -> Option<String> {
    let FittedMotion { rms, length, .. } = of_parts;
    if rms > LARGEST_RESIDUAL {
        return Some(format!(
            "alignment by parts of {length:.1} mm that are off the nominal by {rms:.3} mm, more than {LARGEST_RESIDUAL}: worn, or another nominal"
        ));
    }
    let turn = found.motion.angle().to_degrees();
    (found.length < least).then(|| {
        format!(
            "alignment by a turn of {turn:.3} deg over a base of {:.1} mm, less than {least:.0}, with a residual of {:.3} mm: worn, or another nominal",
            found.length, found.rms
        )
    })
}

/// Doubts a fit from which a tenth or more of its parts is off.
fn off(found: FittedMotion) -> Option<String> {
    let FittedMotion { length, near, rms, .. } = found;
    (length < NEARLY_ALL * near).then(|| {
        format!(
            "alignment by {length:.0} mm of {near:.0} mm that are measured, with a residual of {rms:.3} mm: the rest is off the \
             nominal, dirty, damaged, or another nominal"
        )
    })
}

/// Doubts a turn \[deg\], known within `left`, beyond that of instruments, and of rails as they lie.
fn turned(turn: f64, side: Side, left: f64) -> Option<String> {
    let most = MOST_TURNED + left;
    let lies = |n: &f64| side == Side::Rail && (turn.abs() - n.recip().atan().to_degrees()).abs() <= most;
    if turn.abs() <= most || INCLINED.iter().any(lies) {
        return None;
    }
    let but = if side == Side::Rail { " and no inclination of 1:20, 1:30 or 1:40" } else { "" };
    Some(format!(
        "alignment by a turn of {turn:.3} deg, more than the {MOST_TURNED} of instruments{but}: a turned file, another nominal, or worn parts"
    ))
}

/// Returns first guesses of the motion. Of a wheel, back or tip of the flange are brought to each other, of a rail the faces of either
/// side and the top, whichever are measured.
fn starts(measured: &MarkedCurve, nominal: &MarkedCurve, side: Side) -> Vec<Station> {
    let sign = if side == Side::Rail { 1.0 } else { -1.0 };
    let (Some(best), Some(to)) = (measured.highest(sign), nominal.highest(sign)) else { return Vec::new() };
    let places = |curve: &MarkedCurve, best: CurvePoint| {
        let x = curve.extent();
        if side == Side::Wheel {
            return vec![back_of(curve).is_ok().then_some(x.low), Some(best.x)];
        }
        let faces = curve.at_z(best.z - FACE);
        let [left, right] = [
            faces.iter().rfind(|face| face.mark < best.mark),
            faces.iter().find(|face| face.mark >= best.mark),
        ];
        vec![right.map(|face| face.x), left.map(|face| face.x), Some(x.high)]
    };
    let mut across: Vec<f64> = Vec::new();
    for (own, onto) in places(measured, best).into_iter().zip(places(nominal, to)) {
        if let (Some(own), Some(onto)) = (own, onto)
            && across.iter().all(|other| (other - (onto - own)).abs() > ONE_START)
        {
            across.push(onto - own);
        }
    }
    let wear = if side == Side::Rail { STARTS.as_slice() } else { &STARTS[..1] };
    let start = |x: f64, wear: f64| Station { x, z: to.z - best.z - wear, ..Station::AXES };
    across.into_iter().flat_map(|x| wear.iter().map(move |wear| start(x, *wear))).collect()
}

/// Returns the marks at which the outline of a rail's head begins to recede, to the left and to the right of its top.
fn sides_of_head(curve: &MarkedCurve) -> [usize; 2] {
    let top = curve.highest(1.0).map_or(0, |top| top.mark);
    let x = |k: usize| curve.marks[k].station.x;
    let outermost = |all: &mut dyn Iterator<Item = usize>, sign: f64| {
        let mut best = top;
        for k in all {
            if sign * x(k) > sign * x(best) {
                best = k;
            } else if sign * x(k) < sign * x(best) - RECEDES {
                break;
            }
        }
        best
    };
    [outermost(&mut (0..top).rev(), -1.0), outermost(&mut (top + 1..curve.marks.len()), 1.0)]
}

/// Returns which marks of the nominal are fitted, and their name.
fn parts(nominal: &MarkedCurve, side: Side, align: Align, options: &MeasureOptions) -> (Vec<bool>, String) {
    let marks = &nominal.marks;
    let stations = || marks.iter().map(|mark| mark.station);
    let last = nominal.extent().high;
    match (align, side) {
        (Align::Unworn, _) => {
            let inside = |x: f64| options.unworn.iter().any(|range| range.contains(x));
            (stations().map(|at| inside(at.x)).collect(), "the given ranges".into())
        }
        (Align::Web, _) => {
            let [before, after] = sides_of_head(nominal);
            let below = |k: usize| k < before || k > after;
            ((0..marks.len()).map(below).collect(), "web, underside of the head and foot".into())
        }
        (_, Side::Rail) => {
            let top = nominal.highest(1.0).map_or(0, |top| top.mark);
            let steep = stations().enumerate().map(|(k, at)| k > top && at.sin <= -SIXTY && at.cos >= 0.0);
            (steep.collect(), "the field side from 60°".into())
        }
        (_, Side::Wheel) => {
            let tip = nominal.highest(-1.0).map_or(0, |tip| tip.mark);
            let flat = |k: usize| k > tip && marks[k].station.sin.abs() <= TREAD_END;
            let end = (0..marks.len()).rev().find(|&k| flat(k)).map_or(last, |k| marks[k].station.x);
            let outer = OUTER + end;
            let part = |(k, at): (usize, Station)| {
                if k <= tip { at.sin <= -SIXTY } else { outer.contains(at.x) && flat(k) }
            };
            (stations().enumerate().map(part).collect(), "flange back and outer tread".into())
        }
    }
}
