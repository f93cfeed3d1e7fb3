//! What is counted over a fleet: distributions, where wheels touch, the worst pairs, findings.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::listed::PairNumber;
use super::pair::{CELL, FleetRow, POSITIONS, STEP, numbers};
use super::part::FleetPart;
use crate::export::{FleetDistribution, FleetHeat};
use crate::files::file_name;

/// Pairs that have pages of their own.
const WORST: usize = 10;
/// Findings that the page shows.
const SHOWN: usize = 100;
/// Most bars of a distribution.
const BARS: usize = 60;

/// A quantity whose distribution is counted: the columns, heading, axis, and the cells' beginning, width \[unit\] and number. What lies beyond
/// counts in the outermost cells.
struct Counted {
    key: &'static str,
    columns: &'static [&'static str],
    title: &'static str,
    axis: &'static str,
    from: f64,
    width: f64,
    cells: usize,
}

const COUNTED: [Counted; 6] = [
    Counted {
        key: "conicity",
        columns: &["conicity"],
        title: "Equivalent conicity at 3 mm",
        axis: "tan γ [1]",
        from: 0.0,
        width: 0.002,
        cells: 750,
    },
    Counted {
        key: "nonlinearity_per_mm",
        columns: &["nonlinearity_per_mm"],
        title: "Nonlinearity: slope of the conicity from 2 to 4 mm",
        axis: "slope [1/mm]",
        from: -0.5,
        width: 0.001,
        cells: 1000,
    },
    Counted {
        key: "flange_height_mm",
        columns: &["left_flange_height_mm", "right_flange_height_mm"],
        title: "Flange height Sh",
        axis: "Sh [mm]",
        from: 10.0,
        width: 0.05,
        cells: 800,
    },
    Counted {
        key: "flange_thickness_mm",
        columns: &["left_flange_thickness_mm", "right_flange_thickness_mm"],
        title: "Flange thickness Sd",
        axis: "Sd [mm]",
        from: 10.0,
        width: 0.05,
        cells: 800,
    },
    Counted {
        key: "qr_mm",
        columns: &["left_qr_mm", "right_qr_mm"],
        title: "Flange gradient qR",
        axis: "qR [mm]",
        from: 0.0,
        width: 0.05,
        cells: 500,
    },
    Counted {
        key: "hollow_mm",
        columns: &["left_hollow_mm", "right_hollow_mm"],
        title: "Hollow wear",
        axis: "depth [mm]",
        from: 0.0,
        width: 0.02,
        cells: 500,
    },
];

/// How often which values occur.
#[derive(Debug, Clone, Default)]
struct Distribution {
    counts: Vec<u32>,
    least: Option<f64>,
    largest: Option<f64>,
}

/// A pair among the worst.
#[derive(Debug, Clone)]
pub(super) struct WorstPair {
    pub number: PairNumber,
    pub row: FleetRow,
    pub conicity: f64,
}

/// Counts over a fleet. Their size does not depend on the number of pairs.
#[derive(Debug, Clone, Default)]
pub(super) struct FleetTally {
    pub pairs: usize,
    pub with_conicity: usize,
    pub with_finding: usize,
    /// Pairs whose wheels touch.
    touching: usize,
    distributions: [Distribution; COUNTED.len()],
    touched: BTreeMap<(i32, i32), u64>,
    pub worst: Vec<WorstPair>,
    /// Wheelset, rails and finding of the first pairs that have one.
    pub findings: Vec<[String; 3]>,
}

impl FleetTally {
    /// Counts a part, whose pairs have these numbers.
    pub fn add(&mut self, part: &FleetPart, pairs: impl Iterator<Item = PairNumber>) {
        let names = numbers();
        let column = |name: &str| names.iter().position(|own| own == name);
        let columns =
            COUNTED.map(|counted| counted.columns.iter().filter_map(|name| column(name)).collect::<Vec<_>>());
        let band = column("right_rail_from_mm");
        for (row, number) in part.rows.iter().zip(pairs) {
            let value = |k: usize| row.values.get(k).copied().flatten();
            self.pairs += 1;
            self.touching += usize::from(band.and_then(value).is_some());
            for ((distribution, counted), columns) in
                self.distributions.iter_mut().zip(&COUNTED).zip(&columns)
            {
                columns.iter().filter_map(|&k| value(k)).for_each(|value| distribution.add(counted, value));
            }
            if let Some(conicity) = value(0) {
                self.with_conicity += 1;
                self.rank(WorstPair { number, row: row.clone(), conicity });
            }
            if !row.finding.is_empty() {
                self.with_finding += 1;
                if self.findings.len() < SHOWN {
                    self.findings.push([
                        row.names[0].clone(),
                        by_names(row, &rails(row)),
                        by_names(row, &row.finding),
                    ]);
                }
            }
        }
        for &(position, cell, count) in &part.touched {
            *self.touched.entry((position, cell)).or_default() += u64::from(count);
        }
    }

    /// Keeps a pair if its conicity is among the largest; of equal ones the first.
    fn rank(&mut self, pair: WorstPair) {
        let at = self.worst.partition_point(|other| other.conicity >= pair.conicity);
        if at < WORST {
            self.worst.insert(at, pair);
            self.worst.truncate(WORST);
        }
    }

    /// Returns the distributions, each with least, largest and quantiles, as values with keys.
    pub fn summary(&self) -> Value {
        let all = COUNTED.iter().zip(&self.distributions).map(|(counted, of)| {
            let [low, median, high] = [0.05, 0.5, 0.95].map(|share| of.quantile(counted, share));
            let values = json!({ "count": of.count(), "least": of.least, "quantile_5_percent": low, "median": median,
                "quantile_95_percent": high, "largest": of.largest, "quantiles_within": counted.width });
            (counted.key.to_string(), values)
        });
        Value::Object(all.collect())
    }

    /// Returns the distributions as pages draw them; none of a quantity that no pair has.
    pub fn distributions(&self) -> Vec<FleetDistribution> {
        let all = COUNTED.iter().zip(&self.distributions);
        all.filter_map(|(counted, of)| of.drawn(counted)).collect()
    }

    /// Returns the share \[%\] of the wheels that touch each cell of the rail, by displacement; `None` where no wheel touches.
    pub fn heat(&self) -> Option<FleetHeat> {
        let cells = || self.touched.keys().map(|(_, cell)| *cell);
        let (first, last) = (cells().min()?, cells().max()?);
        let width = (last - first + 1) as usize;
        let mut shares = vec![0.0; width * (2 * POSITIONS + 1) as usize];
        for (&(position, cell), &count) in &self.touched {
            let at = (position + POSITIONS) as usize * width + (cell - first) as usize;
            shares[at] = 100.0 * count as f64 / (2 * self.touching).max(1) as f64;
        }
        Some(FleetHeat {
            from: CELL * f64::from(first),
            width: CELL,
            cells: width,
            first: -STEP * f64::from(POSITIONS),
            step: STEP,
            shares,
            rail: None,
        })
    }
}

/// Returns a text of a row with the names of its files in place of their paths.
pub(super) fn by_names(row: &FleetRow, text: &str) -> String {
    let paths = row.names[1..].iter();
    paths.fold(
        text.to_owned(),
        |text, path| if path.is_empty() { text } else { text.replace(path, file_name(path)) },
    )
}

/// Names the rails of a row: one name, where both are the same.
pub(super) fn rails(row: &FleetRow) -> String {
    let [.., left, right] = &row.names;
    if left == right { left.clone() } else { format!("{left}, {right}") }
}

impl Distribution {
    fn add(&mut self, counted: &Counted, value: f64) {
        self.counts.resize(counted.cells, 0);
        let cell = ((value - counted.from) / counted.width).floor().clamp(0.0, (counted.cells - 1) as f64);
        self.counts[cell as usize] += 1;
        self.least = Some(self.least.map_or(value, |least| least.min(value)));
        self.largest = Some(self.largest.map_or(value, |largest| largest.max(value)));
    }

    fn count(&self) -> u64 {
        self.counts.iter().map(|count| u64::from(*count)).sum()
    }

    /// Returns the value below which this share of all lies: the upper end of its cell, within least and largest.
    fn quantile(&self, counted: &Counted, share: f64) -> Option<f64> {
        let [least, largest] = [self.least?, self.largest?];
        let wanted = share * self.count() as f64;
        let mut sum = 0.0;
        let cell = self.counts.iter().position(|count| {
            sum += f64::from(*count);
            sum >= wanted
        })?;
        let value = counted.from + counted.width * (cell + 1) as f64;
        // No digits beyond those of the cells.
        Some(((value / counted.width).round() * counted.width * 1e9).round() / 1e9)
            .map(|value| value.clamp(least, largest))
    }

    fn drawn(&self, counted: &Counted) -> Option<FleetDistribution> {
        let first = self.counts.iter().position(|count| *count > 0)?;
        let last = self.counts.iter().rposition(|count| *count > 0)?;
        let together = (last - first + 1).div_ceil(BARS);
        let counts = self.counts[first..=last].chunks(together).map(|cells| cells.iter().sum()).collect();
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
        let [low, median, high] = [0.05, 0.5, 0.95].map(|share| number(self.quantile(counted, share)));
        Some(FleetDistribution {
            title: counted.title.into(),
            axis: counted.axis.into(),
            from: counted.from + counted.width * first as f64,
            width: counted.width * together as f64,
            counts,
            told: format!(
                "median {median}, 5 % to 95 %: {low} to {high}, all: {} to {}",
                number(self.least),
                number(self.largest)
            ),
        })
    }
}
