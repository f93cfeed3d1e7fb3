//! Makes outlines of bodies as dense chains of points \[mm\], from left to right: drawn, worn, measured.

use super::instrument::Instrument;
use wheelrail::internal::Random;
use wheelrail::profile::{Profile, Side, trace};

/// Distance of an outline's points \[mm\]: its chords are off a 3 mm radius by 2e-5 mm, far less than any
/// noise.
const STEP: f64 = 0.02;
/// Wavelength \[mm\] below which an instrument's noise is constant: the probe's wheel or the laser's line is
/// wider. Independent noise every 0.05 mm would turn the path back on itself, which no instrument's file
/// does.
const CORRELATION: f64 = 0.25;
/// Largest distance of a point from its place, to either side, as a share of the spacing.
const JITTER: f64 = 0.2;
/// Share of the outline at each end that has no pits and flats.
const CLEAR_END: f64 = 0.05;

/// A point of an outline with its unit tangent.
#[derive(Debug, Clone, Copy)]
pub(super) struct OutlinePoint {
    /// Arc length from the left end \[mm\].
    pub s: f64,
    pub x: f64,
    pub z: f64,
    cos: f64,
    sin: f64,
}

/// Returns a polygon of \[x, z, radius\] \[mm\] with its corners rounded; a radius of 0 leaves a corner
/// sharp.
pub(super) fn rounded(corners: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let mut out = Vec::new();
    for (k, &[x, z, radius]) in corners.iter().enumerate() {
        let neighbours = k.checked_sub(1).and_then(|before| Some((corners[before], *corners.get(k + 1)?)));
        match neighbours {
            Some((before, after)) if radius > 0.0 => {
                let towards = |[a, b, _]: [f64; 3]| {
                    let length = (a - x).hypot(b - z);
                    [(a - x) / length, (b - z) / length]
                };
                let ([ux, uz], [vx, vz]) = (towards(before), towards(after));
                let turn = (vx * uz - vz * ux).atan2(-(ux * vx + uz * vz));
                let tangent = radius * (0.5 * turn).tan().abs();
                let start = [x + tangent * ux, z + tangent * uz];
                let steps = (radius * turn.abs() / STEP).ceil().max(1.0);
                // The chord from the start subtends half of the angle turned through.
                out.extend((0..=steps as usize).map(|k| {
                    let half = 0.5 * turn * k as f64 / steps;
                    let chord = 2.0 * radius * half.abs().sin();
                    let (sin, cos) = half.sin_cos();
                    [start[0] - chord * (ux * cos - uz * sin), start[1] - chord * (uz * cos + ux * sin)]
                }));
            }
            _ => out.push([x, z]),
        }
    }
    out
}

/// Returns the points of a drawn profile.
pub(super) fn drawn(profile: &Profile) -> Vec<[f64; 2]> {
    trace(profile, STEP).iter().map(|mark| [mark.station.x, mark.station.z]).collect()
}

/// Returns places every [`STEP`] along a chain of points.
pub(super) fn places(points: &[[f64; 2]]) -> Vec<OutlinePoint> {
    let mut out = Vec::new();
    let (mut s, mut next) = (0.0, 0.0);
    for pair in points.windows(2) {
        let [[x0, z0], [x1, z1]] = [pair[0], pair[1]];
        let length = (x1 - x0).hypot(z1 - z0);
        if length == 0.0 {
            continue;
        }
        let (cos, sin) = ((x1 - x0) / length, (z1 - z0) / length);
        while next <= s + length {
            let along = next - s;
            out.push(OutlinePoint { s: next, x: x0 + along * cos, z: z0 + along * sin, cos, sin });
            next += STEP;
        }
        s += length;
    }
    out
}

/// Returns the outline after a depth \[mm\] has been worn off at every place, into the material across the
/// outline; a negative depth is material that has flowed outwards.
pub(super) fn worn(points: &[[f64; 2]], side: Side, depth: impl Fn(&OutlinePoint) -> f64) -> Vec<[f64; 2]> {
    let inwards = match side {
        Side::Rail => -1.0,
        Side::Wheel => 1.0,
    };
    places(points)
        .iter()
        .map(|at| {
            let across = inwards * depth(at);
            [at.x - across * at.sin, at.z + across * at.cos]
        })
        .collect()
}

/// Returns the points that an instrument records along an outline.
pub(super) fn recorded(outline: &[[f64; 2]], side: Side, instrument: &Instrument) -> Vec<[f64; 2]> {
    let mut random = Random::new(instrument.seed);
    let damaged =
        flattened(&pitted(outline, side, instrument.pits, &mut random), instrument.flats, &mut random);
    let places = places(&damaged);
    let whole = places.last().map_or(0.0, |last| last.s);
    let noise: Vec<f64> =
        (0..(whole / CORRELATION) as usize + 3).map(|_| 1e-3 * instrument.noise * random.normal()).collect();
    let mut out = Vec::new();
    let mut base = 0.0;
    while base <= whole {
        let jitter = JITTER * instrument.spacing * random.between(-1.0, 1.0);
        let index = ((base + jitter).max(0.0) / STEP) as usize;
        if let Some(at) = places.get(index) {
            let cell = at.s / CORRELATION;
            let (k, share) = (cell as usize, cell.fract());
            let off = noise[k] + share * (noise[k + 1] - noise[k]);
            out.push([at.x - off * at.sin, at.z + off * at.cos]);
        }
        base += instrument.spacing;
    }
    out
}

/// Returns the outline with dents 0.05–0.3 mm deep and 1–5 mm wide.
fn pitted(outline: &[[f64; 2]], side: Side, count: usize, random: &mut Random) -> Vec<[f64; 2]> {
    let whole = places(outline).last().map_or(0.0, |last| last.s);
    let pits: Vec<[f64; 3]> = (0..count)
        .map(|_| {
            let at = whole * random.between(CLEAR_END, 1.0 - CLEAR_END);
            [at, random.between(0.5, 2.5), random.between(0.05, 0.3)]
        })
        .collect();
    let dent = |s: f64, &[at, half, depth]: &[f64; 3]| {
        let share = (s - at).abs() / half;
        if share < 1.0 { depth * (std::f64::consts::FRAC_PI_2 * share).cos().powi(2) } else { 0.0 }
    };
    worn(outline, side, |place| pits.iter().map(|pit| dent(place.s, pit)).sum())
}

/// Returns the outline with stretches of 4–12 mm replaced by their chords.
fn flattened(outline: &[[f64; 2]], count: usize, random: &mut Random) -> Vec<[f64; 2]> {
    let mut places = places(outline);
    let n = places.len() as f64;
    for _ in 0..count {
        let from = (n * random.between(CLEAR_END, 1.0 - CLEAR_END)) as usize;
        let to = (from + (random.between(4.0, 12.0) / STEP) as usize).min(places.len().saturating_sub(1));
        let Some((&a, &b)) = places.get(from).zip(places.get(to)) else { continue };
        for (k, place) in places[from..=to].iter_mut().enumerate() {
            let share = k as f64 / (to - from).max(1) as f64;
            (place.x, place.z) = (a.x + share * (b.x - a.x), a.z + share * (b.z - a.z));
        }
    }
    places.iter().map(|place| [place.x, place.z]).collect()
}
