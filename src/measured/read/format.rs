//! The formats of measured profiles, and how the format of a file is found.

use serde::{Deserialize, Serialize};

use super::scan;
use crate::error::{Error, Result};
use crate::profile::Side;

/// A format of measured profiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// MiniProf: `.ban`, `.whl`, `.mpt`.
    MiniProf,
    /// SIMPACK: `.prr`, `.prw`.
    Simpack,
    /// GENSYS: `.rail`, `.wheel`.
    Gensys,
    /// Columns separated by white space; `.rpr` and `.wpr` of multibody programs are such under a head.
    Text,
    /// Columns separated by commas or semicolons.
    Csv,
    /// Vampire: `.rai`, `.whe`.
    Vampire,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 6] =
        [Self::MiniProf, Self::Simpack, Self::Gensys, Self::Text, Self::Csv, Self::Vampire];

    /// Returns the format that a file's extension stands for. Upper and lower case are the same.
    ///
    /// # Errors
    /// An extension of no format; the message tells to give `format = …`.
    pub fn of_file(name: &str) -> Result<Self> {
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension).to_lowercase();
        let known = Self::ALL.into_iter().find(|format| format.extensions().contains(&extension.as_str()));
        known.ok_or_else(|| {
            let all: Vec<_> =
                Self::ALL.iter().flat_map(|f| f.extensions()).map(|e| format!(".{e}")).collect();
            let names: Vec<_> = Self::ALL.iter().map(|f| format!("\"{}\"", f.name())).collect();
            let advice = format!(
                "give `format = …`, one of {}; of a file of another kind, as a drawing, export the points as two columns of numbers",
                names.join(", ")
            );
            Error::new(scan::clipped(name), format!("extension \"{extension}\""), all.join(", "), advice)
        })
    }

    /// Returns the body that a file's extension stands for. Upper and lower case are the same. Returns `None` if
    /// the extension does not tell the body.
    pub fn body_of_file(name: &str) -> Option<Side> {
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension).to_lowercase();
        match extension.as_str() {
            "ban" | "prr" | "rail" | "slcs" | "rai" | "rpr" => Some(Side::Rail),
            "whl" | "prw" | "wheel" | "slcw" | "whe" | "wpr" => Some(Side::Wheel),
            _ => None,
        }
    }

    /// Returns the extensions of the format, in lower case.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::MiniProf => &["ban", "whl", "mpt"],
            Self::Simpack => &["prr", "prw"],
            Self::Gensys => &["rail", "wheel"],
            Self::Text => &["txt", "dat", "xy", "asc", "rpr", "wpr"],
            Self::Csv => &["csv"],
            Self::Vampire => &["rai", "whe"],
        }
    }

    /// Returns the name of the format in scenes: the value of `format = …`.
    pub fn name(self) -> &'static str {
        match self {
            Self::MiniProf => "miniprof",
            Self::Simpack => "simpack",
            Self::Gensys => "gensys",
            Self::Text => "text",
            Self::Csv => "csv",
            Self::Vampire => "vampire",
        }
    }

    /// Returns the name of the format for sentences.
    pub fn title(self) -> &'static str {
        match self {
            Self::MiniProf => "MiniProf",
            Self::Simpack => "SIMPACK",
            Self::Gensys => "GENSYS",
            Self::Text => "a plain text file",
            Self::Csv => "a CSV file",
            Self::Vampire => "Vampire",
        }
    }
}
