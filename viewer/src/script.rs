//! Actions from a file, played in order.

use std::path::Path;
use std::time::Duration;

use crate::action::Action;
use crate::animation::Animation;
use crate::session::Session;

/// A script that is being played. It is the same with a window and without: whoever owns the
/// session calls [`step`](Self::step) now and then.
#[derive(Debug)]
pub struct Player {
    actions: Vec<Action>,
    next: usize,
    /// What the action in hand waits for.
    awaited: Option<u32>,
}

/// What a player does next.
#[derive(Clone, Debug, PartialEq)]
pub enum Next {
    /// Waits for the renderer or a loader.
    Waits,
    /// Has something for the owner of the session, which [`Session::apply`] does not know.
    Asks(Action),
    /// Is at the end.
    Done,
}

impl Player {
    /// Reads a script: an action a line; `#` at the beginning of a word begins a comment.
    ///
    /// # Errors
    ///
    /// If a line is no action: the line and what is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut actions = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let line = without_comment(line).trim();
            if !line.is_empty() {
                actions.push(line.parse().map_err(|e| format!("line {}: {e}", i + 1))?);
            }
        }
        Ok(Self { actions, next: 0, awaited: None })
    }

    /// Returns a player of one action.
    pub fn of(action: Action) -> Self {
        Self { actions: vec![action], next: 0, awaited: None }
    }

    /// Gives up an animation: writes the film of its pictures so far, and takes the camera or the step
    /// of before. One that has not begun leaves nothing to do.
    pub fn cancel(mut self, session: &mut Session) {
        if self.next == 0 {
            return;
        }
        let end = self.actions.len().saturating_sub(Animation::END);
        for action in self.actions.drain(end.max(self.next)..) {
            // A refusal is in the log.
            let _ = session.apply(&action);
        }
    }

    /// Returns whether a person may do this while it plays: nothing that would be in its pictures.
    pub fn leaves_room_for(action: &Action) -> bool {
        matches!(action, Action::Cancel | Action::Quit | Action::Panel(..) | Action::Screenshot(_))
    }

    /// Reads a script from a file.
    ///
    /// # Errors
    ///
    /// If it cannot be read, or a line is no action.
    pub fn open(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path);
        let text = text.map_err(|e| format!("{}: {e}", path.display()))?;
        Self::read(&text).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// Does what can be done now, without waiting.
    pub fn step(&mut self, session: &mut Session) -> Next {
        loop {
            if let Some(samples) = self.awaited
                && !session.is_stuck()
                && !session.has(samples)
            {
                return Next::Waits;
            }
            self.awaited = None;
            if session.is_asking() || session.is_aiming() {
                return Next::Waits;
            }
            let action = self.actions.get(self.next).cloned();
            // Whatever follows `open` is for the data that it opens, and so is the end.
            let is_for_loader = matches!(action, Some(Action::Cancel | Action::Quit));
            if session.progress().is_some() && !is_for_loader {
                return Next::Waits;
            }
            let Some(action) = action else { return Next::Done };
            if matches!(action, Action::Picture(_) | Action::Screenshot(_))
                && has_to_render(session)
            {
                return Next::Waits;
            }
            self.next += 1;
            match action {
                Action::Screenshot(_) | Action::Panel(..) => return Next::Asks(action),
                Action::Quit => return Next::Done,
                Action::Animate(animation) => match animation.actions(session) {
                    Ok(actions) => {
                        session.note(format!("animate {animation}"));
                        self.actions.splice(self.next..self.next, actions);
                    }
                    Err(message) => session.refuse(&format!("animate {animation}: {message}")),
                },
                action => {
                    // A refusal is in the log.
                    let _ = session.apply(&action);
                    if let Action::Wait(samples) = action {
                        self.awaited = Some(samples);
                    }
                }
            }
        }
    }

    /// Plays all of it without a window.
    pub fn play(&mut self, session: &mut Session) {
        loop {
            session.poll();
            match self.step(session) {
                Next::Waits => std::thread::sleep(Duration::from_millis(2)),
                Next::Asks(action) => {
                    // Without a window there are no panels, and nothing to photograph.
                    let _ = session.apply(&action);
                }
                Next::Done => break,
            }
        }
        session.finish_files();
    }
}

/// Returns a line up to its comment; the name of a file may have `#` inside of a word.
fn without_comment(line: &str) -> &str {
    let is_begin = |at: &usize| line[..*at].chars().next_back().is_none_or(char::is_whitespace);
    let at = line.match_indices('#').map(|(at, _)| at).find(is_begin);
    at.map_or(line, |at| &line[..at])
}

/// A picture is one of the last change: a sample of it is asked for.
fn has_to_render(session: &mut Session) -> bool {
    if session.is_stuck() || session.has(1) {
        return false;
    }
    session.want_samples(1);
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_have_comments_and_lines() {
        let text = "# a\n\nopen head:32 # b\nopen a#1 b.las #c\nwait 4#\nwait 4 #\n";
        let error = Player::read(text).expect_err("no number");
        assert!(error.starts_with("line 5: '4#' is no number"), "{error}");
        let player = Player::read(&text.replace("4#", "4")).expect("a script");
        let lines = ["open head:32", "open a#1 b.las", "wait 4", "wait 4"];
        assert_eq!(player.actions, lines.map(|l| l.parse().expect(l)));
        let error = Player::read("home\nhop\n").expect_err("no verb");
        assert!(error.starts_with("line 2: 'hop' is no verb: "), "{error}");
    }
}
