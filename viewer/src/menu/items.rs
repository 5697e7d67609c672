//! What there is to choose, and in which column and row.

use raydsl::prelude::*;

use crate::action::Action;
use crate::look::{Mode, Show};
use crate::session::Session;

/// Something to choose.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What is written on its button.
    pub label: String,
    /// What choosing it does.
    pub action: Action,
    /// Whether it is what is shown already.
    pub is_chosen: bool,
}

/// Returns the items with their columns and rows: modes, variants, and the rest.
pub(super) fn items(session: &Session) -> Vec<(Item, (u32, u32))> {
    let look = session.look();
    let mut columns: [Vec<Item>; 3] = Default::default();
    let item = |label: &str, action: Action, is_chosen: bool| Item {
        label: label.to_owned(),
        action,
        is_chosen,
    };
    let kind = session.info().map(|info| info.kind);
    for mode in kind.map_or(&[][..], Mode::of) {
        columns[0].push(item(mode.name(), Action::Mode(*mode), look.mode == *mode));
    }
    for variant in Variant::ALL {
        columns[1].push(item(variant.name(), Action::Variant(variant), look.variant == variant));
    }
    let last = &mut columns[2];
    last.push(item("see all", Action::Home, false));
    if kind.is_some_and(|kind| !kind.is_field()) {
        let is_cost = look.show == Show::Cost;
        let show = if is_cost { Show::Picture } else { Show::Cost };
        last.push(item("cost", Action::Show(show), is_cost));
    }
    let (files, step) = session.steps();
    if step > 0 {
        last.push(item("step before", Action::Step(step - 1), false));
    }
    if step + 1 < files.len() {
        last.push(item("next step", Action::Step(step + 1), false));
    }
    last.push(item("close", Action::Menu(false), false));
    let place = |(column, items): (u32, Vec<Item>)| {
        items.into_iter().zip(0..).map(move |(item, row)| (item, (column, row)))
    };
    (0..).zip(columns).flat_map(place).collect()
}
