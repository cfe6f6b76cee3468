//! Where a command writes: standard output, a special file, or a file that appears only when it is
//! complete.

use std::{
    fs::{self, File},
    io::{self, Write},
    path::{Path, PathBuf},
};

use anyhow::Context as _;
use serde::Serialize;

use super::Failure;

/// An open output. Until [`finish`](Self::finish) a regular file goes by its name with `.partial`
/// behind it, so that what a killed command leaves never looks complete; one that fails leaves nothing.
pub(super) struct Output {
    writer: Box<dyn Write + Send>,
    /// The partial file and what it will be called.
    pending: Option<Pending>,
}

/// A file that is not complete.
struct Pending {
    file: File,
    partial: PathBuf,
    path: PathBuf,
}

impl Output {
    /// `None` or `-` is standard output.
    pub(super) fn open(path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path.filter(|path| *path != Path::new("-")) else {
            return Ok(Self {
                writer: Box::new(io::stdout()),
                pending: None,
            });
        };
        let special = fs::metadata(path).is_ok_and(|metadata| !metadata.is_file());
        let partial = if special {
            path.to_owned()
        } else {
            let mut name = path.as_os_str().to_owned();
            name.push(".partial");
            name.into()
        };
        let file = if special {
            File::options().write(true).open(&partial)
        } else {
            File::create(&partial)
        };
        let file = file.with_context(|| format!("cannot write {}", partial.display()))?;
        let pending = match special {
            true => None,
            false => Some(Pending {
                file: file.try_clone()?,
                partial,
                path: path.to_owned(),
            }),
        };
        Ok(Self {
            writer: Box::new(file),
            pending,
        })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.writer
            .write_all(bytes)
            .map_err(|error| self.explained(error))
    }

    fn explained(&self, error: io::Error) -> anyhow::Error {
        let place = match &self.pending {
            Some(pending) => format!("{}", pending.partial.display()),
            None => "the output".into(),
        };
        match error.kind() {
            io::ErrorKind::BrokenPipe => {
                anyhow::anyhow!("the reader of the output closed it early")
            }
            _ => anyhow::Error::new(error).context(format!("cannot write to {place}")),
        }
    }

    /// Everything is written: a file gets its name, once the disk has it all.
    pub(super) fn finish(mut self) -> anyhow::Result<()> {
        self.writer.flush().map_err(|error| self.explained(error))?;
        if let Some(Pending {
            file,
            partial,
            path,
        }) = &self.pending
        {
            file.sync_all().map_err(|error| self.explained(error))?;
            fs::rename(partial, path).with_context(|| {
                format!("cannot rename {} to {}", partial.display(), path.display())
            })?;
        }
        self.pending = None;
        Ok(())
    }
}

impl Drop for Output {
    /// What was not finished serves nobody, and may be what fills the disk.
    fn drop(&mut self) {
        if let Some(pending) = self.pending.take() {
            let _ = fs::remove_file(pending.partial);
        }
    }
}

/// Writes a text to standard output.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    let mut output = Output::open(None)?;
    output.write(text.as_bytes())?;
    Ok(output.finish()?)
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
