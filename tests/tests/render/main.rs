//! Cameras, films, pictures and recorded frames.

mod cameras;
mod film_parts;
mod films;
mod images;
mod lens;
mod recordings;
