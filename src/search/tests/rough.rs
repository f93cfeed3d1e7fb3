//! Tests the search on rough pairs against an oracle that uses no tree, no tangents and no outlines: noise,
//! pits, flats, lips, vertical sides, copies that touch in many points; yawed and rolled.

mod oracle;
mod pairs;

use oracle::Oracle;
use pairs::random_pair;
use rayon::prelude::*;

use super::*;

/// Number of pairs in every run; `WHEELRAIL_ROUGH_PAIRS` sets another number.
const PAIRS: u64 = 2000;

/// First seed.
const SEED: u64 = 0x2024_0001;

/// Largest gap of the near misses that are compared \[mm\].
const WITHIN: f64 = 0.05;

/// Compares one pair; returns the number of its contacts and near misses, or the differences.
fn compare(seed: u64) -> Result<std::result::Result<usize, String>> {
    const RADIUS: f64 = 460.0;
    let pair = random_pair(seed)?;
    let profiles = ProfilePair::new(&Pair::new(pair.rail.clone(), pair.wheel.clone(), RADIUS)?)?;
    let [offset, yaw, roll] = pair.pose;
    let mut search = profiles.search();
    let touch = search.touch(&Pose::new(offset, yaw, roll)?, &Selection { within: WITHIN, apart: 0.0 });
    // At least four samples of a span, see `samples`.
    let step = (pair.spacing / 5.0).clamp(0.015, 0.06);
    let oracle = Oracle::new(&pair, RADIUS, step);
    let minima = oracle.minima(step);
    let name = format!("seed {seed}, pose {:?}", pair.pose);
    let lowest = minima.iter().map(|m| m[0]).fold(f64::INFINITY, f64::min);
    let Ok(touch) = touch else {
        let limit = profiles.bodies.highest(&Attitude::new(offset, yaw, roll, RADIUS));
        let differ = format!("{name}: no touch, but {minima:?}");
        return Ok(if lowest < limit { Err(differ) } else { Ok(0) });
    };
    let first = touch.contacts[0];
    if (lowest + touch.height).abs().is_nan() || (lowest + touch.height).abs() > 1e-8 {
        return Ok(Err(format!(
            "{name}: height {}, oracle {}, {first:?}, {minima:?}",
            touch.height, -lowest
        )));
    }
    for [gap, x] in &minima {
        let gap = gap - lowest;
        // A gap as flat as rounding along x has its place anywhere there; on a steep end zooming stops at
        // 1e-9 mm along x.
        let near =
            |c: &Contact| (c.gap - gap).abs() < 1e-7 && (c.rail_x - x).abs() < 1e-4 + 4e-4 * flatness(c);
        if gap < WITHIN - 1e-6 && !touch.contacts.iter().any(near) {
            return Ok(Err(format!("{name}: nothing at {x} with {gap} among {:?}", touch.contacts)));
        }
    }
    for contact in touch.contacts {
        // A point of both surfaces, at one abscissa, with the gap that it claims. An end may be a rounding
        // outside, on a steep end some more, and a step has two heights.
        let beside = [-1e-9, 0.0, 1e-9].map(|h| contact.rail_x + h);
        let here =
            beside.map(|x| oracle.lowest(x, oracle.near(x), 12)[0]).into_iter().fold(f64::INFINITY, f64::min);
        let lower = here - (contact.gap - touch.height);
        let rail = beside.map(|x| oracle.rail.height(x));
        let on_rail = rail.iter().any(|z| (z - contact.rail_z).abs() < 1e-7);
        if lower > 1e-7 || !on_rail && contact.contact_angle.abs() < 1.3 {
            return Ok(Err(format!("{name}: {lower:e} above, rail at {rail:?}: {contact:?}")));
        }
    }
    Ok(Ok(touch.contacts.len()))
}

/// Returns the distance along x at which a gap has changed by 1e-8 mm, √(2e-8/Δκ) but at most 1 mm, in units
/// of 1e-4 mm.
fn flatness(contact: &Contact) -> f64 {
    let rounder = (contact.wheel_curvature - contact.rail_curvature).max(1e-9);
    (2e-8 / rounder).sqrt().min(1.0) * 1e4
}

#[test]
fn rough_pairs_agree_with_lowered_rings_on_every_contact_and_near_miss() -> Result<()> {
    let pairs = std::env::var("WHEELRAIL_ROUGH_PAIRS").ok().and_then(|n| n.parse().ok()).unwrap_or(PAIRS);
    let compared: Vec<_> = (SEED..SEED + pairs).into_par_iter().map(compare).collect::<Result<_>>()?;
    let (mut touching, mut contacts, mut differ) = (0, 0, Vec::new());
    for outcome in compared {
        match outcome {
            Ok(count) => {
                touching += u64::from(count > 0);
                contacts += count;
            }
            Err(what) => {
                println!("{what}");
                differ.push(what);
            }
        }
    }
    println!("seeds from {SEED}: {pairs} pairs, {touching} touch, {contacts} contacts and near misses");
    assert!(differ.is_empty(), "{} of {pairs} differ: {}", differ.len(), differ.join("\n"));
    assert!(2 * touching > pairs, "{touching} of {pairs} touch");
    Ok(())
}
