//! What a scene does not use leaves no trace in its generated code.

mod by_hand;
mod features;
mod identity;
mod matrix;
mod occlusion;
mod reduce;
mod scenes;
mod unread;
