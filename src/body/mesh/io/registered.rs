//! Readers that a program adds to those here, one registry for the process. A file is theirs when it begins with a reader's magic
//! bytes, which no two readers can claim: neither of two magics begins with the other.

use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use crate::base::error::{Error, Result};
use crate::base::memory::{copied, reserve};
use crate::base::simd::environment::with_callers;
use crate::body::mesh::PolygonMesh;

use super::scanner::{is_space, shown};
use super::{BYTE_ORDER_MARK, without_mark};

/// Makes a mesh of the bytes of a whole file, which come with white space before the magic and the magic itself, without a UTF-8
/// byte order mark. Several threads may call it at once; its error message need not name the file.
pub type MeshReader = dyn Fn(&[u8]) -> Result<PolygonMesh> + Send + Sync;

struct Registered {
    magic: Vec<u8>,
    reader: Arc<MeshReader>,
}

static READERS: RwLock<Vec<Registered>> = RwLock::new(Vec::new());

/// From now on, in all threads, `reader` reads the files that begin with `magic` behind white space and a UTF-8 byte order mark:
/// whatever their extension is, and before the readers for TRI, POLY, OFF, OBJ and STL. A reader that has the same magic is
/// replaced; one that is reading in another thread ends what it began.
///
/// The first bytes alone count: `PLY` is the magic of a file that begins with `PLYMOUTH`, too.
///
/// # Errors
/// [`Error::Argument`] for a magic that is empty or begins with white space or a byte order mark, which are skipped, and for one
/// that begins with that of another reader or the other way round. [`Error::Memory`].
pub fn register_mesh_reader(magic: &[u8], reader: Arc<MeshReader>) -> Result<()> {
    if magic.is_empty() {
        return Err(Error::Argument("the magic of a mesh reader is empty".into()));
    }
    if is_space(magic[0]) || magic.starts_with(BYTE_ORDER_MARK) {
        return Err(Error::Argument(format!(
            "the magic {} of a mesh reader begins with white space or a byte order mark, which are skipped in files",
            shown(magic)
        )));
    }
    let mut readers = write();
    let same = readers.iter_mut().find(|other| other.magic == magic);
    let replaced = match same {
        Some(registered) => Some(std::mem::replace(&mut registered.reader, reader)),
        None => {
            let overlaps = |other: &&Registered| magic.starts_with(&other.magic) || other.magic.starts_with(magic);
            if let Some(Registered { magic: other, .. }) = readers.iter().find(overlaps) {
                let longer = if magic.len() > other.len() { magic } else { other };
                return Err(Error::Argument(format!(
                    "a file that begins with {} would have two mesh readers: there is one for {}",
                    shown(longer),
                    shown(other)
                )));
            }
            reserve(&mut readers, 1)?;
            readers.push(Registered { magic: copied(magic)?, reader });
            None
        }
    };
    // The data that a reader holds are the program's, and may register readers where they are dropped.
    drop(readers);
    drop(replaced);
    Ok(())
}

/// Takes back the reader of files that begin with `magic`; false if it has no reader. It may still be reading in another thread.
pub fn unregister_mesh_reader(magic: &[u8]) -> bool {
    let mut readers = write();
    let place = readers.iter().position(|registered| registered.magic == magic);
    let removed = place.map(|place| readers.swap_remove(place));
    drop(readers); // before what it held, as above
    removed.is_some()
}

/// The mesh that the registered reader of such a file makes; `None` without such a reader. `name` stands for the file in
/// messages.
pub(super) fn parse(bytes: &[u8], name: &str) -> Option<Result<PolygonMesh>> {
    let bytes = without_mark(bytes);
    let start = bytes.iter().position(|&b| !is_space(b))?;
    let readers = read();
    let registered = readers.iter().find(|registered| bytes[start..].starts_with(&registered.magic))?;
    let (magic, reader) = (shown(&registered.magic), Arc::clone(&registered.reader));
    // The reader may read other files and register readers.
    drop(readers);
    let refused = |error: &Error| Error::File(format!("{name}: the reader registered for {magic}: {error}"));
    Some(with_callers(|| reader(bytes)).map_err(|error| error.unless_memory(refused)))
}

/// A reader that panicked somewhere else has left the list as it was.
fn read() -> RwLockReadGuard<'static, Vec<Registered>> {
    READERS.read().unwrap_or_else(PoisonError::into_inner)
}

fn write() -> RwLockWriteGuard<'static, Vec<Registered>> {
    READERS.write().unwrap_or_else(PoisonError::into_inner)
}
