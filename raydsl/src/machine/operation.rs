//! What other modules do on machines.
//!
//! A machine knows arithmetic, control flow, variables and data. A query of a scene or a texture's
//! sampler is done in another way on each: the module that has it says how, in one place.

use super::{B, F, Lanes, Margin, Packet, Recorder, Scalar, Type};

/// The twin of a type of the host on a machine.
pub type On<T, M> = <T as Type>::On<M>;

/// Something that every machine does in a way of its own, by
/// [`Machine::perform`](super::Machine::perform).
pub trait Operation {
    /// The operands, as a type of the host.
    type Input: Type;
    /// The result, as a type of the host.
    type Output: Type;

    /// Does it with one lane.
    fn on_scalar(&self, m: &Scalar, input: On<Self::Input, Scalar>) -> On<Self::Output, Scalar>;

    /// Does it in a packet: for its running lanes. The operands of others may be anything.
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

    /// Does it in `f64`, with bounds of what rounding may do.
    fn on_margin(&self, m: &Margin, input: On<Self::Input, Margin>) -> On<Self::Output, Margin>;
}

/// Items that are found one after another, by [`Machine::visit`](super::Machine::visit).
///
/// `visit` is given each item in the lanes that have it, and says which of them go on. `limit` says
/// up to where items are still wanted. What outlives an item is in variables, as for rounds of a
/// [`Loop`](super::Loop).
pub trait Visit {
    /// The operands, as a type of the host.
    type Input: Type;
    /// What is found, as a type of the host.
    type Item: Type;

    /// Does it with one lane.
    fn on_scalar(
        &self,
        m: &Scalar,
        input: On<Self::Input, Scalar>,
        limit: impl Fn() -> F<Scalar>,
        visit: impl Fn(On<Self::Item, Scalar>) -> B<Scalar>,
    );

    /// Does it in a packet: for its running lanes. The operands of others may be anything.
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        input: On<Self::Input, Packet<L>>,
        limit: impl Fn() -> F<Packet<L>>,
        visit: impl Fn(On<Self::Item, Packet<L>>) -> B<Packet<L>>,
    );

    /// Records it.
    fn on_recorder(
        &self,
        m: &Recorder,
        input: On<Self::Input, Recorder>,
        limit: impl Fn() -> F<Recorder>,
        visit: impl Fn(On<Self::Item, Recorder>) -> B<Recorder>,
    );

    /// Does it in `f64`, with bounds of what rounding may do.
    fn on_margin(
        &self,
        m: &Margin,
        input: On<Self::Input, Margin>,
        limit: impl Fn() -> F<Margin>,
        visit: impl Fn(On<Self::Item, Margin>) -> B<Margin>,
    );
}
