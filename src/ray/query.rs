//! The query of a ray cast: a ray.

use crate::base::error::{Error, Result};
use crate::base::math::Vector;

/// The points `origin + t·direction` with 0 ≤ t ≤ `t_max`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Start of the ray, in the world.
    pub origin: [f64; 3],
    /// Direction of the ray, of any length but 0.
    pub direction: [f64; 3],
    /// End of the ray, from 0 to infinity.
    pub t_max: f64,
}

impl Ray {
    /// Refuses a ray that is out of range.
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

    /// Start of the ray.
    pub(crate) fn origin(&self) -> Vector {
        self.origin.into()
    }

    /// Direction of the ray.
    pub(crate) fn direction(&self) -> Vector {
        self.direction.into()
    }
}
