//! Textures: where they are read, and what filters make of it.

mod reference;

use raydsl::prelude::*;
use raydsl::texture::{Address, Filter, TextureError};
use raydsl_tests::rng::Rng;

use self::reference::{exact_1d, exact_3d};
use super::{Measure, Measured, fault, largest};
use crate::measure::Run;
use crate::outcome::Outcome;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "textures",
    title: "Textures of 1 to 65536 texels, in every filter and address mode",
    clauses: &[
        "The place that a filter reads is at most 2^-20 n texels off, for n texels; every \
         coordinate, a NaN too, has a defined place, and no texel outside is read.",
        "Filters are their definitions.",
        "A constant texture comes back with the same bits.",
        "Linear, B-spline and Catmull-Rom filters return a ramp to 4 ulp, and the B-spline a \
         square and a third to 1e-6.",
        "Weights of cubic filters sum to 1 within 2 ulp, and none of the B-spline is negative.",
    ],
    rows,
};

const ADDRESSES: [Address; 4] = [Address::Wrap, Address::Mirror, Address::Clamp, Address::Border];
const FILTERS: [Filter; 4] = [Filter::Nearest, Filter::Linear, Filter::BSpline, Filter::CatmullRom];

/// How far off a place may be, as a share of the texture: `2^-20`.
const OFF: f64 = 1.0 / 1_048_576.0;

fn rows() -> Vec<Row> {
    let any_coordinate = FILTERS.into_iter().map(any_coordinate);
    let ramps = FILTERS.into_iter().skip(1).map(ramp);
    let sums = [Filter::BSpline, Filter::CatmullRom].into_iter().map(sum_of_weights);
    let all = [linear(), in_space(), constants()].into_iter().chain(any_coordinate).chain(ramps);
    all.chain([squares()]).chain(sums).chain([negative_weights()]).collect()
}

/// Measures with the one kernel for all textures of a dimension: filter and modes are host values.
fn read_1d(texture: &Texture1<'_, Vec4>, measure: &Measure<'_, (f32,), Vec4>) -> Measured {
    measure(&[kernel!(|u: f32| tex1(texture, u))])
}

fn read_3d(texture: &Texture3<'_, f32>, measure: &Measure<'_, (Vec3,), f32>) -> Measured {
    measure(&[kernel!(|p: Vec3| tex3(texture, p))])
}

fn config(filter: Filter, address: Address) -> TextureConfig {
    TextureConfig { filter, ..TextureConfig::new().address(address) }
}

/// Two tents, a quarter of the texture apart: neighbours differ by 1 at most, the last texel and the
/// first too, so that no value is further off than its place; and where one tent has its foot or its
/// top the other is steep.
fn tents(i: u32, n: u32) -> Vec2 {
    let tent = |i: u32| (i + 1).min(n - i) as f32;
    vec2(tent(i), tent((i + n / 4) % n))
}

/// A border that goes on where the tents end.
fn beside_tents(n: u32) -> Vec2 {
    vec2(0.0, tents(0, n).y)
}

fn tent_texture(
    n: u32,
    filter: Filter,
    address: Address,
) -> Result<Texture1<'static, Vec4>, TextureError> {
    let texels: Vec<Vec4> = (0..n).map(|i| tents(i, n).extend(0.0).extend(0.0)).collect();
    let border = beside_tents(n).extend(0.0).extend(0.0);
    Texture1::new(texels, [n], TextureConfig { border, ..config(filter, address) })
}

/// What a filter gives of the tents, in `f64`, at a coordinate that is off by a share.
fn exact_tents(n: u32, filter: Filter, address: Address, x: f32, off: f64) -> [f64; 2] {
    [0, 1].map(|channel| {
        let value = |i: Option<i64>| i.map_or(beside_tents(n), |i| tents(i as u32, n));
        exact_1d(n, filter, address, x, off, |i| f64::from(value(i)[channel]))
    })
}

/// The larger difference of two.
fn apart(found: Vec4, exact: [f64; 2]) -> f64 {
    largest([0, 1].map(|i| (f64::from(found[i]) - exact[i]).abs()))
}

/// Widths, and coordinates at borders and centres of texels. The textbook remaps the coordinates of
/// the two neighbours one by one.
fn linear() -> Row {
    let name = "linear, n from 1 to 65536";
    Row::new(name, 1, Unit::Times, Bound::all(1.0), |run| {
        let mut rng = Rng::new(run.seed);
        let known = [
            1, 2, 3, 4, 5, 7, 8, 9, 31, 64, 97, 100, 127, 128, 129, 1000, 1021, 4096, 4097, 12_345,
            32_768, 50_021, 65_521, 65_535, 65_536,
        ];
        let more = (run.count / 100_000).min(2000);
        let random = (0..more).map(|_| {
            let most = 1 << rng.below(17);
            1 + rng.below(most) as u32
        });
        let sizes: Vec<u32> = known.into_iter().chain(random).collect();
        let (mut all, mut textbook) = (Outcome::default(), 0.0f64);
        for (i, &n) in sizes.iter().enumerate() {
            for (k, address) in ADDRESSES.into_iter().enumerate() {
                let texture = tent_texture(n, Filter::Linear, address)?;
                let part = run.part(0.25 / sizes.len() as f64, (4 * i + k) as u64);
                let part = if i < known.len() { part } else { part.without_wgsl() };
                let make = |rng: &mut Rng| (at_texels(rng, n),);
                let exact = |x: f32| exact_tents(n, Filter::Linear, address, x, 0.0);
                let outcome = read_1d(&texture, &|kernel| {
                    part.measure(kernel, make, |&(x,), found| {
                        Some(apart(*found, exact(x)) / (f64::from(n) * OFF))
                    })
                })?;
                all.merge(run.unit, outcome);
                if address == Address::Wrap {
                    let mut rng = Rng::new(part.seed);
                    let off = (0..part.count.clamp(10, 1000)).map(|_| {
                        let x = at_texels(&mut rng, n);
                        apart(remapped(n, x).extend(0.0).extend(0.0), exact(x))
                    });
                    textbook = textbook.max(largest(off) / (f64::from(n) * OFF));
                }
            }
        }
        Ok(all.beside(textbook))
    })
}

/// Where two texels meet, where one has its centre, next to these, a period off, and anywhere.
fn at_texels(rng: &mut Rng, n: u32) -> f32 {
    let on = (rng.below(n as usize) as f32 + rng.pick(&[0.0, 0.5])) / n as f32;
    match rng.below(6) {
        0 => on.next_down(),
        1 => on,
        2 => on.next_up(),
        3 => on - 1.0,
        4 => on + 1.0,
        _ => rng.range(-1.0, 2.0),
    }
}

/// A linear filter whose two neighbours are found each by its own coordinate.
fn remapped(n: u32, x: f32) -> Vec2 {
    let size = n as f32;
    let place = |x: f32| (x - x.floor()) * size;
    let (low, high) = (place(x - 0.5 / size), place(x + 0.5 / size));
    let texel = |place: f32| tents((place as u32).min(n - 1), n);
    texel(low).lerp(texel(high), low - low.floor())
}

/// Where addressing is easily wrong, and any bits.
fn odd_coordinate(rng: &mut Rng) -> f32 {
    let odd = [
        -1e-9,
        -1e-30,
        -1e-45,
        1.0 - 6e-8,
        1e9,
        -1e9,
        3e9,
        -3e9,
        8_388_607.5,
        8_388_608.0,
        8_388_609.0,
        -8_388_609.0,
        16_777_217.0,
        3e38,
        -3e38,
        f32::MIN_POSITIVE,
        0.0,
        -0.0,
        1.0,
        -1.0,
        2.0,
        f32::MAX,
        f32::MIN,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
    ];
    match rng.below(3) {
        0 => rng.pick(&odd),
        1 => f32::from_bits(rng.bits() as u32),
        _ => rng.range(-4.0, 5.0),
    }
}

fn any_coordinate(filter: Filter) -> Row {
    let name = format!("{filter:?}, any coordinate");
    Row::new(name, 1, Unit::Times, Bound::all(1.0), move |run| {
        let mut all = Outcome::default();
        for (i, n) in [1, 2, 3, 7, 64, 1000].into_iter().enumerate() {
            for (k, address) in ADDRESSES.into_iter().enumerate() {
                let texture = tent_texture(n, filter, address)?;
                let part = run.part(1.0 / 24.0, (4 * i + k) as u64);
                let make = |rng: &mut Rng| (odd_coordinate(rng),);
                let exact = |x: f32, off: f64| exact_tents(n, filter, address, x, off);
                let outcome = read_1d(&texture, &|kernel| {
                    part.measure(kernel, make, |&(x,), found| {
                        Some(if filter == Filter::Nearest {
                            // Next to a border either texel is near enough.
                            let near = [0.0, OFF, -OFF].map(|off| apart(*found, exact(x, off)));
                            if near.contains(&0.0) { 0.0 } else { f64::INFINITY }
                        } else {
                            // No filter of these is steeper than 3/2; sums of four round.
                            let allowed = f64::from(n) * (1.5 * OFF + 2f64.powi(-22));
                            apart(*found, exact(x, 0.0)) / allowed
                        })
                    })
                })?;
                all.merge(run.unit, outcome);
            }
        }
        Ok(all)
    })
}

/// Every filter with every mode along the first axis, the others with others, in three dimensions.
fn in_space() -> Row {
    let name = "three dimensions, random texels";
    Row::new(name, 2, Unit::Absolute, Bound::all(3e-5), |run| {
        let mut all = Outcome::default();
        for (i, filter) in FILTERS.into_iter().enumerate() {
            for k in 0..4 {
                let mut rng = Rng::new(run.seed + (4 * i + k) as u64);
                let size = [(); 3].map(|()| 1 + rng.below(9) as u32);
                let texels: Vec<f32> =
                    (0..size.iter().product()).map(|_| rng.range(-1.0, 1.0)).collect();
                let addresses = [0, 1, 2].map(|axis| ADDRESSES[(k + axis) % 4]);
                let border = vec4(rng.unit(), 0.0, 0.0, 0.0);
                let config = TextureConfig { filter, border, ..TextureConfig::new() };
                let texture = Texture3::new(texels, size, config.addresses(addresses))?;
                let part = run.part(1.0 / 16.0, (4 * i + k) as u64);
                let make = |rng: &mut Rng| (rng.point(2.5),);
                let outcome = read_3d(&texture, &|kernel| {
                    part.measure(kernel, make, |&(p,), found| {
                        let place = p.as_dvec3() * UVec3::from_array(size).as_dvec3();
                        let to_border = (place - place.round()).abs().min_element();
                        // Next to a border of texels the nearest one may be another by rounding.
                        let is_open = filter == Filter::Nearest && to_border < 1e-5;
                        let exact = exact_3d(&texture, p);
                        (!is_open).then_some((f64::from(*found) - exact).abs())
                    })
                })?;
                all.merge(run.unit, outcome);
            }
        }
        Ok(all)
    })
    .share(0.1)
}

fn constants() -> Row {
    Row::new("constants, three dimensions", 3, Unit::Faults, Bound::NONE, |run| {
        let constants = [0.1, 1.0 / 3.0, 1e30, -7.3e-20, 0.7];
        let mut all = Outcome::default();
        let mut part = 0;
        for filter in FILTERS {
            for (constant, address) in constants.into_iter().zip(ADDRESSES.into_iter().cycle()) {
                let border = Vec4::splat(constant);
                let config = TextureConfig { border, ..config(filter, address) };
                let texture = Texture3::new(vec![constant; 60], [3, 4, 5], config)?;
                part += 1;
                let outcome = read_3d(&texture, &|kernel| {
                    run.part(0.05, part).measure(
                        kernel,
                        |rng| (rng.point(3.0),),
                        |_, found| fault(found.to_bits() != constant.to_bits()),
                    )
                })?;
                all.merge(run.unit, outcome);
            }
        }
        Ok(all)
    })
}

/// Measures clamped texels inside, where no edge is near.
fn inside(
    run: &Run,
    filter: Filter,
    n: u32,
    texel: fn(f32) -> f32,
    error: fn(f64, f64) -> f64,
) -> Measured {
    let texels: Vec<Vec4> = (0..n).map(|i| Vec4::splat(texel(i as f32))).collect();
    let texture = Texture1::new(texels, [n], config(filter, Address::Clamp))?;
    let make = |rng: &mut Rng| (rng.range(0.05, 0.95),);
    read_1d(&texture, &|kernel| {
        run.measure(kernel, make, |&(u,), found| {
            Some(error(f64::from(u) * f64::from(n) - 0.5, found.z.into()))
        })
    })
}

fn ramp(filter: Filter) -> Row {
    let name = format!("ramp, {filter:?}");
    Row::new(name, 4, Unit::Ulp, Bound::all(4.0), move |run| {
        inside(
            run,
            filter,
            64,
            |i| i,
            |place, found| {
                let rounded = place.abs() as f32;
                (found - place).abs() / f64::from(rounded.next_up() - rounded)
            },
        )
    })
}

fn squares() -> Row {
    Row::new("squares, BSpline", 4, Unit::Relative, Bound::all(1e-6), |run| {
        inside(
            run,
            Filter::BSpline,
            64,
            |i| i * i,
            |place, found| {
                let exact = place * place + 1.0 / 3.0;
                (found - exact).abs() / exact
            },
        )
    })
}

/// Four impulses, one in each channel: the filter returns its weights.
fn impulses(filter: Filter) -> Result<Texture1<'static, Vec4>, TextureError> {
    let texels = vec![Vec4::X, Vec4::Y, Vec4::Z, Vec4::W];
    Texture1::new(texels, [4], config(filter, Address::Clamp))
}

/// Between the second texel and the third, a third of the time next to the third.
fn between_impulses(rng: &mut Rng) -> (f32,) {
    let share = if rng.below(3) == 0 { 1.0 - rng.unit() * 1e-4 } else { rng.unit() };
    ((1.5 + share) / 4.0,)
}

fn sum_of_weights(filter: Filter) -> Row {
    let name = format!("sum of weights, {filter:?}");
    Row::new(name, 5, Unit::Absolute, Bound::all(2.0 * 2f64.powi(-23)), move |run| {
        let texture = impulses(filter)?;
        read_1d(&texture, &|kernel| {
            run.measure(kernel, between_impulses, |_, weights| {
                let weights = weights.to_array().map(f64::from);
                Some((weights.iter().sum::<f64>() - 1.0).abs())
            })
        })
    })
}

/// The textbook has the first weight as a sum of powers.
fn negative_weights() -> Row {
    Row::new("weights below 0, BSpline", 5, Unit::Faults, Bound::NONE, |run| {
        let texture = impulses(Filter::BSpline)?;
        let outcome = read_1d(&texture, &|kernel| {
            run.measure(kernel, between_impulses, |_, weights| {
                fault(!weights.cmpge(Vec4::ZERO).all())
            })
        })?;
        Ok(outcome.beside(run.broken_by(run.count / 10, |rng| {
            let a = 4.0 * between_impulses(rng).0 - 1.5;
            (((-a + 3.0) * a - 3.0) * a + 1.0) / 6.0 < 0.0
        })))
    })
}
