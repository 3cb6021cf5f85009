//! How a caller asks for a look-up table.

use crate::base::enumerator::enumerator;

/// The look-up table of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum LookupKind {
    /// Shells if the body has enough vertices for them to pay, else none: beside a body with shells all vertices are looked at.
    #[default]
    Automatic = 0,
    /// None.
    None = 1,
    /// Vertices near points on several spheres, looked up on both bodies for the vertex found on the other.
    Shells = 2,
    /// That of Ehmann & Lin (2000, section 4.6), looked up in the direction of the other body's centre of mass.
    Spherical = 3,
}

enumerator!(LookupKind { Automatic, None, Shells, Spherical });

/// How a body's look-up table is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LookupOptions {
    /// Which.
    pub kind: LookupKind,
    /// Shells: cells along a side of the square that all directions are mapped to, a power of two from 4 to 512. Spherical:
    /// increments from pole to pole, from 2 to 512; 32, 16 and 8 are 5.625°, 11.25° and 22.5°. 0 (the default): chosen by the
    /// body's number of vertices, or 32.
    pub resolution: u32,
    /// Spherical: radius of the sphere of sample points as a multiple of the body's, at least 1 (2 by default).
    pub radius_factor: f64,
}

impl LookupOptions {
    /// The defaults.
    pub const DEFAULT: LookupOptions = LookupOptions { kind: LookupKind::Automatic, resolution: 0, radius_factor: 2.0 };
}

impl Default for LookupOptions {
    fn default() -> Self {
        LookupOptions::DEFAULT
    }
}
