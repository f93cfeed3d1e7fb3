//! Wheel/rail contact-patch preprocessor.

pub mod accuracy;
pub mod analysis;
pub mod cli;
pub mod contact;
pub mod error;
pub mod export;
pub mod interpenetration;
pub mod numerics;
pub mod placement;
pub mod profile;
pub mod scene;
pub mod separation;

pub use error::{Error, Result};
