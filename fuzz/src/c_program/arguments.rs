//! Arguments as a careless program hands them over.

use std::alloc::{Layout, alloc, dealloc};
use std::ffi::CString;
use std::ptr::null_mut;

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::pair::*;
use swiftprox::ffi::shape_options::*;
use swiftprox::ffi::tuning::*;
use swiftprox::math::Pose;

use super::MOST_POINTS;
use crate::geometry::{any_number, points, pose};

/// Memory of exactly some size: the address sanitizer sees every access beyond it. Its bytes are 0xa5 at first.
pub struct Block {
    /// Its first byte.
    pub start: *mut u8,
    layout: Layout,
    /// What it points to.
    needs: Option<Box<Block>>,
}

impl Block {
    pub fn new(size: usize) -> Block {
        // Aligned for every struct and array of the interface.
        let layout = Layout::from_size_align(size.max(1), 8).expect("a small size");
        // SAFETY: not of size 0; all of it is written before it is read.
        let start = unsafe { alloc(layout) };
        assert!(!start.is_null());
        // SAFETY: as large as allocated.
        unsafe { start.write_bytes(0xa5, layout.size()) };
        Block { start, layout, needs: None }
    }

    pub fn of<T: Copy>(values: &[T]) -> Block {
        let block = Block::new(size_of_val(values));
        // SAFETY: as large as the values, and nobody else's.
        unsafe { block.start.cast::<T>().copy_from_nonoverlapping(values.as_ptr(), values.len()) };
        block
    }

    pub fn at<T>(&self) -> *mut T {
        self.start.cast()
    }

    /// Keeps what it points to.
    pub fn with(mut self, needs: Option<Block>) -> Block {
        self.needs = needs.map(Box::new);
        self
    }
}

impl Drop for Block {
    fn drop(&mut self) {
        // SAFETY: allocated with this layout.
        unsafe { dealloc(self.start, self.layout) };
    }
}

/// Null one time in sixteen.
pub fn or_null<T>(u: &mut Unstructured, pointer: *mut T) -> Result<*mut T> {
    Ok(if u.ratio(1, 16)? { null_mut() } else { pointer })
}

/// A versioned struct as a program hands it over: null, as it was initialised, or with bytes changed and any struct_size, which the
/// block then has at least.
pub fn options<T: Copy>(u: &mut Unstructured, value: &T, changes: &[(usize, &[u8])]) -> Result<Option<Block>> {
    let size = size_of::<T>();
    Ok(Some(match u.int_in_range(0..=15)? {
        0 => return Ok(None),
        1 => {
            let claimed = match u.int_in_range(0..=3)? {
                0 => u.arbitrary()?,
                1 => size + u.int_in_range(0..=64)?,
                _ => u.int_in_range(0..=size)?,
            };
            // An older header has fewer members, not a part of one: a pointer cut in two would be a wild one.
            let claimed = if claimed < size { claimed & !7 } else { claimed };
            // No more is looked at than the size of a struct that no version has.
            let block = Block::new(if claimed <= 4096 { claimed.max(8) } else { 8 });
            // SAFETY: both are as large.
            unsafe {
                block.start.write_bytes(0, block.layout.size());
                let common = block.layout.size().min(size);
                block.start.copy_from_nonoverlapping((&raw const *value).cast(), common);
                block.at::<usize>().write(claimed);
                if claimed > size && claimed <= 4096 && u.arbitrary()? {
                    block.start.add(u.int_in_range(size..=claimed - 1)?).write(u.arbitrary()?);
                }
            }
            block
        }
        _ => {
            let block = Block::of(std::slice::from_ref(value));
            for (offset, bytes) in changes {
                if u.ratio(1, 3)? {
                    // SAFETY: the offset of a member as large as the bytes.
                    unsafe { block.start.add(*offset).copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
                }
            }
            block
        }
    }))
}

pub fn start<T>(block: &Option<Block>) -> *mut T {
    block.as_ref().map_or(null_mut(), Block::at)
}

/// An array as a program hands it over: now and then null, or with a count that is wrong.
pub fn array<T>(u: &mut Unstructured, start: *mut T, count: usize) -> Result<(*mut T, usize)> {
    Ok(match u.int_in_range(0..=31)? {
        0 => (null_mut(), count),
        1 => (null_mut(), 0),
        2 => (start, u.int_in_range(0..=count)?),
        // Refused before anything is read: a negative number that became a size.
        3 => (start, usize::MAX - u.int_in_range(0..=9)?),
        _ => (start, count),
    })
}

/// Twelve doubles: a pose that is accepted, most of the time.
pub fn any_pose(u: &mut Unstructured) -> Result<Block> {
    let mut pose: Pose = pose(u)?;
    if u.ratio(1, 16)? {
        let mut last = 1.0;
        pose.rows[u.choose_index(3)?][u.choose_index(4)?] = any_number(u, &mut last)?;
    }
    Ok(Block::of(pose.rows.as_flattened()))
}

pub fn pair_config(u: &mut Unstructured) -> Result<Option<Block>> {
    let mut last = 1.0;
    let tolerance = any_number(u, &mut last)?.to_ne_bytes();
    let start = u.int_in_range(-1..=2_i32)?;
    let tuning = Block::of(&[CPairTuning { start, ..CPairTuning::DEFAULT }]);
    let changes = [(std::mem::offset_of!(CPairConfig, max_distance), &tolerance[..])];
    let config = options(u, &CPairConfig { tuning: tuning.at(), ..CPairConfig::DEFAULT }, &changes)?;
    Ok(config.map(|config: Block| config.with(Some(tuning))))
}

/// Half of the time the convex hull is asked for, which makes a shape of nearly anything.
pub fn shape_options(u: &mut Unstructured) -> Result<Option<Block>> {
    let mut tuning: CShapeTuning = CShapeTuning::DEFAULT;
    let mut value: CShapeOptions = CShapeOptions::DEFAULT;
    tuning.hierarchy = u.int_in_range(0..=3)?;
    tuning.minimum_triangles = u.int_in_range(0..=20)?;
    tuning.lookup = u.int_in_range(0..=3)?;
    tuning.lookup_resolution = *u.choose(&[0, 4, 8])?;
    if u.arbitrary()? {
        value.input = 2;
        let tuning = Block::of(&[tuning]);
        value.tuning = tuning.at();
        return Ok(Some(Block::of(&[value]).with(Some(tuning))));
    }
    let mut last = 1.0;
    let numbers = [any_number(u, &mut last)?, any_number(u, &mut last)?, any_number(u, &mut last)?];
    let input = u.int_in_range(-1..=3_i32)?.to_ne_bytes();
    let hierarchy = u.int_in_range(-1..=5_i32)?.to_ne_bytes();
    let lookup = u.int_in_range(-1..=4_i32)?.to_ne_bytes();
    let resolution = u.int_in_range(0..=17_u32)?.to_ne_bytes();
    let [scale, translation, tolerance] = numbers.map(f64::to_ne_bytes);
    let tuning_changes = [
        (std::mem::offset_of!(CShapeTuning, hierarchy), &hierarchy[..]),
        (std::mem::offset_of!(CShapeTuning, decimation), &scale[..]),
        (std::mem::offset_of!(CShapeTuning, lookup), &lookup[..]),
        (std::mem::offset_of!(CShapeTuning, lookup_resolution), &resolution[..]),
        (std::mem::offset_of!(CShapeTuning, lookup_radius_factor), &tolerance[..]),
    ];
    let tuning = options(u, &tuning, &tuning_changes)?;
    value.tuning = start(&tuning);
    let changes = [
        (std::mem::offset_of!(CShapeOptions, input), &input[..]),
        (std::mem::offset_of!(CShapeOptions, scale), &scale[..]),
        (std::mem::offset_of!(CShapeOptions, translation), &translation[..]),
        (std::mem::offset_of!(CShapeOptions, convexity_tolerance), &tolerance[..]),
        (std::mem::offset_of!(CShapeOptions, face_noise), &scale[..]),
        (std::mem::offset_of!(CShapeOptions, swept_radius), &translation[..]),
    ];
    Ok(options(u, &value, &changes)?.map(|options| options.with(tuning)))
}

/// A mesh in a program's arrays.
pub struct Arrays {
    pub vertices: Block,
    pub vertex_count: usize,
    pub indices: Block,
    pub valences: Block,
    pub face_count: usize,
    pub triangles: bool,
}

/// The hull of points as triangles, now and then with an index or a valence changed.
pub fn mesh_arrays(u: &mut Unstructured) -> Result<Arrays> {
    let points = points(u, MOST_POINTS)?;
    let hull = swiftprox::body::build::hull::convex_hull(&points).expect("finite points");
    let vertices: Vec<[f64; 3]> = hull.vertices.iter().map(|&v| points[v as usize].into()).collect();
    let place = |v: &u32| hull.vertices.binary_search(v).expect("corners are vertices") as u32;
    let mut indices: Vec<u32> = hull.triangles.iter().flatten().map(place).collect();
    let mut valences = vec![3_u32; indices.len() / 3];
    let triangles: bool = u.arbitrary()?;
    if u.ratio(1, 8)? && !indices.is_empty() {
        let at = u.choose_index(indices.len())?;
        indices[at] = u.int_in_range(0..=vertices.len() as u32 + 1)?;
    }
    if !triangles && u.ratio(1, 8)? && valences.len() > 1 {
        // As many corners in all, so that the arrays have the room that they claim.
        valences[0] += 1;
        valences[1] -= 1;
    }
    Ok(Arrays {
        vertex_count: vertices.len(),
        face_count: valences.len(),
        vertices: Block::of(&vertices),
        indices: Block::of(&indices),
        valences: Block::of(&valences),
        triangles,
    })
}

/// The path of a file with arbitrary contents, or of none.
pub fn mesh_file(u: &mut Unstructured) -> Result<Option<CString>> {
    let name = match u.int_in_range(0..=7)? {
        0 => return Ok(None),
        1 => return Ok(Some(c"/nowhere/at all.off".into())),
        2 => return Ok(Some(c"/".into())),
        _ => *u.choose(&["mesh.off", "mesh.obj", "mesh.stl", "mesh.tri", "mesh"])?,
    };
    let path = temporary_file(name);
    const TETRAHEDRON: &[u8] = b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    let contents = if u.arbitrary()? { TETRAHEDRON } else { u.arbitrary::<&[u8]>()? };
    std::fs::write(path.to_str().expect("a path in UTF-8"), contents).expect("room for a temporary file");
    Ok(Some(path))
}

/// A path for a file of this process alone.
pub fn temporary_file(name: &str) -> CString {
    let folder = std::env::temp_dir().join(format!("swiftprox-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    CString::new(folder.join(name).to_str().expect("a path in UTF-8")).expect("no zero byte")
}
