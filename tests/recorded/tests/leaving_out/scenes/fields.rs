//! Scenes of volumes and textures.

use std::error::Error;

use raydsl::kernel;
use raydsl::machine::Recording;
use raydsl::prelude::*;
use raydsl::texture::{Address, AsTextureRef, ColorSpace, Filter};
use raydsl::volume::{
    Cut, Euler, ExactCell, Grid, GridConfig, Midpoint, TransferFunction, TransferFunction2d,
    Volume, Volume2d, VolumeLight,
};

use super::Made;
use super::primitives::{Ball, balls};

pub(crate) fn grid(voxels: &[f32]) -> Result<Grid<'_, f32>, Box<dyn Error>> {
    Ok(Grid::new(voxels, uvec3(4, 4, 4), GridConfig::new())?)
}

pub(crate) fn transfer() -> Result<TransferFunction, Box<dyn Error>> {
    let colors = [(0.0, Vec3::ZERO), (1.0, Vec3::ONE)];
    Ok(TransferFunction::from_extinction(&colors, &[(0.0, 0.0), (1.0, 2.0)])?)
}

#[kernel]
pub(crate) fn marched(volume: &Volume<'_, f32>, euler: Euler, ray: Ray) -> Vec4 {
    volume.integrate(&euler, ray, VolumeLight::new()).rgba()
}

pub(super) fn volume() -> Made {
    let voxels = [0.5f32; 64];
    let grid = grid(&voxels)?;
    let (volume, euler) = (&Volume::new(&grid, transfer()?), Euler::new(0.25));
    Ok(recorded!(marched(volume, euler)(ray: Ray) -> Vec4))
}

#[kernel]
pub(super) fn borders(volume: &Volume2d<'_, f32>, midpoint: Midpoint, ray: Ray) -> Vec4 {
    volume.integrate(midpoint, ray, VolumeLight::new()).rgba()
}

/// Colours and opacities by values and the lengths of their gradients.
pub(super) fn volume_2d() -> Made {
    let voxels = [0.5f32; 64];
    let (grid, unit) = (grid(&voxels)?, vec2(0.0, 1.0));
    let samples = [(Vec3::ONE, 0.5); 4];
    let transfer = TransferFunction2d::new(&samples, uvec2(2, 2), unit, unit, 1.0)?;
    let (volume, midpoint) = (&Volume2d::new(&grid, transfer), Midpoint::new(0.25));
    Ok(recorded!(borders(volume, midpoint)(ray: Ray) -> Vec4))
}

#[kernel]
pub(super) fn cut_by_balls(
    volume: &Volume<'_, f32>,
    tool: &[Ball],
    exact: ExactCell,
    ray: Ray,
) -> Vec4 {
    let mut light = VolumeLight::new();
    let mut cut = Cut::new(tool, ray);
    while let Some(part) = cut.next_outside(tool) {
        light = volume.integrate(&exact, part, light);
    }
    light.rgba()
}

pub(super) fn cut() -> Made {
    let voxels = [0.5f32; 64];
    let (grid, balls) = (grid(&voxels)?, balls());
    let (volume, tool) = (&Volume::new(&grid, transfer()?), &balls[..]);
    let exact = ExactCell::new();
    Ok(recorded!(cut_by_balls(volume, tool, exact)(ray: Ray) -> Vec4))
}

#[kernel]
pub(super) fn texel(picture: &TextureRef2<'_, [Unorm8; 4]>, uv: Vec2) -> Vec4 {
    tex2(picture, uv)
}

/// Records a lookup of a picture.
pub(super) fn lookup(config: TextureConfig) -> Made {
    let texels = [[Unorm8::ONE; 4]; 12];
    let texture = Texture2::new(&texels, [4, 3], config)?;
    let picture = &texture.as_texture_ref();
    Ok(recorded!(texel(picture)(uv: Vec2) -> Vec4))
}

pub(super) fn nearest() -> Made {
    lookup(TextureConfig::new().address(Address::Wrap).filter(Filter::Nearest))
}

pub(super) fn repeated() -> Made {
    lookup(TextureConfig::new().address(Address::Wrap).filter(Filter::Linear))
}

pub(super) fn linear() -> Made {
    let config = TextureConfig::new().address(Address::Clamp).filter(Filter::Linear);
    lookup(config.color_space(ColorSpace::Srgb))
}

pub(super) fn cubic() -> Made {
    lookup(TextureConfig::new().border(Vec4::ZERO).filter(Filter::BSpline))
}

#[kernel]
pub(super) fn voxel(picture: &TextureRef3<'_, f32>, at: Vec3) -> f32 {
    tex3(picture, at)
}

pub(super) fn solid() -> Made {
    let texels = [0.5f32; 24];
    let config = TextureConfig::new().address(Address::Mirror).filter(Filter::Linear);
    let texture = Texture3::new(&texels, [4, 3, 2], config)?;
    let picture = &texture.as_texture_ref();
    Ok(recorded!(voxel(picture)(at: Vec3) -> f32))
}
