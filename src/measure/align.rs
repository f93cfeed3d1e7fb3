//! Puts a measured profile on its nominal one, or finds what its axes are without one.

use serde::Serialize;

use super::curve::MarkedCurve;
use super::fit::{FittedMotion, NominalFit};
use super::nominal::{Back, Nominal, back_of, is_from_back, own_back, sized};
use super::options::{Align, MeasureOptions};
use crate::numerics::interval::Interval;
use crate::profile::{Profile, Side, Station, trace};

/// Distance of marks \[mm\] of curves that are fitted.
const STEP: f64 = 0.25;
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

/// Turn \[deg\] above which an alignment is doubted: rails lie inclined by up to 1:20 and are canted a little, instruments are
/// put on by less.
const MOST_TURNED: f64 = 5.0;

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
    pub alignment: Alignment,
}

impl Aligned {
    fn doubted(mut self, doubt: Option<String>) -> Self {
        self.alignment.doubt = doubt;
        self
    }
}

/// Aligns a measured profile.
///
/// # Errors
/// What the alignment needs and the profile does not have, as text.
pub(super) fn align(
    profile: &Profile,
    side: Side,
    nominal: Option<&Nominal>,
    options: &MeasureOptions,
) -> Result<Aligned, String> {
    let curve = sized(profile)?;
    let chosen = options.align.or(nominal.map(|_| Align::BestFit));
    match (side, nominal) {
        (Side::Rail, None) => Ok(moved(&curve, [0.0; 2], 0.0, Align::None, "the file's axes")),
        (Side::Wheel, None) => {
            let own = match options.align {
                Some(Align::None) => Ok(Back { x: 0.0, how: "the file's x = 0".into(), doubt: None }),
                Some(_) => back_of(&curve),
                None => own_back(&curve),
            };
            let Back { x: back, how, doubt } = match own {
                Ok(own) => own,
                Err(why) if options.align.is_none() => return from_taping_line(&curve, why, options),
                Err(why) => return Err(why),
            };
            let align =
                if back == 0.0 && options.align != Some(Align::Back) { Align::None } else { Align::Back };
            Ok(moved(&curve, [0.0; 2], back, align, &format!("X = 0 is {how}")).doubted(doubt))
        }
        (_, Some(nominal)) => {
            with_nominal(profile, &curve, side, nominal, chosen.unwrap_or(Align::None), options)
        }
    }
}

/// Aligns a wheel without its back whose flange's tip shows that x = 0 is the taping line.
fn from_taping_line(curve: &MarkedCurve, why: String, options: &MeasureOptions) -> Result<Aligned, String> {
    let back = -options.tread_at;
    if !curve.highest(-1.0).is_some_and(|tip| is_from_back(tip.x - back)) {
        return Err(why);
    }
    let text = format!("the file's x = 0 is X = {}", options.tread_at);
    Ok(Aligned { no_back: Some(why), ..moved(curve, [0.0; 2], back, Align::None, &text) })
}

fn with_nominal(
    profile: &Profile,
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
            let Back { x: back, how, doubt } = back_of(curve)?;
            let text = format!("X = 0 is {how}; heights are the file's");
            Ok(moved(curve, [nominal.back - back, 0.0], nominal.back, align, &text).doubted(doubt))
        }
        (Align::TreadPoint, _) => {
            let Back { x: back, how, doubt } = back_of(curve)?;
            let x = nominal.back - back;
            let tread = super::wheel::tread(curve, back, options)?;
            let to = super::wheel::tread(&nominal.curve, nominal.back, options)?;
            let text = format!("X = 0 is {how}; the tread at X = {} is the nominal's", options.tread_at);
            Ok(moved(curve, [x, to - tread], nominal.back, align, &text).doubted(doubt))
        }
        _ => fitted(profile, curve, side, nominal, align, options),
    }
}

/// Moves a curve without turning it.
fn moved(curve: &MarkedCurve, [x, z]: [f64; 2], back: f64, align: Align, text: &str) -> Aligned {
    let curve = curve.placed(&Station { x, z, ..Station::AXES });
    let alignment = Alignment { align, text: text.into(), residual: None, doubt: None };
    Aligned { curve, back, no_back: None, alignment }
}

fn fitted(
    profile: &Profile,
    curve: &MarkedCurve,
    side: Side,
    nominal: &Nominal,
    align: Align,
    options: &MeasureOptions,
) -> Result<Aligned, String> {
    let coarse = |profile: &Profile| MarkedCurve { marks: trace(profile, STEP) };
    let (measured, onto) = (coarse(profile), coarse(nominal.profile));
    let work = measured.marks.len().saturating_mul(onto.marks.len());
    if work > MOST_WORK {
        return Err(format!(
            "no alignment: {work} pairs of marks, more than {MOST_WORK}: thin the points out"
        ));
    }
    let (parts, what) = parts(&onto, side, align, options);
    let fit = NominalFit { measured: &measured, nominal: &onto, parts: &parts };
    let all: Vec<Result<FittedMotion, String>> =
        starts(&measured, &onto, side).into_iter().map(|start| fit.of_parts(start)).collect();
    let best = all.iter().flatten().min_by(|a, b| a.rms.total_cmp(&b.rms)).copied();
    let none = || all.iter().find_map(|found| found.as_ref().err().cloned()).unwrap_or_default();
    let of_parts = best.ok_or_else(|| format!("no alignment by {what}: {}", none()))?;
    let (found, by) = if align == Align::BestFit {
        let found = fit.of_all(of_parts).map_err(|why| format!("no alignment by all that fits: {why}"))?;
        (found, format!("all that fits, from {what}"))
    } else {
        (of_parts, what)
    };
    let FittedMotion { motion, rms, length } = found;
    let turn = motion.angle().to_degrees();
    let off = (of_parts.rms > LARGEST_RESIDUAL).then(|| {
        format!("alignment by parts that are off the nominal by {:.3} mm, more than {LARGEST_RESIDUAL}: worn, or another nominal", of_parts.rms)
    });
    let turned = (turn.abs() > MOST_TURNED).then(|| {
        format!(
            "alignment by a turn of {turn:.3} deg, more than {MOST_TURNED}: another nominal, or worn parts"
        )
    });
    let doubt = off.or(turned);
    let text = format!(
        "{by}, over {length:.0} mm; moved by ({:.3}, {:.3}) mm, turned by {turn:.3} deg",
        motion.x, motion.z
    );
    let alignment = Alignment { align, text, residual: Some(rms), doubt };
    Ok(Aligned { curve: curve.placed(&motion), back: nominal.back, no_back: None, alignment })
}

/// Returns first guesses of the motion: back and tip of a flange, field side and top of a rail are brought to each other.
fn starts(measured: &MarkedCurve, nominal: &MarkedCurve, side: Side) -> Vec<Station> {
    let sign = if side == Side::Rail { 1.0 } else { -1.0 };
    let ends = |curve: &MarkedCurve| {
        let x = curve.extent();
        let outer = if side == Side::Rail { x.high } else { x.low };
        let best = curve.highest(sign);
        let back = side == Side::Rail || back_of(curve).is_ok();
        (best.filter(|_| !back).map_or(outer, |tip| tip.x), best.map_or(0.0, |best| best.z), back)
    };
    let ((mut x, z, back), (to_x, to_z, _)) = (ends(measured), ends(nominal));
    if !back {
        // Without its back a flange is brought to the other by their tips.
        x += to_x - nominal.highest(sign).map_or(to_x, |tip| tip.x);
    }
    let wear = if side == Side::Rail { STARTS.as_slice() } else { &STARTS[..1] };
    wear.iter().map(|wear| Station { x: to_x - x, z: to_z - z - wear, ..Station::AXES }).collect()
}

/// Returns which marks of the nominal are fitted, and their name.
fn parts(nominal: &MarkedCurve, side: Side, align: Align, options: &MeasureOptions) -> (Vec<bool>, String) {
    let marks = &nominal.marks;
    let stations = || marks.iter().map(|mark| mark.station);
    let [first, last] = nominal.extent().ends();
    match (align, side) {
        (Align::Unworn, _) => {
            let inside = |x: f64| options.unworn.iter().any(|range| range.contains(x));
            (stations().map(|at| inside(at.x)).collect(), "the given ranges".into())
        }
        (Align::Web, _) => {
            let before = marks.iter().position(|mark| mark.station.x == first).unwrap_or(0);
            let after = marks.iter().rposition(|mark| mark.station.x == last).unwrap_or(marks.len());
            ((0..marks.len()).map(|k| k < before || k > after).collect(), "web and underside".into())
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
