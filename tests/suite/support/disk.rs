//! A small disk, where this process may mount one.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// A small disk; unmounted when dropped.
pub struct SmallDisk {
    folder: tempfile::TempDir,
}

impl SmallDisk {
    /// Mounts a file system of a size such as `1m`. Where that is not permitted, it prints a message.
    pub fn mount(size: &str) -> Option<Self> {
        let folder = tempfile::tempdir().expect("a folder");
        let disk = Self { folder };
        if disk.run(&format!("size={size}")) {
            return Some(disk);
        }
        eprintln!("skipped: this process may not mount a small file system");
        None
    }

    /// Changes its size, but not below its contents.
    pub fn resize(&self, size: &str) {
        assert!(
            self.run(&format!("remount,size={size}")),
            "{size} is too small"
        );
    }

    /// Makes it so small that no more than about this many bytes are free.
    pub fn leave_free(&self, bytes: u64) {
        let disk = rustix::fs::statvfs(self.path()).expect("a disk");
        let used = (disk.f_blocks - disk.f_bfree) * disk.f_frsize;
        self.resize(&(used + bytes).to_string());
    }

    fn run(&self, options: &str) -> bool {
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", options, "strew-test"])
            .arg(self.path())
            .stderr(Stdio::null())
            .status();
        mounted.is_ok_and(|status| status.success())
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Fills the disk to the last byte.
    pub fn fill(&self) {
        let mut piece = 1 << 20;
        let mut filler = vec![];
        while piece > 0 {
            filler.resize(filler.len() + piece, 0);
            if fs::write(self.path().join("filler"), &filler).is_err() {
                filler.truncate(filler.len() - piece);
                piece /= 2;
            }
        }
    }

    /// The names of all files except the filler.
    pub fn names(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path()).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name().into());
        names
            .filter(|name: &PathBuf| name != Path::new("filler"))
            .collect()
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount")
            .arg(self.path())
            .stderr(Stdio::null())
            .status();
    }
}
