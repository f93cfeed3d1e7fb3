//! Sections by planes across the track through a body that varies.

use crate::lofted::{Loft, LoftStrip};

/// Most steps to the place around an axle at which a plane cuts a circle. As the radius varies little around it, each gains two digits.
const STEPS: usize = 8;

/// Step \[rad\] at which the place is found: it moves a point of a wheel by less than 1e-9 mm.
const SETTLED: f64 = 1e-12;

/// Distance \[mm\] below which the ends of two parts are one point: rounding.
const ONE_POINT: f64 = 1e-9;

/// The section of a body that varies, in pieces \[x, z\] \[mm\], each from left to right in the profile axes of its side.
#[derive(Debug, Clone, PartialEq)]
pub enum Cut {
    /// Of a rail: what the plane cuts.
    Rail(Vec<Vec<[f64; 2]>>),
    /// Of a wheel: the profile of a wheel of revolution with the same cut. A point of it is R − z from the axle.
    Wheel(Vec<Vec<[f64; 2]>>),
}

/// Cuts a rail by the plane at y \[mm\] of its list.
pub(super) fn cut_rail(loft: &Loft, y: f64) -> Cut {
    Cut::Rail(pieces(loft, |line| line(y)))
}

/// Cuts a wheel of this nominal rolling radius \[mm\], whose lowest part is at `lowest` \[mm\] of its list, by the plane across the track
/// which lies `ahead` \[mm\] of its profile's origin; `yaw` \[rad\] is that of the side.
pub(super) fn cut_wheel(loft: &Loft, radius: f64, lowest: f64, yaw: f64, ahead: f64) -> Cut {
    let (sin, cos) = yaw.sin_cos();
    Cut::Wheel(pieces(loft, |line| {
        let mut angle = (ahead / radius).asin();
        for _ in 1..STEPS {
            let [x, height] = line(lowest + radius * angle)?;
            let next = ((ahead - x * sin) / (cos * (radius + height))).asin();
            let step = std::mem::replace(&mut angle, next) - next;
            if step.abs() <= SETTLED {
                break;
            }
        }
        let [x, height] = line(lowest + radius * angle)?;
        Some([x, -height])
    }))
}

/// The curve along y of a share of a part's arc length: its point \[x, z\] at y \[mm\]; `None` where the part is interrupted.
type PartCurve<'a> = &'a dyn Fn(f64) -> Option<[f64; 2]>;

/// Lists one point of every curve of equal share, part by part. A curve without a point ends a piece, and parts that meet are one piece.
fn pieces(loft: &Loft, point: impl Fn(PartCurve<'_>) -> Option<[f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
    let parts = loft.strips.iter().map(|strip| strip.part + 1).max().unwrap_or(0);
    for part in 0..parts {
        let strips: Vec<&LoftStrip> = loft.strips.iter().filter(|strip| strip.part == part).collect();
        let cells = strips.iter().map(|strip| strip.cells()).max().unwrap_or(0);
        let mut open = false;
        for node in 0..=cells {
            let share = node as f64 / cells as f64;
            let line = |y: f64| {
                let strip = strips.iter().find(|strip| strip.holds(y))?;
                Some(strip.point(share * strip.cells() as f64, y).at)
            };
            let Some(at) = point(&line) else {
                open = false;
                continue;
            };
            let end = pieces.last().and_then(|piece| piece.last());
            let meets = end.is_some_and(|end| (end[0] - at[0]).hypot(end[1] - at[1]) <= ONE_POINT);
            match pieces.last_mut().filter(|_| open || meets) {
                Some(piece) => piece.push(at),
                None => pieces.push(vec![at]),
            }
            open = true;
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}
