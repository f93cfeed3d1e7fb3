//! How many random scenes a test runs.

use std::ops::Range;

/// Number of random scenes of a kind: 20, or WHEELRAIL_CAMPAIGN.
pub fn scenes() -> u64 {
    let seeds = seeds();
    seeds.end - seeds.start
}

/// Seeds of the random scenes of a kind whose scenes do not follow from each other: WHEELRAIL_CAMPAIGN=2000..2500 is a portion of a campaign.
pub fn seeds() -> Range<u64> {
    let Ok(asked) = std::env::var("WHEELRAIL_CAMPAIGN") else { return 0..20 };
    let (from, to) = asked.split_once("..").unwrap_or(("0", &asked));
    let ends = from.parse().ok().zip(to.parse().ok()).filter(|(from, to)| from <= to);
    let (from, to) =
        ends.unwrap_or_else(|| panic!("WHEELRAIL_CAMPAIGN is {asked}: expected 2000 or 60..120"));
    from..to
}
