//! A shape and the motion that carries it along.

use super::kinds::Motion;
use super::path::Path;
use crate::base::error::Result;
use crate::base::math::Pose;
use crate::shape::Shape;

/// A shape and how it moves.
#[derive(Debug, Clone, Copy)]
pub struct Moving<'a> {
    /// Its geometry.
    pub shape: &'a Shape,
    /// How it moves.
    pub motion: &'a Motion<'a>,
}

/// A shape in the frame that a motion moves: its own frame, or of a piece of an object a place in the object's. A point p of the
/// shape is where the motion has the point place·p, in real arithmetic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carried<'a> {
    pub shape: &'a Shape,
    pub motion: &'a Motion<'a>,
    /// `None` where the shape's own frame is the one that moves.
    pub place: Option<&'a Pose>,
}

impl<'a> From<Moving<'a>> for Carried<'a> {
    fn from(Moving { shape, motion }: Moving<'a>) -> Carried<'a> {
        Carried { shape, motion, place: None }
    }
}

impl Carried<'_> {
    /// The pose of the shape at a time, up to rounding.
    ///
    /// # Errors
    /// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted.
    #[inline]
    pub(super) fn pose(&self, path: &Path, time: f64) -> Result<Pose> {
        let pose = path.pose(time)?;
        let Some(place) = self.place else { return Ok(pose) };
        let whole = pose.after(place);
        whole.check()?;
        Ok(whole)
    }
}
