//! The cases, by family.

use std::error::Error;

use raydsl_report::work_precision::Case;

use crate::hall::hall;
use crate::{
    arithmetic, builders, cloud, files, filters, lamps, light, lines, luneburg, open, paths,
    quadrature, strategies, textured, transmittance, visibility, volumes,
};

/// Of each pixel of each half of the cloud's reference: a second or two.
const CLOUD_SAMPLES: u32 = 16_384;
/// The same of scenes from files, whose every sample has two rays.
const FILE_SAMPLES: u32 = 4096;
/// The same of scenes whose tree is built.
const BUILDER_SAMPLES: u32 = 16_384;
/// Of paths, of several rays each.
const PATH_SAMPLES: u32 = 16_384;
/// Of a metal under one lamp.
const LAMP_SAMPLES: u32 = 1 << 18;

type Made = Result<Case<'static>, Box<dyn Error>>;

/// A case that is made if it is measured: references take a while.
pub(crate) struct Entry {
    /// Its family.
    pub(crate) family: &'static str,
    /// Its name.
    pub(crate) name: String,
    /// Its knob.
    pub(crate) knob: String,
    /// Makes it.
    pub(crate) make: Box<dyn FnOnce() -> Made>,
}

/// Entries of cases that take no time to make.
fn ready(family: &'static str, cases: Vec<Case<'static>>) -> impl Iterator<Item = Entry> {
    cases.into_iter().map(move |case| Entry {
        family,
        name: case.name().to_owned(),
        knob: case.knob_name().to_owned(),
        make: Box::new(|| Ok(case)),
    })
}

/// The entry of a case that takes longer.
fn later(
    family: &'static str,
    name: &str,
    knob: &str,
    make: impl FnOnce() -> Made + 'static,
) -> Entry {
    Entry { family, name: name.to_owned(), knob: knob.to_owned(), make: Box::new(make) }
}

/// All cases, those of a family together.
pub(crate) fn entries() -> Vec<Entry> {
    let edge = cloud::EDGE;
    let mut all: Vec<Entry> = ready("edges", visibility::cases()).collect();
    all.extend(ready("smooth", light::cases()));
    all.extend(ready("smooth", textured::cases()));
    all.push(later("openness", "cloud", "spp", || cloud::case(CLOUD_SAMPLES)));
    let scene = || open::case("scene", files::scene()?, FILE_SAMPLES);
    all.push(later("openness", "scene", "spp", scene));
    let scan = || open::case("scan", files::scan()?, FILE_SAMPLES);
    all.push(later("openness", "scan", "spp", scan));
    all.extend(
        paths::NAMES
            .map(|name| later("paths", name, "spp", move || paths::case(name, PATH_SAMPLES))),
    );
    all.extend(strategies::SCENES.map(|(name, ..)| {
        later("strategies", name, "spp", move || Ok(strategies::case(name, LAMP_SAMPLES)?))
    }));
    all.extend(
        lamps::NAMES
            .map(|(name, _)| later("many-lights", name, "spp", move || lamps::case(name, edge))),
    );
    all.extend(
        volumes::FIELDS
            .map(|name| later("volumes", name, "step", move || Ok(volumes::case(name, edge)))),
    );
    all.extend(transmittance::NAMES.map(|names| {
        later("transmittance", names.0, "spp", move || Ok(transmittance::case(names, edge)))
    }));
    all.extend(ready("filters", vec![filters::case(edge)]));
    let built = || builders::case("hall", builders::hall(hall()), BUILDER_SAMPLES);
    all.push(later("builders", "hall", "spp", built));
    let built = || builders::case("nave", files::scene()?, FILE_SAMPLES);
    all.push(later("builders", "nave", "spp", built));
    all.extend(ready("quadrature", vec![quadrature::case()]));
    all.extend(ready("curved-rays", vec![luneburg::case()]));
    all.extend(ready("streamlines", vec![lines::case(edge)]));
    all.extend(ready("arithmetic", vec![arithmetic::case()]));
    all
}
