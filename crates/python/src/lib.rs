//! The compiled part of the Python package `wheelrail`: every class holds a value of the library, and every method is one
//! call of it.

mod arrays;
mod asked;
mod case;
mod conicity;
mod contact;
mod errors;
mod files;
mod filling;
mod fleet;
mod long;
mod march;
mod measure;
mod pair;
mod patch;
mod place;
mod positions;
mod profile;
mod standards;
mod sweep;
mod table;
mod text;
mod values;
mod wheelset;

use pyo3::prelude::*;

/// The compiled part of `wheelrail`.
#[pymodule(gil_used = false)]
mod _wheelrail {
    #[pymodule_export]
    use super::asked::effective_modulus;
    #[pymodule_export]
    use super::case::{Case, run, schema};
    #[pymodule_export]
    use super::conicity::conicity;
    #[pymodule_export]
    use super::contact::{Contact, contact_from_parts, patch_from_parts};
    #[pymodule_export]
    use super::fleet::{fleet, fleet_part, fleet_parts};
    #[pymodule_export]
    use super::march::march;
    #[pymodule_export]
    use super::measure::{average_profiles, measure_profile, measure_repeats};
    #[pymodule_export]
    use super::pair::{Pair, pair_from_parts};
    #[pymodule_export]
    use super::patch::Patch;
    #[pymodule_export]
    use super::profile::{Profile, profile_from_bytes, read_profile};
    #[pymodule_export]
    use super::standards::{rail, rail_names, wheel, wheel_names};
    #[pymodule_export]
    use super::sweep::{doubt_words, sweep_picture};
    #[pymodule_export]
    use super::table::{ContactTable, table, table_from_text};
    #[pymodule_export]
    use super::wheelset::Wheelset;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
