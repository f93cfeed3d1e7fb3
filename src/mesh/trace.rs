//! A profile as a polygon through its contact point, within a chordal tolerance. It follows the profile's own parameters,
//! so that walls and overhangs, where ζ is no function of ξ, are traced too.

use nalgebra::{Point2, Vector2};

use crate::error::{Error, Result};
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::placement::Body;
use crate::profile::{Arc, Polynomial, Segment, Shape, Station};

/// Most points of a polygon. 1e5 points on a 100 mm profile are a micrometre apart; more can only be a mistake.
const MOST_POINTS: usize = 100_000;

/// Intervals of a segment in which the contact point is sought. A segment that faces the other body passes its ξ once, a
/// wavy polynomial a few times.
const SEARCHED_INTERVALS: usize = 64;

/// Most halvings of a polynomial's parameter. With all of them it would have far more than [`MOST_POINTS`].
const DEEPEST: u32 = 20;

/// Returns stations in profile axes, in the order of the chain: from C in both directions until ξ leaves the interval `xi`
/// of the contact frame, which is widened to hold C. C is one of them; where the frame's origin is off the profile, the profile's point over
/// it takes its place. The chord between two neighbours is within `tolerance` \[mm\] of the profile.
///
/// # Errors
/// More than 10⁵ points.
pub(super) fn trace(body: &Body, xi: Interval, tolerance: f64) -> Result<Vec<Station>> {
    let tracer = Tracer { body, tolerance };
    let contact = tracer.contact_share();
    let mut stations = Vec::new();
    if xi.low < 0.0 {
        stations.extend(tracer.walk(contact, xi.low, false)?.into_iter().rev());
    }
    stations.push(tracer.first(contact));
    if xi.high > 0.0 {
        stations.extend(tracer.walk(contact, xi.high, true)?);
    }
    Ok(stations)
}

struct Tracer<'a> {
    body: &'a Body,
    tolerance: f64,
}

impl Tracer<'_> {
    fn segment(&self, index: usize) -> &Segment {
        &self.body.profile().segments()[index]
    }

    /// Returns ξ of a station \[mm\].
    fn xi(&self, station: &Station) -> f64 {
        station.seen_from(&self.body.section.frame).x
    }

    /// Returns the share of the contact segment at which C lies: of all places with ξ = 0 the one nearest to ζ = 0.
    fn contact_share(&self) -> f64 {
        let segment = self.segment(self.body.point.segment);
        let xi = |share: f64| self.xi(&at(segment, share));
        let step = |k: usize| k as f64 / SEARCHED_INTERVALS as f64;
        let roots = (0..SEARCHED_INTERVALS).filter_map(|k| bracketed(xi, step(k), step(k + 1)));
        let height = |share: f64| at(segment, share).seen_from(&self.body.section.frame).z.abs();
        let nearest = roots.min_by(|a, b| height(*a).total_cmp(&height(*b)));
        // Without a root C is an end of the segment, and rounding has moved it off the segment.
        nearest.unwrap_or(if xi(0.0).abs() <= xi(1.0).abs() { 0.0 } else { 1.0 })
    }

    /// Returns C, or the point of the profile at this share of the contact segment if C is farther than the tolerance from it.
    fn first(&self, contact: f64) -> Station {
        let (own, here) = (self.body.point.station, at(self.segment(self.body.point.segment), contact));
        if (point(&here) - point(&own)).norm() > self.tolerance { here } else { own }
    }

    /// Returns the stations beyond C, without C, until ξ passes `limit` or the chain ends.
    fn walk(&self, contact: f64, limit: f64, forward: bool) -> Result<Vec<Station>> {
        let (index, n) = (self.body.point.segment, self.body.profile().segments().len());
        let order: Vec<usize> = if forward { (index..n).collect() } else { (0..=index).rev().collect() };
        let mut stations: Vec<Station> = Vec::new();
        for k in order {
            let far = if forward { 1.0 } else { 0.0 };
            let from = if k == index { contact } else { 1.0 - far };
            let segment = self.segment(k);
            let near = stations.last().copied().unwrap_or_else(|| self.first(contact));
            let begin = at(segment, from);
            if (point(&begin) - point(&near)).norm() > self.tolerance {
                stations.push(begin);
            }
            let mut last = from;
            for share in self.subdivided(segment, from, far)? {
                let station = at(segment, share);
                if (self.xi(&station) > limit) == forward && self.xi(&station) != limit {
                    let beyond = |share: f64| self.xi(&at(segment, share)) - limit;
                    stations.extend(bracketed(beyond, last, share).map(|share| at(segment, share)));
                    return Ok(stations);
                }
                stations.push(station);
                last = share;
            }
            if stations.len() > MOST_POINTS {
                return Err(too_many(self.tolerance));
            }
        }
        Ok(stations)
    }

    /// Returns the shares after `from` up to `to` whose chords keep the tolerance. There are none if the two are equal.
    fn subdivided(&self, segment: &Segment, from: f64, to: f64) -> Result<Vec<f64>> {
        if from == to {
            return Ok(Vec::new());
        }
        let mut shares = Vec::new();
        match &segment.shape {
            Shape::Arc(arc) => {
                let turn = arc.turn().abs() * (to - from).abs();
                let n = (turn / arc_step(arc.radius.abs(), self.tolerance)).ceil().max(1.0);
                if n > MOST_POINTS as f64 {
                    return Err(too_many(self.tolerance));
                }
                shares.extend((1..n as usize).map(|k| from + (to - from) * k as f64 / n));
                shares.push(to);
            }
            Shape::Polynomial(polynomial) => self.halved(polynomial, from, to, DEEPEST, &mut shares)?,
        }
        Ok(shares)
    }

    fn halved(&self, p: &Polynomial, from: f64, to: f64, depth: u32, shares: &mut Vec<f64>) -> Result<()> {
        let inner = [0.25, 0.5, 0.75].map(|part| on_polynomial(p, from + (to - from) * part));
        let start = point(&on_polynomial(p, from));
        let chord: Vector2<f64> = point(&on_polynomial(p, to)) - start;
        let off = |s: &Station| (point(s) - start).perp(&chord).abs() > self.tolerance * chord.norm();
        if depth == 0 || !inner.iter().any(off) {
            shares.push(to);
            return Ok(());
        }
        if shares.len() > MOST_POINTS {
            return Err(too_many(self.tolerance));
        }
        let middle = from + (to - from) / 2.0;
        self.halved(p, from, middle, depth - 1, shares)?;
        self.halved(p, middle, to, depth - 1, shares)
    }
}

/// Returns the place (x, z) of a station \[mm\].
fn point(station: &Station) -> Point2<f64> {
    Point2::new(station.x, station.z)
}

fn too_many(tolerance: f64) -> Error {
    let found = format!("{tolerance} mm, for which a profile takes more than {MOST_POINTS} points");
    Error::new(
        "surface: tolerance",
        found,
        "a coarser one",
        "1e-3 mm draws a profile with some hundred points",
    )
}

/// Returns the angle Δ \[rad\] over which an arc of this radius departs from its chord by the tolerance: r (1 − cos(Δ/2)) =
/// t.
pub(super) fn arc_step(radius: f64, tolerance: f64) -> f64 {
    if radius.is_finite() { 4.0 * (tolerance / (2.0 * radius)).sqrt().min(1.0).asin() } else { f64::INFINITY }
}

/// Returns the station at a share of a segment: a share of the angle on an arc, of the length on a line, of the parameter
/// on a polynomial.
fn at(segment: &Segment, share: f64) -> Station {
    match &segment.shape {
        Shape::Arc(arc) => on_arc(arc, share),
        Shape::Polynomial(polynomial) => on_polynomial(polynomial, share),
    }
}

fn on_arc(arc: &Arc, share: f64) -> Station {
    let (start, end) = (arc.start, arc.end);
    if share == 1.0 {
        return end;
    }
    if !arc.radius.is_finite() {
        return Station {
            x: start.x + (end.x - start.x) * share,
            z: start.z + (end.z - start.z) * share,
            ..start
        };
    }
    let turn = arc.turn() * share;
    let (sin, cos) = (turn / 2.0).sin_cos();
    let chord = 2.0 * arc.radius * sin;
    let relative = Station { x: chord * cos, z: chord * sin, cos: turn.cos(), sin: turn.sin() };
    relative.placed_by(&start)
}

fn on_polynomial(polynomial: &Polynomial, share: f64) -> Station {
    let t = polynomial.t;
    polynomial.station(if share == 1.0 { t.high } else { t.at(share) })
}
