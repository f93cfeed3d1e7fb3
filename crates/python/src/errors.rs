//! The library's errors as Python's exceptions, and its doubts as Python's warnings.

use pyo3::prelude::*;
use pyo3::types::PyType;
use wheelrail::case::Doubt;
use wheelrail::measured::{self, Finding, Wording};
use wheelrail::{Error, ErrorKind};

/// Texts of scenes and of the command line, each with the text that messages in Python have instead.
const WORDS: [(&str, &str); 12] = [
    ("see `wheelrail schema` and the manual, src/docs/scene.md", "see `help(wheelrail)`"),
    (
        "see `wheelrail profile list`, or give `file` or `segments`",
        "see `rail_names()` and `wheel_names()`, or `read_profile`, `Profile.from_points`, `Profile.from_segments`",
    ),
    ("needs shift = [-70.0, 0.0]", "needs `shifted(-70.0)`"),
    ("[contact] offset finds", "`Pair.touch` finds"),
    ("needs mirror = true", "needs `mirrored()`"),
    ("mirror = true for a profile", "`mirrored()` for a profile"),
    (" = true`", "=True`"),
    (" = false`", "=False`"),
    (
        "give the radius there, or move the profile by shift or origin",
        "give the radius there, or move the profile by `shifted`",
    ),
    ("wheel.radius", "radius"),
    ("give it as the wheel", "make it by `wheelrail.wheel`"),
    ("give it as the rail", "make it by `wheelrail.rail`"),
];

/// Names of a scene's tables that are cut off where a message names an argument.
const TABLES: [&str; 8] =
    ["wheelset: ", "track: ", "contact: ", "patch: ", "grid: ", "material: ", "wheel: ", "conicity: "];

/// A result with an exception where the library has an error.
pub(crate) trait OrRaise<T> {
    /// Gives the value, or the exception of its error.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for wheelrail::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(exception)
    }
}

/// Says a text of the library in Python's words.
fn spoken(text: &str) -> String {
    WORDS
        .iter()
        .fold(measured::spoken(text, Wording::Keywords), |text, (theirs, ours)| text.replace(theirs, ours))
}

/// Names the argument that a key of a scene stands for. A place in a scene begins with the scene, and stays.
fn argument(place: &str) -> String {
    let (position, key) = match place.split_once(": ") {
        Some((position, key)) if position.starts_with("position ") => (format!("{position}: "), key),
        _ => (String::new(), place),
    };
    let short = TABLES.iter().find_map(|table| key.strip_prefix(table)).unwrap_or(key);
    position + short
}

/// Makes the exception of an error: the class of its kind, with its four parts.
pub(crate) fn exception(error: Error) -> PyErr {
    Python::attach(|py| {
        let name = match error.kind {
            ErrorKind::Geometry | ErrorKind::NoContact => "GeometryError",
            ErrorKind::Io => "FileError",
            ErrorKind::Limit => "LimitError",
            _ => "InputError",
        };
        let class = py.import("wheelrail._errors").and_then(|module| module.getattr(name));
        let parts = (argument(&error.place), error.found, spoken(&error.expected), spoken(&error.advice));
        match class.and_then(|class| Ok(class.cast_into::<PyType>()?)) {
            Ok(class) => PyErr::from_type(class, parts),
            Err(missing) => missing,
        }
    })
}

/// Warns the caller of doubts.
///
/// # Errors
/// The doubt itself, where a filter of Python's warnings makes errors of doubts.
pub(crate) fn warn(py: Python<'_>, doubts: impl IntoIterator<Item = Doubt>) -> PyResult<()> {
    doubts.into_iter().try_for_each(|doubt| say(py, doubt.kind.word(), &doubt.found, doubt.kind.cause()))
}

/// Warns the caller of what was found in measured points.
///
/// # Errors
/// Those of [`warn`].
pub(crate) fn warn_of_points(py: Python<'_>, findings: &[Finding]) -> PyResult<()> {
    let say = |finding: &Finding| {
        let found = format!("{}: {}", finding.place, finding.found);
        say(py, "measured", &found, "see `Profile.record`, and give an option where it is not meant")
    };
    findings.iter().try_for_each(say)
}

/// Warns the caller: what is doubted, what was found, and its likely cause.
pub(crate) fn say(py: Python<'_>, kind: &str, found: &str, advice: &str) -> PyResult<()> {
    let class = py.import("wheelrail._errors")?.getattr("Doubt")?;
    let doubt = class.call1((kind, spoken(found), spoken(advice)))?;
    // A compiled function has no frame of its own: the first one is its caller's.
    py.import("warnings")?.call_method1("warn", (doubt, py.None(), 1)).map(drop)
}
