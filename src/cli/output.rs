//! The output of a command: standard output, a special file, or a file that appears only when it is
//! complete.

use std::{
    fs::{self, File},
    io::{self, IsTerminal as _},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow};
use serde::Serialize;

use super::{
    Failure,
    compression::{Compression, Sink},
    refuse,
    signals::Incomplete,
};

/// An open output. Until [`finish`](Self::finish) a regular file is called `NAME.partial`. A command that
/// fails or that a signal ends removes it, and a killed command leaves no file that looks complete.
pub(super) struct Output {
    writer: Sink,
    /// The path that was given; `None` for standard output.
    path: Option<PathBuf>,
    pending: Option<Pending>,
}

struct Pending {
    file: File,
    incomplete: Incomplete,
    /// The final path, with links followed.
    target: PathBuf,
}

/// The reader of the output closed it early. It has all it wanted, so the command succeeds quietly.
#[derive(Debug, thiserror::Error)]
#[error("the reader of the output closed it early")]
pub(super) struct ReaderLeft;

impl Output {
    /// Opens a path; `None` or `-` is standard output. A file is compressed if its name ends with .gz or .zst, and
    /// its folder is made if it is missing. Fails if the path cannot be written.
    pub(super) fn open(path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path.filter(|path| *path != Path::new("-")) else {
            return Ok(Self {
                writer: Sink::Plain(Box::new(io::stdout())),
                path: None,
                pending: None,
            });
        };
        let unwritable = || format!("cannot write {}", path.display());
        let (file, pending) = open(path).with_context(unwritable)?;
        let (compression, _) = Compression::of(path);
        Ok(Self {
            writer: Sink::new(Box::new(file), compression).with_context(unwritable)?,
            path: Some(path.to_owned()),
            pending,
        })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.writer
            .write_all(bytes)
            .map_err(|error| self.explained(error))
    }

    fn explained(&self, error: io::Error) -> anyhow::Error {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return ReaderLeft.into();
        }
        let place = match &self.path {
            Some(path) => format!("{}", path.display()),
            None => "standard output".into(),
        };
        anyhow::Error::new(error).context(format!("cannot write {place}"))
    }

    /// Writes the last bytes and ends.
    pub(super) fn end_with(mut self, bytes: &[u8]) -> Result<(), Failure> {
        self.write(bytes)?;
        Ok(self.finish()?)
    }

    /// Ends the output. A file is renamed to its final name once the disk holds all of it.
    pub(super) fn finish(mut self) -> anyhow::Result<()> {
        let writer = std::mem::replace(&mut self.writer, Sink::Plain(Box::new(io::sink())));
        writer.finish().map_err(|error| self.explained(error))?;
        let Some(Pending {
            file,
            incomplete,
            target,
        }) = self.pending.take()
        else {
            return Ok(());
        };
        let named = file
            .sync_all()
            .and_then(|()| incomplete.complete(|partial| fs::rename(partial, target)));
        named.map_err(|error| self.explained(error))
    }
}

fn open(path: &Path) -> anyhow::Result<(File, Option<Pending>)> {
    // A link stays one.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::metadata(&target) {
        Ok(metadata) if metadata.is_dir() => return Err(anyhow!("it is a folder")),
        Ok(metadata) => {
            // Fails without permission; the content stays.
            let file = File::options().write(true).open(&target)?;
            if !metadata.is_file() {
                return Ok((file, None));
            }
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let folder = target
                .parent()
                .filter(|folder| !folder.as_os_str().is_empty());
            if let Some(folder) = folder.filter(|folder| !folder.exists()) {
                let unwritable = || format!("cannot make the folder {}", folder.display());
                fs::create_dir_all(folder).with_context(unwritable)?;
            }
        }
        Err(error) => return Err(error.into()),
    }
    let mut partial = target.as_os_str().to_owned();
    partial.push(".partial");
    let (file, incomplete) = Incomplete::make(Path::new(&partial), |path| File::create(path))?;
    let pending = Pending {
        file: file.try_clone()?,
        incomplete,
        target,
    };
    Ok((file, Some(pending)))
}

/// Refuses to write binary data to a terminal, unless the path is `-`.
pub(super) fn must_not_be_terminal(path: Option<&Path>, what: &str) -> Result<(), Failure> {
    if path.is_none() && io::stdout().is_terminal() {
        refuse!(
            "{what} is not written to a terminal; allowed: -o FILE, a pipe, or -o - to write it anyway"
        );
    }
    Ok(())
}

pub(super) fn must_be_new(path: &Path, force: bool) -> Result<(), Failure> {
    if path.exists() && !force {
        refuse!("{} exists; --force replaces it", path.display());
    }
    Ok(())
}

/// Fails if a file could not be written. Leaves no file.
pub(super) fn check(path: &Path) -> anyhow::Result<()> {
    Output::open(Some(path)).map(drop)
}

pub(super) fn write(path: Option<&Path>, bytes: &[u8]) -> Result<(), Failure> {
    Output::open(path)?.end_with(bytes)
}

pub(super) fn print(text: &str) -> Result<(), Failure> {
    write(None, text.as_bytes())
}

/// Writes documents to standard output, one a line.
pub(super) fn print_json<T: Serialize>(
    documents: impl IntoIterator<Item = T>,
) -> Result<(), Failure> {
    let mut text = String::new();
    for document in documents {
        text += &serde_json::to_string(&document).context("a document cannot be written")?;
        text.push('\n');
    }
    print(&text)
}
