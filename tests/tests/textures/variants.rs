//! Every variant: the same bits on the CPU, and what rounding explains in WGSL.
//!
//! Each combination of texel and dimension is compiled once; filters and modes are the host's.

use raydsl::assert_variants_agree;
use raydsl::kernel;
use raydsl::kernel::run_batch;
use raydsl::machine::{Lanes, One, Packet, Type};
use raydsl::prelude::*;
use raydsl::texture::{
    Address, AsTextureRef, ColorSpace, Filter, LevelFilter, Texel, TexelValue, TextureError,
};
use raydsl_tests::levels::each_level_padded;
use raydsl_tests::rng::Rng;
use raydsl_tests::run_time::RunTime;

use super::{ADDRESSES, FILTERS};

const ODD: [f32; 12] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    1e9,
    -1e9,
    -1e-9,
    0.0,
    1.0,
    0.5,
    -0.25,
    8388609.0,
    3e38,
];

/// Coordinates, the odd ones among them.
fn points(rng: &mut Rng) -> Vec<(Vec3,)> {
    let odd = |rng: &mut Rng| rng.pick(&ODD);
    let mut all: Vec<_> = (0..150).map(|_| (rng.point(2.5),)).collect();
    all.extend((0..101).map(|_| (vec3(odd(rng), odd(rng), odd(rng)),)));
    all.extend((0..50).map(|_| (vec3(odd(rng), rng.unit(), rng.range(-1.0, 4.0)),)));
    all
}

/// Every filter with every mode along the first axis; the others have others.
fn configs() -> impl Iterator<Item = TextureConfig> {
    FILTERS.into_iter().flat_map(|filter| {
        (0..4).map(move |i| {
            let addresses = [0, 1, 2].map(|axis| ADDRESSES[(i + axis) % 4]);
            let config = TextureConfig::new().filter(filter).border(vec4(0.5, -1.0, 2.0, 0.25));
            config.addresses(addresses)
        })
    })
}

/// What a kernel of one texture gives in every variant.
macro_rules! agree {
    (|$p:ident| $read:expr) => {{
        let inputs = points(&mut Rng::new(40));
        let read = kernel!(|$p: Vec3| $read);
        assert_variants_agree!(&read, &inputs);
    }};
}

#[test]
fn one_dimension() -> Result<(), TextureError> {
    let texels = [0.5, -1.0, 3.0, 0.25, 8.0, 2.0, 1.0];
    for config in configs() {
        let texture = Texture1::new(&texels, [7], config)?;
        one(&texture);
    }
    one(&Texture1::new(&texels[..1], [1], TextureConfig::new().filter(Filter::BSpline))?);
    Ok(())
}

fn one(texture: &Texture1<'_, f32>) {
    agree!(|p| tex1(texture, p.x));
    // Packets of one lane, which no kernel of its own is lifted for.
    let inputs = points(&mut Rng::new(41));
    let mut found = vec![0.0; inputs.len()];
    let lifted = |m: &Packet<One>, (p,): (raydsl::machine::V3<_>,)| {
        tex1::on(m, texture.as_texture_ref(), p.x)
    };
    run_batch::<One, (Vec3,), f32>(One, &lifted, &inputs, &mut found);
    for ((p,), found) in inputs.iter().zip(found) {
        assert_eq!(found, tex1(texture, p.x), "{p}");
    }
}

/// Kinds of lanes that no closure is lifted for.
#[test]
fn every_level() -> Result<(), TextureError> {
    let mut rng = Rng::new(49);
    let texels: Vec<Unorm8> = (0..60).map(|_| Unorm8::new(rng.unit())).collect();
    let inputs = points(&mut Rng::new(50));
    for config in configs() {
        let texture = Texture3::new(&texels, [3, 4, 5], config)?.with_levels()?;
        let expected: Vec<f32> = inputs.iter().map(|(p,)| tex3_level(&texture, *p, p.x)).collect();
        let lifted = |m: &Packet<RunTime<16>>, (p,): (raydsl::machine::V3<_>,)| {
            tex3_level::on(m, texture.as_texture_ref(), p, p.x)
        };
        each_level_padded(&mut |name, lanes, width| {
            // One packet after the other, whose upper lanes hold nothing.
            for (inputs, expected) in inputs.chunks(width).zip(expected.chunks(width)) {
                let m = Packet::with_count(lanes, inputs.len());
                let args = <(Vec3,)>::from_lanes(&m, |l| inputs[l.min(inputs.len() - 1)]);
                let found = lanes.vectorize(|| lifted(&m, args));
                for (l, expected) in expected.iter().enumerate() {
                    let found = f32::lane(&found, l);
                    assert_eq!(found.to_bits(), expected.to_bits(), "{name}: {:?}", inputs[l]);
                }
            }
        });
    }
    Ok(())
}

#[test]
fn two_dimensions() -> Result<(), TextureError> {
    let mut rng = Rng::new(42);
    let texels: Vec<[Unorm8; 4]> =
        (0..35).map(|_| [(); 4].map(|()| Unorm8::new(rng.unit()))).collect();
    for (i, config) in configs().enumerate() {
        let space = [ColorSpace::Linear, ColorSpace::Srgb][i % 2];
        two(&Texture2::new(&texels, [7, 5], config.color_space(space))?);
    }
    two(&Texture2::new(&texels, [35, 1], TextureConfig::new())?);
    Ok(())
}

fn two(texture: &Texture2<'_, [Unorm8; 4]>) {
    agree!(|p| tex2(texture, vec2(p.x, p.y)));
}

#[test]
fn three_dimensions() -> Result<(), TextureError> {
    let mut rng = Rng::new(43);
    let texels: Vec<Vec2> = (0..60).map(|_| vec2(rng.unit(), rng.unit())).collect();
    for config in configs() {
        three(&Texture3::new(&texels, [3, 4, 5], config)?);
    }
    Ok(())
}

fn three(texture: &Texture3<'_, Vec2>) {
    agree!(|p| tex3(texture, p));
}

#[test]
fn levels() -> Result<(), TextureError> {
    let mut rng = Rng::new(44);
    let texels: Vec<Unorm16> = (0..77).map(|_| Unorm16::new(rng.unit())).collect();
    for (filter, level_filter) in [
        (Filter::Linear, LevelFilter::Linear),
        (Filter::Nearest, LevelFilter::Nearest),
        (Filter::CatmullRom, LevelFilter::Linear),
    ] {
        let config = TextureConfig::new().filter(filter).level_filter(level_filter);
        let texture = Texture2::new(&texels, [11, 7], config)?;
        leveled(&texture.with_levels()?);
        leveled(&texture);
    }
    Ok(())
}

fn leveled(texture: &Texture2<'_, Unorm16>) {
    agree!(|p| tex2_level(texture, vec2(p.x, p.y), p.z));
}

/// Tests levels of textures of one and three axes, with a border and in sRGB, like
/// `two_dimensions`.
#[test]
fn levels_of_lines_and_volumes() -> Result<(), TextureError> {
    let mut rng = Rng::new(47);
    let texels: Vec<[Unorm8; 4]> =
        (0..105).map(|_| [(); 4].map(|()| Unorm8::new(rng.unit()))).collect();
    for (i, filter) in FILTERS.into_iter().enumerate() {
        let config = TextureConfig::new()
            .filter(filter)
            .color_space([ColorSpace::Srgb, ColorSpace::Linear][i % 2])
            .level_filter([LevelFilter::Linear, LevelFilter::Nearest][i / 2])
            .addresses([Address::Border, Address::Wrap, Address::Mirror])
            .border(vec4(0.5, -1.0, 2.0, 0.25));
        leveled_line(&Texture1::new(&texels, [105], config)?.with_levels()?);
        leveled_volume(&Texture3::new(&texels, [7, 5, 3], config)?.with_levels()?);
    }
    Ok(())
}

fn leveled_line(texture: &Texture1<'_, [Unorm8; 4]>) {
    agree!(|p| tex1_level(texture, p.x, p.y));
}

fn leveled_volume(texture: &Texture3<'_, [Unorm8; 4]>) {
    agree!(|p| tex3_level(texture, p, p.x * 2.0));
}

/// Some lanes read and others do not, in arms and in loops whose rounds differ.
#[test]
fn lanes_that_do_not_read() -> Result<(), TextureError> {
    let mut rng = Rng::new(48);
    let texels: Vec<Unorm8> = (0..60).map(|_| Unorm8::new(rng.unit())).collect();
    for config in configs() {
        let texture = Texture3::new(&texels, [3, 4, 5], config)?;
        divided(&texture);
        divided(&texture.with_levels()?);
    }
    Ok(())
}

fn divided(texture: &Texture3<'_, Unorm8>) {
    agree!(|p| {
        let mut sum: f32 = 0.0;
        let mut at = p;
        let mut left = select(p.x > 0.5, 3u32, 1u32);
        while left > 0 {
            if at.y > 0.25 {
                sum += tex3_level(texture, at, at.z);
            } else {
                sum += 2.0 * tex3(texture, at);
            }
            at = vec3(at.y, at.z, at.x) * 1.5;
            left -= 1;
        }
        sum
    });
}

/// Texels of every kind are decoded to the same bits.
fn texels<T: Texel>(all: &[T], check: impl Fn(&Texture1<'_, T>)) -> Result<(), TextureError> {
    for space in [ColorSpace::Linear, ColorSpace::Srgb] {
        for filter in [Filter::Nearest, Filter::Linear] {
            let config = TextureConfig::new().filter(filter).color_space(space);
            check(&Texture1::new(all, [all.len() as u32], config)?);
        }
    }
    assert_eq!(T::decode(all[0], ColorSpace::Linear).to_channels()[3..], {
        let n = <T::Value as TexelValue>::CHANNELS;
        if n == 4 {
            T::decode(all[0], ColorSpace::Srgb).to_channels()[3..].to_vec()
        } else {
            vec![0.0]
        }
    });
    Ok(())
}

macro_rules! texel_tests {
    ($($name:ident: $t:ty, $make:expr;)+) => {
        $(
            #[test]
            fn $name() -> Result<(), TextureError> {
                let mut rng = Rng::of(stringify!($name));
                let all: Vec<$t> = (0..67).map(|_| $make(&mut rng)).collect();
                texels(&all, |texture| agree!(|p| tex1(texture, p.x)))
            }
        )+
    };
}

fn half(rng: &mut Rng) -> F16 {
    // Subnormal numbers too, but finite ones.
    F16::from_bits(rng.pick(&[0x8000, 0, 0x400, 0]) | rng.bits() as u16 & 0x3bff)
}

texel_tests! {
    unorm8_2: [Unorm8; 2], |rng: &mut Rng| [(); 2].map(|()| Unorm8::new(rng.unit()));
    unorm8_3: [Unorm8; 3], |rng: &mut Rng| [(); 3].map(|()| Unorm8::new(rng.unit()));
    half3: [F16; 3], |rng: &mut Rng| [(); 3].map(|()| half(rng));
    vector4: Vec4, |rng: &mut Rng| rng.point(2.0).extend(rng.unit());
}

/// Every pattern of 16 bits decodes to the same float in every variant.
#[test]
fn every_half() {
    let inputs: Vec<(u32,)> = (0..1 << 16).map(|code| (code,)).collect();
    let codes: Vec<F16> = (0..=u16::MAX).map(F16::from_bits).collect();
    let codes = &codes[..];
    let decoded = kernel!(|i: u32| codes[i as usize].to_f32());
    assert_variants_agree!(&decoded, &inputs);
}

#[kernel]
fn shade(
    albedo: &Texture2<'_, [Unorm8; 4]>,
    mask: &TextureRef2<'_, [Unorm8; 4]>,
    uv: Vec2,
) -> Vec4 {
    let color = tex2(albedo, uv);
    if tex2(mask, uv).w > 0.5 { color } else { color * 0.25 }
}

/// Kernels take textures and references, and choose between two by a `bool` of the host.
#[test]
fn parameters_and_captures() -> Result<(), TextureError> {
    let texels = [[0, 64, 128, 255], [255, 9, 3, 1]].map(|t| t.map(Unorm8::from_bits));
    let albedo = Texture2::new(&texels, [2, 1], TextureConfig::new().address(Address::Clamp))?;
    let mask = albedo.as_texture_ref().with_config(TextureConfig::new().filter(Filter::Nearest));
    let inputs = points(&mut Rng::new(45));
    let shaded = kernel!(|p: Vec3| shade(&albedo, &mask, vec2(p.x, p.y)));
    assert_variants_agree!(&shaded, &inputs);
    Ok(())
}

/// A device is sent a texture once, and another size or border compiles nothing.
#[test]
fn a_device_keeps_texels_and_code() -> Result<(), Box<dyn std::error::Error>> {
    if raydsl_tests::gpu::gpu().is_none() {
        return Ok(());
    }
    let gpu = GpuScheduler::new()?;
    let texels = [[0, 64, 128, 255]; 6].map(|t| t.map(Unorm8::from_bits));
    let inputs: Vec<(Vec2,)> =
        points(&mut Rng::new(46)).iter().map(|p| (p.0.truncate(),)).collect();
    let run = |texture: &Texture2<'_, [Unorm8; 4]>| {
        let read = kernel!(|uv: Vec2| tex2(texture, uv));
        let mut found = vec![Vec4::ZERO; inputs.len()];
        gpu.batch(&read, &inputs, &mut found)?;
        let sum: Vec4 = found.into_iter().sum();
        let device = gpu.context();
        Ok::<_, raydsl::gpu::GpuError>((sum, device.compiled(), device.uploaded_bytes()))
    };
    let with_border = |c: f32| TextureConfig::new().border(Vec4::splat(c));
    let texture = Texture2::new(&texels, [3, 2], with_border(0.5))?;
    let first = run(&texture)?;
    assert_eq!(run(&texture)?, first);
    let other = Texture2::new(&texels, [2, 3], with_border(0.25))?;
    let (sum, compiled, uploaded) = run(&other)?;
    assert_eq!((compiled, uploaded), (first.1, 2 * first.2));
    assert_ne!(sum, first.0);
    Ok(())
}
