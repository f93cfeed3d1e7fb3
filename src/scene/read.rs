//! Text → scene, with every complaint in the house form.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::Scene;
use crate::error::{Error, Result};

/// A scene from a TOML file, or from a JSON file with the same keys.
///
/// # Errors
/// An unreadable file; syntax, unknown keys and wrong types, each with its line.
pub fn load(path: &Path) -> Result<Scene> {
    let place = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| unreadable(path, &error))?;
    let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    parse(&text, json).map_err(|error| error.within(place))
}

/// A scene from text.
///
/// # Errors
/// Syntax, unknown keys and wrong types, each with its line.
pub fn parse<T: serde::de::DeserializeOwned>(text: &str, json: bool) -> Result<T> {
    if json {
        return serde_json::from_str(text).map_err(|error| {
            house_form(format!("line {}", error.line()), &without_position(&error.to_string()))
        });
    }
    let complaint = |error: toml::de::Error| {
        let line = error.span().map(|span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        house_form(line.map_or_else(String::new, |line| format!("line {line}")), error.message())
    };
    let scene = toml::from_str(text).map_err(complaint)?;
    // `toml` drops what an array has too much, `serde_json` does not; what is not finite is null there, and found later.
    let value: serde_json::Value = toml::from_str(text).map_err(complaint)?;
    if !has_null(&value) {
        serde_json::from_value::<T>(value).map_err(|error| house_form(String::new(), &error.to_string()))?;
    }
    Ok(scene)
}

fn has_null(value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::Null => true,
        serde_json::Value::Array(values) => values.iter().any(has_null),
        serde_json::Value::Object(values) => values.values().any(has_null),
        _ => false,
    }
}

/// SHA-256 of the scene as read, in hexadecimal: equal scenes have equal hashes whatever their comments.
pub fn hash(scene: &Scene) -> String {
    let canonical = serde_json::to_vec(scene).unwrap_or_default();
    Sha256::digest(canonical).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Why a file cannot be read, in words.
pub fn unreadable(path: &Path, error: &std::io::Error) -> Error {
    use std::io::ErrorKind;
    let found = match error.kind() {
        ErrorKind::NotFound => "no such file".to_owned(),
        ErrorKind::PermissionDenied => "a file that you may not read".to_owned(),
        ErrorKind::IsADirectory => "a folder".to_owned(),
        ErrorKind::InvalidData => "bytes that are no text in UTF-8".to_owned(),
        _ => error.to_string(),
    };
    Error::new(path.display().to_string(), found, "a readable file", "check the path")
}

/// Advice for a word that is not known: the nearest one that is, where one is near.
pub fn perhaps(found: &str, known: &[&str]) -> String {
    /// Likeness from which two words look like one misspelt: `yaw` and `yaw_rad` have 0.87, words of a letter or two in
    /// common 0.6.
    const ALIKE: f64 = 0.7;
    let likeness = |known: &str| strsim::jaro_winkler(known, found);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    match nearest.filter(|nearest| likeness(nearest) >= ALIKE) {
        Some(nearest) => format!("perhaps `{nearest}` is meant"),
        None => "correct or remove it".into(),
    }
}

fn without_position(message: &str) -> String {
    message.split(" at line ").next().unwrap_or(message).to_string()
}

/// Serde's "unknown field `x`, expected one of `a`, `b`" and its kin, split into what stands there and what
/// could.
fn house_form(place: String, message: &str) -> Error {
    let message = message.trim();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if (message.starts_with("unknown field") || message.starts_with("unknown variant"))
        && let [found, known @ ..] = quoted.as_slice()
    {
        let expected = format!("one of {}", known.join(", "));
        return Error::new(place, format!("`{found}`"), expected, perhaps(found, known));
    }
    if let (true, Some(key)) = (message.starts_with("missing field"), quoted.first()) {
        return Error::new(place, format!("no `{key}`"), format!("the key `{key}`"), "add it");
    }
    if let Some((found, expected)) = message.split_once(", expected ") {
        return Error::new(place, found, expected, "see `wheelrail schema` and the README");
    }
    Error::new(place, message, "a scene in TOML or JSON", "see `wheelrail schema` and the README")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::separation::grid::Method;

    const SCENE: &str = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                         [contact]\nrail_x = 0.0\nwheel_x = 0.0\n";

    #[test]
    fn a_misspelt_key_is_named_with_its_line_and_the_nearest_one() {
        let text = SCENE.replace("wheel_x", "wheel_z");
        let error = parse::<Scene>(&text, false).err().map(|e| e.to_string());
        let expected = "line 8: found `wheel_z`; expected one of rail_x, wheel_x, offset, roll, yaw, within; perhaps `wheel_x` is meant";
        assert_eq!(error.as_deref(), Some(expected));
    }

    #[test]
    fn the_same_keys_work_in_json() -> Result<()> {
        let scene: Scene = parse(SCENE, false)?;
        let json = serde_json::to_string(&scene).unwrap_or_default();
        assert_eq!(parse::<Scene>(&json, true)?, scene);
        assert_eq!(hash(&scene).len(), 64);
        Ok(())
    }

    #[test]
    fn an_array_that_is_too_long_is_not_cut_short() {
        let text = SCENE.replace("[wheel]", "shift = [0.0, 0.0, 99.0]\n[wheel]");
        let error = parse::<Scene>(&text, false).err().map(|e| e.to_string());
        assert!(error.as_deref().is_some_and(|e| e.contains("invalid length 3")), "{error:?}");
    }

    #[test]
    fn a_method_is_one_of_the_ladder_or_auto() -> Result<()> {
        for (word, method) in [("auto", None), ("report-newton", Some(Method::ReportNewton))] {
            let scene: Scene = parse(&format!("{SCENE}[grid]\nmethod = \"{word}\"\n"), false)?;
            assert_eq!(scene.grid.method, method);
            assert_eq!(
                serde_json::to_value(&scene).map_or_else(|_| "".into(), |s| s["grid"]["method"].clone()),
                word
            );
        }
        let error = parse::<Scene>(&format!("{SCENE}[grid]\nmethod = \"spectrl\"\n"), false).err();
        assert_eq!(error.map(|e| e.advice).as_deref(), Some("perhaps `spectral` is meant"));
        Ok(())
    }

    #[test]
    fn wrong_types_and_missing_keys_are_named() {
        for (bad, found) in
            [("radius = \"big\"", "invalid type: string \"big\""), ("radios = 1.0", "`radios`")]
        {
            let error = parse::<Scene>(&SCENE.replace("radius = 460.0", bad), false).err();
            assert_eq!(error.map(|e| e.found).as_deref(), Some(found));
        }
    }
}
