//! Checkpoints: the state of a job between two steps, from which interrupted work is resumed.
//!
//! A checkpoint holds everything that decides the next step, down to the moves that the neighbor
//! lists were built for, because the order of sums follows those lists. So a resumed job makes the
//! same table, bit for bit, as one that was never interrupted. A checkpoint names its job in full
//! and is refused by every other job.
//!
//! The file holds a magic number, counts, the job as lines of text, the state, and a digest of all of
//! these. Numbers are little-endian. Tables of points in space have a magic number and a state of their own.

use std::{fs, io::ErrorKind, path::Path};

use strew_core::table::Digest;

use crate::{ForgeError, file, optimize::DescentState, space::SpaceState};

/// The first bytes of a checkpoint file. A change of the layout raises the digit.
const MAGIC: &[u8; 8] = b"strewck1";
/// Those of a checkpoint of a table of points in space.
const SPACE_MAGIC: &[u8; 8] = b"strewcs1";
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
    pub(crate) state: State,
}

/// The state of a phase.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum State {
    Plane(DescentState),
    Space(SpaceState),
}

impl State {
    /// The number of vectors.
    fn blocks(&self) -> usize {
        match self {
            Self::Plane(state) => state.moves.len(),
            Self::Space(state) => state.moves.len(),
        }
    }
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
            return match self.state.blocks() {
                found if found == blocks => Ok(()),
                found => Err(wrong(format!("a state of {found} blocks"))),
            };
        }
        let differs = self.job.lines().zip(job.lines()).find(|(a, b)| a != b);
        let (theirs, ours) = differs.unwrap_or(("longer or shorter", "as described"));
        Err(ForgeError::field(
            "checkpoint",
            format!("one of another job ({theirs})"),
            format!("one of this job ({ours})"),
        ))
    }

    /// The content of a checkpoint file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let (magic, counts) = match &self.state {
            State::Plane(state) => {
                let (moves, prepared) = (state.moves.len(), state.prepared_for.len());
                let counts = [
                    state.steps,
                    self.job.len() as u32,
                    moves as u32,
                    prepared as u32,
                ];
                (MAGIC, counts.to_vec())
            }
            State::Space(state) => (SPACE_MAGIC, vec![state.step, self.job.len() as u32]),
        };
        let mut bytes = magic.to_vec();
        for value in [self.phase, self.steps, self.of].into_iter().chain(counts) {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend(self.job.as_bytes());
        match &self.state {
            State::Plane(state) => {
                for value in [state.energy, state.last, state.age, state.slowing] {
                    bytes.extend(value.to_le_bytes());
                }
                for list in [&state.moves, &state.at, &state.ahead, &state.prepared_for] {
                    bytes.extend(list.iter().flatten().flat_map(|v| v.to_le_bytes()));
                }
            }
            State::Space(state) => {
                bytes.extend(state.least.to_le_bytes());
                for list in [&state.moves, &state.momentum, &state.best] {
                    bytes.extend((list.len() as u32).to_le_bytes());
                    bytes.extend(list.iter().flatten().flat_map(|v| v.to_le_bytes()));
                }
                bytes.extend((state.listed.len() as u32).to_le_bytes());
                let listed = state.listed.iter().flatten();
                bytes.extend(listed.flat_map(|v| v.to_le_bytes()));
            }
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
        let is_space = bytes.starts_with(SPACE_MAGIC);
        if !is_space && !bytes.starts_with(MAGIC) {
            return Err(wrong("of an unknown format".into()));
        }
        let length = bytes.len().saturating_sub(DIGEST_BYTES);
        let (content, digest) = bytes.split_at(length);
        if content.len() < MAGIC.len() || Digest::of(content).as_bytes() != digest {
            return Err(wrong("damaged".into()));
        }
        let mut rest = Reader(&content[MAGIC.len()..]);
        let read = match is_space {
            true => Self::read_space(&mut rest),
            false => Self::read(&mut rest),
        };
        read.filter(|_| rest.0.is_empty())
            .ok_or_else(|| wrong("damaged".into()))
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
            state: State::Plane(state),
        };
        (prepared == 0 || prepared == moves).then_some(read)
    }

    /// Reads the same of a checkpoint of points in space.
    fn read_space(rest: &mut Reader<'_>) -> Option<Self> {
        let [phase, steps, of, step] = [rest.u32()?, rest.u32()?, rest.u32()?, rest.u32()?];
        let job = rest.u32()? as usize;
        let job = String::from_utf8(rest.take(job)?.to_vec()).ok()?;
        let least = rest.f64()?;
        let mut list = || {
            let count = rest.u32()? as usize;
            rest.vectors(count)
        };
        let [moves, momentum, best] = [list()?, list()?, list()?];
        let count = rest.u32()? as usize;
        let mut bytes = Reader(rest.take(count.checked_mul(12)?)?);
        let listed = (0..count)
            .map(|_| Some([bytes.f32()?, bytes.f32()?, bytes.f32()?]))
            .collect::<Option<Vec<_>>>()?;
        let fits = |length: usize| length == 0 || length == moves.len();
        let sizes_agree = fits(momentum.len()) && fits(best.len()) && fits(listed.len());
        let state = State::Space(SpaceState {
            step,
            moves,
            momentum,
            listed,
            least,
            best,
        });
        sizes_agree.then_some(Self {
            job,
            phase,
            steps,
            of,
            state,
        })
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
        let failed = |action| ForgeError::file(action, path);
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

/// The refusal of a checkpoint whose job is the right one but whose state is of other points.
pub(crate) fn other_kind(of: &str) -> ForgeError {
    wrong(format!("one of {of}"))
}

fn wrong(value: String) -> ForgeError {
    ForgeError::field(
        "checkpoint",
        value,
        "one written by this version of the forge",
    )
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

    fn f32(&mut self) -> Option<f32> {
        Some(f32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn vectors<const N: usize>(&mut self, count: usize) -> Option<Vec<[f64; N]>> {
        let mut bytes = Reader(self.take(count.checked_mul(8 * N)?)?);
        let vector = |_| {
            let mut vector = [0.0; N];
            for v in &mut vector {
                *v = bytes.f64()?;
            }
            Some(vector)
        };
        (0..count).map(vector).collect()
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
            state: State::Plane(state),
        }
    }

    fn of_space() -> Checkpoint {
        let moves = vec![[0.25, -1e-300, 2.0], [3.0, f64::MIN_POSITIVE, 0.5]];
        Checkpoint {
            state: State::Space(SpaceState {
                step: 3,
                momentum: moves.clone(),
                listed: vec![[0.5, 1.0, -2.0]; 2],
                least: 0.75,
                moves,
                best: Vec::new(),
            }),
            ..checkpoint()
        }
    }

    #[test]
    fn a_written_file_reads_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.checkpoint");
        assert_eq!(Checkpoint::read_file(&path).expect("none"), None);
        for kept in [checkpoint(), of_space()] {
            kept.write(&path).expect("written");
            assert_eq!(Checkpoint::read_file(&path).expect("read"), Some(kept));
        }
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn damage_anywhere_is_found() {
        for good in [of_space(), checkpoint()].map(|kept| kept.to_bytes()) {
            for at in 0..good.len() {
                let mut bad = good.clone();
                bad[at] ^= 0x10;
                assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {at}");
                assert!(Checkpoint::from_bytes(&good[..at]).is_err(), "cut at {at}");
            }
        }
        let good = checkpoint().to_bytes();
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
