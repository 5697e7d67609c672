//! Extension points: operations of other modules on machines.
//!
//! A machine implements arithmetic, control flow, variables and data. A scene query or a texture
//! sampler has an implementation per machine, all in one place in the module that owns it.

use super::{B, F, Lanes, Margin, Packet, Recorder, Scalar, Type};

/// The twin of a type of the host on a machine.
pub type On<T, M> = <T as Type>::On<M>;

/// An operation with an implementation per machine, run by
/// [`Machine::perform`](super::Machine::perform).
pub trait Operation {
    /// The operand type on the host.
    type Input: Type;
    /// The result type on the host.
    type Output: Type;

    /// Performs it for one lane.
    fn on_scalar(&self, m: &Scalar, input: On<Self::Input, Scalar>) -> On<Self::Output, Scalar>;

    /// Performs it for the running lanes of a packet. The operands of other lanes are arbitrary.
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        input: On<Self::Input, Packet<L>>,
    ) -> On<Self::Output, Packet<L>>;

    /// Records it.
    fn on_recorder(
        &self,
        m: &Recorder,
        input: On<Self::Input, Recorder>,
    ) -> On<Self::Output, Recorder>;

    /// Computes it in `f64`, with bounds on rounding errors.
    fn on_margin(&self, m: &Margin, input: On<Self::Input, Margin>) -> On<Self::Output, Margin>;
}

/// Items found one after another by [`Machine::visit`](super::Machine::visit).
///
/// `visit` receives each item in the lanes that have it and returns the lanes that go on. `limit`
/// returns the bound up to which items are still wanted. Values that outlive an item are in
/// variables, as for iterations of a [`Loop`](super::Loop).
pub trait Visit {
    /// The operand type on the host.
    type Input: Type;
    /// The item type on the host.
    type Item: Type;

    /// Visits items with one lane.
    fn on_scalar(
        &self,
        m: &Scalar,
        input: On<Self::Input, Scalar>,
        limit: impl Fn() -> F<Scalar>,
        visit: impl Fn(On<Self::Item, Scalar>) -> B<Scalar>,
    );

    /// Visits items with the running lanes of a packet. The operands of other lanes are arbitrary.
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        input: On<Self::Input, Packet<L>>,
        limit: impl Fn() -> F<Packet<L>>,
        visit: impl Fn(On<Self::Item, Packet<L>>) -> B<Packet<L>>,
    );

    /// Records the visit.
    fn on_recorder(
        &self,
        m: &Recorder,
        input: On<Self::Input, Recorder>,
        limit: impl Fn() -> F<Recorder>,
        visit: impl Fn(On<Self::Item, Recorder>) -> B<Recorder>,
    );

    /// Visits items in `f64`, with bounds on rounding errors.
    fn on_margin(
        &self,
        m: &Margin,
        input: On<Self::Input, Margin>,
        limit: impl Fn() -> F<Margin>,
        visit: impl Fn(On<Self::Item, Margin>) -> B<Margin>,
    );
}
