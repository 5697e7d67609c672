//! Cursors: the items that a kernel's `for` visits one after another.

use super::{B, Machine};

/// A lifted sequence of items, found one after another: `for hit in scene.hits(ray)` runs over one.
#[diagnostic::on_unimplemented(
    message = "a kernel's `for` does not run over this",
    label = "these are no items of a kernel",
    note = "write `for i in 0..n`, `for x in list.iter()` or `for hit in scene.hits(ray)`"
)]
pub trait Cursor<M: Machine> {
    /// The item as the loop's body sees it.
    type Item: Copy;

    /// Its position, in variables.
    type State;

    /// Creates the state before the first item.
    fn begin(&self, m: &M) -> Self::State;

    /// Goes to the next item in the running lanes and returns whether there is one.
    fn advance(&self, m: &M, state: &Self::State) -> B<M>;

    /// Returns the current item.
    fn item(&self, m: &M, state: &Self::State) -> Self::Item;
}
