//! Checkpoints: where a job stands, so that interrupted work can go on.
//!
//! A checkpoint holds all that decides what comes next, down to the moves that lists of neighbors
//! were made for, because the order of sums follows those lists. So a job that goes on from one makes
//! the table, bit by bit, that it would have made at one go. It names its job in full; no other job
//! takes it.
//!
//! As a file: a mark, the job as lines of text, the state in little-endian numbers, and a digest of
//! it all.

use std::{fs, io::ErrorKind, path::Path};

use strew_core::table::Digest;

use crate::{ForgeError, Job, file, optimize::DescentState, plan::Plan};

/// The first bytes of a checkpoint file. The number rises with the layout.
const MARK: &[u8; 8] = b"strewck1";
/// No checkpoint is larger: it has four vectors a block, 15 MB for the largest maps.
const MAX_BYTES: u64 = 64 << 20;
/// The bytes of the digest at the end.
const DIGEST: usize = 32;

/// Where a job stands between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The job, everything that decides its result: lines of `name = value`.
    pub(crate) job: String,
    /// The phase under way, from 0; equal to their number when only measuring is left.
    pub(crate) phase: u32,
    /// Steps done, over all phases.
    pub(crate) steps: u32,
    /// Steps there are, over all phases.
    pub(crate) of: u32,
    /// The state of the phase.
    pub(crate) state: DescentState,
}

impl Checkpoint {
    /// Steps that are done.
    #[must_use]
    pub const fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether only measuring is left.
    #[must_use]
    pub const fn is_optimized(&self) -> bool {
        self.steps >= self.of
    }

    /// Whether it belongs to a job.
    ///
    /// # Errors
    /// [`ForgeError::Field`] with what differs, or for a part of the job that is not allowed.
    pub fn is_of(&self, job: &Job) -> Result<(), ForgeError> {
        let plan = Plan::new(job)?;
        self.check(&plan.identity(job, &plan.phases()), plan.blocks())
    }

    /// Whether it belongs to the job that these lines describe.
    pub(crate) fn check(&self, job: &str, blocks: usize) -> Result<(), ForgeError> {
        if self.job == job {
            // The digest has vouched for the rest; a state of another size would be our own fault.
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
            value: format!("that of another job ({theirs})"),
            allowed: format!("one of this job ({ours})"),
        })
    }

    /// The content of its file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let state = &self.state;
        let mut bytes = MARK.to_vec();
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

    /// Reads the content of a file.
    ///
    /// # Errors
    /// [`ForgeError::Field`] if it is no checkpoint, or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ForgeError> {
        if !bytes.starts_with(MARK) {
            return Err(wrong("no checkpoint, or one of another version".into()));
        }
        let length = bytes.len().saturating_sub(DIGEST);
        let (content, digest) = bytes.split_at(length);
        if Digest::of(content).as_bytes() != digest {
            return Err(wrong("damaged".into()));
        }
        let mut rest = Reader(&content[MARK.len()..]);
        Self::read(&mut rest).ok_or_else(|| wrong("damaged".into()))
    }

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
    /// [`ForgeError::File`]; what stood at `path` stands there still.
    pub fn write(&self, path: &Path) -> Result<(), ForgeError> {
        file::write_whole(path, &self.to_bytes())
    }

    /// Reads a file; `None` if there is none.
    ///
    /// # Errors
    /// [`ForgeError::File`] if it cannot be read, [`ForgeError::NotACheckpoint`] with what is wrong
    /// in it.
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
        allowed: "one that this version of the forge has written".into(),
    }
}

/// What is left of a file.
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

    fn some() -> Checkpoint {
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
    fn a_file_holds_all_of_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.checkpoint");
        assert_eq!(Checkpoint::read_file(&path).expect("none"), None);
        some().write(&path).expect("written");
        assert_eq!(Checkpoint::read_file(&path).expect("read"), Some(some()));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn damage_anywhere_is_found() {
        let good = some().to_bytes();
        for at in 0..good.len() {
            let mut bad = good.clone();
            bad[at] ^= 0x10;
            assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {at}");
            assert!(Checkpoint::from_bytes(&good[..at]).is_err(), "cut at {at}");
        }
        // Counts that promise more than there is, with a digest that agrees.
        let mut bad = good[..good.len() - DIGEST].to_vec();
        bad[8 + 5 * 4..8 + 6 * 4].copy_from_slice(&u32::MAX.to_le_bytes());
        let digest = Digest::of(&bad);
        bad.extend(digest.as_bytes());
        let error = Checkpoint::from_bytes(&bad).expect_err("refused");
        assert!(error.to_string().contains("damaged"), "{error}");
    }

    #[test]
    fn another_jobs_is_refused_with_the_difference() {
        let some = some();
        some.check("profile = blue\nseed = 17\n", 2)
            .expect("its own");
        let error = some
            .check("profile = blue\nseed = 18\n", 2)
            .expect_err("refused");
        let text = error.to_string();
        assert!(
            text.contains("seed = 17") && text.contains("seed = 18"),
            "{text}"
        );
        assert!(some.check(&some.job, 3).is_err());
    }
}
