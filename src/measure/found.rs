//! The values of a profile, and why others are missing.

use super::quantity::Quantity;

/// Values in the order of [`Quantity::ALL`], and why others cannot be had.
#[derive(Debug, Clone, Default)]
pub(super) struct FoundValues {
    values: [Option<f64>; Quantity::ALL.len()],
    /// Why, and which quantities.
    missing: Vec<(String, Vec<Quantity>)>,
}

impl FoundValues {
    pub fn put(&mut self, quantity: Quantity, value: Result<f64, String>) {
        let why = match value {
            Ok(value) if value.is_finite() => {
                self.values[quantity as usize] = Some(value);
                return;
            }
            Ok(_) => "no finite value".into(),
            Err(why) => why,
        };
        match self.missing.iter_mut().find(|(own, _)| *own == why) {
            Some((_, quantities)) => quantities.push(quantity),
            None => self.missing.push((why, vec![quantity])),
        }
    }

    /// Notes that quantities cannot be had.
    pub fn lack(&mut self, quantities: &[Quantity], why: &str) {
        quantities.iter().for_each(|quantity| self.put(*quantity, Err(why.to_owned())));
    }

    /// Takes values back that cannot be relied on.
    pub fn withdraw(&mut self, quantities: &[Quantity], why: &str) {
        quantities.iter().for_each(|quantity| self.values[*quantity as usize] = None);
        self.lack(quantities, why);
    }

    /// Takes over what another search has found.
    pub fn with(mut self, other: Self) -> Self {
        for quantity in Quantity::ALL {
            if let Some(value) = other.values[quantity as usize] {
                self.put(quantity, Ok(value));
            }
        }
        for (why, quantities) in other.missing {
            self.lack(&quantities, &why);
        }
        self
    }

    pub fn values(&self) -> [Option<f64>; Quantity::ALL.len()] {
        self.values
    }

    /// Returns why quantities are missing, a sentence for each reason.
    pub fn findings(&self) -> impl Iterator<Item = String> {
        self.missing.iter().map(|(why, quantities)| {
            let keys: Vec<&str> = quantities.iter().map(|quantity| quantity.key()).collect();
            format!("{why}: no {}", keys.join(", "))
        })
    }
}
