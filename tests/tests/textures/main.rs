//! Textures: facts of the formulas, an independent reference in `f64`, all variants, sizes, levels,
//! single texels, files.

mod example;
mod facts;
mod fetch;
mod files;
mod known;
mod levels;
mod reference;
mod sampler;
mod sizes;
mod variants;

use raydsl::texture::{Address, Filter};

const FILTERS: [Filter; 4] = [Filter::Nearest, Filter::Linear, Filter::BSpline, Filter::CatmullRom];
const ADDRESSES: [Address; 4] = [Address::Wrap, Address::Mirror, Address::Clamp, Address::Border];
