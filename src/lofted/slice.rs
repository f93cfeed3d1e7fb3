//! The slices of a list.

use crate::profile::Profile;

/// Largest distance of the points across a slice \[mm\]: a spline through them is then off by 0.01 nm on a 13 mm radius, and by up to
/// 0.15 µm beside the joint of that radius to a crown.
pub const SPACING: f64 = 0.25;

/// One slice of a list.
#[derive(Debug, Clone, PartialEq)]
pub struct LoftSlice {
    /// Position along the track \[mm\], or angle around a wheel \[rad\].
    pub at: f64,
    /// Its name in messages.
    pub name: String,
    /// Its curve, in the axes that all slices share.
    pub profile: Profile,
    /// Arc lengths of the features from the left end of the curve \[mm\], negative for one that the slice does not have; a last one
    /// beyond the curve means its end. Empty for a list without features.
    pub features: Vec<f64>,
    /// Length \[mm\] of the polygon along which the features are given; `None` where that is the curve itself.
    pub measured_along: Option<f64>,
}
