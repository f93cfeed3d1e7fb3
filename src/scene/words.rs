//! Advice for words that are not known.

/// Gives advice for a word that is not known: the nearest one that is, where one is near.
pub fn perhaps(found: &str, known: &[&str]) -> String {
    nearest(found, known).unwrap_or_else(|| "correct or remove it".into())
}

/// Gives the nearest known word as advice, in upper or lower case; `None` where none is near.
pub(super) fn nearest(found: &str, known: &[&str]) -> Option<String> {
    /// Likeness from which two words look like one misspelt: `yaw` and `yaw_rad` have 0.87, words of a letter or two in
    /// common 0.6.
    const ALIKE: f64 = 0.7;
    let lower = found.to_lowercase();
    let likeness = |known: &str| strsim::jaro_winkler(&known.to_lowercase(), &lower);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    nearest
        .filter(|nearest| likeness(nearest) >= ALIKE)
        .map(|nearest| format!("perhaps `{nearest}` is meant"))
}
