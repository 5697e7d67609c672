//! What a campaign found.

use std::fmt::Write as _;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use raydsl::prelude::*;

use super::VARIANTS;
use crate::gpu::gpu;
use crate::in_parallel;
use crate::rng::Rng;

/// Rays that a thread makes at a time.
const PART: usize = 1 << 14;

/// Rays of one dispatch.
const BATCH: usize = 1 << 18;

/// One variant's part in a campaign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The variant, and the registers that it ran in.
    pub who: String,
    /// How many rays it was asked about.
    pub rays: u64,
    /// How many it answered wrongly.
    pub lost: u64,
}

/// What a campaign found, variant by variant.
#[derive(Debug, Default)]
#[must_use = "a campaign that is not looked at finds nothing"]
pub struct Tally {
    /// What the rays were like.
    pub name: String,
    /// Who was asked.
    pub asked: Vec<Asked>,
    /// Others than the library, for comparison: what they lose is not counted.
    pub others: Vec<Asked>,
    /// The first ray that was lost, and by whom.
    pub first: Option<String>,
}

impl Tally {
    /// Nothing yet.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds what was found elsewhere with rays of the same kind.
    pub fn add(&mut self, other: Self) {
        merge(&mut self.asked, other.asked);
        merge(&mut self.others, other.others);
        self.first = self.first.take().or(other.first);
    }

    /// How many answers were wrong.
    pub fn lost(&self) -> u64 {
        self.asked.iter().map(|a| a.lost).sum()
    }

    /// Panics if a ray was lost.
    ///
    /// # Panics
    ///
    /// If one was, or if none was asked about.
    pub fn assert_none(&self) {
        assert!(self.asked.iter().any(|a| a.rays > 0), "{}: no rays", self.name);
        let first = self.first.as_deref().unwrap_or_default();
        assert!(self.lost() == 0, "{}: {} rays are lost: {first}", self.name, self.lost());
    }

    /// Asks every natural variant of the CPU about `count` rays that must be hits.
    pub fn cpu(
        &mut self,
        kernels: &[Kernel<'_, (Ray,), bool>],
        count: usize,
        ray: &(impl Fn(&mut Rng) -> Ray + Sync),
    ) {
        let seed = Rng::of(&self.name).bits();
        let lost = VARIANTS.map(|_| AtomicU64::new(0));
        let first = Mutex::new(None);
        in_parallel(count, PART, |range| {
            let rays = rays(seed ^ range.start as u64, range.len(), ray);
            let mut found = vec![false; rays.len()];
            // Queries take turns, so that each is asked about its share.
            let kernel = &kernels[range.start / PART % kernels.len()];
            for (variant, lost) in VARIANTS.into_iter().zip(&lost) {
                found.fill(false);
                kernel.run(variant, &rays, &mut found);
                lost.fetch_add(note(variant.name(), &rays, &found, &first), Ordering::Relaxed);
            }
        });
        let asked = VARIANTS.into_iter().zip(lost).map(|(variant, lost)| {
            let (isa, lanes) = variant.isa();
            let who = format!("{} ({lanes} of {isa})", variant.name());
            Asked { who, rays: count as u64, lost: lost.into_inner() }
        });
        let asked = asked.collect();
        self.add(Self { asked, first: first.into_inner().unwrap_or(None), ..Self::default() });
    }

    /// Asks WGSL about `count` rays that must be hits, if there is a device.
    ///
    /// # Panics
    ///
    /// If the device refuses the kernel.
    pub fn wgsl(
        &mut self,
        kernels: &[Kernel<'_, (Ray,), bool>],
        count: usize,
        ray: &impl Fn(&mut Rng) -> Ray,
    ) {
        let Some(gpu) = gpu() else { return };
        let seed = Rng::of(&self.name).bits();
        let first = Mutex::new(None);
        let mut lost = 0;
        for (i, start) in (0..count).step_by(BATCH).enumerate() {
            let rays = rays(!seed ^ start as u64, BATCH.min(count - start), ray);
            let mut found = vec![false; rays.len()];
            let kernel = &kernels[i % kernels.len()];
            if let Err(error) = gpu.batch(kernel, &rays, &mut found) {
                panic!("{}: {error}\n{}", self.name, kernel.wgsl());
            }
            lost += note("WGSL", &rays, &found, &first);
        }
        let asked = vec![Asked { who: "WGSL".to_owned(), rays: count as u64, lost }];
        self.add(Self { asked, first: first.into_inner().unwrap_or(None), ..Self::default() });
    }

    /// A row of a table: what, how many rays, how many of them each variant lost, and the share
    /// that something else loses.
    pub fn row(&self) -> String {
        let mut row = format!("| {} |", self.name);
        let most = self.asked.iter().map(|a| a.rays).max().unwrap_or(0);
        let of = |who: &str| self.asked.iter().find(|a| a.who.starts_with(who));
        let _ = write!(row, " {} |", grouped(most));
        for who in ["scalar", "packet4", "packet8", "packet16", "WGSL"] {
            let _ = match of(who) {
                Some(a) if a.rays == most => write!(row, " {} |", a.lost),
                Some(a) => write!(row, " {} of {} |", a.lost, grouped(a.rays)),
                None => write!(row, " |"),
            };
        }
        for other in &self.others {
            let _ = write!(row, " {:.2} % |", 100.0 * other.lost as f64 / other.rays as f64);
        }
        row
    }
}

/// Adds the figures of each that is in both.
fn merge(mine: &mut Vec<Asked>, others: Vec<Asked>) {
    for other in others {
        match mine.iter_mut().find(|a| a.who == other.who) {
            Some(a) => (a.rays, a.lost) = (a.rays + other.rays, a.lost + other.lost),
            None => mine.push(other),
        }
    }
}

/// `count` rays of one kind.
fn rays(seed: u64, count: usize, ray: &impl Fn(&mut Rng) -> Ray) -> Vec<(Ray,)> {
    let mut rng = Rng::new(seed);
    (0..count).map(|_| (ray(&mut rng),)).collect()
}

/// How many rays were not found; remembers the first.
fn note(who: &str, rays: &[(Ray,)], found: &[bool], first: &Mutex<Option<String>>) -> u64 {
    let mut lost = rays.iter().zip(found).filter(|(_, found)| !**found).map(|((ray,), _)| ray);
    let Some(ray) = lost.next() else { return 0 };
    if let Ok(mut first) = first.lock() {
        first.get_or_insert_with(|| format!("{who}: {ray:?}"));
    }
    1 + lost.count() as u64
}

/// `12_345_678` as `12,345,678`.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
