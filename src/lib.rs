//! Wheel/rail contact-patch preprocessor.

pub mod contact;
pub mod error;
pub mod numerics;
pub mod placement;
pub mod profile;

pub use error::{Error, Result};
