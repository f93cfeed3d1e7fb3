//! Limits of quantities: which rows break them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::measures::Measures;
use super::quantity::Quantity;
use crate::error::{Error, Result};

/// Least and largest values of quantities by their keys.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Limits(BTreeMap<String, Limit>);

/// The limits of a quantity, in its unit. A value that is equal to a limit keeps it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// Least value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Largest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

impl Limits {
    /// Makes limits from those of quantities by their keys.
    ///
    /// # Errors
    /// A key that is no quantity; limits that are not finite, that contradict each other, or none at all.
    pub fn new(limits: BTreeMap<String, Limit>) -> Result<Self> {
        let keys: Vec<&str> = Quantity::ALL.iter().map(|quantity| quantity.key()).collect();
        for (key, Limit { min, max }) in &limits {
            if !keys.contains(&key.as_str()) {
                let expected = format!("one of {}", keys.join(", "));
                return Err(Error::new(key, "no quantity", expected, "correct or remove it"));
            }
            let given = [*min, *max].into_iter().flatten();
            if given.clone().count() == 0 || given.clone().any(|value| !value.is_finite()) {
                let expected = "`min`, `max` or both, finite numbers";
                return Err(Error::new(key, "no limit", expected, "give a number"));
            }
            if let (Some(min), Some(max)) = (min, max)
                && min > max
            {
                let found = format!("min {min} above max {max}");
                return Err(Error::new(key, found, "min up to max", "swap them"));
            }
        }
        Ok(Self(limits))
    }

    /// Returns the limits that a profile breaks. A quantity of its body that cannot be had breaks its limit.
    pub(super) fn broken(&self, measures: &Measures) -> Vec<String> {
        let mut broken = Vec::new();
        for quantity in Quantity::ALL.into_iter().filter(|quantity| quantity.side() == measures.side) {
            let key = quantity.key();
            let Some(Limit { min, max }) = self.0.get(key) else { continue };
            let Some(value) = measures.value(quantity) else {
                broken.push(format!("{key} not measured"));
                continue;
            };
            if let Some(min) = min.filter(|min| value < *min) {
                broken.push(format!("{key} {value:.3} below {min}"));
            }
            if let Some(max) = max.filter(|max| value > *max) {
                broken.push(format!("{key} {value:.3} above {max}"));
            }
        }
        broken
    }
}
