//! What a `for` of a kernel takes one by one.

use super::{B, Machine};

/// Items that are found one after another, lifted: what `for hit in scene.hits(ray)` runs over.
#[diagnostic::on_unimplemented(
    message = "a kernel's `for` does not run over this",
    label = "these are no items of a kernel",
    note = "write `for i in 0..n`, `for x in list.iter()` or `for hit in scene.hits(ray)`"
)]
pub trait Cursor<M: Machine> {
    /// What the loop's body sees.
    type Item: Copy;

    /// Where it stands, in variables.
    type State;

    /// Before the first item.
    fn begin(&self, m: &M) -> Self::State;

    /// Goes to the next item in the running lanes; whether there is one.
    fn advance(&self, m: &M, state: &Self::State) -> B<M>;

    /// The item at which it stands.
    fn item(&self, m: &M, state: &Self::State) -> Self::Item;
}
