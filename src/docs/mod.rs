//! Background: conventions, measured files, the numerics with their derivation, conformal contact, the Report's errata, sweeps,
//! rails that vary along the track, fleets, loads, clients, where time goes, references.

#[doc = include_str!("conventions.md")]
pub mod conventions {}

#[doc = include_str!("measured-files.md")]
pub mod measured_files {}

#[doc = include_str!("measures.md")]
pub mod measures {}

#[doc = include_str!("numerics.md")]
pub mod numerics {}

#[doc = include_str!("conformal.md")]
pub mod conformal {}

#[doc = include_str!("errata.md")]
pub mod errata {}

#[doc = include_str!("sweeps.md")]
pub mod sweeps {}

#[doc = include_str!("along-the-track.md")]
pub mod along_the_track {}

#[cfg(feature = "files")]
#[doc = include_str!("fleet.md")]
pub mod fleet {}

#[doc = include_str!("loads.md")]
pub mod loads {}

#[doc = include_str!("clients.md")]
pub mod clients {}

#[doc = include_str!("python.md")]
pub mod python {}

#[doc = include_str!("gallery.md")]
pub mod gallery {}

#[doc = include_str!("time.md")]
pub mod time {}

#[doc = include_str!("references.md")]
pub mod references {}
