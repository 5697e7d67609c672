//! Partition of a scene buffer into wgpu buffers.

/// Bytes `start..end` of a scene buffer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Span {
    pub(super) start: u64,
    pub(super) end: u64,
}

impl Span {
    /// Returns the number of bytes.
    pub(super) fn len(self) -> u64 {
        self.end - self.start
    }

    /// Returns whether `other` lies within. An empty span holds nothing but itself: a window
    /// without elements gets a buffer of its own.
    pub(super) fn holds(self, other: Span) -> bool {
        if self.len() == 0 || other.len() == 0 {
            return self == other;
        }
        self.start <= other.start && other.end <= self.end
    }
}

/// Groups windows, in their order, into as few chunks as the device allows.
///
/// A chunk holds whole windows only, since a binding cannot cross buffers; it stays within
/// `max_bytes`, except that a window larger than that stays alone for the caller to refuse;
/// and every window in it starts at a multiple of `alignment`.
pub(super) fn plan(windows: &[Span], max_bytes: u64, alignment: u64) -> Vec<Span> {
    let mut chunks: Vec<Span> = Vec::new();
    for &window in windows {
        if chunks.iter().any(|chunk| chunk.holds(window)) {
            continue;
        }
        match chunks.last_mut() {
            Some(last) if continues(*last, window, max_bytes, alignment) => last.end = window.end,
            _ => chunks.push(window),
        }
    }
    chunks
}

/// Returns whether `window` may be appended to `chunk`.
fn continues(chunk: Span, window: Span, max_bytes: u64, alignment: u64) -> bool {
    let offset = chunk.len();
    chunk.end == window.start
        && offset > 0
        && window.len() > 0
        && offset.is_multiple_of(alignment)
        && offset + window.len() <= max_bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spans(borders: &[u64]) -> Vec<Span> {
        borders.windows(2).map(|pair| Span { start: pair[0], end: pair[1] }).collect()
    }

    #[test]
    fn aligned_windows_share_a_buffer() {
        assert_eq!(plan(&spans(&[0, 256, 512, 700]), 1 << 20, 32), spans(&[0, 700]));
    }

    #[test]
    fn large_data_is_cut_at_window_borders() {
        assert_eq!(plan(&spans(&[0, 256, 512, 700]), 512, 32), spans(&[0, 512, 700]));
    }

    #[test]
    fn unaligned_windows_stay_apart() {
        assert_eq!(plan(&spans(&[0, 36, 72]), 1 << 20, 32), spans(&[0, 36, 72]));
    }

    #[test]
    fn windows_already_covered_add_nothing() {
        let mut windows = spans(&[0, 256, 512]);
        windows.push(Span { start: 128, end: 256 });
        assert_eq!(plan(&windows, 1 << 20, 32), spans(&[0, 512]));
    }

    #[test]
    fn an_empty_window_gets_a_buffer() {
        assert_eq!(plan(&spans(&[0, 0]), 1 << 20, 32), spans(&[0, 0]));
    }
}
