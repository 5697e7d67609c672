//! Lights as kernels see them.

use super::choice::{
    chance_of, choose_one, emitted_by, radiance_of_miss, sample_number, sample_one,
};
use super::{Lights, LightsLayout};
use crate::Type;
use crate::geometry::SurfacePointOn;
use crate::light::environment::{EnvironmentView, sample_direction};
use crate::light::tree::LightNode;
use crate::light::{Light, LightChoice, LightSample};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, F, HostFact, Leaves, Machine, Method, On, Parameter, Resource, Schema,
    Slice, Table, TableView, Type as MachineType, U, Value, X2, X3, name, table_view, visit_value,
};

impl<L: Light + MachineType> Lights<'_, L> {
    fn named_view(&self, name: &'static str) -> LightsView<'_, L> {
        let key = |part| Some(BufferKey { id: self.owner.id(), version: 0, part });
        LightsView {
            list: Slice::new(self.list, name),
            distant: Slice::owned(&self.distant, key(0), name).suffixed("distant"),
            cdf: Slice::owned(&self.cdf, key(1), name).suffixed("cdf"),
            nodes: Slice::owned(&self.tree.nodes, key(2), name).suffixed("tree"),
            trails: Slice::owned(&self.tree.trails, key(3), name).suffixed("trails"),
            table_share: self.table_share,
            environment: self.environment.map(|e| e.named_view(name)),
            layout: self.layout,
            name,
        }
    }
}

/// View of [`Lights`] in kernels: a host value on every machine.
#[derive(Debug)]
pub struct LightsView<'a, L: Light + MachineType> {
    list: Slice<'a, L>,
    distant: Slice<'a, u32>,
    cdf: Slice<'a, f32>,
    nodes: Slice<'a, LightNode>,
    trails: Slice<'a, u32>,
    table_share: f32,
    environment: Option<EnvironmentView<'a>>,
    layout: LightsLayout,
    name: &'static str,
}

impl<L: Light + MachineType> Clone for LightsView<'_, L> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Light + MachineType> Copy for LightsView<'_, L> {}

/// A light that kernels have.
pub trait KernelLight: Light + MachineType {}

impl<L: Light + MachineType> KernelLight for L {}

table_view!([L: KernelLight] Lights<'_, L>, LightsView, "lights", "lights");

impl<L: Light + MachineType> TableView for LightsView<'_, L> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(self.list));
        visit(&DescribedSlice(self.distant));
        visit(&DescribedSlice(self.cdf));
        visit(&DescribedSlice(self.nodes));
        visit(&DescribedSlice(self.trails));
        visit_value(InUniforms { lights: self.layout }, self.name, visit);
        visit_value(OfTree { table_share: self.table_share }, self.name, visit);
        visit(&HostFact(self.environment.is_some().into()));
        if let Some(environment) = &self.environment {
            environment.resources(visit);
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        self.list.is_same(&other.list)
            && core::ptr::eq(self.cdf.elements(), other.cdf.elements())
            && match (&self.environment, &other.environment) {
                (None, None) => true,
                (Some(a), Some(b)) => a.is_same(b),
                _ => false,
            }
    }
}

/// Layout in the uniform block: `lamps_lights`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    lights: LightsLayout,
}

/// What kernels know of the tree in the uniform block, if there is one: `lamps_table_share`.
#[derive(Clone, Copy, Type)]
struct OfTree {
    table_share: f32,
}

/// Implements a method of the view in kernels.
macro_rules! methods {
    ($($name:literal ($($arg:ident: $t:ty),*) -> $out:ty, |$this:ident, $m:ident| $body:expr;)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<'a, M: Machine, L: Light + MachineType> Method<{ name($name) }, M, ($($t,)*)>
                for LightsView<'a, L>
            {
                type Output = $out;

                #[inline(always)]
                fn call(self, $m: &M, ($($arg,)*): ($($t,)*)) -> $out {
                    let $this = self;
                    $body
                }
            }
        )+
    };
}

methods! {
    "layout" () -> On<LightsLayout, M>, |this, m| {
        m.capture(this.name, InUniforms { lights: this.layout }).lights
    };
    "light" (i: U<M>) -> On<L, M>, |this, m| m.element(&this.list, i);
    "is_listed" () -> bool, |this, _m| !this.list.elements().is_empty();
    "has_environment" () -> bool, |this, _m| this.environment.is_some();
    "environment" () -> EnvironmentView<'a>, |this, _m| {
        this.environment.expect("kernels ask only where there is one")
    };
    "count" () -> U<M>, |this, m| {
        m.capture(this.name, InUniforms { lights: this.layout }).lights.count
    };
    "sample_light" (i: U<M>, from: SurfacePointOn<M>, u: X2<F<M>>) -> On<LightSample, M>, |this, m| {
        sample_number::on(m, this, i, from, u)
    };
    "sample_environment" (u: X2<F<M>>) -> On<LightSample, M>, |this, m| match this.environment {
        Some(e) => sample_direction::on(m, e, u),
        None => LightSample::splat(m, LightSample::dark()),
    };
    "has_distant" () -> bool, |this, _m| !this.distant.elements().is_empty();
    "distant_light" (k: U<M>) -> U<M>, |this, m| m.element(&this.distant, k);
    "cdf" () -> Slice<'a, f32>, |this, _m| this.cdf;
    "has_tree" () -> bool, |this, _m| !this.nodes.elements().is_empty();
    "tree_node" (k: U<M>) -> On<LightNode, M>, |this, m| m.element(&this.nodes, k);
    "trail" (i: U<M>) -> U<M>, |this, m| m.element(&this.trails, i);
    "table_share" () -> F<M>, |this, m| {
        m.capture(this.name, OfTree { table_share: this.table_share }).table_share
    };
    "choose" (from: SurfacePointOn<M>, u: F<M>) -> On<LightChoice, M>, |this, m| {
        choose_one::on(m, this, from, u)
    };
    "chance" (i: U<M>, from: SurfacePointOn<M>) -> F<M>, |this, m| {
        chance_of::on(m, this, i, from)
    };
    "sample" (from: SurfacePointOn<M>, u: X3<F<M>>) -> On<LightSample, M>, |this, m| {
        sample_one::on(m, this, from, u)
    };
    "emitted" (
        i: U<M>, at: SurfacePointOn<M>, from: SurfacePointOn<M>, wi: X3<F<M>>, pdf: F<M>
    ) -> X3<F<M>>, |this, m| emitted_by::on(m, this, i, at, from, wi, pdf);
    "missed" (wi: X3<F<M>>, pdf: F<M>) -> X3<F<M>>, |this, m| {
        radiance_of_miss::on(m, this, wi, pdf)
    };
}
