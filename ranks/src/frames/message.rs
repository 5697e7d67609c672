//! Fragments as messages: for each part runs of pixels side by side, with what was found.

use core::ops::Range;

use bytemuck::Pod;

use super::strips::Strips;

/// What rays of pixels found in a part, by rising pixel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fragments<F> {
    pixels: Vec<u32>,
    found: Vec<F>,
}

impl<F: Pod> Fragments<F> {
    pub(super) fn new() -> Self {
        Self { pixels: Vec::new(), found: Vec::new() }
    }

    /// Adds what was found at a pixel behind all others.
    pub(super) fn push(&mut self, pixel: u32, found: F) {
        self.pixels.push(pixel);
        self.found.push(found);
    }

    pub(super) fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Returns those in a range of pixels, as runs: the first pixel, and what was found.
    fn runs(&self, pixels: Range<u32>) -> impl Iterator<Item = (u32, &[F])> {
        let place = |pixel: u32| self.pixels.partition_point(|p| *p < pixel);
        let places = place(pixels.start)..place(pixels.end);
        let first = places.start;
        let runs = self.pixels[places].chunk_by(|a, b| *a + 1 == *b);
        runs.scan(first, |at, run| {
            let found = &self.found[*at..*at + run.len()];
            *at += run.len();
            Some((run[0], found))
        })
    }
}

/// Returns the message to each rank: the fragments in its strip. A run has the number of its part,
/// its first pixel and its length, then what was found.
pub(super) fn encode<F: Pod>(strips: &Strips, parts: &[(u32, Fragments<F>)]) -> Vec<Vec<u8>> {
    let message = |rank: u32| {
        let mut bytes = Vec::new();
        for (part, fragments) in parts {
            for (first, found) in fragments.runs(strips.of(rank)) {
                bytes.extend(bytemuck::bytes_of(&[*part, first, found.len() as u32]));
                bytes.extend(bytemuck::cast_slice::<F, u8>(found));
            }
        }
        bytes
    };
    (0..strips.count()).map(message).collect()
}

/// What fragments a message may have: those of the sender's parts, in the strip of its receiver.
pub(super) struct Sent {
    pub(super) parts: Range<u32>,
    pub(super) strip: Range<u32>,
}

/// Adds the fragments of a message that are in a band of its strip: part, pixel, and what was found.
/// Returns `None` if it is no such message.
pub(super) fn decode<F: Pod>(
    mut bytes: &[u8],
    Sent { parts, strip }: &Sent,
    band: &Range<u32>,
    fragments: &mut Vec<(u32, u32, F)>,
) -> Option<()> {
    // Runs rise by part and pixel: none is there twice.
    let mut next = (parts.start, strip.start);
    while !bytes.is_empty() {
        let (head, rest) = bytes.split_at_checked(size_of::<[u32; 3]>())?;
        let [part, first, count]: [u32; 3] = bytemuck::pod_read_unaligned(head);
        let end = first.checked_add(count)?;
        let is_within = strip.start <= first && end <= strip.end && parts.contains(&part);
        if count == 0 || (part, first) < next {
            return None;
        }
        next = (part, end);
        let length = (count as usize).checked_mul(size_of::<F>()).filter(|_| is_within)?;
        let (found, rest) = rest.split_at_checked(length)?;
        bytes = rest;

        let pixels = first.max(band.start)..end.min(band.end);
        if !pixels.is_empty() {
            let found = &found[(pixels.start - first) as usize * size_of::<F>()..];
            let found = found.chunks_exact(size_of::<F>()).map(bytemuck::pod_read_unaligned);
            fragments.extend(pixels.zip(found).map(|(pixel, found)| (part, pixel, found)));
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use glam::uvec2;

    use super::super::strips;
    use super::*;

    #[test]
    fn messages_keep_fragments() {
        let pixels = [0u32, 1, 2, 5, 9, 10, 11, 12, 19];
        let part = |number: u32, step: usize| {
            let mut fragments = Fragments::new();
            for pixel in pixels.iter().step_by(step) {
                fragments.push(*pixel, [number * 100 + pixel, *pixel]);
            }
            (number, fragments)
        };
        let parts = [part(1, 2), (2, Fragments::new()), part(3, 1)];
        for ranks in [1, 2, 3, 7, 30] {
            let strips = Strips::new(uvec2(5, 4), ranks);
            let messages = encode(&strips, &parts);
            let mut found = Vec::new();
            for (rank, bytes) in (0..ranks).zip(&messages) {
                let sent = Sent { parts: 1..4, strip: strips.of(rank) };
                for band in strips::bands(&sent.strip, 3) {
                    let before = found.len();
                    decode(bytes, &sent, &band, &mut found).expect("what was written");
                    assert!(found[before..].iter().all(|(_, p, _)| band.contains(p)));
                }
            }
            found.sort_unstable();
            let mut expected: Vec<(u32, u32, [u32; 2])> = parts
                .iter()
                .flat_map(|(n, f)| f.pixels.iter().zip(&f.found).map(|(p, v)| (*n, *p, *v)))
                .collect();
            expected.sort_unstable();
            assert_eq!(found, expected, "{ranks} ranks");
        }
    }

    #[test]
    fn other_messages_are_refused() {
        let refused_of = |parts: Range<u32>, bytes: &[u8], strip: Range<u32>| {
            let sent = Sent { parts, strip: strip.clone() };
            decode::<u32>(bytes, &sent, &strip, &mut Vec::new()).is_none()
        };
        let refused = |bytes: &[u8], strip: Range<u32>| refused_of(2..4, bytes, strip);
        let mut fragments = Fragments::new();
        (4..9).for_each(|pixel| fragments.push(pixel, pixel));
        let strips = Strips::new(uvec2(5, 2), 1);
        let [bytes] = encode(&strips, &[(2, fragments)]).try_into().expect("one rank");
        for length in 1..bytes.len() {
            assert!(refused(&bytes[..length], 0..10), "{length}");
        }
        assert!(!refused(&bytes, 0..10));
        // Parts of other ranks, and more than there are.
        assert!(refused_of(0..2, &bytes, 0..10) && refused_of(3..9, &bytes, 0..10));
        // Pixels that are there twice, and a run of none.
        assert!(refused(&bytes.repeat(2), 0..10));
        assert!(refused(bytemuck::bytes_of(&[2u32, 4, 0]), 0..10));
        // Pixels outside of the strip.
        assert!(refused(&bytes, 0..8));
        assert!(refused(&bytes, 5..10));
        assert!(refused(&[255; 12], 0..10));
    }
}
