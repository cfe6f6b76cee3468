//! Reading that ends early once the result is no longer wanted.
//!
//! Decoders loop where nothing of ours runs, but all of them read: so the flag is looked at wherever they do, and
//! they are handed small pieces, each of which inflates to a few megabytes at most.

use std::io::{self, BufRead, Read, Seek, SeekFrom};

use strew_core::server::Stop;

use super::error::RasterError;

/// The most bytes read without a look at the flag.
const PIECE: usize = 4 << 10;

/// The most numbers that are converted without a look at the flag.
pub(super) const FEW: usize = 1 << 18;

/// The source of a decoder, whose reads fail once `stop` is raised.
#[derive(Debug)]
pub(super) struct Wanted<'a, R> {
    from: R,
    stop: &'a Stop,
}

impl<'a, R> Wanted<'a, R> {
    pub(super) const fn new(from: R, stop: &'a Stop) -> Self {
        Self { from, stop }
    }

    fn look(&self) -> io::Result<()> {
        match self.stop.is_raised() {
            true => Err(io::Error::other("not wanted any more")),
            false => Ok(()),
        }
    }
}

impl<R: Read> Read for Wanted<'_, R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        self.look()?;
        let most = out.len().min(PIECE);
        self.from.read(&mut out[..most])
    }
}

impl<R: BufRead> BufRead for Wanted<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.look()?;
        let all = self.from.fill_buf()?;
        Ok(&all[..all.len().min(PIECE)])
    }

    fn consume(&mut self, bytes: usize) {
        self.from.consume(bytes);
    }
}

impl<R: Seek> Seek for Wanted<'_, R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.from.seek(to)
    }
}

/// Ends a loop of ours once the flag is raised.
pub(super) fn look(stop: &Stop) -> Result<(), RasterError> {
    match stop.is_raised() {
        true => Err(RasterError::Stopped),
        false => Ok(()),
    }
}
