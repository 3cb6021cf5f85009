//! Progress of long builds, and their cancellation.

use std::hint::black_box;

use crate::error::{Error, Result};
use crate::simd::environment;

/// Where a long build says how far it is: the caller's function gets a fraction that never falls, from 0 to 1, and returns whether
/// to go on.
pub struct Progress<'a> {
    callback: &'a mut (dyn FnMut(f64) -> bool + 'a),
    start: f64,
    end: f64,
}

impl<'a> Progress<'a> {
    /// The whole build.
    pub fn new(callback: &'a mut (dyn FnMut(f64) -> bool + 'a)) -> Progress<'a> {
        Progress { callback, start: 0.0, end: 1.0 }
    }

    /// A part of it: what reports to the part from 0 to 1 appears between `start` and `end` of the whole.
    pub fn part(&mut self, start: f64, end: f64) -> Progress<'_> {
        let length = self.end - self.start;
        Progress { callback: &mut *self.callback, start: self.start + start * length, end: self.start + end * length }
    }

    /// Says that `fraction` of the build, or of this part of it, is done.
    ///
    /// # Errors
    /// [`Error::Cancelled`] when the caller does not want to go on.
    pub fn report(&mut self, fraction: f64) -> Result<()> {
        // In the library's floating-point environment: nothing may move it behind the change to the program's.
        let fraction = black_box(self.start + fraction * (self.end - self.start));
        if environment::with_callers(|| (self.callback)(fraction)) {
            Ok(())
        } else {
            Err(Error::Cancelled("the progress callback asked to stop".into()))
        }
    }
}
