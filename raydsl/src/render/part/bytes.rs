//! Parts of films as bytes, for files and messages.

use glam::{DVec4, Vec4, uvec2};

use super::tree::{Node, Place, largest};
use super::{FilmExtent, FilmPart, PartError};
use crate::render::moments::Sums;

/// The bytes of an extent: eight numbers.
const HEADER: usize = size_of::<[u32; 8]>();

/// The bytes of a pixel in a leaf, whose moments are `f32`, and in any other subtree.
const LEAF_PIXEL: usize = size_of::<[f32; 8]>();
const SUM_PIXEL: usize = size_of::<[f64; 8]>();

impl FilmPart {
    /// Returns the part as bytes, little-endian, without loss: 32 for each pixel of a block of
    /// samples that is alone, 64 for each pixel of a larger subtree.
    pub fn to_bytes(&self) -> Vec<u8> {
        let (film, origin) = (self.extent.film(), self.extent.origin());
        let (size, samples) = (self.extent.size(), self.extent.samples());
        let header =
            [film.x, film.y, origin.x, origin.y, size.x, size.y, samples.start, samples.end];
        let mut bytes: Vec<u8> = header.iter().flat_map(|n| n.to_le_bytes()).collect();
        for node in &self.nodes {
            for Sums { mean, m2, .. } in &node.pixels {
                let numbers = [*mean, *m2].into_iter().flat_map(|v| v.to_array());
                if node.is_leaf() {
                    bytes.extend(numbers.flat_map(|v| (v as f32).to_le_bytes()));
                } else {
                    bytes.extend(numbers.flat_map(f64::to_le_bytes));
                }
            }
        }
        bytes
    }

    /// Returns the part that [`FilmPart::to_bytes`] wrote.
    ///
    /// # Errors
    ///
    /// If there is no such window or range of samples, or the number of bytes is another one than
    /// theirs. Nothing is allocated for more pixels than there are bytes for.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PartError> {
        let found = bytes.len() as u64;
        let Some((header, mut rest)) = bytes.split_at_checked(HEADER) else {
            return Err(PartError::Length { expected: HEADER as u64, found });
        };
        let mut words =
            header.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let mut word = || words.next().unwrap_or_default();
        let (film, origin, size) =
            (uvec2(word(), word()), uvec2(word(), word()), uvec2(word(), word()));
        let extent = FilmExtent::new(film, origin, size, word()..word())?;
        let places = largest(extent.blocks());
        let expected = length(&extent, &places);
        if expected != u128::from(found) {
            let expected = u64::try_from(expected).unwrap_or(u64::MAX);
            return Err(PartError::Length { expected, found });
        }
        let mut nodes = Vec::with_capacity(places.len());
        for place in places {
            // The length was checked.
            let (bytes, others) = rest.split_at(extent.area() * pixel_length(place));
            rest = others;
            let count = samples_in(&extent, place);
            let pixels = bytes.chunks_exact(pixel_length(place));
            let pixels = pixels.map(|bytes| {
                let [mean, m2] = moments(place, bytes);
                Sums { count, mean, m2 }
            });
            nodes.push(Node::at(place, pixels.collect()));
        }
        Ok(Self { extent, nodes })
    }
}

fn pixel_length(place: Place) -> usize {
    if place.level == 0 { LEAF_PIXEL } else { SUM_PIXEL }
}

/// Returns the number of bytes of a part.
fn length(extent: &FilmExtent, places: &[Place]) -> u128 {
    let of_a_pixel: usize = places.iter().map(|place| pixel_length(*place)).sum();
    let area = u128::from(extent.size().x) * u128::from(extent.size().y);
    HEADER as u128 + area * of_a_pixel as u128
}

/// Returns the number of samples of each pixel in a subtree.
fn samples_in(extent: &FilmExtent, place: Place) -> u64 {
    let block = u64::from(super::SAMPLE_BLOCK);
    let blocks = place.blocks();
    (blocks.end * block).min(u64::from(extent.samples().end)) - blocks.start * block
}

/// Returns the mean and the sum of squared deviations of a pixel.
fn moments(place: Place, bytes: &[u8]) -> [DVec4; 2] {
    let vectors: [[usize; 4]; 2] = [[0, 1, 2, 3], [4, 5, 6, 7]];
    if place.level == 0 {
        let number = |i: usize| {
            let b = &bytes[4 * i..];
            f32::from_le_bytes([b[0], b[1], b[2], b[3]])
        };
        vectors.map(|v| Vec4::from_array(v.map(number)).as_dvec4())
    } else {
        let number = |i: usize| {
            let b = &bytes[8 * i..];
            f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])
        };
        vectors.map(|v| DVec4::from_array(v.map(number)))
    }
}
