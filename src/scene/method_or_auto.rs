//! Reads and writes the method of a grid in a scene: its name, or "auto" for `None`.

use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

use crate::separation::Method;

const AUTO: &str = "auto";

fn words() -> Vec<&'static str> {
    std::iter::once(AUTO).chain(Method::ALL.map(Method::name)).collect()
}

// serde prescribes the reference to an option.
pub(super) fn serialize<S: Serializer>(method: &Option<Method>, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(method.map_or(AUTO, Method::name))
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Method>, D::Error> {
    let word = String::deserialize(from)?;
    let named = Method::ALL.into_iter().find(|method| method.name() == word);
    if named.is_some() || word == AUTO {
        return Ok(named);
    }
    let known = words().join("`, `");
    Err(D::Error::custom(format!("unknown variant `{word}`, expected one of `{known}`")))
}

pub(super) fn schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": words() })
}
