//! Reading files that others write: regular files only, and no more of them than expected.
//!
//! A pipe or a device in the place of a file would otherwise be waited for, or read, for ever.

use std::{
    fs::{File, OpenOptions},
    io::{self, Read as _},
    path::Path,
};

/// The content of a regular file, up to `most` bytes.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] if the path is not a regular file,
/// [`io::ErrorKind::FileTooLarge`] if it has more bytes, or the error of the file system.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let mut content = vec![];
    file.take(most.saturating_add(1))
        .read_to_end(&mut content)?;
    if content.len() as u64 > most {
        let problem = format!("it has more than {most} bytes");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, problem));
    }
    Ok(content)
}

/// The text of a regular file, up to `most` bytes.
///
/// # Errors
/// As [`read`], and [`io::ErrorKind::InvalidData`] if it is not UTF-8.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let not_text = |problem: String| io::Error::new(io::ErrorKind::InvalidData, problem);
    let content = read(path, most)?;
    let text = without_mark(&content).map_err(|problem| not_text(problem.into()))?;
    let text = std::str::from_utf8(text).map_err(|error| not_text(error.to_string()))?;
    Ok(text.to_owned())
}

/// Text without the byte order mark of UTF-8, which editors and GIS write (RFC 8259, 8.1, allows to skip it).
///
/// # Errors
/// Names UTF-16 or UTF-32, which the mark says.
pub fn without_mark(bytes: &[u8]) -> Result<&[u8], &'static str> {
    match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Err("UTF-32 text; save it as UTF-8"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Err("UTF-16 text; save it as UTF-8"),
        [0xef, 0xbb, 0xbf, text @ ..] | text => Ok(text),
    }
}

/// Opens a regular file.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] if the path is not one, or the error of the file system.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let file = open(path)?;
    if !file.metadata()?.is_file() {
        let problem = "it is not a regular file";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
    }
    Ok(file)
}

/// Opens without waiting for the other end of a pipe.
#[cfg(unix)]
fn open(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt as _;
    let flags = rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY;
    let flags = i32::try_from(flags.bits()).unwrap_or_default();
    OpenOptions::new().read(true).custom_flags(flags).open(path)
}

#[cfg(not(unix))]
fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_the_expected_size_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        std::fs::write(&path, "12345").expect("writable");
        assert_eq!(read(&path, 5).expect("as long"), b"12345");
        let kind = |path: &Path, most| read(path, most).expect_err("refused").kind();
        assert_eq!(kind(&path, 4), io::ErrorKind::FileTooLarge);
        assert_eq!(kind(folder.path(), 9), io::ErrorKind::InvalidInput);
        assert_eq!(kind(&folder.path().join("no"), 9), io::ErrorKind::NotFound);
    }

    #[test]
    fn the_mark_of_utf_8_is_skipped_and_that_of_others_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        let text = |bytes: &[u8]| {
            std::fs::write(&path, bytes).expect("writable");
            read_text(&path, 99).map_err(|error| error.to_string())
        };
        assert_eq!(text(b"\xef\xbb\xbf{}"), Ok("{}".into()));
        assert_eq!(text(b"{}"), Ok("{}".into()));
        assert_eq!(
            text(b"\xff\xfe{\0"),
            Err("UTF-16 text; save it as UTF-8".into())
        );
        assert!(text(b"\xef\xbb").is_err_and(|error| error.contains("utf-8")));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn pipes_and_devices_are_refused_at_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.expect("mkfifo").success());
        for path in [&pipe, Path::new("/dev/zero")] {
            let refused = read(path, 9).expect_err("refused");
            assert_eq!(refused.kind(), io::ErrorKind::InvalidInput, "{path:?}");
        }
    }
}
