//! The destination of a manifold's points.

use super::answer::ManifoldPoint;

/// Fills all members of a point in its final place: numbers just written one by one are not copied (rule R1).
pub(crate) type Fill<'a> = &'a mut dyn FnMut(&mut ManifoldPoint);

/// The destination of points.
pub(crate) struct Sink<'a> {
    /// How many there is room for.
    pub capacity: usize,
    /// How many have been written.
    pub written: usize,
    /// Has one filled at its place.
    pub write: &'a mut dyn FnMut(usize, Fill),
}

impl Sink<'_> {
    pub(super) fn push(&mut self, mut fill: impl FnMut(&mut ManifoldPoint)) {
        if self.written < self.capacity {
            (self.write)(self.written, &mut fill);
            self.written += 1;
        }
    }

    /// Adds one that must be among them, in place of the last where there is no room.
    pub(super) fn insist(&mut self, fill: impl FnMut(&mut ManifoldPoint)) {
        if self.capacity > 0 {
            self.written = self.written.min(self.capacity - 1);
            self.push(fill);
        }
    }
}
