//! The device's own sampler: what it gives is explained by the precision of its weights, and it is
//! used for what it can read and for nothing else.

use raydsl::machine::Rounding;
use raydsl::prelude::*;
use raydsl::testing::explain;
use raydsl::texture::{
    Address, AsTextureRef, ColorSpace, Filter, Filtering, LevelFilter, Texel, TexelValue,
    TextureError,
};
use raydsl_tests::gpu::gpu;
use raydsl_tests::rng::Rng;

/// Those that a sampler has.
const ADDRESSES: [Address; 3] = [Address::Wrap, Address::Mirror, Address::Clamp];

fn config() -> TextureConfig {
    TextureConfig::new().filtering(Filtering::Device)
}

/// Every mode along the first axis, the others with others.
fn configs() -> impl Iterator<Item = TextureConfig> {
    (0..3).map(|i| config().addresses([0, 1, 2].map(|axis| ADDRESSES[(i + axis) % 3])))
}

fn points() -> Vec<(Vec3,)> {
    let mut rng = Rng::new(50);
    let mut all: Vec<_> = (0..200).map(|_| (rng.point(2.5),)).collect();
    // The centres of texels and the borders between them.
    let eighth = |rng: &mut Rng| (rng.range(-16.0, 16.0)).round() / 8.0;
    all.extend((0..50).map(|_| (vec3(eighth(&mut rng), eighth(&mut rng), eighth(&mut rng)),)));
    all
}

fn texels<T: Texel>(count: u32, seed: u64) -> Vec<T> {
    let mut rng = Rng::new(seed);
    let mut value = || T::Value::from_channels([(); 4].map(|()| rng.unit()));
    (0..count).map(|_| T::encode(value(), ColorSpace::Linear)).collect()
}

/// A device's results are explained, and within what 8 bits of each weight and of the result may
/// make of values from 0 to 1: the bounds of an explanation alone would be too wide to mean much.
macro_rules! agree {
    ($kernel:expr, $inputs:expr) => {{
        let (kernel, inputs) = ($kernel, $inputs);
        if let Some(gpu) = gpu() {
            let mut found = vec![Default::default(); inputs.len()];
            gpu.batch(kernel, inputs, &mut found).expect("a device");
            let explanation = explain(kernel, inputs, &found, Rounding::WGSL);
            assert_eq!(explanation.unexplained(), 0, "{:?}", explanation.causes);
            for (input, found) in inputs.iter().zip(found) {
                let (found, expected) = (found.to_channels(), kernel.call(*input).to_channels());
                let apart = |i: usize| (found[i] - expected[i]).abs();
                assert!((0..4).all(|i| apart(i) <= 0.016), "{input:?} {found:?} {expected:?}");
            }
        }
    }};
}

macro_rules! images {
    ($($name:ident: $t:ty, $space:ident;)+) => {
        $(
            #[test]
            fn $name() -> Result<(), TextureError> {
                let texels = texels::<$t>(77, 51);
                for config in configs() {
                    let config = config.color_space(ColorSpace::$space);
                    let image = Texture2::new(&texels, [11, 7], config)?;
                    let read = kernel!(|p: Vec3| tex2(&image, vec2(p.x, p.y)));
                    agree!(&read, &points());
                    assert!(read.wgsl().contains("image_sample(p.xy, 0.0f)"), "{}", read.wgsl());
                }
                Ok(())
            }
        )+
    };
}

images! {
    one_code: Unorm8, Linear;
    two_codes: [Unorm8; 2], Linear;
    four_codes: [Unorm8; 4], Linear;
    four_encoded_codes: [Unorm8; 4], Srgb;
    one_half: F16, Linear;
    two_halves: [F16; 2], Linear;
    four_halves: [F16; 4], Linear;
}

#[test]
fn volumes_and_rows() -> Result<(), TextureError> {
    let texels = texels::<Unorm8>(60, 52);
    for config in configs() {
        let volume = Texture3::new(&texels, [3, 4, 5], config)?;
        agree!(&kernel!(|p: Vec3| tex3(&volume, p)), &points());
        let slice = Texture3::new(&texels, [12, 5, 1], config)?;
        agree!(&kernel!(|p: Vec3| tex3(&slice, p)), &points());
        let row = Texture1::new(&texels, [60], config)?;
        let read = kernel!(|p: Vec3| tex1(&row, p.x));
        agree!(&read, &points());
        assert!(read.wgsl().contains("row_texture: texture_2d<f32>"), "{}", read.wgsl());
    }
    Ok(())
}

#[test]
fn levels_of_detail() -> Result<(), TextureError> {
    let texels = texels::<[Unorm8; 4]>(77, 53);
    for level_filter in [LevelFilter::Nearest, LevelFilter::Linear] {
        let image = Texture2::new(&texels, [11, 7], config().level_filter(level_filter))?;
        let image = image.with_levels()?;
        let read = kernel!(|p: Vec3| tex2_level(&image, vec2(p.x, p.y), p.z));
        agree!(&read, &points());
        assert!(read.wgsl().contains("image_sample("), "{}", read.wgsl());
    }
    Ok(())
}

/// What no sampler reads has the text that it has without one.
#[test]
fn others_are_read_exactly() -> Result<(), TextureError> {
    fn check<T: Texel + Sync>(config: TextureConfig, width: u32) -> Result<(), TextureError> {
        let texels = texels::<T>(2 * width, 54);
        let texts = [Filtering::Device, Filtering::Exact].map(|filtering| {
            let image = Texture2::new(&texels, [width, 2], config.filtering(filtering))?;
            Ok(kernel!(|uv: Vec2| tex2(&image, uv)).wgsl())
        });
        let [device, exact] = texts;
        let (device, exact) = (device?, exact?);
        assert!(!device.contains("textureSampleLevel") && device == exact, "{device}");
        Ok(())
    }
    check::<Unorm8>(config().filter(Filter::Nearest), 5)?;
    check::<Unorm8>(config().filter(Filter::CatmullRom), 5)?;
    check::<Unorm8>(config().border(vec4(1.0, 0.0, 0.0, 0.0)), 5)?;
    check::<Unorm8>(config().color_space(ColorSpace::Srgb), 5)?;
    check::<[Unorm8; 3]>(config(), 5)?;
    check::<Unorm16>(config(), 5)?;
    check::<Vec4>(config(), 5)?;
    check::<Unorm8>(config(), 8193)
}

/// WebGPU guarantees no more; the seventeenth is read exactly.
#[test]
fn a_kernel_has_sixteen() -> Result<(), TextureError> {
    let texels = texels::<Unorm8>(4, 55);
    let new = || Texture2::new(&texels, [2, 2], config());
    let all = (0..17).map(|_| new()).collect::<Result<Vec<_>, _>>()?;
    let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q] = &all[..] else { return Ok(()) };
    let sum = kernel!(|uv: Vec2| {
        let first = tex2(a, uv) + tex2(b, uv) + tex2(c, uv) + tex2(d, uv) + tex2(e, uv);
        let second = tex2(f, uv) + tex2(g, uv) + tex2(h, uv) + tex2(i, uv) + tex2(j, uv);
        let third = tex2(k, uv) + tex2(l, uv) + tex2(m, uv) + tex2(n, uv) + tex2(o, uv);
        (first + second + third + tex2(p, uv) + tex2(q, uv)) / 17.0
    });
    let text = sum.wgsl();
    assert_eq!(text.matches("textureSampleLevel(").count(), 16, "{text}");
    assert_eq!(text.matches("var<storage, read> q").count(), 1, "{text}");
    let places: Vec<_> = points().into_iter().map(|(p,)| (vec2(p.x, p.y),)).collect();
    agree!(&sum, &places);
    Ok(())
}

/// The same texels as two pictures of other sizes.
#[cfg(feature = "gpu")]
#[test]
fn sizes_of_one_slice_are_told_apart() -> Result<(), Box<dyn std::error::Error>> {
    use raydsl::gpu::GpuScheduler;
    if gpu().is_none() {
        return Ok(());
    }
    let gpu = GpuScheduler::new()?;
    let texels = texels::<Unorm8>(77, 57);
    let wide = TextureRef2::new(&texels, [11, 7], config())?;
    let tall = TextureRef2::new(&texels, [7, 11], config())?;
    let both = kernel!(|uv: Vec2| vec2(tex2(&wide, uv), tex2(&tall, uv)));
    let (of_wide, of_tall) =
        (kernel!(|uv: Vec2| tex2(&wide, uv)), kernel!(|uv: Vec2| tex2(&tall, uv)));
    let places = [0.1, 0.3, 0.55, 0.9].map(|x| (vec2(x, 0.7 - 0.5 * x),));
    let (mut found, mut expected) = ([Vec2::ZERO; 4], [[0.0; 4]; 2]);
    gpu.batch(&both, &places, &mut found)?;
    gpu.batch(&of_wide, &places, &mut expected[0])?;
    gpu.batch(&of_tall, &places, &mut expected[1])?;
    assert_ne!(expected[0], expected[1]);
    assert_eq!(found.map(|v| v.x), expected[0]);
    assert_eq!(found.map(|v| v.y), expected[1]);
    Ok(())
}

/// Texels are sent as they lie, once, and are gone with their texture; those of a slice are gone
/// when the kernel has run.
#[cfg(feature = "gpu")]
#[test]
fn texels_are_sent_once() -> Result<(), Box<dyn std::error::Error>> {
    use raydsl::gpu::GpuScheduler;
    if gpu().is_none() {
        return Ok(());
    }
    let gpu = GpuScheduler::new()?;
    let texels = texels::<Unorm8>(77, 56);
    let places = [(vec2(0.1, 0.9),); 3];
    let mut found = [0.0; 3];
    {
        let image = Texture2::new(&texels, [11, 7], config())?;
        let other_way = image.as_texture_ref().with_config(config().address(Address::Clamp));
        let sum = kernel!(|uv: Vec2| tex2(&image, uv) + tex2(&other_way, uv));
        for _ in 0..2 {
            gpu.batch(&sum, &places, &mut found)?;
            assert_eq!((gpu.context().uploaded_bytes(), gpu.context().scene_bytes()), (77, 77));
        }
    }
    let slice = TextureRef2::new(&texels, [7, 11], config())?;
    let read = kernel!(|uv: Vec2| tex2(&slice, uv));
    for sent in [2 * 77, 3 * 77] {
        gpu.batch(&read, &places, &mut found)?;
        assert_eq!((gpu.context().uploaded_bytes(), gpu.context().scene_bytes()), (sent, 0));
    }
    Ok(())
}
