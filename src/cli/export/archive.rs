//! One file with all chunks: a zip whose members have the names of a folder's files. It is written from beginning to
//! end, so a killed run leaves complete members and a broken one, which the next run writes again.

use std::{
    collections::HashMap,
    fs::{self, File},
    io::{self, BufWriter, Read as _, Seek as _, SeekFrom, Write as _},
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow, ensure};

use super::{
    chunks::{Chunk, Maker},
    lock::lock,
    record::{MANIFEST, Manifest, Record},
    spec::{DEFLATE, Spec},
    zip::{self, Content, Member},
};
use crate::cli::{Failure, refuse};

/// The options, the first member. A run that resumes compares them.
pub(super) const SPEC: &str = "export.json";
/// For each chunk in order: the offset of its bytes (8 bytes), their number (4), and its number of points (4).
pub(super) const INDEX: &str = "index.bin";

/// An archive that is being written.
#[derive(Debug)]
pub(super) struct Archive {
    path: PathBuf,
    partial: PathBuf,
    file: BufWriter<File>,
    /// The length so far.
    at: u64,
    spec: Member,
    chunks: Vec<Member>,
    is_deflated: bool,
}

fn other(path: &Path) -> Failure {
    Failure::Usage(anyhow!(
        "--archive {}: the file holds no export with these options (for --format arrow limits.block_bytes is one of \
         them): choose another name",
        path.display()
    ))
}

fn no_file(path: &Path) -> Failure {
    Failure::Usage(anyhow!(
        "--archive {}: not a regular file; allowed: a new file, or one of an export",
        path.display()
    ))
}

/// A complete archive, if it is of this export.
fn is_complete(path: &Path, spec: &Spec) -> Result<Found, Failure> {
    if !path.is_file() {
        return Err(no_file(path));
    }
    let manifest = Reader::open(path).and_then(|mut archive| archive.read(MANIFEST));
    let manifest = manifest.and_then(|bytes| Manifest::read(&bytes));
    match manifest.is_ok_and(|manifest| manifest.export == *spec) {
        true => Ok(Found::Complete),
        false => Err(other(path)),
    }
}

/// Whether a file holds only the beginning of a first member: a run was killed before it had written one.
fn is_torn(file: &mut File) -> io::Result<bool> {
    // Members with options are far shorter.
    const MOST: u64 = 1 << 20;
    if file.metadata()?.len() > MOST {
        return Ok(false);
    }
    let mut bytes = vec![];
    file.seek(SeekFrom::Start(0))?;
    file.read_to_end(&mut bytes)?;
    let begins = bytes
        .iter()
        .zip(zip::MEMBER)
        .all(|(byte, known)| byte == known);
    let has_second = bytes
        .windows(zip::MEMBER.len())
        .skip(1)
        .any(|window| window == zip::MEMBER);
    Ok(begins && !has_second)
}

/// The state of an archive that is opened.
#[derive(Debug)]
pub(super) enum Found {
    /// It is complete.
    Complete,
    /// It is empty, or holds the first chunks.
    Open(Box<Archive>, Vec<Record>),
}

impl Archive {
    /// Opens an archive for an export; refuses one that holds anything else.
    pub(super) fn open(path: &Path, spec: &Spec, maker: &Maker) -> Result<Found, Failure> {
        let unwritable = || format!("cannot write {}", path.display());
        if path.exists() {
            return is_complete(path, spec);
        }
        let mut partial = path.as_os_str().to_owned();
        partial.push(".partial");
        let partial = PathBuf::from(partial);
        if partial.exists() && !partial.is_file() {
            return Err(no_file(&partial));
        }
        let Some(mut file) = lock(&partial).with_context(unwritable)? else {
            refuse!(
                "--archive {}: another process writes this file",
                path.display()
            );
        };
        // Another process may have ended meanwhile; then the locked file is a new one, without content.
        if path.exists() {
            if file.metadata().with_context(unwritable)?.len() == 0 {
                fs::remove_file(&partial).with_context(unwritable)?;
            }
            return is_complete(path, spec);
        }
        let is_deflated = spec.archive.as_deref() == Some(DEFLATE);
        let ours = serde_json::to_vec(spec).context("the options cannot be written")?;
        let first = zip::next(&mut file, 0).with_context(unwritable)?;
        let first = match first {
            Some((name, member, theirs)) if name == SPEC && theirs == ours => Some(member),
            None if is_torn(&mut file).with_context(unwritable)? => None,
            _ => return Err(other(&partial)),
        };
        let mut archive = Self {
            path: path.into(),
            partial,
            at: 0,
            spec: Member::default(),
            chunks: vec![],
            is_deflated,
            file: BufWriter::with_capacity(1 << 20, file),
        };
        let records = match first {
            None => {
                archive.file.get_ref().set_len(0).with_context(unwritable)?;
                archive
                    .file
                    .seek(SeekFrom::Start(0))
                    .with_context(unwritable)?;
                archive.spec = archive.add(SPEC, ours)?;
                vec![]
            }
            Some(member) => {
                archive.spec = member;
                archive.at = zip::end(&member, SPEC);
                archive.recover(maker).with_context(unwritable)?
            }
        };
        Ok(Found::Open(Box::new(archive), records))
    }

    /// The complete chunks. Cuts off the rest of the file.
    fn recover(&mut self, maker: &Maker) -> io::Result<Vec<Record>> {
        let mut records = vec![];
        for i in 0..maker.grid.chunks() {
            let expected = maker.grid.name(maker.grid.place(i));
            let next = zip::next(self.file.get_mut(), self.at)?;
            let Some((_, member, bytes)) = next.filter(|(name, ..)| *name == expected) else {
                break;
            };
            self.at = zip::end(&member, &expected);
            self.chunks.push(member);
            records.push(Record::of(&Chunk {
                points: member.points.into(),
                bytes,
            }));
        }
        self.file.get_ref().set_len(self.at)?;
        self.file.seek(SeekFrom::Start(self.at))?;
        Ok(records)
    }

    /// Whether members are deflated.
    pub(super) const fn is_deflated(&self) -> bool {
        self.is_deflated
    }

    fn add(&mut self, name: &str, bytes: Vec<u8>) -> anyhow::Result<Member> {
        let is_deflated = self.is_deflated;
        let content = Content::new(bytes, is_deflated, 0).with_context(|| self.unwritable())?;
        self.write(name, &content)
    }

    fn write(&mut self, name: &str, content: &Content) -> anyhow::Result<Member> {
        let written = zip::write(&mut self.file, self.at, name, content);
        let member = written.with_context(|| self.unwritable())?;
        self.at = zip::end(&member, name);
        Ok(member)
    }

    fn unwritable(&self) -> String {
        format!("cannot write {}", self.partial.display())
    }

    /// Packs a chunk for [`put`](Self::put), on any thread.
    pub(super) fn pack(chunk: Chunk, is_deflated: bool) -> anyhow::Result<(Record, Content)> {
        let record = Record::of(&chunk);
        let content = Content::new(chunk.bytes, is_deflated, chunk.points);
        let content = content.context("a chunk is too large for an archive")?;
        Ok((record, content))
    }

    /// Writes the next chunk.
    pub(super) fn put(&mut self, name: &str, content: &Content) -> anyhow::Result<()> {
        let member = self.write(name, content)?;
        self.chunks.push(member);
        Ok(())
    }

    /// Hands everything to the system. An interrupted run resumes after it.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        self.file.flush().with_context(|| self.unwritable())
    }

    /// Removes the beginning of an export that stops here, so that another one may begin.
    pub(super) fn abandon(self) {
        // Without the removal, an export without chunks stays.
        let _ = fs::remove_file(&self.partial);
    }

    /// The files that only archives have beside the chunks.
    pub(super) fn extra(
        &self,
        spec: &Spec,
        maker: &Maker,
    ) -> anyhow::Result<Vec<(String, Vec<u8>)>> {
        let mut index = vec![];
        for (i, member) in self.chunks.iter().enumerate() {
            let data = member.data(&maker.grid.name(maker.grid.place(i)));
            index.extend(data.to_le_bytes());
            index.extend(member.packed.to_le_bytes());
            index.extend(member.points.to_le_bytes());
        }
        let spec = serde_json::to_vec(spec).context("the options cannot be written")?;
        Ok(vec![(SPEC.into(), spec), (INDEX.into(), index)])
    }

    /// Writes the documents and the central directory, which begins with the manifest and the index, and renames
    /// the file.
    pub(super) fn finish(
        mut self,
        documents: Vec<(String, Vec<u8>)>,
        maker: &Maker,
    ) -> anyhow::Result<()> {
        let mut members = vec![];
        for (name, bytes) in documents {
            let member = match &*name {
                SPEC => self.spec,
                // Readers take ranges of these.
                INDEX | MANIFEST => {
                    let content =
                        Content::new(bytes, false, 0).with_context(|| self.unwritable())?;
                    self.write(&name, &content)?
                }
                _ => self.add(&name, bytes)?,
            };
            members.push((name, member));
        }
        let rank = |name: &str| {
            [MANIFEST, INDEX]
                .iter()
                .position(|first| *first == name)
                .unwrap_or(2)
        };
        members.sort_by_key(|(name, _)| rank(name));
        let chunks = self.chunks.iter().enumerate();
        let chunks = chunks.map(|(i, member)| (maker.grid.name(maker.grid.place(i)), member));
        let members = members.iter().map(|(name, member)| (name.clone(), member));
        let written = zip::finish(&mut self.file, self.at, members.chain(chunks));
        let named = written
            .and_then(|()| self.file.flush())
            .and_then(|()| self.file.get_ref().sync_all())
            .and_then(|()| fs::rename(&self.partial, &self.path));
        named.with_context(|| format!("cannot write {}", self.path.display()))
    }
}

/// An archive to read.
#[derive(Debug)]
pub(super) struct Reader {
    file: File,
    /// The offsets of members, by name.
    members: HashMap<String, u64>,
    path: PathBuf,
}

impl Reader {
    pub(super) fn open(path: &Path) -> anyhow::Result<Self> {
        let unreadable = || format!("cannot read {}", path.display());
        // Devices have no end, and pipes block.
        let kind = fs::metadata(path).with_context(unreadable)?;
        ensure!(kind.is_file(), "{} is not a regular file", path.display());
        let mut file = File::open(path).with_context(unreadable)?;
        let members = zip::members(&mut file).with_context(unreadable)?;
        let members =
            members.with_context(|| format!("{} is no archive of an export", path.display()))?;
        let places = members
            .into_iter()
            .map(|(name, member)| (name, member.offset));
        Ok(Self {
            file,
            members: places.collect(),
            path: path.into(),
        })
    }

    /// The names of its members.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.members.keys().map(String::as_str)
    }

    /// The content of a member.
    pub(super) fn read(&mut self, name: &str) -> anyhow::Result<Vec<u8>> {
        let broken = || format!("{name} of {} is missing or damaged", self.path.display());
        let offset = *self.members.get(name).with_context(broken)?;
        let next = zip::next(&mut self.file, offset).with_context(broken)?;
        let content = next.filter(|(known, ..)| known == name);
        content.map(|(_, _, content)| content).with_context(broken)
    }
}
