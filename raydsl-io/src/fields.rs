//! Headers of text: a name and a value in each line.

use crate::error::word_text;
use crate::source::Source;
use crate::{LoadError, Place};

/// Headers are far shorter.
const LONGEST: u64 = 1 << 20;

/// A value, and its line.
#[derive(Clone, Copy)]
pub(crate) struct Value<'a> {
    pub(crate) text: &'a str,
    pub(crate) line: u64,
}

impl Value<'_> {
    pub(crate) fn wrong(self, source: &Source, remedy: &'static str) -> LoadError {
        let what = format!("'{}' is none of its values", word_text(self.text.as_bytes()));
        source.corrupt(Place::Line(self.line), what, remedy)
    }

    /// The numbers of a list.
    pub(crate) fn numbers<T: std::str::FromStr, const N: usize>(
        self,
        source: &Source,
        remedy: &'static str,
    ) -> Result<[T; N], LoadError> {
        let numbers: Option<Vec<T>> =
            self.text.split_whitespace().map(|w| w.parse().ok()).take(N + 1).collect();
        let numbers = numbers.and_then(|numbers| <[T; N]>::try_from(numbers).ok());
        numbers.ok_or_else(|| {
            let text = word_text(self.text.as_bytes());
            let what = match N {
                1 => format!("'{text}' is no number that it can be"),
                _ => format!("'{text}' is no list of {N} numbers"),
            };
            source.corrupt(Place::Line(self.line), what, remedy)
        })
    }
}

/// The lines of a header.
#[derive(Default)]
pub(crate) struct Fields {
    fields: Vec<(String, String, u64)>,
}

impl Fields {
    /// Adds the line that was read last.
    pub(crate) fn add(
        &mut self,
        source: &Source,
        name: &str,
        value: &str,
        remedy: &'static str,
    ) -> Result<(), LoadError> {
        check_length(source, remedy)?;
        self.fields.push((name.trim().into(), value.trim().into(), source.line));
        Ok(())
    }

    /// The value of the first of `names` that is there.
    pub(crate) fn get(&self, names: &[&str]) -> Option<Value<'_>> {
        let found = |name: &&str| self.fields.iter().find(|(known, ..)| known == name);
        let (_, text, line) = names.iter().find_map(found)?;
        Some(Value { text, line: *line })
    }

    /// The value of `name`, which has to be there.
    pub(crate) fn required(
        &self,
        source: &Source,
        name: &str,
        remedy: &'static str,
    ) -> Result<Value<'_>, LoadError> {
        self.get(&[name]).ok_or_else(|| {
            source.corrupt(Place::Somewhere, format!("its header has no line '{name}'"), remedy)
        })
    }
}

/// An error if the header goes on for too long.
pub(crate) fn check_length(source: &Source, remedy: &'static str) -> Result<(), LoadError> {
    if source.at <= LONGEST {
        return Ok(());
    }
    Err(source.bad_line(format!("its header is longer than {LONGEST} bytes"), remedy))
}
