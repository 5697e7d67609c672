//! Panics of a kernel's source: an index out of range, an overflow.

use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether panics of this thread are caught.
    static CATCHES: Cell<bool> = const { Cell::new(false) };
    /// The place of the last one.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `f`, or returns the place and the message of its panic.
pub(super) fn caught<R>(f: impl FnOnce() -> R) -> Result<R, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(note_places);
    let outer = CATCHES.replace(true);
    let result = catch_unwind(AssertUnwindSafe(f));
    CATCHES.set(outer);
    result.map_err(|payload| {
        let literal = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = literal.or_else(|| payload.downcast_ref::<String>().cloned());
        let text = text.unwrap_or_else(|| "a panic without a message".to_owned());
        match PLACE.take() {
            Some(place) => format!("{place}: {text}"),
            None => text,
        }
    })
}

/// Lets the places of panics that are caught be noted, and not printed.
fn note_places() {
    let others = take_hook();
    set_hook(Box::new(move |info: &PanicHookInfo<'_>| {
        if CATCHES.get() {
            let place = info.location().map(|at| format!("{}:{}", at.file(), at.line()));
            PLACE.replace(place);
        } else {
            others(info);
        }
    }));
}
