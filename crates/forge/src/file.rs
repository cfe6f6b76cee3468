//! Table files on disk: their names, reading, and writing whole or not at all.

use std::{
    fs::File,
    io::{Read, Write},
    path::Path,
};

use strew_core::{
    Alpha, ErrorKind, Table,
    map::Size,
    space,
    table::{Head, MAX_FILE_BYTES},
};

use crate::ForgeError;

/// The extension of table files.
pub const EXTENSION: &str = "strew";

/// Returns the usual name of a table's file: profile, α and size, such as
/// `blue-5-sqrt3-over-2-s.strew`.
///
/// α is its canonical text without parentheses, with `-over-` for `/`, `-plus-` for `+` and
/// `-times-` for `*`. The size is `s` for R = 49, `m` for R = 100, `l` for R = 200, and `r` with R
/// for others.
///
/// ```
/// let name = strew_forge::file_name("blue", "sqrt(3)".parse()?, 100);
/// assert_eq!(name, "blue-sqrt3-m.strew");
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn file_name(profile: &str, alpha: Alpha, radius: u32) -> String {
    let alpha = alpha
        .to_string()
        .replace(['(', ')'], "")
        .replace('/', "-over-")
        .replace('+', "-plus-")
        .replace('*', "-times-");
    let size = Size::of_radius(radius);
    format!("{profile}-{alpha}-{size}.{EXTENSION}")
}

/// Reads and checks a table file of the plane.
///
/// # Errors
/// [`ForgeError::File`] if it cannot be read, [`ForgeError::TooLarge`] if it has more than
/// [`MAX_FILE_BYTES`], [`ForgeError::NotATable`] if its content is not a valid table,
/// [`ForgeError::InSpace`] if it is one of points in space.
pub fn read_table(path: &Path) -> Result<Table, ForgeError> {
    let content = read_bytes(path)?;
    Table::from_bytes(&content).map_err(|source| match source {
        // The file has grown meanwhile.
        error if error.kind() == ErrorKind::TableTooLarge => too_large(path, content.len() as u64),
        _ if is_space(&content) => ForgeError::InSpace {
            path: path.to_owned(),
        },
        source => ForgeError::NotATable {
            path: path.to_owned(),
            source,
        },
    })
}

/// Returns the usual name of the file of a table of points in space: that of a table of the plane with `space-` before it.
pub fn space_file_name(profile: &str, alpha: Alpha, radius: u32) -> String {
    format!("space-{}", file_name(profile, alpha, radius))
}

/// Reads and checks a table file of points in space. Returns `None` for a table of the plane, and for a file whose head is
/// that of no table.
pub fn read_space_table(path: &Path) -> Result<Option<space::Table>, ForgeError> {
    let content = read_bytes(path)?;
    let table = is_space(&content).then(|| space::Table::from_bytes(&content));
    table.transpose().map_err(|source| ForgeError::NotATable {
        path: path.to_owned(),
        source,
    })
}

/// Whether the head of a table file says that its points are in space.
fn is_space(bytes: &[u8]) -> bool {
    let head = Head::read(bytes.len() as u64, |at, part: &mut [u8]| {
        let from = at as usize;
        let found = bytes.get(from..from + part.len()).ok_or(())?;
        part.copy_from_slice(found);
        Ok::<(), ()>(())
    });
    matches!(head, Ok(Ok(head)) if head.is_space)
}

/// The content of a table file, at most one byte more than such files may have.
fn read_bytes(path: &Path) -> Result<Vec<u8>, ForgeError> {
    let failed = |action| ForgeError::file(action, path);
    let file = File::open(path).map_err(failed("open"))?;
    let bytes = file.metadata().map_err(failed("examine"))?.len();
    if bytes > MAX_FILE_BYTES {
        return Err(too_large(path, bytes));
    }
    // The file may grow meanwhile, or be a pipe without a size: read one byte beyond the limit.
    let mut content = Vec::with_capacity(bytes as usize);
    file.take(MAX_FILE_BYTES + 1)
        .read_to_end(&mut content)
        .map_err(failed("read"))?;
    Ok(content)
}

fn too_large(path: &Path, bytes: u64) -> ForgeError {
    ForgeError::TooLarge {
        path: path.to_owned(),
        bytes,
    }
}

/// Writes a table file, whole or not at all.
///
/// It is written under a temporary name in the same folder, flushed to the disk and renamed. So
/// readers see the old file or the new one and never a part of it.
///
/// # Errors
/// [`ForgeError::File`] if a step fails; a file that was at `path` is then unchanged.
pub fn write_table(path: &Path, table: &Table) -> Result<(), ForgeError> {
    write_whole(path, &table.to_bytes())
}

/// Writes a table file of points in space as [`write_table`] does.
pub fn write_space_table(path: &Path, table: &space::Table) -> Result<(), ForgeError> {
    write_whole(path, &table.to_bytes())
}

/// Writes any file as [`write_table`] does.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ForgeError> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".strew-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Readable for others, unlike other temporary files; the umask still applies.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder
        .tempfile_in(folder)
        .map_err(ForgeError::file("create a file in", folder))?;
    file.write_all(bytes)
        .map_err(ForgeError::file("write", path))?;
    file.as_file()
        .sync_all()
        .map_err(ForgeError::file("flush", path))?;
    file.persist(path)
        .map_err(|e| ForgeError::file("replace", path)(e.error))?;
    // The rename is on the disk only once the folder is. Windows cannot flush folders and need not.
    #[cfg(unix)]
    File::open(folder)
        .and_then(|folder| folder.sync_all())
        .map_err(ForgeError::file("flush", folder))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        Table::undisplaced("sqrt(3)".parse().expect("valid"), 4, "pattern").expect("valid")
    }

    #[test]
    fn written_tables_read_back_and_leave_nothing_else() {
        let folder = tempfile::tempdir().expect("valid");
        let path = folder.path().join("some.strew");
        for _ in 0..2 {
            write_table(&path, &table()).expect("valid");
            assert_eq!(read_table(&path).expect("valid"), table());
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("valid").count(), 1);
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().expect("valid");
        let path = folder.path().join("a-folder-in-the-way");
        std::fs::create_dir(&path).expect("valid");
        let error = write_table(&path, &table())
            .expect_err("refused")
            .to_string();
        assert!(error.contains("a-folder-in-the-way"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("valid").count(), 1);
        let nowhere = folder.path().join("no/such/x.strew");
        assert!(matches!(
            write_table(&nowhere, &table()),
            Err(ForgeError::File { .. })
        ));
    }

    #[test]
    fn errors_name_the_file_and_the_cause() {
        let folder = tempfile::tempdir().expect("valid");
        let path = folder.path().join("bad.strew");
        let missing = read_table(&path).expect_err("refused").to_string();
        assert!(missing.contains("bad.strew"), "{missing}");
        std::fs::write(&path, &table().to_bytes()[..100]).expect("valid");
        let damaged = read_table(&path).expect_err("refused");
        let ForgeError::NotATable { source, .. } = &damaged else {
            panic!("{damaged}")
        };
        assert_eq!(source.kind(), ErrorKind::TableTruncated);
        assert!(damaged.to_string().contains("bad.strew"), "{damaged}");
        // A sparse file, refused by its size alone.
        let huge = File::create(&path).expect("valid");
        huge.set_len(MAX_FILE_BYTES + 1).expect("valid");
        assert!(matches!(
            read_table(&path),
            Err(ForgeError::TooLarge { bytes, .. }) if bytes == MAX_FILE_BYTES + 1
        ));
    }

    #[test]
    fn a_table_of_points_in_space_is_read_by_its_own_reader() {
        let folder = tempfile::tempdir().expect("valid");
        let path = folder.path().join("t.strew");
        let alpha = "sqrt(3)".parse().expect("valid");
        let other = space::Table::undisplaced(alpha, 4, "pattern").expect("valid");
        write_space_table(&path, &other).expect("valid");
        assert_eq!(read_space_table(&path).expect("valid"), Some(other.clone()));
        let error = read_table(&path).expect_err("refused").to_string();
        assert!(
            error.contains("t.strew: a table of points in space"),
            "{error}"
        );
        write_table(&path, &table()).expect("valid");
        assert_eq!(read_space_table(&path).expect("valid"), None);
        let mut damaged = other.to_bytes();
        *damaged.last_mut().expect("bytes") ^= 1;
        std::fs::write(&path, damaged).expect("valid");
        let error = read_space_table(&path).expect_err("refused").to_string();
        assert!(error.contains("t.strew: "), "{error}");
    }

    #[test]
    fn file_names_have_profile_alpha_and_size() {
        for (alpha, radius, name) in [
            ("(5-sqrt(3))/2", 49, "blue-5-sqrt3-over-2-s.strew"),
            ("sqrt(3)", 100, "blue-sqrt3-m.strew"),
            ("(1+sqrt(5))/2", 200, "blue-1-plus-sqrt5-over-2-l.strew"),
            ("3*sqrt(2)/4", 20, "blue-3-times-sqrt2-over-4-r20.strew"),
        ] {
            assert_eq!(
                file_name("blue", alpha.parse().expect("valid"), radius),
                name
            );
        }
    }
}
