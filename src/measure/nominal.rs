//! What profiles are put on: the flange back from which X counts, the running head, and the nominal profile with both.

use super::curve::MarkedCurve;
use crate::error::{self, Error};
use crate::numerics::interval::Interval;
use crate::profile::{Profile, Side, Station, last_groove};

/// Places \[mm\] of a flange's tip right of x = 0 that show that x = 0 is at the flange back: flanges are 20 to 40 mm thick.
const TIP_FROM_BACK: Interval = Interval::new(5.0, 40.0);
/// Height \[mm\] of the flange back over which its line is fitted, and the least one.
const BACK_LENGTH: f64 = 10.0;
const LEAST_BACK: f64 = 5.0;
/// Sine of the inclination of a back through which a line is fitted, 85°; and of the end of a drawn profile that is its back, 75°.
const STRAIGHT: f64 = 0.996_194_698_091_745_5;
const STEEP: f64 = 0.965_925_826_289_068_3;
/// Largest extent of a profile \[mm\]: a whole rail is 230 mm high, and a crossing with its wing rails 400 mm wide.
const LARGEST: f64 = 1000.0;

/// Sine of the inclination of an end that is the back without a doubt, 88°: a back that turns upright with 20 mm radius lies
/// 0.01 mm farther left.
const UPRIGHT: f64 = 0.999_390_827_019_095_7;
const BACK_RADIUS: f64 = 20.0;
/// Distance \[mm\] of a flange's tip from its back, and by how much that of a usual wheel is another.
const TIP: f64 = 15.0;
const TIPS_DIFFER: f64 = 1.0;
/// Distances \[mm\] of a file's x = 0 from the flange back above which it is doubted, and from which it is not there: instruments
/// touch the back, a little beside the place where it is found.
const MOST_OFF: f64 = 0.3;
const ELSEWHERE: f64 = 1.0;

/// The flange back of a wheel.
pub(super) struct Back {
    /// x of the back \[mm\].
    pub x: f64,
    /// How it was found.
    pub how: String,
    /// How far it may lie elsewhere \[mm\], besides what an instrument is put on by.
    pub reach: f64,
    /// Why it may lie elsewhere.
    pub doubt: Option<String>,
}

/// A nominal profile with its axes.
pub(super) struct Nominal<'a> {
    pub profile: &'a Profile,
    pub curve: MarkedCurve,
    /// x of its flange back \[mm\]; 0 for rails.
    pub back: f64,
}

impl<'a> Nominal<'a> {
    /// Makes the nominal of a body, with the flange back of a wheel.
    ///
    /// # Errors
    /// A wheel without a flange back; a profile larger than wheels and rails are.
    pub fn new(profile: &'a Profile, side: Side) -> Result<Self, String> {
        let curve = sized(profile)?;
        let back = if side == Side::Wheel { own_back(&curve)?.x } else { 0.0 };
        Ok(Self { profile, curve, back })
    }

    /// Makes the nominal of a body, as [`Nominal::new`] does, with an error that names the profile.
    pub fn named(profile: &'a Profile, side: Side) -> error::Result<Self> {
        let advice = "give the whole profile";
        Self::new(profile, side).map_err(|why| Error::new(&profile.name, why, "a whole nominal", advice))
    }
}

/// Returns the curve of a profile; an error if it is larger than wheels and rails are.
pub(super) fn sized(profile: &Profile) -> Result<MarkedCurve, String> {
    let extent = profile.extent();
    if extent > LARGEST {
        return Err(format!(
            "the profile is {extent:.0} mm large, and wheels and rails are at most {LARGEST}: check its unit"
        ));
    }
    Ok(MarkedCurve::new(profile))
}

/// Returns x of the flange back in the axes of a file or a drawing: 0 if the flange's tip shows that it is there and no back contradicts,
/// otherwise the back itself; and how it was found.
pub(super) fn own_back(curve: &MarkedCurve) -> Result<Back, String> {
    let tip = curve.highest(-1.0).map_or(f64::NAN, |tip| tip.x);
    let found = back_of(curve);
    if !is_from_back(tip) {
        return found;
    }
    let how = "the file's x = 0".to_owned();
    let Ok(found) = found else {
        let doubt = Some("no flange back shows that it stands at the file's x = 0".to_owned());
        return Ok(Back { x: 0.0, how, reach: from_tip(tip), doubt });
    };
    // A back that was not measured until it is upright stands so much farther left.
    let off = (found.x - found.reach).abs();
    let doubt = |kept: &str| {
        let found = if found.reach > 0.0 { "where the points end" } else { "the flange back" };
        (off > MOST_OFF).then(|| format!("the file's x = 0 lies {off:.2} mm beside {found}: X = 0 is {kept}"))
    };
    if off > ELSEWHERE && (found.x < 0.0 || found.doubt.is_none()) {
        let doubt = doubt(&found.how);
        return Ok(Back { doubt, ..found });
    }
    let doubt = doubt(&how);
    Ok(Back { x: 0.0, how, reach: off + 0.5 * found.reach, doubt })
}

/// Returns how far \[mm\] the flange back may stand from X = 0 if nothing but the tip, at this distance from it, tells.
pub(super) fn from_tip(tip: f64) -> f64 {
    (tip - TIP).abs() + TIPS_DIFFER
}

/// Tells whether a flange's tip at this distance \[mm\] from x = 0 shows that x = 0 is the flange back.
pub(super) fn is_from_back(tip: f64) -> bool {
    tip > TIP_FROM_BACK.low && tip < TIP_FROM_BACK.high
}

/// Returns x of the flange back: of a line through the lowest 10 mm where it is upright, at their middle; otherwise of the leftmost
/// point, if the profile is inclined by 75° or more there.
pub(super) fn back_of(curve: &MarkedCurve) -> Result<Back, String> {
    let none = |why: String| format!("no flange back: {why}");
    let tip = curve.highest(-1.0).ok_or_else(|| none("no points".into()))?;
    let back = curve.up_to(tip.mark);
    let upright: Vec<Station> =
        back.marks.iter().map(|mark| mark.station).filter(|at| at.sin <= -STRAIGHT).collect();
    let low = upright.iter().map(|at| at.z).fold(f64::INFINITY, f64::min);
    let line: Vec<&Station> = upright.iter().filter(|at| at.z <= low + BACK_LENGTH).collect();
    let height = line.iter().map(|at| at.z - low).fold(0.0, f64::max);
    if height >= LEAST_BACK {
        // Marks are at equal distances nearly, so that the mean is the line at its middle.
        let x = line.iter().map(|at| at.x).sum::<f64>() / line.len() as f64;
        let how = format!("the flange back at x = {x:.3}, a line over {height:.1} mm");
        return Ok(Back { x, how, reach: 0.0, doubt: None });
    }
    let leftmost = back.marks.iter().map(|mark| mark.station).min_by(|a, b| a.x.total_cmp(&b.x));
    match leftmost {
        Some(at) if at.sin <= -STEEP => {
            let angle = at.angle().to_degrees().abs();
            let doubt = (at.sin > -UPRIGHT).then(|| {
                format!("X = 0 is the leftmost point, inclined by {angle:.0}°: the flange back may lie farther left")
            });
            let reach = BACK_RADIUS * (1.0 + at.sin);
            Ok(Back { x: at.x, how: format!("the leftmost point, x = {:.3}", at.x), reach, doubt })
        }
        Some(at) => Err(none(format!(
            "the profile begins at x = {:.3} mm, inclined by {:.0}°, less than 75°",
            at.x,
            at.angle().to_degrees().abs()
        ))),
        None => Err(none("no points".into())),
    }
}

/// Returns x of a wheel's flange back \[mm\] where its profile shows it without a doubt: as a line, or as an end that stands upright to
/// 15°, which lies within 1 mm of the back.
#[cfg(feature = "files")]
pub fn flange_back(wheel: &Profile) -> Option<f64> {
    back_of(&sized(wheel).ok()?).ok().map(|back| back.x)
}

/// Returns the running head of a rail, right of its last groove, and the index of the groove's bottom; `None` without a groove.
pub(super) fn running_head(curve: &MarkedCurve) -> (MarkedCurve, Option<usize>) {
    let heights: Vec<f64> = curve.marks.iter().map(|mark| mark.station.z).collect();
    let groove = last_groove(&heights);
    (curve.from(groove.unwrap_or(0)), groove)
}
