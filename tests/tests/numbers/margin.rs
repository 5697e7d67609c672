//! The bounds of the rounding error hold what the scalar variant gives, for every kernel.

use std::fmt::Debug;

use raydsl::machine::{KernelFn, Leaf, Outcomes, Rounding};
use raydsl_tests::check::recorded;
use raydsl_tests::kernels;
use raydsl_tests::rng::Rng;
use raydsl_tests::values::{Numbers, floats, random};

const INPUTS: usize = 1003;

/// In how many ways a kernel may go.
const WAYS: usize = 64;

/// Results lie within the bounds: of the path of `f64` where nothing is uncertain, else of one of
/// the outcomes, as long as all were followed.
fn sound<F: KernelFn>(name: &str, numbers: Numbers)
where
    F::Args: Debug,
{
    let mut rng = Rng::of(name);
    let kernel = recorded::<F>();
    let (mut uncertain, mut incomplete) = (0, 0);
    let mut widths = Vec::new();
    for _ in 0..INPUTS {
        let args: F::Args = random(&mut rng, numbers);
        let outcomes = kernel.outcomes(args, Rounding::IEEE, WAYS);
        uncertain += u32::from(outcomes.is_uncertain());
        incomplete += u32::from(!outcomes.is_complete());
        // Of infinite numbers nothing is known.
        if floats(&args).into_iter().all(|v| v.abs() < 1e6) {
            widths.extend(relative_widths(&outcomes));
        }
        let result = F::scalar(args);
        let leaves: Vec<_> = outcomes.iter().collect();
        assert!(
            outcomes.contains(result) || !outcomes.is_complete(),
            "{name} of {args:?}: uncertain {}, {leaves:#?}",
            outcomes.is_uncertain()
        );
        // A device may do what the CPU does.
        let device = kernel.outcomes(args, Rounding::WGSL, WAYS);
        let leaves: Vec<_> = device.iter().collect();
        let holds = device.contains(result) || !device.is_complete();
        assert!(holds, "{name} of {args:?} on a device: {leaves:#?}");
    }
    widths.sort_by(f64::total_cmp);
    let median = widths.get(widths.len() / 2).copied().unwrap_or_default();
    println!(
        "{name}: {uncertain} uncertain, {incomplete} not followed to the end, width {median:e}"
    );
    assert!(incomplete * 20 < INPUTS as u32, "{name}: {incomplete} inputs prove nothing");
    // Bounds that hold everything would be sound too.
    assert!(median <= 1e-5, "{name}: half of the bounds are wider than {median:e}");
}

/// The widths of the floats' bounds, as parts of the numbers.
fn relative_widths(outcomes: &Outcomes) -> Vec<f64> {
    let width = |leaf: &Leaf| match *leaf {
        Leaf::Float { low, high, .. } if low <= high => {
            let width = leaf.width();
            let size = low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
            Some(if width.is_finite() { width / size } else { width })
        }
        _ => None,
    };
    outcomes.reference().iter().filter_map(width).collect()
}

/// The bounds are no wider than they must be: without the rounding of sums and products they do not
/// hold.
#[test]
fn bounds_without_rounding_do_not_hold() {
    let kernel = recorded::<kernels::vectors>();
    let mut rng = Rng::of("bounds_without_rounding_do_not_hold");
    let misses = |rounding: Rounding, rng: &mut Rng| {
        let outside = (0..INPUTS).filter(|_| {
            let args = random(rng, Numbers::Tame);
            !kernel.outcomes(args, rounding, WAYS).contains(kernels::vectors::scalar(args))
        });
        outside.count()
    };
    let none = Rounding { sum: 0.0, quotient: 0.0, root: 0.0, ..Rounding::IEEE };
    assert!(misses(none, &mut rng) > INPUTS / 2);
    assert_eq!(misses(Rounding::WGSL, &mut rng), 0);
}

macro_rules! tests {
    ($($kernel:ident: $numbers:ident $wgsl:ident;)+) => {
        $(
            #[test]
            fn $kernel() {
                sound::<kernels::$kernel>(stringify!($kernel), Numbers::$numbers);
            }
        )+
    };
}

raydsl_tests::kernel_table!(tests);
