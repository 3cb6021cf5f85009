//! The digest of an answer, in few bytes: enough to tell whether another one reports the same.

use crate::base::binary::{CHECKSUM_PRIME, EMPTY_CHECKSUM, Reader, Writer};
use crate::base::error::{Error, Result};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::scene::search::query::{Contact, PairResult, PiecePairs, SceneAnswer, SceneQuery};
use crate::scene::world::object::ObjectId;

/// The digest of one answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Digest {
    intersecting: bool,
    /// The query stopped at an intersecting pair, which is then the only one that is listed here.
    stopped: bool,
    count: u64,
    /// The checksum of which pairs are listed with which outcome.
    listed: u64,
    /// Sums over the listed pairs: the true one lies in between.
    lower: f64,
    upper: f64,
    /// The checksum of all bits of distances, intervals, points, normals and depths.
    bits: u64,
}

/// A sum over words: FNV-1a's step, of 64 bits at a time. Its product carries bits up alone, the rotation brings them down.
#[derive(Clone, Copy)]
struct Sum(u64);

impl Sum {
    fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(CHECKSUM_PRIME).rotate_left(29);
    }

    fn add_real(&mut self, x: f64) {
        // Which NaN it is does not matter.
        self.add(if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() });
    }
}

impl Digest {
    /// `name` names objects as the recording does, any other way for what is no object, and tells whether they are compounds.
    pub fn of(answer: &SceneAnswer, query: &SceneQuery, name: impl Fn(ObjectId) -> (u32, bool)) -> Digest {
        let results = answer.found.map_or(answer.pairs, std::slice::from_ref);
        let (mut listed, mut bits) = (Sum(EMPTY_CHECKSUM), Sum(EMPTY_CHECKSUM));
        let (mut lower, mut upper) = (0.0, 0.0);
        for PairResult { object1, object2, piece1, piece2, answer, .. } in results {
            let [(number1, is_compound1), (number2, is_compound2)] = [name(*object1), name(*object2)];
            listed.add(u64::from(number1) << 32 | u64::from(number2));
            // Which of several pieces a compound is named with, or is nearest, depends on earlier questions.
            let is_nearest = query.piece_pairs == PiecePairs::Nearest;
            let [varies1, varies2] = [is_compound1 || is_nearest, is_compound2 || is_nearest];
            let [fixed1, fixed2] = [u32::from(!varies1) * piece1, u32::from(!varies2) * piece2];
            listed.add(u64::from(fixed1) << 32 | u64::from(fixed2));
            if varies1 || varies2 {
                bits.add(u64::from(*piece1) << 32 | u64::from(*piece2));
            }
            listed.add(answer.outcome as u64);
            for x in [answer.distance, answer.lower, answer.upper] {
                bits.add_real(x);
            }
            let vectors = [answer.local1, answer.local2, answer.world1, answer.world2, answer.normal];
            vectors.as_flattened().iter().for_each(|x| bits.add_real(*x));
            lower += answer.lower;
            upper += answer.upper;
        }
        for Contact { depth, manifold, .. } in answer.contacts.contacts {
            bits.add_real(depth.depth);
            bits.add(u64::from(manifold.point_count));
        }
        Digest {
            intersecting: answer.intersecting,
            stopped: answer.found.is_some(),
            count: results.len() as u64,
            listed: listed.0,
            lower,
            upper,
            bits: bits.0,
        }
    }

    /// Whether both answers are the same, bit for bit.
    pub fn is(&self, other: &Digest) -> bool {
        let Digest { intersecting, stopped, count, listed, lower: _, upper: _, bits } = *self;
        let other = (other.intersecting, other.stopped, other.count, other.listed, other.bits);
        (intersecting, stopped, count, listed, bits) == other
    }

    /// Refuses an answer that cannot be right if the other one is, wherever it was found, and regardless of earlier questions to
    /// the scene.
    ///
    /// # Errors
    /// [`Error::Unverified`].
    pub fn check(&self, recorded: &Digest) -> Result<()> {
        let words = |digest: &Digest| {
            let verdict = if digest.intersecting { "some intersecting" } else { "none intersecting" };
            format!("{} pairs, {verdict}, distances from {:e} to {:e} in all", digest.count, digest.lower, digest.upper)
        };
        let refuse = |what: &str| {
            let (found, recorded) = (words(self), words(recorded));
            Err(Error::Unverified(format!("{what}: it says {found}; the recorded answer says {recorded}")))
        };
        if (self.intersecting, self.stopped, self.count) != (recorded.intersecting, recorded.stopped, recorded.count) {
            return refuse("the answer is not the recorded one");
        }
        if self.listed != recorded.listed {
            return refuse("the answer lists other pairs or outcomes than the recorded one");
        }
        // Each sum of n positive terms is off by n roundings of itself at most.
        let error = 2.0 * U * (self.count as f64 + 2.0);
        if self.lower > recorded.upper * (1.0 + error) || recorded.lower > self.upper * (1.0 + error) {
            return refuse("the intervals of distances have nothing in common with the recorded ones");
        }
        Ok(())
    }

    pub fn write(&self, to: &mut Writer) -> Result<()> {
        to.flag(self.intersecting)?;
        to.flag(self.stopped)?;
        to.raw(self.count.to_le_bytes())?;
        to.raw(self.listed.to_le_bytes())?;
        to.real(self.lower)?;
        to.real(self.upper)?;
        to.raw(self.bits.to_le_bytes())
    }

    pub fn read(from: &mut Reader) -> Result<Digest> {
        Ok(Digest {
            intersecting: from.flag()?,
            stopped: from.flag()?,
            count: u64::from_le_bytes(from.raw()?),
            listed: u64::from_le_bytes(from.raw()?),
            lower: from.real()?,
            upper: from.real()?,
            bits: u64::from_le_bytes(from.raw()?),
        })
    }
}
