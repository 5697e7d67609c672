//! Kernels that choose among lights, and weight what rays meet of them.

use glam::{Vec2, Vec3, vec2, vec3};

use super::Lights;
use crate::geometry::SurfacePoint;
use crate::kernel;
use crate::light::tree::{LEAF, LightNode, NOT_IN_TREE, share_of_first};
use crate::light::{DistantLight, Light, LightChoice, LightSample};
use crate::machine::Type as MachineType;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{max, min};
use crate::sampling::{ONE_MINUS_EPSILON, power_heuristic, sample_table};

/// Returns the probability of a light by the table alone.
#[kernel]
#[inline]
pub(super) fn chance_by_table<L: Light + MachineType>(lights: &Lights<'_, L>, i: u32) -> f32 {
    let before = lights.cdf()[i as usize];
    lights.cdf()[(i + 1) as usize] - before
}

/// Goes down the tree, by a number or by the trail of a light.
#[kernel]
pub(super) fn descend<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    is_known: bool,
    trail: u32,
    u: f32,
) -> LightChoice {
    let top: u32 = 0;
    let root: LightNode = lights.tree_node(top);
    let mut child = root.child;
    let (mut rest, mut turns, mut chance) = (u, trail, 1.0);
    while child < LEAF {
        let first: LightNode = lights.tree_node(child);
        let second: LightNode = lights.tree_node(child + 1);
        let share = share_of_first(first, second, from);
        let is_second = if is_known { (turns & 1) == 1 } else { rest >= share };
        let before = if is_second { share } else { 0.0 };
        let own = if is_second { 1.0 - share } else { share };
        // What chose the child is used again below it.
        rest = min((rest - before) / max(own, f32::MIN_POSITIVE), ONE_MINUS_EPSILON);
        turns >>= 1;
        chance *= own;
        child = if is_second { second.child } else { first.child };
    }
    LightChoice { light: child & (LEAF - 1), chance }
}

/// Returns the probability of a light by the table or the tree.
#[kernel]
#[inline]
pub(super) fn by_either(by_table: f32, by_tree: f32, table_share: f32) -> f32 {
    by_table * table_share + by_tree * (1.0 - table_share)
}

/// Returns the probability of choosing a light among the list.
#[kernel]
pub(super) fn chance_of<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    i: u32,
    from: SurfacePoint,
) -> f32 {
    let by_table = chance_by_table(lights, i);
    if lights.has_tree() {
        let trail = lights.trail(i);
        let mut by_tree = 0.0;
        if trail < NOT_IN_TREE {
            let found: LightChoice = descend(lights, from, true, trail, 0.0);
            by_tree = found.chance;
        }
        return by_either(by_table, by_tree, lights.table_share());
    }
    by_table
}

/// Returns the probability of choosing a light that is infinitely far away.
#[kernel]
#[inline]
pub(super) fn chance_of_distant<L: Light + MachineType>(lights: &Lights<'_, L>, i: u32) -> f32 {
    let by_table = chance_by_table(lights, i);
    if lights.has_tree() { by_either(by_table, 0.0, lights.table_share()) } else { by_table }
}

/// Returns the probability of choosing a light of the list and not the environment, given that among
/// the list.
#[kernel]
#[inline]
pub(super) fn of_all<L: Light + MachineType>(lights: &Lights<'_, L>, chance: f32) -> f32 {
    if lights.has_environment() {
        chance * (1.0 - lights.layout().environment_share)
    } else {
        chance
    }
}

/// Chooses a light of the list.
#[kernel]
pub(super) fn choose_listed<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: f32,
) -> LightChoice {
    if lights.has_tree() {
        let table_share = lights.table_share();
        let is_by_table = u < table_share;
        let mut light: u32 = 0;
        let mut trail: u32 = 0;
        if is_by_table {
            light = sample_table(min(u / table_share, ONE_MINUS_EPSILON), lights.cdf()).cell;
            trail = lights.trail(light);
        }
        let mut by_tree = 0.0;
        if trail < NOT_IN_TREE {
            let others = max(1.0 - table_share, f32::MIN_POSITIVE);
            let rest = min((u - table_share) / others, ONE_MINUS_EPSILON);
            let found: LightChoice = descend(lights, from, is_by_table, trail, rest);
            light = found.light;
            by_tree = found.chance;
        }
        let chance = by_either(chance_by_table(lights, light), by_tree, table_share);
        return LightChoice { light, chance };
    }
    let light = sample_table(u, lights.cdf()).cell;
    LightChoice { light, chance: chance_by_table(lights, light) }
}

#[kernel]
pub(super) fn choose_one<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: f32,
) -> LightChoice {
    if lights.is_listed() {
        choose_listed(lights, from, u)
    } else {
        LightChoice { light: 0, chance: 0.0 }
    }
}

/// Samples the light `i`.
#[kernel]
#[inline]
pub(super) fn sample_number<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    i: u32,
    from: SurfacePoint,
    u: Vec2,
) -> LightSample {
    let light: L = lights.light(i);
    light.sample(from.position, u)
}

/// Samples a light of the list.
#[kernel]
pub(super) fn sample_listed<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: Vec3,
) -> LightSample {
    let chosen: LightChoice = choose_listed(lights, from, u.z);
    let light: L = lights.light(chosen.light);
    let sample = light.sample(from.position, vec2(u.x, u.y));
    LightSample { pdf: sample.pdf * of_all(lights, chosen.chance), ..sample }
}

#[kernel]
pub(super) fn sample_one<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: Vec3,
) -> LightSample {
    if lights.has_environment() {
        let share = lights.layout().environment_share;
        let mut sample = LightSample::dark();
        if u.z < share || !lights.is_listed() {
            sample = lights.environment().sample(vec2(u.x, u.y));
            sample.pdf *= share;
        } else if lights.is_listed() {
            let z = min((u.z - share) / (1.0 - share), ONE_MINUS_EPSILON);
            sample = sample_listed(lights, from, vec3(u.x, u.y, z));
        }
        return sample;
    }
    if lights.is_listed() { sample_listed(lights, from, u) } else { LightSample::dark() }
}

#[kernel]
#[expect(clippy::collapsible_if, reason = "the outer one is decided before the kernel runs")]
pub(super) fn emitted_by<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    i: u32,
    at: SurfacePoint,
    from: SurfacePoint,
    wi: Vec3,
    pdf: f32,
) -> Vec3 {
    let mut radiance = vec3(0.0, 0.0, 0.0);
    if lights.is_listed() {
        if i < lights.layout().count {
            let light: L = lights.light(i);
            let rival = light.pdf(from.position, at) * of_all(lights, chance_of(lights, i, from));
            radiance = light.emitted(at, -wi) * power_heuristic(1.0, pdf, 1.0, rival);
        }
    }
    radiance
}

#[kernel]
pub(super) fn radiance_of_miss<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    wi: Vec3,
    pdf: f32,
) -> Vec3 {
    let mut radiance = vec3(0.0, 0.0, 0.0);
    if lights.has_environment() {
        let rival = lights.environment().pdf(wi) * lights.layout().environment_share;
        radiance = lights.environment().radiance(wi) * power_heuristic(1.0, pdf, 1.0, rival);
    }
    if lights.has_distant() {
        for k in 0..lights.layout().distant {
            let i = lights.distant_light(k);
            let light: L = lights.light(i);
            let seen: DistantLight = light.distant(wi);
            let rival = seen.pdf * of_all(lights, chance_of_distant(lights, i));
            radiance += seen.radiance * power_heuristic(1.0, pdf, 1.0, rival);
        }
    }
    radiance
}
