//! A menu in space, before the camera, picked by a wand.
//!
//! Its buttons are quads in the world. One query finds what the wand points at, another one what each
//! pixel shows of it.

mod items;
mod layout;
mod picture;

use raydsl::prelude::*;

use crate::session::Session;
use crate::wand::Wand;
pub use items::Item;
pub use layout::Button;
use layout::Frame;

/// A menu as it is to be seen now.
#[derive(Clone, Debug, PartialEq)]
pub struct Menu {
    items: Vec<Item>,
    buttons: Vec<Button>,
    /// What the wand is, from its hand.
    wand: Option<Ray>,
    frame: Frame,
}

impl Menu {
    /// Returns the menu of a session, before its camera.
    pub(crate) fn new(session: &Session, wand: Option<Wand>) -> Self {
        let look = session.look();
        let frame = Frame::new(&look.pose, look.size);
        let (items, places): (Vec<_>, Vec<_>) = items::items(session).into_iter().unzip();
        let buttons = places.into_iter().map(|(column, row)| frame.button(column, row)).collect();
        let wand = wand.map(|wand| frame.ray(wand, &look.pose, look.size));
        Self { items, buttons, wand, frame }
    }

    /// Returns what there is to choose.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// Returns the button of each item, in the world.
    pub fn buttons(&self) -> &[Button] {
        &self.buttons
    }

    // ANCHOR: pointed
    /// Returns the number of the item that the wand points at.
    pub fn pointed(&self) -> Option<usize> {
        let hit = self.buttons[..].closest_hit(self.wand?);
        hit.is_hit.then_some(hit.prim_id as usize)
    }
    // ANCHOR_END: pointed

    /// Returns the menu and the beam of the wand as they are seen by a camera: linear colours times
    /// their alpha, transparent elsewhere.
    pub fn picture(&self, camera: &Pinhole, size: (u32, u32)) -> Image<Vec4> {
        picture::of(self, camera, size)
    }
}
