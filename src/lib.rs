//! Wheel/rail contact-patch preprocessor.

pub mod error;
pub mod export;
pub mod numerics;
pub mod profile;

pub use error::{Error, Result};
