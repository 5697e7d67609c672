//! Levels of detail.

use raydsl::prelude::*;
use raydsl::texture::{ColorSpace, Filter, LevelFilter, TextureError};
use raydsl_tests::rng::Rng;

#[test]
fn each_is_the_mean_of_the_one_before() -> Result<(), TextureError> {
    let texels: Vec<f32> = (0..8).map(|i| i as f32).collect();
    let nearest = TextureConfig::new().filter(Filter::Nearest);
    let texture = Texture2::new(&texels, [4, 2], nearest)?.with_levels()?;
    assert_eq!(texture.levels(), 3);
    assert_eq!(texture.texels()[8..], [2.5, 4.5, 3.5]);
    // Odd sizes: 5 texels become 2, each with half of the middle one.
    let odd = Texture1::new(&[1.0, 2.0, 3.0, 4.0, 5.0], [5], nearest)?.with_levels()?;
    assert_eq!(odd.texels()[5..], [1.8, 4.2, 3.0]);
    Ok(())
}

/// In linear space: black and white make a code of 188, not of 128.
#[test]
fn means_are_linear() -> Result<(), TextureError> {
    let texels = [[0, 0, 0, 0], [255, 255, 255, 255]].map(|t| t.map(Unorm8::from_bits));
    let encoded = TextureConfig::new().color_space(ColorSpace::Srgb);
    let texture = Texture2::new(&texels, [2, 1], encoded)?.with_levels()?;
    assert_eq!(texture.texels()[2].map(|c| c.to_bits()), [188, 188, 188, 128]);
    Ok(())
}

#[test]
fn the_mean_of_all_stays() -> Result<(), TextureError> {
    let mut rng = Rng::new(20);
    for _ in 0..200 {
        let size = [1 + rng.below(20) as u32, 1 + rng.below(20) as u32, 1 + rng.below(5) as u32];
        let texels: Vec<f32> = (0..size.iter().product()).map(|_| rng.unit()).collect();
        let mean = texels.iter().map(|v| f64::from(*v)).sum::<f64>() / texels.len() as f64;
        let all = Texture3::new(texels, size, TextureConfig::new())?.with_levels()?;
        let last = all.texels().last().copied().unwrap_or_default();
        assert!((f64::from(last) - mean).abs() < 1e-6, "{size:?}: {last} {mean}");
    }
    Ok(())
}

#[test]
fn levels_between_levels() -> Result<(), TextureError> {
    let texels = [0.0, 2.0, 4.0, 10.0];
    let nearest = TextureConfig::new().filter(Filter::Nearest);
    let texture = Texture1::new(&texels, [4], nearest)?.with_levels()?;
    let read = |texture: &Texture1<'_, f32>, level| tex1_level(texture, 0.1, level);
    for (level, expected) in
        [(-5.0, 0.0), (0.4, 0.0), (0.5, 1.0), (1.5, 4.0), (9.0, 4.0), (f32::NAN, 0.0)]
    {
        assert_eq!(read(&texture, level), expected, "{level}");
    }
    let blended = texture.with_config(nearest.level_filter(LevelFilter::Linear));
    for (level, expected) in [(0.0, 0.0), (0.25, 0.25), (1.5, 2.5), (2.0, 4.0), (1e9, 4.0)] {
        assert_eq!(read(&blended, level), expected, "{level}");
    }
    assert_eq!(tex1(&blended, 0.1), 0.0);
    let single = Texture1::new(&texels, [4], nearest)?;
    assert_eq!(read(&single, 3.0), 0.0);
    Ok(())
}
