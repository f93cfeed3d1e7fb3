//! Finds the built-in profiles that fit a measured one better than its nominal does, or as well. One fits as well in three cases: it fits over
//! the same length, and no more metal lies outside of it; much less metal lies outside of it; or the length over which it fits, less the
//! length over which metal lies outside of it, is no shorter.

use super::align::{consensus, onto};
use super::curve::MarkedCurve;
use super::fit::FittedMotion;
use super::nominal::Nominal;
use super::options::Align;
use crate::profile::{Profile, Side, Station, standards};

/// Distance of marks \[mm\]: built-in profiles differ by more over whole roundings.
const STEP: f64 = 1.0;
/// Share of the measured curve over which a nominal that fits is the right one.
const ALL: f64 = 0.95;
/// Share of the measured curve over which another profile that fits is the nominal though the caller says which parts are not worn: wear
/// at one side makes a head that of a narrower rail, but does not spare the rest.
const NEARLY_ALL: f64 = 0.9;
/// Length \[mm\] of the curve, and share of it, over which another profile has to fit beyond what the nominal fits to be named, or by which
/// less of the curve lies outside of it.
const MORE: f64 = 20.0;
const MORE_SHARE: f64 = 0.15;
/// Difference \[mm\] of such lengths that is none: of two the one with the smaller residual fits better.
const AS_LONG: f64 = 5.0;

/// A built-in profile that fits a measured curve as well as its nominal, and the motion that puts the curve on it.
pub(super) struct Rival {
    pub profile: Profile,
    pub motion: Station,
}

/// The built-in profiles that fit a measured curve as well as its nominal or better.
pub(super) struct Rivals {
    pub all: Vec<Rival>,
    /// The best one by name, with both residuals, if it fits so much better that the nominal is probably another.
    pub better: Option<String>,
    /// Whether it fits nearly all of the curve, so that the nominal is another.
    pub is_nominal: bool,
    /// Whether wear explains all that is off the nominal: nothing of the curve lies outside of it.
    pub is_worn: bool,
}

/// Finds the built-in profiles that fit over as great a length as the nominal or more; `None` if the nominal fits nearly all.
pub(super) fn rivals(nominal: &Nominal, curve: &MarkedCurve, side: Side, align: Align) -> Option<Rivals> {
    let curve = curve.thinned(STEP);
    let length: f64 = curve.lengths().sum();
    let of = |profile: &Profile| consensus(&curve, &onto(profile, align, STEP), side, align);
    let own = of(nominal.profile);
    let fits = own.map_or(0.0, |own| own.length);
    if fits >= ALL * length {
        return None;
    }
    let built_in = |name: &str| match side {
        Side::Rail => standards::rail(name).ok(),
        Side::Wheel => standards::wheel(name).ok(),
    };
    let names: Vec<&str> = match side {
        Side::Rail => standards::rail_names().collect(),
        Side::Wheel => standards::wheel_names().collect(),
    };
    let others = names.into_iter().filter_map(|name| {
        let profile = built_in(name)?;
        Some((of(&profile)?, name, profile))
    });
    // Wear takes metal away: what lies outside of a profile was never worn from it.
    let outside = |of: &FittedMotion| match side {
        Side::Rail => of.above,
        Side::Wheel => of.near - of.length - of.above,
    };
    let own_outside = own.as_ref().map_or(f64::INFINITY, outside);
    let more = MORE.max(MORE_SHARE * length);
    let is_as_good = |of: &FittedMotion| {
        let as_long = of.length >= fits - AS_LONG && outside(of) <= own_outside + AS_LONG;
        let as_much = of.length - outside(of) >= fits - own_outside;
        as_long || as_much || outside(of) + more <= own_outside
    };
    let mut others: Vec<_> = others.filter(|other| is_as_good(&other.0)).collect();
    let longest = others.iter().map(|other| other.0.length).fold(0.0, f64::max);
    let as_long = others.iter().filter(|other| other.0.length >= longest - AS_LONG);
    let (best, name, _) = as_long.min_by(|a, b| a.0.rms.total_cmp(&b.0.rms))?;
    let text = |of: &FittedMotion| format!("{:.3} mm over {:.0} mm", of.rms, of.length);
    let better = (best.length >= fits + more).then(|| {
        let own = own.map_or_else(|| "nothing".to_owned(), |own| text(&own));
        format!(
            "{name} fits better, with a residual of {}, than the nominal {} with {own}: another nominal",
            text(best),
            nominal.profile.name
        )
    });
    let is_nominal = better.is_some() && best.length >= NEARLY_ALL * length;
    others.retain(|(_, name, _)| *name != nominal.profile.name);
    let all = others.into_iter().map(|(fit, _, profile)| Rival { profile, motion: fit.motion }).collect();
    Some(Rivals { all, better, is_nominal, is_worn: own_outside <= AS_LONG })
}
