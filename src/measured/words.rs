//! Says messages about measured files in the words of the surface where the options are given.
//!
//! Messages name an option, and what may be given for it, as a scene has it and between backquotes: `` `mirror = true` ``.

use super::options::Options;
use crate::error::Error;

/// Where the options of a measured file are given, other than in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wording {
    /// Options of the command line: `--mirror true`.
    CommandLine,
    /// Keywords of Python: `mirror=True`.
    Keywords,
}

/// Says a text in the words of a surface: what it has between backquotes, where that is an option or a value for one.
///
/// # Examples
/// ```
/// use wheelrail::measured::{Wording, spoken};
///
/// let text = "give `repair = [\"sort\", \"cut-loops\"]` or `flip_z = true`";
/// assert_eq!(spoken(text, Wording::CommandLine), "give `--repair sort,cut-loops` or `--flip-z true`");
/// assert_eq!(spoken(text, Wording::Keywords), "give `repair=[\"sort\", \"cut-loops\"]` or `flip_z=True`");
/// ```
pub fn spoken(text: &str, surface: Wording) -> String {
    let mut out = String::with_capacity(text.len());
    for (k, part) in text.split('`').enumerate() {
        if k > 0 {
            out.push('`');
        }
        match option(part, surface).filter(|_| k % 2 == 1) {
            Some(said) => out += &said,
            None => out += part,
        }
    }
    out
}

/// Says an error in the words of a surface.
#[must_use]
pub fn spoken_error(mut error: Error, surface: Wording) -> Error {
    for text in [&mut error.found, &mut error.expected, &mut error.advice] {
        *text = spoken(text, surface);
    }
    error
}

/// Says an option, or an option with a value; `None` for other text.
fn option(text: &str, surface: Wording) -> Option<String> {
    let (key, value) = text.split_once(" = ").map_or((text, None), |(key, value)| (key, Some(value)));
    Options::KEYS.contains(&key).then(|| match surface {
        Wording::CommandLine => {
            let bare = |value: &str| value.trim_matches(['[', ']']).replace('"', "").replace(", ", ",");
            let value = value.map_or_else(String::new, |value| format!(" {}", bare(value)));
            format!("--{}{value}", key.replace('_', "-"))
        }
        Wording::Keywords => {
            let capital = |value: &str| match value {
                "true" => "True".to_owned(),
                "false" => "False".to_owned(),
                other => other.to_owned(),
            };
            key.to_owned() + &value.map_or_else(String::new, |value| format!("={}", capital(value)))
        }
    })
}
