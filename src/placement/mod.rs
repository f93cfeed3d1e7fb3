//! Where the bodies are: contact frames, track and wheelset.

pub mod track;
