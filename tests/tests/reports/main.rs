//! Reports: sizes of programs, verdicts of comparisons, error against run time.

mod explain;
mod left_out;
mod testing;
mod work_precision;
