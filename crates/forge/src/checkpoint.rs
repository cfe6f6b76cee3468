//! Checkpoints: the state of a job between two steps, from which interrupted work is resumed.
//!
//! A checkpoint holds everything that decides the next step, down to the moves that the neighbor
//! lists were built for, because the order of sums follows those lists. So a resumed job makes the
//! same table, bit for bit, as one that was never interrupted. A checkpoint names its job in full
//! and is refused by every other job.
//!
//! The file holds a magic number, seven counts, the job as lines of text, the state, and a digest
//! of all of these. Numbers are little-endian.

use std::{fs, io::ErrorKind, path::Path};

use strew_core::table::Digest;

use crate::{ForgeError, file, optimize::DescentState};

/// The first bytes of a checkpoint file. A change of the layout raises the digit.
const MAGIC: &[u8; 8] = b"strewck1";
/// The largest file that is read. A checkpoint has four vectors a block, at most 15 MB.
const MAX_BYTES: u64 = 32 << 20;
/// The length of the digest at the end of the file.
const DIGEST_BYTES: usize = 32;

/// The state of a job between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Everything that decides the result of the job, as lines of `name = value`.
    pub(crate) job: String,
    /// The current phase, from 0; the number of phases if only measuring is left.
    pub(crate) phase: u32,
    /// Steps done in all phases.
    pub(crate) steps: u32,
    /// Steps of all phases.
    pub(crate) of: u32,
    /// The state of the current phase.
    pub(crate) state: DescentState,
}

impl Checkpoint {
    /// The number of optimizer steps done.
    #[must_use]
    pub const fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether the optimizer is done, so that only measuring is left.
    #[must_use]
    pub const fn is_optimized(&self) -> bool {
        self.steps >= self.of
    }

    /// Refuses a job whose lines differ from those of the checkpoint.
    pub(crate) fn check(&self, job: &str, blocks: usize) -> Result<(), ForgeError> {
        if self.job == job {
            // The digest rules out damage; only a fault of the forge makes a state of another size.
            return match self.state.moves.len() == blocks {
                true => Ok(()),
                false => Err(wrong(format!(
                    "a state of {} blocks",
                    self.state.moves.len()
                ))),
            };
        }
        let differs = self.job.lines().zip(job.lines()).find(|(a, b)| a != b);
        let (theirs, ours) = differs.unwrap_or(("longer or shorter", "as described"));
        Err(ForgeError::Field {
            field: "checkpoint",
            value: format!("one of another job ({theirs})"),
            allowed: format!("one of this job ({ours})"),
        })
    }

    /// The content of a checkpoint file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let state = &self.state;
        let mut bytes = MAGIC.to_vec();
        let mut number = |value: u32| bytes.extend(value.to_le_bytes());
        for value in [
            self.phase,
            self.steps,
            self.of,
            state.steps,
            self.job.len() as u32,
            state.moves.len() as u32,
            state.prepared_for.len() as u32,
        ] {
            number(value);
        }
        bytes.extend(self.job.as_bytes());
        for value in [state.energy, state.last, state.age, state.slowing] {
            bytes.extend(value.to_le_bytes());
        }
        for list in [&state.moves, &state.at, &state.ahead, &state.prepared_for] {
            bytes.extend(list.iter().flatten().flat_map(|v| v.to_le_bytes()));
        }
        let digest = Digest::of(&bytes);
        bytes.extend(digest.as_bytes());
        bytes
    }

    /// Parses the content of a checkpoint file.
    ///
    /// # Errors
    /// [`ForgeError::Field`] if it is not a checkpoint of this version, or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ForgeError> {
        if !bytes.starts_with(MAGIC) {
            return Err(wrong("of an unknown format".into()));
        }
        let length = bytes.len().saturating_sub(DIGEST_BYTES);
        let (content, digest) = bytes.split_at(length);
        if Digest::of(content).as_bytes() != digest {
            return Err(wrong("damaged".into()));
        }
        let mut rest = Reader(&content[MAGIC.len()..]);
        Self::read(&mut rest).ok_or_else(|| wrong("damaged".into()))
    }

    /// Reads what is between the magic number and the digest.
    fn read(rest: &mut Reader<'_>) -> Option<Self> {
        let [phase, steps, of, own_steps] = [rest.u32()?, rest.u32()?, rest.u32()?, rest.u32()?];
        let [job, moves, prepared] = [rest.u32()?, rest.u32()?, rest.u32()?].map(|n| n as usize);
        let job = String::from_utf8(rest.take(job)?.to_vec()).ok()?;
        let [energy, last, age, slowing] = [rest.f64()?, rest.f64()?, rest.f64()?, rest.f64()?];
        let state = DescentState {
            energy,
            steps: own_steps,
            last,
            age,
            slowing,
            moves: rest.vectors(moves)?,
            at: rest.vectors(moves)?,
            ahead: rest.vectors(moves)?,
            prepared_for: rest.vectors(prepared)?,
        };
        let read = Self {
            job,
            phase,
            steps,
            of,
            state,
        };
        let sizes_agree = prepared == 0 || prepared == moves;
        (rest.0.is_empty() && sizes_agree).then_some(read)
    }

    /// Writes a file, whole or not at all; see [`write_table`](crate::write_table).
    ///
    /// # Errors
    /// [`ForgeError::File`] if a step fails; a file that was at `path` is then unchanged.
    pub fn write(&self, path: &Path) -> Result<(), ForgeError> {
        file::write_whole(path, &self.to_bytes())
    }

    /// Reads a file. Returns `None` if it does not exist.
    ///
    /// # Errors
    /// [`ForgeError::File`] if it cannot be read, [`ForgeError::NotACheckpoint`] if it is larger
    /// than any checkpoint or [`from_bytes`](Self::from_bytes) refuses it.
    pub fn read_file(path: &Path) -> Result<Option<Self>, ForgeError> {
        let failed = |action| {
            move |source| ForgeError::File {
                action,
                path: path.to_owned(),
                source,
            }
        };
        let not = |error: ForgeError| ForgeError::NotACheckpoint {
            path: path.to_owned(),
            error: Box::new(error),
        };
        let size = match fs::metadata(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            found => found.map_err(failed("examine"))?.len(),
        };
        if size > MAX_BYTES {
            return Err(not(wrong(format!("{size} bytes long"))));
        }
        let bytes = fs::read(path).map_err(failed("read"))?;
        Self::from_bytes(&bytes).map(Some).map_err(not)
    }
}

fn wrong(value: String) -> ForgeError {
    ForgeError::Field {
        field: "checkpoint",
        value,
        allowed: "one written by this version of the forge".into(),
    }
}

/// Takes values off the front of a file's content.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, bytes: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(bytes)?;
        self.0 = rest;
        Some(taken)
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn f64(&mut self) -> Option<f64> {
        Some(f64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    fn vectors(&mut self, count: usize) -> Option<Vec<[f64; 2]>> {
        let mut bytes = Reader(self.take(count.checked_mul(16)?)?);
        (0..count)
            .map(|_| Some([bytes.f64()?, bytes.f64()?]))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkpoint() -> Checkpoint {
        let mut state = DescentState::start(vec![[0.25, -1e-300], [3.0, f64::MIN_POSITIVE]]);
        state.prepared_for = vec![[1.0, 2.0], [3.0, 4.0]];
        state.slowing = 0.5;
        Checkpoint {
            job: "profile = blue\nseed = 17\n".into(),
            phase: 1,
            steps: 30,
            of: 40,
            state,
        }
    }

    #[test]
    fn a_written_file_reads_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.checkpoint");
        assert_eq!(Checkpoint::read_file(&path).expect("none"), None);
        checkpoint().write(&path).expect("written");
        assert_eq!(
            Checkpoint::read_file(&path).expect("read"),
            Some(checkpoint())
        );
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn damage_anywhere_is_found() {
        let good = checkpoint().to_bytes();
        for at in 0..good.len() {
            let mut bad = good.clone();
            bad[at] ^= 0x10;
            assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {at}");
            assert!(Checkpoint::from_bytes(&good[..at]).is_err(), "cut at {at}");
        }
        // A count beyond the end of the file, under a valid digest.
        let mut bad = good[..good.len() - DIGEST_BYTES].to_vec();
        bad[8 + 5 * 4..8 + 6 * 4].copy_from_slice(&u32::MAX.to_le_bytes());
        let digest = Digest::of(&bad);
        bad.extend(digest.as_bytes());
        let error = Checkpoint::from_bytes(&bad).expect_err("refused");
        assert!(error.to_string().contains("damaged"), "{error}");
    }

    #[test]
    fn a_checkpoint_of_another_job_is_refused_with_the_difference() {
        let kept = checkpoint();
        kept.check("profile = blue\nseed = 17\n", 2)
            .expect("its own");
        let error = kept
            .check("profile = blue\nseed = 18\n", 2)
            .expect_err("refused");
        let text = error.to_string();
        assert!(
            text.contains("seed = 17") && text.contains("seed = 18"),
            "{text}"
        );
        assert!(kept.check(&kept.job, 3).is_err());
    }
}
