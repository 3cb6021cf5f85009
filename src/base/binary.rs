//! Numbers in binary files, little-endian, and the checksum that finds damage.

use crate::base::error::{Error, Result};
use crate::base::memory::{extend, with_capacity};

/// The 64-bit FNV-1a hash of no bytes (G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, "The FNV Non-Cryptographic Hash Algorithm",
/// IETF draft).
pub(crate) const EMPTY_CHECKSUM: u64 = 0xcbf2_9ce4_8422_2325;

/// The FNV-1a multiplier.
pub(crate) const CHECKSUM_PRIME: u64 = 0x0000_0100_0000_01b3;

/// The checksum of data with the checksum `before`, followed by these bytes.
pub(crate) fn checksum(before: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(before, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(CHECKSUM_PRIME))
}

/// Bytes that grow.
#[derive(Debug, Default)]
pub(crate) struct Writer {
    pub(crate) bytes: Vec<u8>,
}

impl Writer {
    pub(crate) fn raw<const N: usize>(&mut self, bytes: [u8; N]) -> Result<()> {
        extend(&mut self.bytes, bytes)
    }

    pub(crate) fn number(&mut self, x: u32) -> Result<()> {
        self.raw(x.to_le_bytes())
    }

    pub(crate) fn real(&mut self, x: f64) -> Result<()> {
        self.raw(x.to_le_bytes())
    }

    pub(crate) fn numbers(&mut self, list: &[u32]) -> Result<()> {
        debug_assert!(u32::try_from(list.len()).is_ok());
        self.number(list.len() as u32)?;
        list.iter().try_for_each(|x| self.number(*x))
    }
}

/// Reads the rest of some bytes.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    /// The owner of the bytes, for messages.
    whose: &'static str,
    whole: usize,
    pub(crate) rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub(crate) fn new(whose: &'static str, bytes: &'a [u8]) -> Reader<'a> {
        Reader { whose, whole: bytes.len(), rest: bytes }
    }

    /// The fraction that is read.
    pub(crate) fn done(&self) -> f64 {
        1.0 - self.rest.len() as f64 / self.whole as f64
    }

    pub(crate) fn damaged<T>(&self, what: &str) -> Result<T> {
        Err(Error::File(format!("{} is damaged: {what}", self.whose)))
    }

    pub(crate) fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        match self.rest.split_at_checked(count) {
            Some((taken, rest)) => {
                self.rest = rest;
                Ok(taken)
            }
            None => self.damaged("it is cut off"),
        }
    }

    /// The next `N` bytes.
    pub(crate) fn raw<const N: usize>(&mut self) -> Result<[u8; N]> {
        Ok(self.take(N)?.first_chunk().copied().unwrap_or([0; N]))
    }

    pub(crate) fn number(&mut self) -> Result<u32> {
        Ok(u32::from_le_bytes(self.raw()?))
    }

    pub(crate) fn real(&mut self) -> Result<f64> {
        Ok(f64::from_le_bytes(self.raw()?))
    }

    /// A list of items of so many bytes each; its length is checked against the rest before anything is allocated.
    pub(crate) fn list<T>(&mut self, size: usize, item: impl Fn(&mut Reader<'a>) -> Result<T>) -> Result<Vec<T>> {
        let count = self.number()? as usize;
        if count > self.rest.len() / size {
            return self.damaged("it is cut off");
        }
        let mut list = with_capacity(count)?;
        for _ in 0..count {
            list.push(item(self)?);
        }
        Ok(list)
    }

    pub(crate) fn numbers(&mut self) -> Result<Vec<u32>> {
        self.list(4, Reader::number)
    }
}
