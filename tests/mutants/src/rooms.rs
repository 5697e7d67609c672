//! Which sources are mutated, and which tests are run.

/// A part of the library.
pub(crate) struct Room {
    pub(crate) name: &'static str,
    /// Files and folders below `raydsl/src`.
    pub(crate) sources: &'static [&'static str],
    /// The number of mutants drawn of 300.
    pub(crate) share: usize,
}

/// The rooms. Shares follow the amount of arithmetic rather than lines, and small rooms have enough to
/// say something.
pub(crate) const ROOMS: [Room; 5] = [
    Room { name: "geometry", sources: &["geometry"], share: 75 },
    Room { name: "bvh", sources: &["bvh"], share: 95 },
    Room { name: "volume", sources: &["volume"], share: 75 },
    Room { name: "shading", sources: &["shading"], share: 20 },
    Room {
        name: "masks",
        sources: &[
            "machine/control.rs",
            "machine/packet.rs",
            "machine/lanes",
            "machine/record/machine.rs",
            "machine/record/restart.rs",
        ],
        share: 35,
    },
];

/// The programs of `tests/tests` that concern the rooms, beside the library's unit tests.
pub(crate) const PROGRAMS: [&str; 14] = [
    "adversary",
    "analytic",
    "cells",
    "flow",
    "geometry",
    "language",
    "moving",
    "queries",
    "render",
    "reports",
    "sampling",
    "scenes",
    "variants",
    "volumes",
];

/// Tests that look at recorded text too, by a part of their names: a change of text alone is no fault.
pub(crate) const OF_TEXT: [&str; 12] = [
    "a_grid_of_one_step_is_as_it_was",
    "a_scene_has_tables",
    "conditions_prune",
    "golden",
    "hits_of_another_scene",
    "host_values",
    "sampler",
    "some_kinds_share_data",
    "the_text",
    "the_book_shows",
    "the_rest_of_a_record_is_computed_once",
    "trees_with_different_kinds",
];
