//! Scenes: what the user writes, read and then resolved once into a [`Case`](crate::case::Case) of checked values, in mm and
//! rad.

mod axes;
mod data;
mod method_or_auto;
mod profiles;
mod read;
mod resolve;
mod standing;
mod words;

pub use axes::check_axis;
pub use data::{
    AxisData, ContactData, GridData, MaterialData, OutputData, PatchData, ProfileData, RollData, RollWord,
    Rotation, Scene, Spacing, TrackData, WheelsetData, schema,
};
pub use profiles::{ProfileSource, is_chain_file, profile_from_file, read_profile};
pub use read::{load, parse};
pub use resolve::{approach, echo, modulus, resolve, with_profiles};
pub use words::perhaps;
