//! Answers of error scopes: there at once on a machine, later in a browser.

use std::collections::VecDeque;
use std::fmt;
use std::pin::Pin;
use std::sync::Mutex;
use std::task::{Context, Poll, Waker};

use super::device::lock;
use super::error::GpuError;

/// The error of a call, if it had one. In a browser nothing may move to another thread.
#[cfg(not(target_family = "wasm"))]
type Answer = Pin<Box<dyn Future<Output = Option<GpuError>> + Send>>;
#[cfg(target_family = "wasm")]
type Answer = Pin<Box<dyn Future<Output = Option<GpuError>>>>;

/// The answers that are not there yet, in the order of their calls.
#[derive(Default)]
pub(super) struct Answers {
    late: Mutex<VecDeque<Answer>>,
}

impl Answers {
    /// Returns the error of a call if its answer is there, and keeps the answer if it is not.
    pub(super) fn now(
        &self,
        answer: impl Future<Output = Option<GpuError>> + wgpu::WasmNotSend + 'static,
    ) -> Option<GpuError> {
        let mut answer: Answer = Box::pin(answer);
        match poll_once(&mut answer) {
            Poll::Ready(error) => error,
            Poll::Pending => {
                lock(&self.late).push_back(answer);
                None
            }
        }
    }

    /// Returns the first error among the answers that came since.
    pub(super) fn arrived(&self) -> Option<GpuError> {
        let mut late = lock(&self.late);
        while let Some(oldest) = late.front_mut() {
            let Poll::Ready(error) = poll_once(oldest) else { break };
            late.pop_front();
            if error.is_some() {
                // The errors of the calls after it are mostly its consequences.
                late.clear();
                return error;
            }
        }
        None
    }

    /// Waits for all answers and returns the first error. If it is dropped before its end, a later
    /// call has what it has not returned.
    pub(super) async fn all(&self) -> Option<GpuError> {
        let rest = std::mem::take(&mut *lock(&self.late));
        let mut waiting = Waiting { answers: self, rest, first: None };
        while let Some(oldest) = waiting.rest.front_mut() {
            let error = oldest.await;
            waiting.rest.pop_front();
            waiting.first = waiting.first.take().or(error);
        }
        waiting.first.take()
    }
}

/// Answers that are waited for.
struct Waiting<'a> {
    answers: &'a Answers,
    rest: VecDeque<Answer>,
    first: Option<GpuError>,
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        let mut late = lock(&self.answers.late);
        while let Some(newest) = self.rest.pop_back() {
            late.push_front(newest);
        }
        if let Some(error) = self.first.take() {
            late.push_front(Box::pin(std::future::ready(Some(error))));
        }
    }
}

impl fmt::Debug for Answers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Answers").field("late", &lock(&self.late).len()).finish()
    }
}

/// Polls a future that needs no wake-up: it is polled again by a later call.
pub(super) fn poll_once<T>(future: &mut (impl Future<Output = T> + Unpin)) -> Poll<T> {
    Pin::new(future).poll(&mut Context::from_waker(Waker::noop()))
}

#[cfg(test)]
mod tests {
    use futures_channel::oneshot;

    use super::*;

    fn refused(what: &str) -> Option<GpuError> {
        Some(GpuError::Rejected { what: what.to_owned(), message: String::new() })
    }

    #[test]
    fn an_answer_that_is_there_is_returned() {
        let answers = Answers::default();
        assert_eq!(answers.now(std::future::ready(refused("a"))), refused("a"));
        assert_eq!(answers.arrived(), None);
    }

    #[test]
    fn a_late_error_arrives_once_and_in_order() {
        let answers = Answers::default();
        let (first, answer) = oneshot::channel();
        assert_eq!(answers.now(async { answer.await.ok().flatten() }), None);
        let (second, answer) = oneshot::channel();
        assert_eq!(answers.now(async { answer.await.ok().flatten() }), None);
        second.send(refused("b")).expect("the answer is kept");
        assert_eq!(answers.arrived(), None, "the first one is still out");
        first.send(refused("a")).expect("the answer is kept");
        assert_eq!(answers.arrived(), refused("a"));
        assert_eq!(answers.arrived(), None);
    }

    #[test]
    fn what_is_no_longer_waited_for_is_kept() {
        let answers = Answers::default();
        let mut ends = Vec::new();
        for _ in 0..3 {
            let (end, answer) = oneshot::channel();
            assert_eq!(answers.now(async { answer.await.ok().flatten() }), None);
            ends.push(end);
        }
        let mut ends = ends.into_iter();
        let mut answer = |error| {
            let end = ends.next().expect("there are three");
            end.send(error).expect("the answer is kept");
        };
        answer(refused("a"));
        let mut waiting = Box::pin(answers.all());
        assert_eq!(poll_once(&mut waiting), Poll::Pending);
        drop(waiting);
        assert_eq!(answers.arrived(), refused("a"));

        // An error of an answer that nobody waits for any more comes with a later call, too.
        let (end, answer) = oneshot::channel();
        assert_eq!(answers.now(async { answer.await.ok().flatten() }), None);
        let mut waiting = Box::pin(answers.all());
        assert_eq!(poll_once(&mut waiting), Poll::Pending);
        drop(waiting);
        end.send(refused("b")).expect("the answer is kept");
        assert_eq!(answers.arrived(), refused("b"));
    }

    #[test]
    fn waiting_returns_the_first_error() {
        let answers = Answers::default();
        let mut ends = Vec::new();
        for error in [None, refused("a"), refused("b")] {
            let (end, answer) = oneshot::channel();
            assert_eq!(answers.now(async { answer.await.ok().flatten() }), None);
            ends.push((end, error));
        }
        let waiting = std::thread::spawn(move || {
            for (end, error) in ends.into_iter().rev() {
                end.send(error).expect("the answer is kept");
            }
        });
        assert_eq!(pollster::block_on(answers.all()), refused("a"));
        waiting.join().expect("the thread ends");
    }
}
