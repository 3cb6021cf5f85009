//! How far apart near pairs may be.

/// After this many queries with smaller tolerances, the list's tolerance follows.
const PATIENCE: u32 = 16;

/// τ: no pair is missing in the list that is so near.
#[derive(Debug, Default)]
pub(crate) struct ListTolerance {
    value: f64,
    /// Queries in a row whose tolerance was smaller, and the largest of those.
    smaller: u32,
    largest: f64,
}

impl ListTolerance {
    pub fn new(value: f64) -> ListTolerance {
        ListTolerance { value, ..ListTolerance::default() }
    }

    pub fn value(&self) -> f64 {
        self.value
    }

    /// Whether there is nothing to follow.
    pub fn is(&self, tolerance: f64) -> bool {
        (self.value == tolerance) & (self.smaller == 0)
    }

    /// Makes room for a query's; whether all boxes must be fitted anew.
    pub fn follow(&mut self, tolerance: f64) -> bool {
        debug_assert!(tolerance >= 0.0);
        if tolerance >= self.value {
            let is_larger = tolerance > self.value;
            *self = ListTolerance::new(tolerance);
            return is_larger;
        }
        let is_over = self.smaller >= PATIENCE;
        (self.smaller, self.largest) = (self.smaller + 1, self.largest.max(tolerance));
        if is_over {
            *self = ListTolerance::new(self.largest);
        }
        is_over
    }
}
