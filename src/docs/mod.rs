//! The manual, in the order of `SUMMARY.md`: the same pages are a site (`scripts/book`).

#[doc = include_str!("getting-started.md")]
pub mod getting_started {}

#[doc = include_str!("profiles.md")]
pub mod profiles {}

#[doc = include_str!("scene.md")]
pub mod scene {}

#[doc = include_str!("wheelset.md")]
pub mod wheelset {}

#[doc = include_str!("loads.md")]
pub mod loads {}

#[doc = include_str!("sweeps.md")]
pub mod sweeps {}

#[doc = include_str!("conicity.md")]
pub mod conicity {}

#[doc = include_str!("fleet.md")]
pub mod fleet {}

#[doc = include_str!("measures.md")]
pub mod measures {}

#[doc = include_str!("along-the-track.md")]
pub mod along_the_track {}

#[doc = include_str!("tables.md")]
pub mod tables {}

#[doc = include_str!("conformal.md")]
pub mod conformal {}

#[doc = include_str!("python.md")]
pub mod python {}

#[doc = include_str!("gallery-of-scenes.md")]
pub mod gallery_of_scenes {}

#[doc = include_str!("gallery.md")]
pub mod gallery {}

#[doc = include_str!("commands.md")]
pub mod commands {}

#[doc = include_str!("conventions.md")]
pub mod conventions {}

#[doc = include_str!("measured-files.md")]
pub mod measured_files {}

#[doc = include_str!("clients.md")]
pub mod clients {}

#[doc = include_str!("accuracy-and-speed.md")]
pub mod accuracy_and_speed {}

#[doc = include_str!("time.md")]
pub mod time {}

#[doc = include_str!("numerics.md")]
pub mod numerics {}

#[doc = include_str!("errata.md")]
pub mod errata {}

#[doc = include_str!("references.md")]
pub mod references {}
