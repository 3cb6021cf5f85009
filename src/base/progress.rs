//! Progress of long builds, and their cancellation.

use std::hint::black_box;

use crate::base::error::{Error, Result};
use crate::base::simd::environment;

/// Steps between two reports. A step takes well below a microsecond; the longest, a sign from integers of 2,000 bits, some ten.
const STEPS_A_REPORT: usize = 2048;

/// Progress reports of a long build: the caller's function gets a fraction that never falls, from 0 to 1, and returns whether to
/// go on.
pub struct Progress<'a> {
    callback: &'a mut (dyn FnMut(f64) -> bool + 'a),
    start: f64,
    end: f64,
    /// Since the last report.
    steps: usize,
}

impl<'a> Progress<'a> {
    /// The whole build.
    pub fn new(callback: &'a mut (dyn FnMut(f64) -> bool + 'a)) -> Progress<'a> {
        Progress { callback, start: 0.0, end: 1.0, steps: 0 }
    }

    /// A part of it: reports to the part from 0 to 1 appear between `start` and `end` of the whole.
    pub fn part(&mut self, start: f64, end: f64) -> Progress<'_> {
        debug_assert!(0.0 <= start && start <= end && end <= 1.0);
        let length = self.end - self.start;
        let [start, end] = [start, end].map(|fraction| self.start + fraction * length);
        Progress { callback: &mut *self.callback, start, end, steps: 0 }
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

    /// One step of a loop, `done` of `all` of which are done: reports now and then.
    ///
    /// # Errors
    /// Same as [`Progress::report`].
    #[inline]
    pub fn step(&mut self, done: usize, all: usize) -> Result<()> {
        self.steps(1, done, all)
    }

    /// Same as [`Progress::step`], for work that takes as long as `count` steps.
    ///
    /// # Errors
    /// Same as [`Progress::report`].
    #[inline]
    pub fn steps(&mut self, count: usize, done: usize, all: usize) -> Result<()> {
        self.steps += count;
        if self.steps < STEPS_A_REPORT {
            return Ok(());
        }
        self.steps = 0;
        self.report(done as f64 / all as f64)
    }
}
