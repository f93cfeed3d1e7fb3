//! Reads scenes from text. Every error has four parts: where → found → expected → what to do.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::data::Scene;
use super::words::perhaps;
use crate::error::{Error, Result};
use crate::files::read_text;
use crate::measured::LARGEST_FILE;

/// Reads a scene from a TOML file, or from a JSON file with the same keys.
///
/// # Errors
/// An unreadable file; syntax, unknown keys and wrong types, each with its line.
pub fn load(path: &Path) -> Result<Scene> {
    let place = path.display().to_string();
    let text = read_text(path, LARGEST_FILE)?;
    let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    parse(&text, json).map_err(|error| error.within(place))
}

/// Reads a scene, or any other table of keys, from TOML or JSON text.
///
/// # Errors
/// Syntax, unknown keys and wrong types, each with its line.
pub fn parse<T: DeserializeOwned + Serialize>(text: &str, json: bool) -> Result<T> {
    let (read, value): (T, Value) = if json { from_json(text)? } else { from_toml(text)? };
    // `serde` accepts a list instead of a table, with its items in the order of the keys.
    // `toml` drops the surplus items of a list.
    let again = serde_json::to_value(&read).unwrap_or_default();
    match wrong_list(&value, &again, "") {
        None => Ok(read),
        Some((key, found, expected)) => Err(Error::new(key, found, expected, SEE_ALSO)),
    }
}

fn from_json<T: DeserializeOwned>(text: &str) -> Result<(T, Value)> {
    let complaint = |error: serde_json::Error| {
        let line = error.line().checked_sub(1).and_then(|line| text.lines().nth(line));
        let read = line.and_then(|line| line.get(..error.column()));
        let found = read.map(|read| format!("`{}` up to there", shortened(read.trim(), Keep::End)));
        let place = format!("line {}, column {}", error.line(), error.column());
        advised(house_form(place, &without_position(&error.to_string()), found), line)
    };
    Ok((serde_json::from_str(text).map_err(complaint)?, serde_json::from_str(text).map_err(complaint)?))
}

fn from_toml<T: DeserializeOwned>(text: &str) -> Result<(T, Value)> {
    let complaint = |error: toml::de::Error| {
        let line = |start| text.get(..start).map_or(0, |before: &str| before.matches('\n').count()) + 1;
        let number = error.span().map(|span| line(span.start));
        let place = number.map_or_else(String::new, |number| format!("line {number}"));
        let found = error.span().and_then(|span| text.get(span));
        let read = number.and_then(|number| text.lines().nth(number - 1));
        advised(
            house_form(place, error.message(), found.map(|found| shortened(found, Keep::Beginning))),
            read,
        )
    };
    let table = toml::de::DeTable::parse(text).map_err(complaint)?;
    let read = T::deserialize(toml::Deserializer::from(table.clone())).map_err(complaint)?;
    // Numbers that are not finite become null here and are found later.
    Ok((read, Value::deserialize(toml::Deserializer::from(table)).map_err(complaint)?))
}

/// Gives an error better advice where its line has a decimal comma, a word without quotes or a number with them.
fn advised(mut error: Error, line: Option<&str>) -> Error {
    if let Some(number) = line.and_then(decimal_comma) {
        error.advice = format!("write numbers with a decimal point: {number}");
    } else if let Some(value) = line.and_then(bare_value) {
        let word = error.expected == "a string" || error.expected == "string";
        let number = value.split_whitespace().next().filter(|first| first.parse::<f64>().is_ok());
        // `toml` reads 60E1 as 60·10¹ and 1:40 as a time of day.
        let unread = ["string values must be quoted", "invalid time"].contains(&error.found.as_str());
        if let (Some(number), true) = (number.filter(|number| *number != value), unread) {
            error.found = value.to_owned();
            error.expected = "a number, or words in quotes".into();
            error.advice = format!("write the number alone, in the unit of its key: {number}");
        } else if word || unread {
            error.found = value.to_owned();
            error.expected = "a name in quotes".into();
            error.advice = format!("a name needs quotes: \"{value}\"");
        }
    } else if error.found.starts_with("invalid type: string") && error.expected == "a number" {
        error.advice = "write the number alone, without quotes and in the unit of its key".into();
    }
    error
}

/// Gives the value of a line `key = value`, or `"key": value` in JSON, without its comment; `None` of quotes, lists and tables.
fn bare_value(line: &str) -> Option<&str> {
    let line = line.split('#').next().unwrap_or(line);
    let (_, value) = line.rsplit_once("\":").or_else(|| line.split_once('='))?;
    let value = value.trim().trim_end_matches([',', '}', ' ']);
    (!value.is_empty() && !value.contains(['"', '\'', '[', '{', '='])).then_some(value)
}

/// Finds a number with a decimal comma in a line, outside of lists, and gives it with a point.
fn decimal_comma(line: &str) -> Option<String> {
    let digit = |c: Option<&char>| c.is_some_and(char::is_ascii_digit);
    let line: Vec<char> = line.split('#').next().unwrap_or(line).chars().collect();
    let mut depth = 0;
    for (k, c) in line.iter().enumerate() {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            ',' if depth == 0 && k > 0 && digit(line.get(k - 1)) && digit(line.get(k + 1)) => {
                let whole = line[..k].iter().rev().take_while(|c| digit(Some(c))).count();
                let part = line[k + 1..].iter().take_while(|c| digit(Some(c)));
                return Some(line[k - whole..k].iter().chain(['.'].iter()).chain(part).collect());
            }
            _ => {}
        }
    }
    None
}

/// Finds the first key whose list was read as a table or as a shorter list; gives it with what was found and expected.
fn wrong_list(given: &Value, read: &Value, key: &str) -> Option<(String, String, String)> {
    match (given, read) {
        (Value::Array(_), Value::Object(_)) => {
            Some((key.into(), "a list".into(), "a table of keys and values".into()))
        }
        (Value::Array(given), Value::Array(read)) if given.len() > read.len() => {
            let expected = format!("a list of {}", read.len());
            Some((key.into(), format!("a list of {}", given.len()), expected))
        }
        (Value::Array(given), Value::Array(read)) => {
            given.iter().zip(read).find_map(|(given, read)| wrong_list(given, read, key))
        }
        (Value::Object(given), Value::Object(read)) => given.iter().find_map(|(name, given)| {
            let key = if key.is_empty() { name.clone() } else { format!("{key}: {name}") };
            wrong_list(given, read.get(name)?, &key)
        }),
        _ => None,
    }
}

/// Advice for errors that have no better one.
const SEE_ALSO: &str = "see `wheelrail schema` and the manual, src/docs/scene.md";

fn without_position(message: &str) -> String {
    message.split(" at line ").next().unwrap_or(message).to_string()
}

/// The part of a long text that is shown.
#[derive(Clone, Copy)]
enum Keep {
    Beginning,
    End,
}

/// Returns a text on one line, shortened to the part that helps to find it.
fn shortened(text: &str, keep: Keep) -> String {
    /// Number of characters that are shown.
    const SHOWN: usize = 60;
    let words: Vec<&str> = text.split_whitespace().collect();
    let line: Vec<char> = words.join(" ").chars().collect();
    match (line.len().checked_sub(SHOWN), keep) {
        (None | Some(0), _) => line.into_iter().collect(),
        (_, Keep::Beginning) => line[..SHOWN].iter().chain(['…'].iter()).collect(),
        (Some(cut), Keep::End) => ['…'].iter().chain(&line[cut..]).collect(),
    }
}

/// Turns a message of serde ("unknown field `x`, expected one of `a`, `b`" and similar) into an error that tells what was
/// found and what was expected. Keys with several forms give messages that tell only what was expected; `found` is then
/// what stands there.
fn house_form(place: String, message: &str, found: Option<String>) -> Error {
    let message = message.trim();
    if let Some(expected) = message.strip_prefix("expected ").or(message.strip_prefix("wanted ")) {
        let found = found.unwrap_or_else(|| "something else".into());
        return Error::new(place, found, expected, SEE_ALSO);
    }
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
        // The list has the wrong length for a table that lists can stand for.
        let list = message.starts_with("invalid length") && expected.starts_with("struct");
        let found = if list { "a list" } else { found };
        let expected = match expected {
            "f64" => "a number",
            "u64" | "usize" => "a whole number of 0 or more",
            "a sequence" => "a list",
            table if table == "a map" || table.starts_with("struct") => "a table of keys and values",
            other => other,
        };
        return Error::new(place, found, expected, SEE_ALSO);
    }
    Error::new(place, message, "a scene in TOML or JSON", SEE_ALSO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_keep_the_end_that_is_asked_for_and_lists_have_no_decimal_comma() {
        assert_eq!(shortened(&"a ".repeat(50), Keep::End), format!("…{}", " a".repeat(30)));
        assert_eq!(decimal_comma("shift = [1,2]"), None);
    }
}
