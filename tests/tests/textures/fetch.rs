//! Texels by their places: which one is read, everywhere and in every variant.

use raydsl::machine::{Lanes, Packet, Type};
use raydsl::prelude::*;
use raydsl::testing::run;
use raydsl::texture::{
    Address, AsTextureRef, ColorSpace, Filtering, Texel, TexelValue, Texture, TextureError,
};
use raydsl::{assert_variants_agree, kernel, variant_test};
use raydsl_tests::filters::texel_at;
use raydsl_tests::levels::each_level_padded;
use raydsl_tests::rng::Rng;
use raydsl_tests::run_time::RunTime;

use super::{ADDRESSES, FILTERS};

/// Places inside and outside, some as far as a number goes.
fn place(rng: &mut Rng) -> i32 {
    let far = [i32::MIN, i32::MIN + 1, i32::MAX, i32::MAX - 1, 1 << 24, -(1 << 24), -1, 0];
    match rng.below(4) {
        0 => rng.pick(&far),
        1 => rng.bits() as i32,
        _ => rng.below(40) as i32 - 20,
    }
}

fn places(seed: u64, count: usize) -> Vec<(IVec3, u32)> {
    let mut rng = Rng::new(seed);
    let levels = [0, 0, 1, 2, 3, 9, 31, 32, u32::MAX];
    let place = |rng: &mut Rng| ivec3(place(rng), place(rng), place(rng));
    (0..count).map(|_| (place(&mut rng), rng.pick(&levels))).collect()
}

/// Every mode along each axis, and every filter, which has no effect.
fn configs() -> impl Iterator<Item = TextureConfig> {
    (0..4).map(|i| {
        let addresses = [0, 1, 2].map(|axis| ADDRESSES[(i + axis) % 4]);
        let config = TextureConfig::new().filter(FILTERS[i]).border(vec4(-2.0, -3.0, -4.0, -5.0));
        config.addresses(addresses)
    })
}

/// A texel and the number of texels along each axis.
type Found = (f32, UVec3);

/// The texel at a place, and the size of its level, by definition.
fn expected<const D: usize>(texture: &Texture<'_, f32, D>, place: IVec3, level: u32) -> Found {
    let level = level.min(texture.levels() - 1);
    let config = texture.config();
    let size_of = |level: u32| {
        let mut size = UVec3::ONE;
        for (axis, n) in texture.size().into_iter().enumerate() {
            size[axis] = (n >> level).max(1);
        }
        size
    };
    let size = size_of(level);
    let first: usize = (0..level).map(|l| size_of(l).element_product() as usize).sum();
    let along = |axis: usize| {
        let mode = if axis < D { config.address[axis] } else { Address::Clamp };
        texel_at(place[axis].into(), size[axis].into(), mode)
    };
    let in_level = (|| {
        let [w, h] = [size.x, size.y].map(i64::from);
        Some((along(2)? * h + along(1)?) * w + along(0)?)
    })();
    let texel = in_level.map_or(config.border.x, |i| texture.texels()[first + i as usize]);
    (texel, size)
}

/// Checks what is read of textures of these sizes, with levels and without, in every mode.
fn check<const D: usize>(
    sizes: [[u32; D]; 3],
    read: impl Fn(&Texture<'_, f32, D>, &[(IVec3, u32)]) -> Vec<Found>,
) -> Result<(), TextureError> {
    let inputs = places(60, 600);
    for (size, config) in sizes.into_iter().flat_map(|s| configs().map(move |c| (s, c))) {
        // No two are the same.
        let texels: Vec<f32> = (0..size.iter().product()).map(|i: u32| (i * i) as f32).collect();
        let texture = Texture::new(texels, size, config)?;
        for texture in [texture.with_levels()?, texture] {
            for ((p, level), found) in inputs.iter().zip(read(&texture, &inputs)) {
                let expected = expected(&texture, *p, *level);
                assert_eq!(found, expected, "{size:?} {config:?}: {p} of level {level}");
            }
        }
    }
    Ok(())
}

#[variant_test]
fn texels_of_lines(variant: Variant) -> Result<(), TextureError> {
    check([[1], [7], [16]], |line, inputs| {
        let read = kernel!(|p: IVec3, level: u32| {
            (tex1_fetch(line, p.x, level), uvec3(tex1_texels(line, level), 1, 1))
        });
        run(&read, variant, inputs)
    })
}

#[variant_test]
fn texels_of_images(variant: Variant) -> Result<(), TextureError> {
    check([[1, 1], [7, 5], [2, 9]], |image, inputs| {
        let read = kernel!(|p: IVec3, level: u32| {
            (tex2_fetch(image, p.truncate(), level), tex2_texels(image, level).extend(1))
        });
        run(&read, variant, inputs)
    })
}

#[variant_test]
fn texels_of_volumes(variant: Variant) -> Result<(), TextureError> {
    check([[1, 1, 1], [3, 4, 5], [8, 1, 2]], |volume, inputs| {
        let read = kernel!(|p: IVec3, level: u32| {
            (tex3_fetch(volume, p, level), tex3_texels(volume, level))
        });
        run(&read, variant, inputs)
    })
}

/// Kinds of lanes that no closure is lifted for.
#[test]
fn every_level() -> Result<(), TextureError> {
    let mut rng = Rng::new(61);
    let texels: Vec<Unorm8> = (0..60).map(|_| Unorm8::new(rng.unit())).collect();
    let inputs = places(62, 400);
    for config in configs() {
        let texture = Texture3::new(&texels, [3, 4, 5], config)?;
        for texture in [texture.with_levels()?, texture] {
            let expected: Vec<f32> =
                inputs.iter().map(|(p, level)| tex3_fetch(&texture, *p, *level)).collect();
            each_level_padded(&mut |name, lanes, width| {
                // One packet after the other, whose upper lanes hold nothing.
                for (inputs, expected) in inputs.chunks(width).zip(expected.chunks(width)) {
                    let m: Packet<RunTime<16>> = Packet::with_count(lanes, inputs.len());
                    let args = <(IVec3, u32)>::from_lanes(&m, |l| inputs[l.min(inputs.len() - 1)]);
                    let found = lanes
                        .vectorize(|| tex3_fetch::on(&m, texture.as_texture_ref(), args.0, args.1));
                    for (l, expected) in expected.iter().enumerate() {
                        assert_eq!(f32::lane(&found, l), *expected, "{name}: {:?}", inputs[l]);
                    }
                }
            });
        }
    }
    Ok(())
}

/// Some lanes read and others do not, in arms and in loops whose rounds differ.
#[test]
fn lanes_that_do_not_read() -> Result<(), TextureError> {
    let texels: Vec<[Unorm8; 4]> =
        (0..60).map(|i| [i, 2 * i, 3 * i, 4 * i].map(Unorm8::from_bits)).collect();
    let inputs = places(63, 300);
    for config in configs() {
        let texture = Texture3::new(&texels, [3, 4, 5], config)?.with_levels()?;
        let read = kernel!(|p: IVec3, level: u32| {
            let mut sum = vec4(0.0, 0.0, 0.0, 0.0);
            let mut at = p;
            let mut left = level % 4;
            while left > 0 {
                if at.x > at.y {
                    sum += tex3_fetch(&texture, at, level);
                } else if at.z > 3 {
                    sum += 2.0 * tex3_fetch(&texture, at.zxy(), left);
                }
                at = ivec3(at.y, at.z, at.x.wrapping_mul(3));
                left -= 1;
            }
            sum
        });
        assert_variants_agree!(&read, &inputs);
    }
    Ok(())
}

/// Texels of every kind are decoded as filters decode them.
macro_rules! kinds {
    ($($name:ident: $t:ty;)+) => {
        $(
            #[test]
            fn $name() -> Result<(), TextureError> {
                let mut rng = Rng::of(stringify!($name));
                let mut channels = || [(); 4].map(|()| rng.unit());
                let all: Vec<$t> = (0..67)
                    .map(|_| {
                        let value = TexelValue::from_channels(channels());
                        <$t>::encode(value, ColorSpace::Linear)
                    })
                    .collect();
                for space in [ColorSpace::Linear, ColorSpace::Srgb] {
                    let config = TextureConfig::new().color_space(space);
                    let line = Texture1::new(&all, [67], config)?;
                    let read = kernel!(|i: i32| tex1_fetch(&line, i, 0));
                    let inputs: Vec<(i32,)> = (-67..67).map(|i| (i,)).collect();
                    assert_variants_agree!(&read, &inputs);
                    for (i, texel) in all.iter().enumerate() {
                        assert_eq!(read.call((i as i32,)), texel.decode(space));
                    }
                }
                Ok(())
            }
        )+
    };
}

kinds! {
    bytes: Unorm8;
    two_bytes: [Unorm8; 2];
    three_bytes: [Unorm8; 3];
    four_bytes: [Unorm8; 4];
    codes: Unorm16;
    three_codes: [Unorm16; 3];
    halves: F16;
    two_halves: [F16; 2];
    array: [f32; 1];
    vectors_of_two: Vec2;
    vectors_of_three: Vec3;
    vectors_of_four: Vec4;
}

/// What a sampler filters, a fetch reads from a buffer: exactly.
#[test]
fn sampled_textures_are_fetched_exactly() -> Result<(), Box<dyn std::error::Error>> {
    let codes: Vec<Unorm8> = (0..77).map(|i| Unorm8::from_bits(3 * i)).collect();
    let config = TextureConfig::new().filtering(Filtering::Device);
    let image = Texture2::new(&codes, [11, 7], config)?;
    let read = kernel!(|p: IVec2| tex2_fetch(&image, p, 0));
    assert!(!read.wgsl().contains("textureSampleLevel("), "{}", read.wgsl());
    let both = kernel!(|p: IVec2| {
        let middle = (p.as_vec2() + 0.5) / tex2_texels(&image, 0).as_vec2();
        (tex2_fetch(&image, p, 0), tex2(&image, middle))
    });
    let text = both.wgsl();
    assert_eq!(text.matches("textureSampleLevel(").count(), 1, "{text}");
    let inputs: Vec<(IVec2,)> = (0..77).map(|i| (ivec2(i % 11, i / 11),)).collect();
    assert_variants_agree!(&read, &inputs);
    let Some(gpu) = raydsl_tests::gpu::gpu() else { return Ok(()) };
    let mut found = vec![(0.0, 0.0); inputs.len()];
    gpu.batch(&both, &inputs, &mut found)?;
    for ((fetched, sampled), code) in found.into_iter().zip(&codes) {
        assert_eq!(fetched, code.to_f32());
        assert!((sampled - fetched).abs() <= 0.016, "{sampled}, not {fetched}");
    }
    Ok(())
}

/// The sum of the texels around one, by a kernel of any texture.
#[kernel]
fn around(image: &Texture2<'_, f32>, at: IVec2, level: u32) -> f32 {
    let mut sum: f32 = 0.0;
    for y in -1..=1 {
        for x in -1..=1 {
            sum += tex2_fetch(image, at + ivec2(x, y), level);
        }
    }
    sum
}

/// A parameter; literals as coordinates and levels; and another size compiles nothing.
#[test]
fn parameters_and_literals() -> Result<(), TextureError> {
    let texels: Vec<f32> = (0..12).map(|i| i as f32).collect();
    let text = [([4, 3], 45.0), ([6, 2], 27.0)].map(|(size, sum)| {
        let image = Texture2::new(&texels, size, TextureConfig::new())?;
        let read = kernel!(|at: IVec2| {
            let last = tex2_texels(&image, 0) - uvec2(1, 1);
            let corner = tex2_fetch(&image, last.as_ivec2(), 0);
            around(&image, at, 0) + 100.0 * corner + tex2_fetch(&image, ivec2(-1, -1), 0)
        });
        let inputs: Vec<(IVec2,)> = (-9..9).map(|i| (ivec2(i, 3 - i),)).collect();
        assert_variants_agree!(&read, &inputs);
        assert_eq!(read.call((ivec2(1, 1),)), sum + 1111.0);
        Ok(read.wgsl())
    });
    let [first, second] = text;
    assert_eq!(first?, second?);
    Ok(())
}
