//! What is no texture is refused, and every small texture can be read anywhere.

use proptest::prelude::{any, *};
use raydsl::prelude::{
    Texture1, Texture2, Texture3, TextureConfig, Unorm8, Vec2, Vec3, tex1, tex2, tex3, tex3_level,
};
use raydsl::texture::{Filter, MAX_SIZE, MAX_TEXELS, TextureError, TextureRef3};

use super::{ADDRESSES, FILTERS};

#[test]
fn sizes_that_are_none() {
    let config = TextureConfig::new();
    let texels = [0.0; 6];
    let refused = |size, expected: TextureError| {
        let found = Texture3::new(&texels, size, config).err();
        assert_eq!(found.as_ref(), Some(&expected));
        assert_eq!(TextureRef3::new(&texels, size, config).err(), Some(expected));
    };
    refused([0, 2, 3], TextureError::NoTexels { axis: 0 });
    refused([2, 3, 0], TextureError::NoTexels { axis: 2 });
    refused([2, 3, 2], TextureError::WrongLength { expected: 12, found: 6 });
    refused([1, 2, 2], TextureError::WrongLength { expected: 4, found: 6 });
    let (size, limit) = (MAX_SIZE + 1, MAX_SIZE);
    refused([1, size, 1], TextureError::TooLong { axis: 1, size, limit });
    let (size, count) = ([MAX_SIZE; 3], u128::from(MAX_SIZE).pow(3));
    refused(size, TextureError::TooManyTexels { count, limit: MAX_TEXELS });
    // The product is 2^32: as a number of 32 bits it would be 0.
    let count = 1 << 32;
    refused([1 << 16, 1 << 16, 1], TextureError::TooManyTexels { count, limit: MAX_TEXELS });
    let text = Texture1::new(&texels, [7], config).err().map(|e| e.to_string());
    assert!(text.is_some_and(|t| t.contains("7 texels") && t.contains("exactly that many")));
}

#[test]
fn the_largest_axis() -> Result<(), TextureError> {
    let texels = vec![Unorm8::ZERO; MAX_SIZE as usize - 1];
    let mut texels = texels;
    texels.push(Unorm8::ONE);
    let nearest = TextureConfig::new().filter(Filter::Nearest);
    let texture = Texture1::new(&texels, [MAX_SIZE], nearest)?;
    assert_eq!(tex1(&texture, 1.0f32.next_down()), 1.0);
    assert_eq!(tex1(&texture, 1.0f32.next_down().next_down()), 0.0);
    assert_eq!(tex1(&texture, -1e-9), 1.0);
    Ok(())
}

#[test]
fn a_texture_has_what_it_was_given() -> Result<(), TextureError> {
    let texels = vec![[Unorm8::ONE; 3]; 6];
    let texture = Texture2::new(texels, [2, 3], TextureConfig::new())?;
    assert_eq!((texture.size(), texture.levels()), ([2, 3], 1));
    let other = texture.clone().with_config(TextureConfig::new().filter(Filter::Nearest));
    assert_eq!(other.config().filter, Filter::Nearest);
    assert_eq!(tex2(&other, Vec2::ZERO), Vec3::ONE);
    assert_eq!(texture.texels().len(), 6);
    Ok(())
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        -3.0f32..3.0,
        any::<u32>().prop_map(f32::from_bits),
        (-9i32..9, 1u32..9).prop_map(|(i, n)| i as f32 / n as f32),
        Just(1e9),
        Just(-1e-9),
        Just(f32::NAN),
    ]
}

proptest! {
    /// No coordinate reads outside, which would panic, and values stay near those of the texels.
    #[test]
    fn any_texture_can_be_read_anywhere(
        size in [1u32..6, 1u32..6, 1u32..6],
        modes in [0usize..4, 0usize..4, 0usize..4],
        filter in 0usize..4,
        at in [coordinate(), coordinate(), coordinate()],
        level in coordinate(),
    ) {
        let texels = vec![1.0; size.iter().product::<u32>() as usize];
        let modes = modes.map(|m| ADDRESSES[m]);
        let config = TextureConfig::new().filter(FILTERS[filter]).addresses(modes);
        let made = Texture3::new(&texels, size, config).and_then(|t| t.with_levels());
        let texture = made.map_err(|e| TestCaseError::fail(e.to_string()))?;
        for v in [tex3(&texture, at.into()), tex3_level(&texture, at.into(), level)] {
            prop_assert!((-0.5..=1.5).contains(&v), "{v}");
        }
    }

    /// Whatever sizes are asked for, the answer is a texture or an error.
    #[test]
    fn any_size_has_an_answer(
        size in any::<[u32; 3]>(),
        small in any::<[u8; 3]>(),
        len in 0usize..70,
    ) {
        let texels = vec![0.5; len];
        for size in [size, small.map(u32::from), small.map(|n| u32::from(n % 5))] {
            let made = TextureRef3::new(&texels, size, TextureConfig::new());
            let product: u128 = size.iter().map(|n| u128::from(*n)).product();
            prop_assert_eq!(made.is_ok(), len > 0 && product == len as u128, "{:?}", size);
        }
    }
}
