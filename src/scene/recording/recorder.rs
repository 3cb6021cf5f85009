//! Records written one behind the other.

use std::collections::HashMap;
use std::fmt;
use std::io::Write;
use std::sync::{Arc, Weak};

use crate::base::binary::{EMPTY_CHECKSUM, Writer, checksum};
use crate::base::error::{Error, Result};
use crate::base::memory::{lacking, with_capacity};
use crate::compound::Compound;
use crate::ground::Ground;
use crate::scene::recording::format::{MAGIC, Record, VERSION};
use crate::shape::Shape;

/// So much is kept before it is handed to the system, in bytes.
const MOST_KEPT: usize = 1 << 16;

/// Bytes before the content of a record.
pub(crate) const HEAD: usize = 12;

pub(crate) struct Recorder {
    sink: Box<dyn Write + Send + Sync>,
    /// The sink's, in messages.
    name: String,
    /// The bytes that are not handed over yet.
    kept: Writer,
    /// The checksum of all that was written.
    sum: u64,
    shapes: Numbered<Shape>,
    grounds: Numbered<Ground>,
    compounds: Numbered<Compound>,
    /// Places in the order of creation of the objects that there were at first: their numbers are those in here.
    serials: Vec<u64>,
    /// The position in the order of creation of the objects that came later.
    first_new: u64,
}

/// The numbers of things that are written down, by addresses, which are theirs as long as a weak share is kept.
struct Numbered<T>(HashMap<usize, (Weak<T>, u32)>);

impl<T> Numbered<T> {
    /// Its number, and whether it is new: to be written down at once.
    fn number(&mut self, thing: &Arc<T>) -> Result<(u32, bool)> {
        let (address, count) = (Arc::as_ptr(thing).addr(), self.0.len());
        if let Some((_, number)) = self.0.get(&address) {
            return Ok((*number, false));
        }
        self.0.try_reserve(1).map_err(|e| lacking::<(usize, Weak<T>, u32)>(count + 1, &e))?;
        self.0.insert(address, (Arc::downgrade(thing), count as u32));
        Ok((count as u32, true))
    }
}

impl fmt::Debug for Recorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Recorder({})", self.name)
    }
}

impl Recorder {
    /// A recorder for a scene with objects of these places in the order of creation, of `created` that it ever had.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn new(sink: Box<dyn Write + Send + Sync>, name: String, serials: Vec<u64>, created: u64) -> Result<Recorder> {
        let mut kept = Writer::default();
        kept.raw(MAGIC)?;
        kept.number(VERSION)?;
        let sum = checksum(EMPTY_CHECKSUM, &kept.bytes);
        let (shapes, grounds) = (Numbered(HashMap::new()), Numbered(HashMap::new()));
        let compounds = Numbered(HashMap::new());
        Ok(Recorder { sink, name, kept, sum, shapes, grounds, compounds, serials, first_new: created })
    }

    /// The number of the object with this place in the order of creation.
    ///
    /// # Errors
    /// [`Error::Limit`].
    pub fn number(&self, serial: u64) -> Result<u32> {
        let number = match serial.checked_sub(self.first_new) {
            Some(place) => self.serials.len() as u64 + place,
            None => self.serials.partition_point(|known| *known < serial) as u64,
        };
        u32::try_from(number).map_err(|_| Error::Limit("a recording numbers objects up to 4294967295".into()))
    }

    /// The number of a shape, which is written down if it is not yet.
    ///
    /// # Errors
    /// As [`Recorder::write`].
    pub fn shape(&mut self, shape: &Arc<Shape>) -> Result<u32> {
        // A record that cannot be written ends the recording.
        let (number, is_new) = self.shapes.number(shape)?;
        if is_new {
            self.write(&Record::Shape(shape.clone()))?;
        }
        Ok(number)
    }

    /// The same of a ground.
    ///
    /// # Errors
    /// As [`Recorder::write`].
    pub fn ground(&mut self, ground: &Arc<Ground>) -> Result<u32> {
        let (number, is_new) = self.grounds.number(ground)?;
        if is_new {
            self.write(&Record::Ground(ground.clone()))?;
        }
        Ok(number)
    }

    /// The same of a compound, whose shapes are written down first.
    ///
    /// # Errors
    /// As [`Recorder::write`].
    pub fn compound(&mut self, compound: &Arc<Compound>) -> Result<u32> {
        let (number, is_new) = self.compounds.number(compound)?;
        if is_new {
            let mut pieces = with_capacity(compound.piece_count())?;
            for piece in compound.pieces() {
                pieces.push((self.shape(&piece.shape)?, piece.pose));
            }
            self.write(&Record::Compound(pieces.into()))?;
        }
        Ok(number)
    }

    /// Writes a record behind the others.
    ///
    /// # Errors
    /// [`Error::File`] where it cannot be written, [`Error::Memory`], [`Error::Limit`]; it is not there then.
    pub fn write(&mut self, record: &Record) -> Result<()> {
        let start = self.kept.bytes.len();
        if let Err(error) = self.append(record) {
            self.kept.bytes.truncate(start);
            return Err(error);
        }
        if self.kept.bytes.len() >= MOST_KEPT { self.hand_over() } else { Ok(()) }
    }

    fn append(&mut self, record: &Record) -> Result<()> {
        let start = self.kept.bytes.len();
        self.kept.number(record.kind() as u32)?;
        self.kept.raw([0; HEAD - 4])?;
        record.write(&mut self.kept)?;
        let bytes = &mut self.kept.bytes[start..];
        let Ok(length) = u32::try_from(bytes.len() - HEAD) else {
            return Err(Error::Limit(format!("{}: a record of more than 4294967295 bytes", self.name)));
        };
        bytes[4..8].copy_from_slice(&length.to_le_bytes());
        let of_head = checksum(self.sum, &bytes[..8]) as u32;
        bytes[8..HEAD].copy_from_slice(&of_head.to_le_bytes());
        let sum = checksum(self.sum, bytes);
        self.kept.raw(sum.to_le_bytes())?;
        self.sum = checksum(sum, &sum.to_le_bytes());
        Ok(())
    }

    /// Hands the kept bytes to the system: they outlive the program.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn hand_over(&mut self) -> Result<()> {
        let written = self.sink.write_all(&self.kept.bytes).and_then(|()| self.sink.flush());
        self.kept.bytes.clear();
        written.map_err(|e| Error::File(format!("{}: the recording ends, it cannot be written: {e}", self.name)))
    }

    /// Writes nothing any more but the kept bytes.
    pub fn give_up(&mut self) {
        // Only the reason for giving up counts.
        let _ = self.hand_over();
        self.sink = Box::new(std::io::sink());
    }

    /// Writes the last record.
    ///
    /// # Errors
    /// As [`Recorder::write`].
    pub fn end(&mut self) -> Result<()> {
        self.write(&Record::End)?;
        let ended = self.hand_over();
        self.sink = Box::new(std::io::sink());
        ended
    }
}

/// Ended with the scene.
impl Drop for Recorder {
    fn drop(&mut self) {
        let _ = self.end();
    }
}
