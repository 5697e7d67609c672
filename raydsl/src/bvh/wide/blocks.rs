//! Primitives in blocks of eight, in structure-of-arrays layout.

use super::collapse::Range;
use super::node::{NO_BOXES, Planes, WIDTH, set_box};
use super::prefetch::prefetch;
use crate::bvh::build::tasks;
use crate::geometry::{Aabb, Primitive, SharedSlices};
use crate::machine::{Leaves, Machine, Schema, Type, Value, op};

/// One word of each of eight primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Row(pub(crate) [u32; WIDTH]);

/// Blocks of primitives in the order of the tree.
///
/// A block has a row for each word of a primitive in the host's layout, and a row of primitive ids.
/// Unused lanes repeat the first primitive.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    rows: Vec<Row>,
    /// Rows per block, for code that is not generic over the primitive.
    height: usize,
    /// The boxes of each block's primitives, if they [have boxes](has_boxes).
    boxes: Vec<Boxes>,
}

/// The boxes of a block's primitives.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Boxes(Planes);

/// Whether blocks have the boxes of their primitives: tests of primitives that take longer than
/// those of boxes are worth a test of their own box first.
pub(super) const fn has_boxes<P: Primitive>() -> bool {
    !P::IS_SHORT
}

/// Fills a block with the primitives of these ids; the bytes are scratch space for one of them.
type Fill<'a> = &'a (dyn Fn(&mut [Row], &[u32], &mut [u8]) + Sync);

/// What blocks are filled with.
struct Contents<'a> {
    fill: Fill<'a>,
    /// Has the primitives of these ids fetched, which are wanted soon.
    prefetch: &'a (dyn Fn(&[u32]) + Sync),
}

/// Blocks between one that is filled and one whose primitives are fetched: as many lines as a core has
/// under way.
const AHEAD: usize = 4;

/// Maximum number of blocks: eight times the number of each, and a slot, fit in a word.
const MOST_BLOCKS: usize = 1 << 29;

/// Blocks per task.
const PIECE: usize = 512;

impl Blocks {
    /// Builds the blocks of these ranges of the index list.
    pub(super) fn of<P: Primitive>(
        prims: &[P],
        shared: SharedSlices<'_, P>,
        indices: &[u32],
        ranges: &[Range],
    ) -> Self {
        assert!(
            ranges.len() <= MOST_BLOCKS,
            "a wide tree has at most 2^29 blocks: build a binary one"
        );
        let contents = Contents {
            fill: &|block, ids, bytes| fill(block, prims, ids, bytes),
            prefetch: &|ids| ids.iter().for_each(|&id| prefetch(&prims[id as usize])),
        };
        let mut blocks = Self::filled(words_of::<P>() + 1, indices, ranges, &contents);
        if const { has_boxes::<P>() } {
            blocks.add_boxes(&|id| prims[id as usize].get_bounds(shared));
        }
        blocks
    }

    /// Adds the boxes of all primitives.
    fn add_boxes(&mut self, bounds: &(dyn Fn(u32) -> Aabb + Sync)) {
        let mut boxes = vec![Boxes(NO_BOXES); self.len()];
        tasks::map_pieces_mut(&mut boxes, PIECE, |first, boxes| {
            for (block, Boxes(planes)) in boxes.iter_mut().enumerate() {
                for (slot, &id) in self.members(first + block).iter().enumerate() {
                    set_box(planes, slot, bounds(id));
                }
            }
        });
        self.boxes = boxes;
    }

    /// Builds blocks of `height` rows, each of the primitives of its range.
    fn filled(height: usize, indices: &[u32], ranges: &[Range], contents: &Contents<'_>) -> Self {
        // Zeros come from the system page by page, to the threads that write there.
        let mut rows: Vec<Row> = bytemuck::zeroed_vec(height * ranges.len());
        tasks::map_pieces_mut(&mut rows, PIECE * height, |first, rows| {
            let mut bytes = vec![0; 4 * (height - 1)];
            let ranges = &ranges[first / height..];
            let ids = |range: &Range| &indices[range.first as usize..][..range.count as usize];
            for (k, (block, range)) in rows.chunks_exact_mut(height).zip(ranges).enumerate() {
                if let Some(later) = ranges.get(k + AHEAD) {
                    (contents.prefetch)(ids(later));
                }
                (contents.fill)(block, ids(range), &mut bytes);
            }
        });
        Self { rows, height, boxes: Vec::new() }
    }

    /// Returns the rows of a block of these primitives; the last one has their ids.
    #[inline(always)]
    pub(crate) fn block<P: Primitive>(&self, index: usize) -> &[Row] {
        let height = const { words_of::<P>() + 1 };
        &self.rows[index * height..][..height]
    }

    /// Returns the boxes of a block's primitives, which [have boxes](has_boxes).
    #[inline(always)]
    pub(super) fn boxes(&self, index: usize) -> &Planes {
        &self.boxes[index].0
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len() / self.height
    }

    /// Returns the ids of a block's primitives, each once.
    pub(super) fn members(&self, index: usize) -> &[u32] {
        let Row(ids) = &self.rows[(index + 1) * self.height - 1];
        let again = ids[1..].iter().position(|&id| id == ids[0]);
        &ids[..again.map_or(WIDTH, |k| k + 1)]
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.rows[..]) + size_of_val(&self.boxes[..])
    }
}

fn fill<P: Primitive>(block: &mut [Row], prims: &[P], ids: &[u32], bytes: &mut [u8]) {
    let Some((id_row, words)) = block.split_last_mut() else { return };
    id_row.0 = each_once(ids);
    for (lane, &id) in id_row.0.iter().enumerate() {
        prims[id as usize].write(bytes);
        for (row, word) in words.iter_mut().zip(bytes.chunks_exact(4)) {
            row.0[lane] = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        }
    }
}

/// Returns the ids, each once, padded with the first one: a primitive with spatial splits may be in
/// two leaves that became one block.
fn each_once(ids: &[u32]) -> [u32; WIDTH] {
    let mut once = [ids[0]; WIDTH];
    let mut count = 0;
    for &id in ids {
        if !once[..count].contains(&id) {
            once[count] = id;
            count += 1;
        }
    }
    once
}

/// Returns the size of a primitive in words.
const fn words_of<P: Type>() -> usize {
    P::SCHEMA.size().div_ceil(4)
}

/// The offset and the size of a scalar in the bytes of a value.
#[derive(Clone, Copy)]
struct Spot {
    offset: u16,
    size: u8,
}

/// Maximum number of scalars of a primitive in blocks.
const MOST: usize = 256;

/// Appends the scalars of a structure in order of declaration to the first `n` spots.
const fn spots(schema: &Schema, at: usize, spots: &mut [Spot; MOST], n: usize) -> usize {
    const fn scalar(size: usize, at: usize, spots: &mut [Spot; MOST], n: usize) -> usize {
        assert!(n < MOST && at + size <= 65536, "a primitive has at most 256 scalars and 64 KiB");
        spots[n] = Spot { offset: at as u16, size: size as u8 };
        n + 1
    }
    match schema {
        Schema::F32 | Schema::I32 | Schema::U32 | Schema::Kind { .. } => scalar(4, at, spots, n),
        Schema::Bool => scalar(1, at, spots, n),
        Schema::Small { bytes } => scalar(*bytes, at, spots, n),
        Schema::Vector(element, count) => {
            let size = match element {
                Schema::Bool => 1,
                _ => 4,
            };
            many(element, *count, size, at, spots, n)
        }
        Schema::Array { element, count, stride } => many(element, *count, *stride, at, spots, n),
        Schema::Struct { fields, .. } => {
            let (mut n, mut i) = (n, 0);
            while i < fields.len() {
                n = self::spots(fields[i].schema, at + fields[i].offset, spots, n);
                i += 1;
            }
            n
        }
        Schema::Host => n,
    }
}

const fn many(
    element: &Schema,
    count: usize,
    stride: usize,
    at: usize,
    spots: &mut [Spot; MOST],
    n: usize,
) -> usize {
    let (mut n, mut i) = (n, 0);
    while i < count {
        n = self::spots(element, at + i * stride, spots, n);
        i += 1;
    }
    n
}

/// The spots of a type, as a constant.
struct Spots<T>(core::marker::PhantomData<T>);

impl<T: Type> Spots<T> {
    const ALL: [Spot; MOST] = {
        let mut all = [Spot { offset: 0, size: 0 }; MOST];
        spots(T::SCHEMA, 0, &mut all, 0);
        all
    };
}

/// Reads a value from its words in the host's layout.
#[inline(always)]
pub(crate) fn read<M: Machine, T: Type>(m: &M, word: impl Fn(usize) -> M::U32) -> T::On<M> {
    let zero = T::On::zero(m);
    T::On::zip(m, zero, zero, &mut Reader::<_, T> { word, next: 0, of: core::marker::PhantomData })
}

struct Reader<W, T> {
    word: W,
    next: usize,
    of: core::marker::PhantomData<T>,
}

impl<W, T: Type> Reader<W, T> {
    #[inline(always)]
    fn take<M: Machine>(&mut self, m: &M) -> M::U32
    where
        W: Fn(usize) -> M::U32,
    {
        let Spot { offset, size } = Spots::<T>::ALL[self.next];
        self.next += 1;
        let (word, bit) = ((self.word)(offset as usize / 4), 8 * (offset as u32 % 4));
        if size == 4 {
            return word;
        }
        let shifted = m.u32_binary(op::Shr, word, m.u32(bit));
        m.u32_binary(op::And, shifted, m.u32((1 << (8 * size)) - 1))
    }
}

impl<M: Machine, W: Fn(usize) -> M::U32, T: Type> Leaves<M> for Reader<W, T> {
    #[inline(always)]
    fn f32(&mut self, m: &M, _: M::F32, _: M::F32) -> M::F32 {
        let bits = self.take(m);
        m.f32_from_bits(bits)
    }
    #[inline(always)]
    fn i32(&mut self, m: &M, _: M::I32, _: M::I32) -> M::I32 {
        let bits = self.take(m);
        m.u32_to_i32(bits)
    }
    #[inline(always)]
    fn u32(&mut self, m: &M, _: M::U32, _: M::U32) -> M::U32 {
        self.take(m)
    }
    #[inline(always)]
    fn bool(&mut self, m: &M, _: M::Bool, _: M::Bool) -> M::Bool {
        let bits = self.take(m);
        m.u32_compare(op::Ne, bits, m.u32(0))
    }
}
