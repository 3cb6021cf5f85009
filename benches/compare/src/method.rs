//! What is compared: a method answers distance queries about one model against itself, pose after pose.

use std::hint::black_box;
use std::ops::Range;

use testkit::PosePair;

/// What a method says about one pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reply {
    /// 0 when intersecting; NaN when the method failed.
    pub distance: f64,
    /// What is guaranteed to hold the distance; NaN for a method that guarantees nothing.
    pub interval: [f64; 2],
    /// Work done, in the method's own unit; NaN when it does not say.
    pub steps: f64,
    /// A tier beyond the usual one had to decide.
    pub fallback: bool,
    /// Integer arithmetic had to decide.
    pub exact: bool,
    /// Levels of detail answered.
    pub by_levels: bool,
}

impl Reply {
    /// Of a method that says nothing else.
    pub fn of(distance: f64) -> Reply {
        Reply { distance, interval: [f64::NAN; 2], steps: f64::NAN, fallback: false, exact: false, by_levels: false }
    }

    /// Of the guaranteed interval; NaN where nothing is guaranteed.
    pub fn width(&self) -> f64 {
        self.interval[1] - self.interval[0]
    }
}

/// A distance query with witness points, its coherence and its last answer.
pub trait Method {
    /// A word for tables and files.
    fn name(&self) -> &str;

    /// Takes over the poses of a scene, in whatever form the method wants them. Not timed.
    fn load(&mut self, poses: &[PosePair]);

    /// Drops all coherence.
    fn forget(&mut self);

    /// Answers the query at pose `i`; the answer stays in the method.
    fn ask(&mut self, i: usize);

    /// The last answer.
    fn reply(&self) -> Reply;

    /// All queries from the last to the first.
    fn run_backwards(&mut self, count: usize) {
        for i in (0..count).rev() {
            self.ask(i);
        }
    }

    /// What is timed: one virtual call for many queries, each query inlined into the loop.
    fn run(&mut self, queries: Range<usize>) {
        for i in queries {
            self.ask(i);
            black_box(&mut *self);
        }
    }
}

/// A method that drops all coherence before each query: bodies that meet for the first time. What dropping takes is timed, too.
pub struct Cold(pub Box<dyn Method>);

impl Method for Cold {
    fn name(&self) -> &str {
        self.0.name()
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.0.load(poses);
    }

    fn forget(&mut self) {
        self.0.forget();
    }

    fn ask(&mut self, i: usize) {
        self.0.forget();
        self.0.ask(i);
    }

    fn reply(&self) -> Reply {
        self.0.reply()
    }
}

/// One pass, coherence flowing.
pub fn replies(method: &mut dyn Method, count: usize) -> Vec<Reply> {
    method.forget();
    let mut reply = |i| {
        method.ask(i);
        method.reply()
    };
    (0..count).map(&mut reply).collect()
}
