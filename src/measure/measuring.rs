//! Measures one profile: aligned, as it is, and moved as far as an alignment may be off.

use super::align::{Aligned, align};
use super::better::{self, Rival, Rivals};
use super::curve::MarkedCurve;
use super::found::FoundValues;
use super::measures::Measures;
use super::nominal::{Nominal, sized};
use super::options::{Align, MeasureOptions};
use super::quantity::Quantity;
use super::{rail, wheel};
use crate::error::Result;
use crate::measured::noise::Deviates;
use crate::profile::{Profile, Side, Station};

/// Moves \[mm\] and turn \[rad\], 0.1°, by which an alignment may be off.
const OFF: f64 = 0.1;
const TURNED_OFF: f64 = OFF * std::f64::consts::PI / 180.0;

/// Number and seed of samples of the points' own noise, and how many standard deviations are its share of a value's uncertainty.
const SAMPLES: u64 = 20;
const SEED: u64 = 1;
const DEVIATIONS: f64 = 2.0;

/// Gain of metal \[mm\] on a tread or crown above which the alignment is doubted: more than tolerances of new profiles.
const MOST_GAINED: f64 = 0.5;
/// Gain of metal \[mm\] on a gauge face above which the alignment is doubted: metal flows to it from the crown.
const MOST_FLOWN: f64 = 3.0;

/// Measures a profile, right-hand and upright: its flange or gauge side is at smaller x.
///
/// What cannot be had is `None`, and the findings say why; what needs a nominal profile or a groove is `None` without one.
/// Accuracy: 1e-7 mm on the curve. Cost: about 20 ms, with a fit about 100 ms.
///
/// # Errors
/// Options without meaning.
///
/// # Examples
/// ```
/// use wheelrail::measure::{MeasureOptions, Quantity, measure};
/// use wheelrail::{Side, standards};
///
/// let measures = measure(&standards::wheel("S1002")?, Side::Wheel, None, &MeasureOptions::default())?;
/// let height = measures.value(Quantity::FlangeHeight).expect("a flange");
/// assert!((height - 28.0).abs() < 1e-6);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn measure(
    profile: &Profile,
    side: Side,
    nominal: Option<&Profile>,
    options: &MeasureOptions,
) -> Result<Measures> {
    options.validate(side, nominal.is_some())?;
    let nominal = match nominal.map(|nominal| Nominal::new(nominal, side)).transpose() {
        Ok(nominal) => nominal,
        Err(why) => return Ok(Measures::none(side, format!("in the nominal: {why}"))),
    };
    let curve = match sized(profile) {
        Ok(curve) => curve,
        Err(why) => return Ok(Measures::none(side, why)),
    };
    Ok(match laid(&curve, side, nominal.as_ref(), options) {
        Ok(laid) => laid.beside_rivals(&curve).measures(&curve, options),
        Err(why) => Measures::none(side, why),
    })
}

/// A profile in its own axes, in which all is measured that needs no nominal, and aligned on its nominal, where wear is measured.
pub(super) struct AlignedProfile<'a> {
    side: Side,
    own: std::result::Result<Aligned, String>,
    on_nominal: Option<(Aligned, &'a Nominal<'a>)>,
    /// Why there is no wear though there is a nominal.
    lost: Option<String>,
    /// The built-in profiles that fit as well as the nominal.
    rivals: Option<Rivals>,
    /// A fit on the nominal that gives no wear, but shows how the profile lies.
    shown: Option<Aligned>,
}

/// Aligns a profile. Where its nominal does not help, what needs no nominal is measured.
pub(super) fn laid<'a>(
    curve: &MarkedCurve,
    side: Side,
    nominal: Option<&'a Nominal<'a>>,
    options: &MeasureOptions,
) -> std::result::Result<AlignedProfile<'a>, String> {
    let own = alone(curve, side, nominal.is_some(), options);
    let (mut on_nominal, mut lost, mut shown) = (None, None, None);
    if let Some(nominal) = nominal {
        match align(curve, side, Some(nominal), options) {
            Err(why) => lost = Some(why),
            Ok(aligned) if aligned.refused.is_none() => on_nominal = Some((aligned, nominal)),
            Ok(aligned) => {
                lost.clone_from(&aligned.refused);
                shown = Some(aligned).filter(|aligned| aligned.parts_fit);
            }
        }
    }
    match (&own, &on_nominal) {
        (Err(why), None) => Err(lost.unwrap_or_else(|| why.clone())),
        _ => Ok(AlignedProfile { side, own, on_nominal, lost, rivals: None, shown }),
    }
}

/// Aligns a profile without its nominal, in the axes of its file or by its flange back: no fit moves what is measured there.
fn alone(
    curve: &MarkedCurve,
    side: Side,
    nominal: bool,
    options: &MeasureOptions,
) -> std::result::Result<Aligned, String> {
    let align_by = match options.align {
        Some(Align::None | Align::Back) => options.align,
        Some(Align::TreadPoint) if nominal => Some(Align::Back),
        _ => None,
    };
    align(curve, side, None, &MeasureOptions { align: align_by, unworn: Vec::new(), ..options.clone() })
}

impl AlignedProfile<'_> {
    /// Withdraws the wear if another built-in profile fits better than the nominal, unless the caller says which parts are not worn, and
    /// keeps those that fit as well.
    fn beside_rivals(mut self, curve: &MarkedCurve) -> Self {
        let Some((on, nominal)) = &self.on_nominal else { return self };
        let by_all = on.alignment.align == Align::BestFit;
        self.rivals = better::rivals(nominal, curve, self.side, on.alignment.align);
        let other = self.rivals.as_ref().filter(|rivals| by_all && !rivals.is_worn || rivals.is_nominal);
        if let Some(better) = other.and_then(|rivals| rivals.better.clone()) {
            self.lost = Some(better);
            self.shown = self.on_nominal.take().map(|(on, _)| on);
        }
        self
    }

    /// Measures the wear against each rival.
    fn by_rivals(&self, curve: &MarkedCurve, options: &MeasureOptions) -> Vec<ValueRow> {
        let all = self.rivals.as_ref().filter(|_| self.on_nominal.is_some()).map(|rivals| &rivals.all);
        let by = |rival: &Rival| {
            let nominal = Nominal::new(&rival.profile, self.side).ok()?;
            Some(wear(self.side, &curve.placed(&rival.motion), &nominal, options).values())
        };
        all.into_iter().flatten().filter_map(by).collect()
    }

    fn measures(self, curve: &MarkedCurve, options: &MeasureOptions) -> Measures {
        let mut found = self.found(options);
        let if_off = self.if_off(curve, options, found.values());
        let unbounded: Vec<Quantity> = Quantity::ALL
            .into_iter()
            .filter(|of| found.values()[*of as usize].is_some() && if_off[*of as usize].is_none())
            .collect();
        found.withdraw(&unbounded, "a profile that lies 0.1 mm or 0.1° otherwise has no value");
        let Self { side, own, on_nominal, lost, rivals, .. } = self;
        let lost = lost.map(|why| format!("{why}: no wear, the rest in its own axes"));
        let alignments =
            own.into_iter().map(|own| own.alignment).chain(on_nominal.map(|(on, _)| on.alignment));
        let mut alignments: Vec<_> = alignments.collect();
        let mut doubts: Vec<String> = alignments.iter().filter_map(|of| of.doubt.clone()).collect();
        doubts.dedup();
        doubts.extend(rivals.filter(|_| lost.is_none()).and_then(|rivals| rivals.better));
        let findings =
            lost.into_iter().chain(doubts).chain(gains(found.values())).chain(found.findings()).collect();
        let alignment = alignments.pop().map(|mut last| {
            if let Some(own) = alignments.first() {
                last.text += &format!("; without wear: {}", own.text);
            }
            last
        });
        Measures { values: found.values(), if_off, alignment, findings, ..Measures::empty(side) }
    }

    /// Measures the profile as it is aligned.
    pub(super) fn found(&self, options: &MeasureOptions) -> FoundValues {
        self.moved(&|_, _| Station::AXES, options)
    }

    /// Measures the aligned profile after a further motion, which depends on what it is measured by and on how far its X = 0 may
    /// be off.
    fn moved(&self, motion: &dyn Fn(&Aligned, f64) -> Station, options: &MeasureOptions) -> FoundValues {
        let own = match &self.own {
            Ok(own) => own_values(own, self.side, &own.curve.placed(&motion(own, own.reach)), options),
            Err(why) => {
                let mut found = FoundValues::default();
                let needed = Quantity::ALL.into_iter().filter(|of| of.side() == self.side && of.needs_back());
                found.lack(&needed.collect::<Vec<_>>(), why);
                found
            }
        };
        let Some((on, nominal)) = &self.on_nominal else { return own };
        own.with(wear(self.side, &on.curve.placed(&motion(on, on.reach)), nominal, options))
    }

    /// Returns how far each value is off if the profile lies otherwise: by what instruments and flange backs are off, and as the fit on
    /// the nominal or on rivals has it; by what smoothing or a spline makes of the shape; and by the noise of the points.
    fn if_off(&self, curve: &MarkedCurve, options: &MeasureOptions, values: ValueRow) -> ValueRow {
        let mut most = values.map(|value| value.map(|_| 0.0f64));
        let mut at_most = |moved: ValueRow, share: f64, gone: bool| {
            for ((most, value), moved) in most.iter_mut().zip(values).zip(moved) {
                let change = moved.zip(value).map(|(moved, value)| share * (moved - value).abs());
                // A quantity that is gone after the motion has no bound.
                *most = match change {
                    None if !gone => *most,
                    change => most.zip(change).map(|(most, change)| most.max(change)),
                };
            }
        };
        // A value may jump: after a turn another place is the highest. Of motions up to three times as far their share counts.
        for times in [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0f64] {
            let along = |x: f64, z: f64| Station { x, z, ..Station::AXES };
            let about = |on: &Aligned| turned(pivot(on, self.side, options), times * TURNED_OFF);
            let mut at = |motion: &dyn Fn(&Aligned, f64) -> Station| {
                at_most(self.moved(motion, options).values(), times.abs().recip(), times.abs() == 1.0);
            };
            at(&|_, reach| along(times * OFF + times.signum() * reach, 0.0));
            at(&|_, _| along(0.0, times * OFF));
            at(&|on, _| about(on));
        }
        let fit = self.on_nominal.as_ref().map(|(on, _)| on).or(self.shown.as_ref());
        if let (Some(on), Ok(_)) = (fit, &self.own) {
            at_most(own_values(on, self.side, &on.curve, options).values(), 1.0, false);
        }
        for by_rival in self.by_rivals(curve, options) {
            at_most(by_rival, 1.0, false);
        }
        if let Some(less) = curve.less_smoothed() {
            at_most(self.again(&less, options), 1.0, false);
        }
        let noise = self.noise(curve, options, values);
        for (most, noise) in most.iter_mut().zip(noise) {
            *most = most.map(|most| most + noise);
        }
        most
    }

    /// Measures another curve of the same points without a new fit.
    fn again(&self, curve: &MarkedCurve, options: &MeasureOptions) -> ValueRow {
        let own = alone(curve, self.side, self.on_nominal.is_some(), options);
        let on_nominal =
            self.on_nominal.as_ref().map(|(on, nominal)| (on.with(curve.placed(&on.frame)), *nominal));
        let other =
            AlignedProfile { side: self.side, own, on_nominal, lost: None, rivals: None, shown: None };
        other.found(options).values()
    }

    /// Returns the share of the points' own noise in the uncertainty of each value: samples of the whole measurement but the fit.
    fn noise(
        &self,
        curve: &MarkedCurve,
        options: &MeasureOptions,
        values: ValueRow,
    ) -> [f64; Quantity::ALL.len()] {
        let (mut squares, mut counts) = ([0.0; Quantity::ALL.len()], [0u32; Quantity::ALL.len()]);
        for number in 0..SAMPLES {
            let Some(again) = curve.again(&mut Deviates::new(SEED, number)) else { break };
            let found = self.again(&again, options);
            for (k, (value, found)) in values.into_iter().zip(found).enumerate() {
                if let Some((value, found)) = value.zip(found) {
                    squares[k] += (found - value).powi(2);
                    counts[k] += 1;
                }
            }
        }
        std::array::from_fn(|k| DEVIATIONS * (squares[k] / f64::from(counts[k].max(1))).sqrt())
    }
}

/// A number for each quantity that there is.
type ValueRow = [Option<f64>; Quantity::ALL.len()];

/// Measures what needs no nominal.
fn own_values(on: &Aligned, side: Side, curve: &MarkedCurve, options: &MeasureOptions) -> FoundValues {
    match side {
        Side::Wheel => wheel::measure(curve, (on.back, on.no_back.as_deref()), options),
        Side::Rail => rail::measure(curve, options),
    }
}

fn wear(side: Side, curve: &MarkedCurve, nominal: &Nominal, options: &MeasureOptions) -> FoundValues {
    match side {
        Side::Wheel => wheel::wear(curve, nominal, options),
        Side::Rail => rail::wear(curve, nominal, options),
    }
}

/// Returns the point about which an alignment may be turned.
fn pivot(on: &Aligned, side: Side, options: &MeasureOptions) -> [f64; 2] {
    match side {
        Side::Wheel => [on.back, wheel::tread(&on.curve, on.back, options).unwrap_or(0.0)],
        Side::Rail => on.curve.highest(1.0).map_or([0.0; 2], |top| [top.x, top.z]),
    }
}

/// Says which wear is a gain of metal that no wheel or rail has.
fn gains(values: [Option<f64>; Quantity::ALL.len()]) -> impl Iterator<Item = String> {
    let doubted =
        [(Quantity::TreadWear, MOST_GAINED), (Quantity::W1, MOST_GAINED), (Quantity::W2, MOST_FLOWN)];
    let gained = doubted
        .into_iter()
        .filter(move |(quantity, most)| values[*quantity as usize].is_some_and(|wear| wear < -most));
    gained
        .map(|(quantity, _)| quantity.key())
        .map(|key| format!("{key} is negative: another nominal, or worn parts were aligned"))
}

/// Returns the turn about a point.
fn turned([x, z]: [f64; 2], angle: f64) -> Station {
    let (sin, cos) = angle.sin_cos();
    Station { x: x - (x * cos - z * sin), z: z - (x * sin + z * cos), cos, sin }
}
