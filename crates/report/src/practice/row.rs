//! The result of a practice case.

/// The result of a case, one row of the report.
#[derive(Debug, Clone, PartialEq)]
pub struct PracticeRow {
    /// Name of the case.
    pub name: String,
    /// Reason for the case, with its profiles and position.
    pub what: String,
    /// Largest difference \[mm\] of a height, gap or separation from brute force.
    pub figure: f64,
    /// Number of contacts and near misses that were compared.
    pub contacts: usize,
    /// Largest relative difference of a patch's area from the flood fill; NaN if no patch was asked for.
    pub area: f64,
    /// The disagreements; empty if there are none.
    pub failures: Vec<String>,
}
