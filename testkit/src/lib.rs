//! What tests, benchmarks, examples and fuzz targets share: bodies and motions from fixed seeds, the truth about a pair in exact
//! arithmetic by other algorithms than the library's, and what every answer must satisfy.

pub mod random;

pub mod counting;
pub mod files;
pub mod hard;
pub mod mesh_dialects;
pub mod models;
pub mod orbits;
pub mod provenance;
pub mod random_scene;
pub mod shapes;
pub mod solids;

pub mod any_size;
pub mod cases;
pub mod certificate;
pub mod oracle;

pub mod bodies;
pub mod caches;
pub mod casts;
pub mod forgery;
pub mod manifolds;
pub mod properties;
pub mod rays;
pub mod retold;
pub mod swept;

/// The poses of a pair: the row-major 3x4 `[R|T]` of object 1 and then of object 2.
pub type PosePair = [f64; 24];
