//! How many random scenes a test runs.

/// Number of random scenes of a kind: 20, or WHEELRAIL_CAMPAIGN.
pub fn scenes() -> u64 {
    std::env::var("WHEELRAIL_CAMPAIGN").ok().and_then(|n| n.parse().ok()).unwrap_or(20)
}
