//! How many random scenes a test runs.

use std::ops::Range;

/// Number of random scenes of a kind: 20, or WHEELRAIL_CAMPAIGN.
pub fn scenes() -> u64 {
    let seeds = seeds();
    seeds.end - seeds.start
}

/// Seeds of the random scenes of a kind whose scenes do not follow from each other: WHEELRAIL_CAMPAIGN=2000..2500 is a portion of a campaign.
pub fn seeds() -> Range<u64> {
    let asked = std::env::var("WHEELRAIL_CAMPAIGN").unwrap_or_default();
    let (from, to) = asked.split_once("..").unwrap_or(("0", &asked));
    let ends = from.parse().ok().zip(to.parse().ok()).filter(|(from, to)| from <= to);
    ends.map_or(0..20, |(from, to)| from..to)
}
