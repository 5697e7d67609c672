//! The menu in the picture.

use std::sync::Arc;

use super::Session;
use crate::frame::{Frame, over};
use crate::menu::Menu;
use crate::wand::Wand;

/// A menu that is open, and what points at it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct OpenMenu {
    wand: Option<Wand>,
}

impl Session {
    pub(super) fn show_menu(&mut self, is_open: bool) -> Result<(), String> {
        if is_open && self.info.is_none() {
            return Err("nothing is open".to_owned());
        }
        self.open_menu = is_open.then(OpenMenu::default);
        Ok(())
    }

    pub(super) fn point(&mut self, wand: Wand) -> Result<(), String> {
        let wand = wand.checked()?;
        self.open_menu.as_mut().ok_or("no menu is open")?.wand = Some(wand);
        Ok(())
    }

    /// Chooses what the wand points at.
    pub(super) fn press(&mut self) -> Result<(), String> {
        let menu = self.menu().ok_or("no menu is open")?;
        let pointed = menu.pointed().ok_or("the wand points at no item")?;
        let item = menu.items().get(pointed).ok_or("the wand points at no item")?;
        let (label, action) = (item.label.clone(), item.action.clone());
        self.try_apply(&action)?;
        self.log.note(format!("chose {label}"));
        Ok(())
    }

    /// Returns the menu that is open.
    pub fn menu(&self) -> Option<Menu> {
        self.open_menu.map(|open| Menu::new(self, open.wand))
    }

    /// Returns the pixels of a picture, with the menu if that is open.
    pub(super) fn with_menu(&self, frame: &Frame) -> Arc<Vec<u8>> {
        let mut rgba = frame.rgba.clone();
        if let Some(menu) = self.menu() {
            over(&menu.picture(&self.look.pose.camera(), frame.size), &mut rgba);
        }
        Arc::new(rgba)
    }
}

#[cfg(test)]
mod tests {
    use raydsl::prelude::*;

    use super::*;
    use crate::device::Device;
    use crate::session::Config;

    #[test]
    fn there_is_no_menu_of_nothing() {
        let mut session = Session::new(Config::scripted("out"), Device::default(), || {});
        for line in ["menu on", "wand pixel 1 2", "press"] {
            assert!(session.apply(&line.parse().expect(line)).is_err(), "{line}");
        }
        let flat = Wand::Tracked(Mat4::from_diagonal(vec4(1.0, 1.0, 0.0, 1.0)));
        assert!(flat.checked().is_err());
    }
}
