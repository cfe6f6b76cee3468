//! Checkpoints: the state of a job between two steps, from which interrupted work is resumed.
//!
//! A checkpoint holds everything that decides the next step, down to the moves that the neighbor
//! lists were built for, because the order of sums follows those lists. So a resumed job makes the
//! same table, bit for bit, as one that was never interrupted. A checkpoint names its job in full
//! and is refused by every other job.
//!
//! The file holds a magic number, counts, the job as lines of text, the state, and a digest of all of
//! these. A state is numbers and lists of numbers, so jobs of the plane and of space have one format. Numbers are
//! little-endian.

use std::{fs, io::ErrorKind, path::Path};

use strew_core::table::Digest;

use crate::{ForgeError, file};

/// The first bytes of a checkpoint file. A change of the layout raises the digit.
const MAGIC: &[u8; 8] = b"strewck3";
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
    /// The state of the phase.
    pub(crate) state: State,
}

/// All that decides the next step of a phase. Vectors, of the plane or of space, are lists of their components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// The steps done in the phase.
    pub steps: u32,
    /// A vector for each block, in mean spacings: the best so far, or the last.
    pub moves: Vec<f64>,
    /// The phase's own numbers, and lists of vectors, each empty or as long as the moves.
    pub(crate) numbers: [f64; 4],
    pub(crate) lists: [Vec<f64>; 3],
}

impl State {
    /// The state before any step of a phase.
    pub fn start(moves: Vec<f64>) -> Self {
        Self {
            moves,
            ..Self::default()
        }
    }
}

/// The vectors of a list of components.
pub(crate) fn vectors<const D: usize>(list: &[f64]) -> &[[f64; D]] {
    list.as_chunks().0
}

impl Checkpoint {
    /// The number of optimizer steps done.
    pub const fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether the optimizer is done, so that only measuring is left.
    pub const fn is_optimized(&self) -> bool {
        self.steps >= self.of
    }

    /// Refuses a job whose lines differ from those of the checkpoint.
    pub(crate) fn check(&self, job: &str) -> Result<(), ForgeError> {
        if self.job == job {
            return Ok(());
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
    pub fn to_bytes(&self) -> Vec<u8> {
        let State {
            steps,
            moves,
            numbers,
            lists: [a, b, c],
        } = &self.state;
        let lists = [moves, a, b, c];
        let mut bytes = MAGIC.to_vec();
        let lengths = lists.map(|list| list.len() as u32);
        let job = self.job.len() as u32;
        let counts = [self.phase, self.steps, self.of, *steps, job];
        bytes.extend(counts.iter().chain(&lengths).flat_map(|n| n.to_le_bytes()));
        bytes.extend(self.job.as_bytes());
        let lists = lists.into_iter().flatten();
        bytes.extend(numbers.iter().chain(lists).flat_map(|v| v.to_le_bytes()));
        let digest = Digest::of(&bytes);
        bytes.extend(digest.as_bytes());
        bytes
    }

    /// Parses the content of a checkpoint file.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ForgeError> {
        if !bytes.starts_with(MAGIC) {
            return Err(wrong("of an unknown format"));
        }
        let (content, digest) = bytes.split_at(bytes.len().saturating_sub(DIGEST_BYTES));
        if content.len() < MAGIC.len() || Digest::of(content).as_bytes() != digest {
            return Err(wrong("damaged"));
        }
        let mut rest = Reader(&content[MAGIC.len()..]);
        let read = Self::read(&mut rest);
        read.filter(|_| rest.0.is_empty())
            .ok_or_else(|| wrong("damaged"))
    }

    /// Reads what is between the magic number and the digest.
    fn read(rest: &mut Reader<'_>) -> Option<Self> {
        let counts: Option<Vec<u32>> = (0..9).map(|_| rest.u32()).collect();
        let [phase, steps, of, own_steps, job, moves, a, b, c] = counts?.try_into().ok()?;
        let job = String::from_utf8(rest.take(job as usize)?.to_vec()).ok()?;
        let numbers = rest.numbers(4)?.try_into().ok()?;
        let moves = rest.numbers(moves)?;
        let lists = [rest.numbers(a)?, rest.numbers(b)?, rest.numbers(c)?];
        let fits = |list: &Vec<f64>| list.is_empty() || list.len() == moves.len();
        lists.iter().all(fits).then_some(Self {
            job,
            phase,
            steps,
            of,
            state: State {
                steps: own_steps,
                numbers,
                moves,
                lists,
            },
        })
    }

    /// Writes a file, whole or not at all; see [`write_table`](crate::write_table).
    pub fn write(&self, path: &Path) -> Result<(), ForgeError> {
        file::write_whole(path, &self.to_bytes())
    }

    /// Reads a file. Returns `None` if it does not exist.
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

/// The refusal of a checkpoint.
pub(crate) fn wrong(value: impl ToString) -> ForgeError {
    let allowed = "one written by this version of the forge";
    ForgeError::field("checkpoint", value, allowed)
}

/// The front of a file's content.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, bytes: usize) -> Option<&'a [u8]> {
        self.0.split_off(..bytes)
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn numbers(&mut self, count: u32) -> Option<Vec<f64>> {
        let (bytes, _) = self.take((count as usize).checked_mul(8)?)?.as_chunks();
        Some(
            bytes
                .iter()
                .map(|&bytes| f64::from_le_bytes(bytes))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkpoint() -> Checkpoint {
        Checkpoint {
            job: "profile = blue\nseed = 17\n".into(),
            phase: 1,
            steps: 30,
            of: 40,
            state: State {
                steps: 3,
                moves: vec![0.25, -1e-300, f64::MIN_POSITIVE, 3.0],
                numbers: [0.5, f64::INFINITY, 0.0, -1.0],
                lists: [vec![1.0; 4], vec![], vec![]],
            },
        }
    }

    #[test]
    fn a_written_file_reads_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.checkpoint");
        assert_eq!(Checkpoint::read_file(&path).expect("none"), None);
        let kept = checkpoint();
        kept.write(&path).expect("written");
        assert_eq!(Checkpoint::read_file(&path).expect("read"), Some(kept));
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
        // Counts beyond the end of the file, under a valid digest.
        for count in 4..9 {
            let mut bad = good[..good.len() - DIGEST_BYTES].to_vec();
            bad[8 + count * 4..12 + count * 4].copy_from_slice(&u32::MAX.to_le_bytes());
            let digest = Digest::of(&bad);
            bad.extend(digest.as_bytes());
            let error = Checkpoint::from_bytes(&bad).expect_err("refused");
            assert!(error.to_string().contains("damaged"), "{error}");
        }
    }

    #[test]
    fn lists_are_of_all_blocks_or_empty() {
        let mut kept = checkpoint();
        kept.state.lists[2] = vec![1.0; 2];
        let error = Checkpoint::from_bytes(&kept.to_bytes()).expect_err("refused");
        assert!(error.to_string().contains("damaged"), "{error}");
    }
}
