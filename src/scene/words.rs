//! Finds the word that a misspelt word may mean.

/// Returns advice for an unknown word: the most similar known word, or no advice if none is similar.
pub fn perhaps(found: &str, known: &[&str]) -> String {
    nearest(found, known).unwrap_or_else(|| "correct or remove it".into())
}

/// Returns the most similar known word as advice; upper and lower case are the same. Returns `None` if none is similar.
pub(super) fn nearest(found: &str, known: &[&str]) -> Option<String> {
    /// Least similarity of two words of which one may be a misspelling: `yaw` and `yaw_rad` have 0.87; words with a letter
    /// or two in common have 0.6.
    const ALIKE: f64 = 0.7;
    let lower = found.to_lowercase();
    let likeness = |known: &str| strsim::jaro_winkler(&known.to_lowercase(), &lower);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    nearest
        .filter(|nearest| likeness(nearest) >= ALIKE)
        .map(|nearest| format!("perhaps `{nearest}` is meant"))
}
