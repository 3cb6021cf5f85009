//! Records read one behind the other, from bytes of any kind.

use std::fmt;
use std::io::{ErrorKind, Read};

use crate::base::binary::{EMPTY_CHECKSUM, Reader, checksum};
use crate::base::enumerator::Enumerator;
use crate::base::error::{Error, Result};
use crate::scene::recording::format::{MAGIC, Record, RecordKind, VERSION};
use crate::scene::recording::recorder::HEAD;

/// Bytes before the first record.
const OPENING: usize = 12;

/// The rest of a recording.
pub(crate) struct RecordReader {
    source: Box<dyn Read + Send + Sync>,
    /// The source's, in messages.
    name: String,
    /// The checksum of all that was read.
    sum: u64,
    /// Bytes that were read.
    position: u64,
    /// Whole records that were read.
    count: u64,
    content: Vec<u8>,
}

impl fmt::Debug for RecordReader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RecordReader({}, {})", self.name, self.position)
    }
}

/// The next item in a recording.
pub(crate) enum NextRecord {
    Record(Record<'static>),
    /// It ends within a record, or before the last one: the program did not end it.
    CutOff,
}

impl RecordReader {
    /// From the beginning.
    ///
    /// # Errors
    /// [`Error::File`] for a file that is no recording, or of another version.
    pub fn new(source: Box<dyn Read + Send + Sync>, name: String) -> Result<RecordReader> {
        let (sum, content) = (EMPTY_CHECKSUM, Vec::new());
        let mut reader = RecordReader { source, name, sum, position: 0, count: 0, content };
        let whole = reader.take(OPENING)?;
        let mut opening = Reader::new("the recording", &reader.content);
        if opening.raw().ok() != Some(MAGIC) {
            return Err(Error::File(format!("{}: this is no recording of a scene", reader.name)));
        }
        if !whole {
            return Err(Error::File(format!("{}: the recording ends before its first record", reader.name)));
        }
        let version = opening.number()?;
        if version != VERSION {
            let known = format!("this library reads version {VERSION}");
            return Err(Error::File(format!("{}: a recording of version {version}; {known}", reader.name)));
        }
        reader.sum = checksum(reader.sum, &reader.content);
        Ok(reader)
    }

    /// Bytes that were read.
    pub fn position(&self) -> u64 {
        self.position
    }

    /// The next record; no other comes after one that is cut off, [`Record::End`], or an error.
    ///
    /// # Errors
    /// [`Error::File`] for data that is damaged or cannot be read; the message tells where. [`Error::Memory`].
    pub fn next(&mut self) -> Result<NextRecord> {
        let start = self.position;
        if !self.take(HEAD)? {
            return Ok(NextRecord::CutOff);
        }
        let head = self.content.first_chunk::<HEAD>().copied().unwrap_or_default();
        let [kind, length, of_head] = [0, 4, 8].map(|at| u32::from_le_bytes([0, 1, 2, 3].map(|k| head[at + k])));
        if checksum(self.sum, &head[..8]) as u32 != of_head {
            return Err(self.damaged(start, "the checksum of its head is wrong"));
        }
        let Some(kind) = i32::try_from(kind).ok().and_then(RecordKind::from_number) else {
            return Err(self.damaged(start, "its kind is unknown"));
        };
        self.sum = checksum(self.sum, &head);
        if !self.take(length as usize + size_of::<u64>())? {
            return Ok(NextRecord::CutOff);
        }
        let (content, sum) = self.content.split_last_chunk::<8>().unwrap_or((&[], &[0; 8]));
        self.sum = checksum(self.sum, content);
        if self.sum != u64::from_le_bytes(*sum) {
            return Err(self.damaged(start, "its checksum is wrong"));
        }
        self.sum = checksum(self.sum, sum);
        let record = Record::read(kind, &mut Reader::new("the record", content));
        let record = record.map_err(|error| error.unless_memory(|error| self.damaged(start, error.message())))?;
        self.count += 1;
        if matches!(record, Record::End) && self.take(1)? {
            return Err(self.damaged(start, "there is more behind it, and it is the last"));
        }
        Ok(NextRecord::Record(record))
    }

    /// An error about the record that begins at `start`.
    pub fn damaged(&self, start: u64, what: &str) -> Error {
        let place = format!("record {} at byte {start}", self.count + 1);
        Error::File(format!("{}: the recording is damaged in {place}: {what}", self.name))
    }

    /// An error about the records that were read last.
    pub fn refused(&self, error: &Error) -> Error {
        let place = format!("before record {} at byte {}", self.count + 1, self.position);
        Error::File(format!("{}: the recording cannot be replayed {place}: {}", self.name, error.message()))
    }

    /// Makes the next bytes the content, and returns whether there are so many. No more room is asked for than for those that
    /// there are.
    fn take(&mut self, count: usize) -> Result<bool> {
        self.content.clear();
        let read = self.source.by_ref().take(count as u64).read_to_end(&mut self.content);
        let read = read.map_err(|e| match e.kind() {
            ErrorKind::OutOfMemory => Error::Memory(format!("{}: there is no memory for a record", self.name)),
            _ => Error::File(format!("{}: cannot be read: {e}", self.name)),
        })?;
        self.position += read as u64;
        Ok(read == count)
    }
}
