//! Reads and writes regular files: whatever else bears a file's name is refused, not waited for. A file that is read whole is no
//! larger than the limit.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::Path;

use crate::base::error::{Error, Result};
use crate::base::memory;

/// The largest mesh file or shape file that is read, in bytes.
pub const MOST_FILE_BYTES: u64 = 1 << 32;

/// The bytes of a regular file. `name` stands for it in messages.
///
/// # Errors
/// [`Error::File`] if it cannot be read, is no regular file or is larger than [`MOST_FILE_BYTES`]; [`Error::Memory`].
pub(crate) fn read_whole(path: &Path, name: &str) -> Result<Vec<u8>> {
    let (file, length) = open_to_read(path, name)?;
    if length > MOST_FILE_BYTES {
        return Err(too_large(name, MOST_FILE_BYTES));
    }
    read_at_most(file, length, MOST_FILE_BYTES, name)
}

/// A regular file to be read, and its length. `name` stands for it in messages.
///
/// # Errors
/// [`Error::File`] if it cannot be read or is no regular file.
pub(crate) fn open_to_read(path: &Path, name: &str) -> Result<(File, u64)> {
    let unreadable = |e: std::io::Error| Error::File(format!("{name}: cannot be read: {e}"));
    let file = open(OpenOptions::new().read(true), path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if !metadata.file_type().is_file() {
        let what = kind(&metadata.file_type());
        let cure = "only regular files are read: write its content to one first";
        return Err(Error::File(format!("{name}: cannot be read: it is {what}; {cure}")));
    }
    Ok((file, metadata.len()))
}

/// Makes these bytes the content of a regular file, a new one or one that is there.
///
/// # Errors
/// [`Error::File`] if it cannot be written or is no regular file.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    create(path)?.write_all(bytes).map_err(|e| unwritable(path, &e))
}

/// A regular file, a new one or one that is there, without content.
///
/// # Errors
/// [`Error::File`] if it cannot be written or is no regular file.
pub(crate) fn create(path: &Path) -> Result<File> {
    let unwritable = |e: std::io::Error| unwritable(path, &e);
    // Cut off only once it is known to be a file.
    let file = open(OpenOptions::new().write(true).create(true).truncate(false), path).map_err(unwritable)?;
    let file_type = file.metadata().map_err(unwritable)?.file_type();
    if !file_type.is_file() {
        let (name, what) = (path.display(), kind(&file_type));
        return Err(Error::File(format!("{name}: cannot be written: it is {what}; only regular files are written")));
    }
    file.set_len(0).map_err(unwritable)?;
    Ok(file)
}

fn unwritable(path: &Path, error: &std::io::Error) -> Error {
    Error::File(format!("{}: cannot be written: {error}", path.display()))
}

/// Opens a file without waiting for another end of it, and without becoming the terminal's.
fn open(options: &mut OpenOptions, path: &Path) -> std::io::Result<File> {
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(options, libc::O_NONBLOCK | libc::O_NOCTTY);
    options.open(path)
}

/// The kind of a file that is not regular, in words.
fn kind(file_type: &std::fs::FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if file_type.is_fifo() {
            return "a FIFO (a pipe)";
        }
        if file_type.is_char_device() || file_type.is_block_device() {
            return "a device";
        }
        if file_type.is_socket() {
            return "a socket";
        }
    }
    if file_type.is_dir() { "a directory" } else { "no regular file" }
}

/// All bytes that a reader gives, `expected` in number or not: files of /proc say that they are empty, others grow meanwhile.
fn read_at_most(reader: impl Read, expected: u64, most: u64, name: &str) -> Result<Vec<u8>> {
    // One byte more, so that the end is seen without growing.
    let mut bytes = memory::with_capacity(usize::try_from(expected).unwrap_or(usize::MAX - 1) + 1)?;
    reader.take(most + 1).read_to_end(&mut bytes).map_err(|e| match e.kind() {
        ErrorKind::OutOfMemory => Error::Memory(format!("{name}: there is no memory for its content")),
        _ => Error::File(format!("{name}: cannot be read: {e}")),
    })?;
    if bytes.len() as u64 > most {
        return Err(too_large(name, most));
    }
    Ok(bytes)
}

fn too_large(name: &str, most: u64) -> Error {
    let cure = "simplify the body, or take its hull first: only the vertices of that count";
    Error::File(format!("{name}: larger than {most} bytes, the most that is read of a file; {cure}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_that_never_ends_is_given_up_at_the_limit() {
        let error = read_at_most(std::io::repeat(b'1'), 0, 100_000, "endless").unwrap_err();
        assert!(error.message().contains("endless: larger than 100000 bytes"), "{error}");
        assert_eq!(read_at_most(std::io::repeat(b'1').take(7), 0, 7, "short").unwrap(), [b'1'; 7]);
        assert_eq!(read_at_most(&b"grown"[..], 2, 7, "short").unwrap(), b"grown");
    }
}
