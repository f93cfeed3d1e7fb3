//! Wheel/rail contact-patch preprocessor.

pub mod check;
pub mod contact;
pub mod error;
pub mod interpenetration;
pub mod numerics;
pub mod placement;
pub mod profile;
pub mod scene;
pub mod separation;

pub use error::{Error, Result};
