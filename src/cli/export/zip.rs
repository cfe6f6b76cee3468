//! The part of the zip format that archives need: members one after another, stored or deflated, then the central
//! directory, with the fields for more than 65,534 members and 4 GiB where they are needed (APPNOTE 6.3).

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom, Write},
};

use flate2::{Crc, read::DeflateDecoder, write::DeflateEncoder};

/// A written member.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Member {
    /// Whether its content is deflated, else stored.
    pub(super) is_deflated: bool,
    crc: u32,
    /// The length of its content in the file.
    pub(super) packed: u32,
    size: u32,
    /// Where its head begins.
    pub(super) offset: u64,
    /// The number of points, in a field of our own.
    pub(super) points: u32,
}

/// A member's content, ready to be written.
#[derive(Clone, Debug)]
pub(super) struct Content {
    head: Member,
    bytes: Vec<u8>,
}

/// The length of a head without the name: with our field.
const HEAD: u64 = 30 + 8;
/// The signature of a member.
pub(super) const MEMBER: &[u8] = b"PK\x03\x04";
/// Our field, `SP`: the number of points.
const POINTS: u16 = 0x5053;

impl Member {
    /// Where its content begins.
    pub(super) fn data(&self, name: &str) -> u64 {
        self.offset + HEAD + name.len() as u64
    }
}

impl Content {
    /// Some bytes, deflated if that is wanted.
    pub(super) fn new(bytes: Vec<u8>, is_deflated: bool, points: u64) -> io::Result<Self> {
        let large = || {
            io::Error::new(
                io::ErrorKind::InvalidInput,
                "a file of an archive has less than 4 GiB",
            )
        };
        let short = |length: usize| u32::try_from(length).map_err(|_| large());
        let (crc, size) = (crc(&bytes), short(bytes.len())?);
        let bytes = match is_deflated {
            true => {
                let mut encoder = DeflateEncoder::new(vec![], flate2::Compression::default());
                encoder.write_all(&bytes)?;
                encoder.finish()?
            }
            false => bytes,
        };
        let head = Member {
            is_deflated,
            crc,
            packed: short(bytes.len())?,
            size,
            offset: 0,
            points: u32::try_from(points).map_err(|_| large())?,
        };
        Ok(Self { head, bytes })
    }
}

fn crc(bytes: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum()
}

/// Puts numbers into a head.
struct Fields(Vec<u8>);

macro_rules! put {
    ($($kind:ident)+) => {$(
        fn $kind(mut self, value: $kind) -> Self {
            self.0.extend(value.to_le_bytes());
            self
        }
    )+};
}

impl Fields {
    put! { u16 u32 u64 }

    /// The common part of heads in both places, up to the length of the name.
    fn member(self, member: &Member, name: &str) -> Self {
        let method = if member.is_deflated { 8 } else { 0 };
        // Names are UTF-8; the first day of the calendar.
        let fields = self.u16(0x0800).u16(method).u16(0).u16(0x21);
        let fields = fields.u32(member.crc).u32(member.packed).u32(member.size);
        fields.u16(name.len() as u16)
    }

    fn points(self, member: &Member) -> Self {
        self.u16(POINTS).u16(4).u32(member.points)
    }
}

/// Writes a member at a place of the file.
pub(super) fn write(
    file: &mut impl Write,
    offset: u64,
    name: &str,
    content: &Content,
) -> io::Result<Member> {
    let member = Member {
        offset,
        ..content.head
    };
    let fields = Fields(MEMBER.to_vec()).u16(20).member(&member, name).u16(8);
    file.write_all(&fields.0)?;
    file.write_all(name.as_bytes())?;
    file.write_all(&Fields(vec![]).points(&member).0)?;
    file.write_all(&content.bytes)?;
    Ok(member)
}

/// Writes the central directory, which ends the file.
pub(super) fn finish<'a>(
    file: &mut impl Write,
    offset: u64,
    members: impl Iterator<Item = (String, &'a Member)>,
) -> io::Result<()> {
    let (mut length, mut count) = (0, 0_u64);
    for (name, member) in members {
        let is_far = member.offset >= u64::from(u32::MAX);
        let extra = 8 + if is_far { 12 } else { 0 };
        let near = u32::try_from(member.offset).unwrap_or(u32::MAX);
        let fields = Fields(b"PK\x01\x02".to_vec())
            .u16(0x031e)
            .u16(if is_far { 45 } else { 20 });
        let fields = fields.member(member, &name).u16(extra).u16(0).u16(0).u16(0);
        let mut head = fields.u32(0o100_644 << 16).u32(near).0;
        head.extend(name.as_bytes());
        let mut fields = Fields(head).points(member);
        if is_far {
            fields = fields.u16(1).u16(8).u64(member.offset);
        }
        file.write_all(&fields.0)?;
        (length, count) = (length + fields.0.len() as u64, count + 1);
    }
    let mut end = Fields(vec![]);
    let (short, few) = (u32::try_from(length), u16::try_from(count));
    if count >= 0xffff || length >= u64::from(u32::MAX) || offset >= u64::from(u32::MAX) {
        end = Fields(b"PK\x06\x06".to_vec())
            .u64(44)
            .u16(0x031e)
            .u16(45)
            .u32(0)
            .u32(0);
        end = end.u64(count).u64(count).u64(length).u64(offset);
        end.0.extend(b"PK\x06\x07");
        end = end.u32(0).u64(offset + length).u32(1);
    }
    end.0.extend(b"PK\x05\x06");
    let few = few.unwrap_or(0xffff);
    let near = u32::try_from(offset).unwrap_or(u32::MAX);
    end = end
        .u16(0)
        .u16(0)
        .u16(few)
        .u16(few)
        .u32(short.unwrap_or(u32::MAX))
        .u32(near)
        .u16(0);
    file.write_all(&end.0)
}

/// Reads numbers of a head.
#[derive(Clone, Copy)]
struct Head<'a>(&'a [u8]);

impl Head<'_> {
    fn u16(self, at: usize) -> u16 {
        self.0
            .get(at..at + 2)
            .map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    fn u32(self, at: usize) -> u32 {
        u32::from(self.u16(at)) | u32::from(self.u16(at + 2)) << 16
    }

    fn u64(self, at: usize) -> u64 {
        u64::from(self.u32(at)) | u64::from(self.u32(at + 4)) << 32
    }

    /// The common part of heads in both places, beginning with the flags.
    fn member(self, at: usize, offset: u64) -> Member {
        Member {
            is_deflated: self.u16(at + 2) == 8,
            crc: self.u32(at + 8),
            packed: self.u32(at + 12),
            size: self.u32(at + 16),
            offset,
            points: 0,
        }
    }
}

/// The name, the head and the content of the member at an offset; `None` if it is incomplete.
pub(super) fn next(file: &mut File, offset: u64) -> io::Result<Option<(String, Member, Vec<u8>)>> {
    file.seek(SeekFrom::Start(offset))?;
    let Some(bytes) = exactly(file, 30)? else {
        return Ok(None);
    };
    let head = Head(&bytes);
    if !bytes.starts_with(MEMBER) || head.u16(28) != 8 {
        return Ok(None);
    }
    let mut member = head.member(6, offset);
    let Some(name) = exactly(file, u64::from(head.u16(26)))? else {
        return Ok(None);
    };
    let Some(extra) = exactly(file, 8)? else {
        return Ok(None);
    };
    member.points = Head(&extra).u32(4);
    let Some(packed) = exactly(file, u64::from(member.packed))? else {
        return Ok(None);
    };
    let content = unpacked(&member, packed)?;
    let is_whole = content
        .as_ref()
        .is_some_and(|content| crc(content) == member.crc);
    let name = String::from_utf8(name).ok();
    Ok(name
        .zip(content)
        .filter(|_| is_whole)
        .map(|(name, content)| (name, member, content)))
}

/// The place after a member.
pub(super) fn end(member: &Member, name: &str) -> u64 {
    member.data(name) + u64::from(member.packed)
}

fn unpacked(member: &Member, packed: Vec<u8>) -> io::Result<Option<Vec<u8>>> {
    if !member.is_deflated {
        return Ok(Some(packed));
    }
    let mut content = vec![];
    let decoder = DeflateDecoder::new(&*packed);
    // No more than the announced size.
    let read = decoder
        .take(u64::from(member.size) + 1)
        .read_to_end(&mut content);
    Ok(read.is_ok().then_some(content))
}

/// Some bytes of a file; `None` if it ends before.
fn exactly(file: &mut File, length: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = vec![];
    io::Read::by_ref(file)
        .take(length)
        .read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 == length).then_some(bytes))
}

/// The members of the central directory, in its order; `None` without one.
pub(super) fn members(file: &mut File) -> io::Result<Option<Vec<(String, Member)>>> {
    let length = file.seek(SeekFrom::End(0))?;
    // Our files have no comment, so the end is the last 22 bytes, and what it cannot say is in the 76 before.
    let from = length.saturating_sub(22 + 76);
    file.seek(SeekFrom::Start(from))?;
    let mut tail = vec![];
    file.read_to_end(&mut tail)?;
    let Some(end) = tail
        .len()
        .checked_sub(22)
        .filter(|at| tail[*at..].starts_with(b"PK\x05\x06"))
    else {
        return Ok(None);
    };
    let all = Head(&tail);
    let is_long = end == 76 && tail.starts_with(b"PK\x06\x06");
    let (count, bytes, offset) = match is_long {
        true => (all.u64(24), all.u64(40), all.u64(48)),
        false => (
            all.u16(end + 8).into(),
            all.u32(end + 12).into(),
            all.u32(end + 16).into(),
        ),
    };
    file.seek(SeekFrom::Start(offset))?;
    let Some(directory) = exactly(file, bytes)? else {
        return Ok(None);
    };
    let mut at = 0;
    let mut members = vec![];
    for _ in 0..count {
        let head = Head(directory.get(at..).unwrap_or_default());
        let (name, extra) = (usize::from(head.u16(28)), usize::from(head.u16(30)));
        let text = head
            .0
            .get(46..46 + name)
            .map(|name| String::from_utf8_lossy(name).into_owned());
        let Some(text) = text.filter(|_| head.0.starts_with(b"PK\x01\x02")) else {
            return Ok(None);
        };
        let near = head.u32(42);
        let offset = match near {
            u32::MAX => head.u64(46 + name + 8 + 4),
            near => near.into(),
        };
        let points = head.u32(46 + name + 4);
        members.push((
            text,
            Member {
                points,
                ..head.member(8, offset)
            },
        ));
        at += 46 + name + extra;
    }
    Ok(Some(members))
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    /// Stored content, with a number of points.
    fn content(text: &str, points: u64) -> Content {
        Content::new(text.into(), false, points).expect("short")
    }

    /// Some bytes at a place of a file.
    fn range(file: &mut File, first: u64, length: u64) -> Vec<u8> {
        file.seek(SeekFrom::Start(first)).expect("a place");
        let bytes = exactly(file, length).expect("readable");
        bytes.expect("long enough")
    }

    /// The number of members, the directory's length and its place, as docs/export.md says how to find them.
    fn directory(file: &mut File) -> [u64; 3] {
        let length = file.metadata().expect("there").len();
        let end = range(file, length - 22, 22);
        assert_eq!(&end[..4], b"PK\x05\x06");
        // One of the short fields at least does not suffice.
        let short = Head(&end);
        assert!(short.u16(10) == u16::MAX || short.u32(16) == u32::MAX);
        let wide = range(file, length - 22 - 76, 76);
        assert_eq!(
            (&wide[..4], &wide[56..60]),
            (&b"PK\x06\x06"[..], &b"PK\x06\x07"[..])
        );
        let wide = Head(&wide);
        assert_eq!(wide.u64(64), length - 22 - 76);
        [wide.u64(32), wide.u64(40), wide.u64(48)]
    }

    /// The number of members and the last one with its content, as Python's `zipfile` reads them.
    fn python(path: &std::path::Path) -> Option<String> {
        let Some(python) = std::env::var_os("STREW_TEST_PYTHON") else {
            eprintln!("skipped: STREW_TEST_PYTHON names no Python");
            return None;
        };
        let read = "import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); n = z.namelist(); \
                    print(len(n), n[-1], z.read(n[-1]).decode())";
        let output = Command::new(python).args(["-c", read]).arg(path).output();
        let output = output.expect("Python runs");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        Some(String::from_utf8_lossy(&output.stdout).trim().into())
    }

    #[test]
    fn more_members_than_16_bits_count_are_all_found() {
        const MEMBERS: u64 = 70_000;
        let mut archive = tempfile::NamedTempFile::new().expect("a file");
        let (mut at, mut all) = (0, vec![]);
        let mut bytes = vec![];
        for i in 0..MEMBERS {
            let name = format!("v1/{i}");
            let content = content(&format!("chunk {i}"), i);
            let member = write(&mut bytes, at, &name, &content).expect("memory");
            at = end(&member, &name);
            all.push((name, member));
        }
        let members = all.iter().map(|(name, member)| (name.clone(), member));
        finish(&mut bytes, at, members).expect("memory");
        archive.write_all(&bytes).expect("writable");
        let file = archive.as_file_mut();
        let [count, _, offset] = directory(file);
        assert_eq!((count, offset), (MEMBERS, at));
        assert!(members_of(file) == all);
        if let Some(said) = python(archive.path()) {
            assert_eq!(said, "70000 v1/69999 chunk 69999");
        }
    }

    fn members_of(file: &mut File) -> Vec<(String, Member)> {
        let found = super::members(file).expect("readable");
        found.expect("a directory")
    }

    #[test]
    fn members_beyond_4_gib_are_found() {
        // What is left out takes no room on the disk.
        const FAR: u64 = (4 << 30) + 12_345;
        let mut archive = tempfile::NamedTempFile::new().expect("a file");
        let file = archive.as_file_mut();
        let near = write(file, 0, "near", &content("first", 1)).expect("writable");
        file.seek(SeekFrom::Start(FAR)).expect("a place");
        let far = write(file, FAR, "far", &content("last", 2)).expect("writable");
        let at = end(&far, "far");
        let all = [("near".to_owned(), near), ("far".to_owned(), far)];
        let members = all.iter().map(|(name, member)| (name.clone(), member));
        finish(file, at, members).expect("writable");
        let [count, _, offset] = directory(file);
        assert_eq!((count, offset), (2, at));
        assert!(members_of(file) == all);
        let (name, member, bytes) = next(file, FAR).expect("readable").expect("whole");
        assert_eq!((&*name, member, &*bytes), ("far", far, &b"last"[..]));
        if let Some(said) = python(archive.path()) {
            assert_eq!(said, "2 far last");
        }
    }
}
