//! The library's errors as Python's exceptions.

use pyo3::prelude::*;
use pyo3::types::PyType;
use wheelrail::{Error, ErrorKind};

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
        match class.and_then(|class| Ok(class.cast_into::<PyType>()?)) {
            Ok(class) => PyErr::from_type(class, (error.place, error.found, error.expected, error.advice)),
            Err(missing) => missing,
        }
    })
}

/// Makes the error of a wheel that touches nothing.
pub(crate) fn no_contact(place: &str, expected: &str) -> PyErr {
    let error = Error::new(place, "no contact", expected, "check the displacement, the gauge and the signs");
    exception(error.of_kind(ErrorKind::NoContact))
}
