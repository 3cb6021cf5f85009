//! What a ray cast is asked: a ray.

use crate::base::error::{Error, Result};
use crate::base::math::Vector;

/// The points `origin + t·direction` with 0 ≤ t ≤ `t_max`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Where it begins, in the world.
    pub origin: [f64; 3],
    /// Where it leads, of any length but 0.
    pub direction: [f64; 3],
    /// Where it ends, from 0 to infinity.
    pub t_max: f64,
}

impl Ray {
    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`Error::Argument`], naming the member.
    pub(crate) fn check(&self) -> Result<()> {
        for (name, numbers) in [("origin", &self.origin), ("direction", &self.direction)] {
            if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
                return Err(Error::Argument(format!("the ray's {name}[{k}] is {}, it must be finite", numbers[k])));
            }
        }
        if self.direction == [0.0; 3] {
            return Err(Error::Argument("the ray's direction is 0: give it a length".into()));
        }
        if !(self.t_max >= 0.0) {
            return Err(Error::Argument(format!("the ray's t_max is {}, it must be at least 0", self.t_max)));
        }
        Ok(())
    }

    /// Where it begins.
    pub(crate) fn origin(&self) -> Vector {
        self.origin.into()
    }

    /// Where it leads.
    pub(crate) fn direction(&self) -> Vector {
        self.direction.into()
    }
}
