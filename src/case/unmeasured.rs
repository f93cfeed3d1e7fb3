//! Bridges of measured profiles: over gaps and points off the curve there is no surface, so that a contact there is none that can be trusted.

use crate::lofted::LoftedBody;
use crate::patch::{Component, Patch};
use crate::placement::{Body, Pair, Placement};
use crate::profile::{Profile, Segment, Side};
use crate::search::Contact;

/// Distance \[mm\] from a bridge's box within which a point lies in it: searches put it on a profile to some roundings.
const ROUNDING: f64 = 1e-6;

/// A bridge in a contact.
#[derive(Debug, Clone, PartialEq)]
pub struct BridgeInContact {
    /// The body whose profile has it.
    pub side: Side,
    /// The profile's name: that of its file.
    pub name: String,
    /// Its rows in the file; empty where they are not known.
    pub rows: String,
    /// Abscissae of its ends on the profile \[mm\].
    pub x: [f64; 2],
}

/// The boxes around the bridges of both profiles of a pair, none of a body that varies. A bridge leaves its chord by less than its length.
#[derive(Debug, Clone)]
pub(super) struct Bridges([Vec<[[f64; 2]; 2]>; 2]);

impl Bridges {
    /// Lists the bridges of a pair; `varying` is its body that is no swept profile.
    pub fn new(pair: &Pair, varying: Option<&LoftedBody>) -> Self {
        let boxes = |side: Side, profile: &Profile| {
            let swept = varying.is_none_or(|body| body.side() != side);
            let own = profile.segments().iter().filter(|segment| swept && segment.is_gap());
            own.map(|segment| {
                let (a, b) = (segment.start(), segment.end());
                let length = (b.x - a.x).hypot(b.z - a.z);
                [[a.x.min(b.x), a.z.min(b.z) - length], [a.x.max(b.x), a.z.max(b.z) + length]]
            })
            .collect()
        };
        Self([boxes(Side::Rail, pair.rail()), boxes(Side::Wheel, pair.wheel())])
    }

    /// Tells whether a body touches on a bridge.
    pub fn hold(&self, contact: &Contact) -> bool {
        let places = [[contact.rail_x, contact.rail_z], [contact.wheel_x, contact.wheel_z]];
        places.iter().zip(&self.0).any(|(at, boxes)| {
            let inside = |[low, high]: &[[f64; 2]; 2]| {
                (0..2).all(|k| (low[k] - ROUNDING..=high[k] + ROUNDING).contains(&at[k]))
            };
            boxes.iter().any(inside)
        })
    }
}

/// Finds a bridge at C, or in any part of the patch: pressures of one part are those of all.
pub(super) fn bridge_in_contact(placement: &Placement, patch: Option<&Patch>) -> Option<BridgeInContact> {
    let parts: &[Component] = patch.map_or(&[], |patch| &patch.components);
    let in_contact = |body: &Body, segment: &Segment| {
        let ends = [segment.start(), segment.end()];
        let seen = ends.map(|end| body.contact_frame().inverse_transform_point(&[end.x, end.z].into()));
        let middle = nalgebra::center(&seen[0], &seen[1]);
        let facing = (body.section().height(middle.x) - middle.y).abs() <= (seen[1] - seen[0]).norm();
        let [low, high] = [seen[0].x.min(seen[1].x), seen[0].x.max(seen[1].x)];
        let at_c = placement.is_at_contact() && low <= ROUNDING && high >= -ROUNDING;
        facing && (at_c || parts.iter().any(|part| part.xi.low < high && part.xi.high > low))
    };
    let bodies = [(Side::Rail, placement.rail()), (Side::Wheel, placement.wheel())];
    let swept =
        bodies.into_iter().filter(|(side, _)| placement.lofted().is_none_or(|body| body.side() != *side));
    let mut all =
        swept.flat_map(|(side, body)| body.profile().segments().iter().map(move |own| (side, body, own)));
    let (side, body, segment) =
        all.find(|(_, body, segment)| segment.is_gap() && in_contact(body, segment))?;
    Some(BridgeInContact {
        side,
        name: body.profile().name.clone(),
        rows: segment.gap().unwrap_or_default().into(),
        x: [segment.start().x, segment.end().x],
    })
}
