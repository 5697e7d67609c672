//! Base64 within XML: with white space, and one run after another.

use std::io::{self, BufRead, ErrorKind, Read};

use crate::source::Source;

/// The bytes of a text up to the next tag. Each run of the text may end with `=`.
pub(super) struct Base64<'a> {
    source: &'a mut Source,
    /// The bytes of the group that was read last, and how many of them are given out.
    group: [u8; 3],
    held: usize,
    given: usize,
}

impl<'a> Base64<'a> {
    pub(super) fn new(source: &'a mut Source) -> Self {
        Self { source, group: [0; 3], held: 0, given: 0 }
    }

    /// Reads a group of four letters; without any, nothing is held.
    fn next_group(&mut self) -> io::Result<()> {
        let (mut bits, mut letters, mut padding) = (0u32, 0, 0);
        (self.held, self.given) = (0, 0);
        while letters < 4 {
            let bytes = self.source.fill_buf()?;
            let Some(first) = bytes.first() else {
                return Err(ErrorKind::UnexpectedEof.into());
            };
            let letter = *first;
            if letter == b'<' {
                return match letters {
                    0 => Ok(()),
                    _ => Err(bad("a base64 text ends within a group of four letters")),
                };
            }
            self.source.consume(1);
            if letter.is_ascii_whitespace() {
                continue;
            }
            let value = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                b'=' if letters >= 2 => {
                    padding += 1;
                    0
                }
                _ => return Err(bad("a base64 text has a letter that is none of its own")),
            };
            if padding > 0 && letter != b'=' {
                return Err(bad("a base64 text goes on behind the `=` of a group"));
            }
            bits = bits << 6 | u32::from(value);
            letters += 1;
        }
        let [_, bytes @ ..] = bits.to_be_bytes();
        (self.group, self.held) = (bytes, 3 - padding);
        Ok(())
    }
}

fn bad(what: &'static str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, what)
}

impl Read for Base64<'_> {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        let mut count = 0;
        while count < buf.len() {
            if self.given == self.held {
                match self.next_group() {
                    Ok(()) if self.held > 0 => {}
                    // What is there comes first; the next call meets the error again.
                    Err(e) if count == 0 => return Err(e),
                    _ => break,
                }
            }
            let part = (self.held - self.given).min(buf.len() - count);
            buf[count..][..part].copy_from_slice(&self.group[self.given..][..part]);
            self.given += part;
            count += part;
        }
        Ok(count)
    }
}
