//! The memory that the system allows this process, to which limits are fitted at the start.
//!
//! Linux bounds a container by control groups (version 2): each group of the path from the process up to the root may have
//! a limit, and the least one counts. Inside a container the path may begin at the container's own group or at the root of
//! the machine, depending on namespaces: `/proc/self/mountinfo` says where the groups that can be seen begin.

use std::{
    fs,
    path::{Path, PathBuf},
};

use strew_config::Config;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Memory {
    bytes: u64,
    of: &'static str,
}

const MACHINE: &str = "the machine";
const CONTAINER: &str = "the container (cgroup v2)";

/// Lowers the limits of memory to what there is, and logs which ones.
pub fn fit(config: &mut Config) {
    let known = match config.limits.memory_bytes {
        0 => Memory::of(Path::new("/")),
        bytes => Some(Memory {
            bytes,
            of: "limits.memory_bytes",
        }),
    };
    let Some(memory) = known else {
        return;
    };
    let lowered = config.fit(memory.bytes);
    let Memory { bytes, of } = memory;
    let most = config.memory_bound();
    if !lowered.is_empty() {
        let lowered: Vec<String> = lowered
            .iter()
            .map(|one| format!("{} = {}", one.key, one.value))
            .collect();
        let lowered = lowered.join(", ");
        tracing::info!(memory = bytes, %of, most, "limits are lowered to fit the memory: {lowered}");
    } else if of != MACHINE {
        tracing::info!(memory = bytes, %of, most, "limits fit the memory");
    }
    if most > bytes {
        tracing::warn!(
            memory = bytes,
            %of,
            most,
            "the memory is less than clients can make the daemon take"
        );
    }
}

impl Memory {
    /// The least limit of a system whose files are below `root`; none where there is no `/proc`.
    fn of(root: &Path) -> Option<Self> {
        let machine = read(root, "proc/meminfo").and_then(|text| total(&text));
        let machine = machine.map(|bytes| Self { bytes, of: MACHINE });
        let levels = group(root).into_iter().flat_map(|folder| {
            let levels = folder.ancestors().map(Path::to_owned);
            levels
                .take_while(|level| level.starts_with(root))
                .collect::<Vec<_>>()
        });
        let groups = levels.filter_map(|level| {
            let text = fs::read_to_string(level.join("memory.max")).ok()?;
            // It is `max` for no limit.
            let bytes = text.trim().parse().ok()?;
            Some(Self {
                bytes,
                of: CONTAINER,
            })
        });
        groups.chain(machine).min_by_key(|memory| memory.bytes)
    }
}

fn group(root: &Path) -> Option<PathBuf> {
    let paths = read(root, "proc/self/cgroup")?;
    let path = paths.lines().find_map(|line| line.strip_prefix("0::"))?;
    let mounts = read(root, "proc/self/mountinfo")?;
    let (begins, place) = mounts.lines().find_map(mount)?;
    let below = Path::new(path).strip_prefix(begins);
    let place = root.join(place.strip_prefix('/').unwrap_or(place));
    Some(place.join(below.unwrap_or(Path::new(""))))
}

/// The group that is mounted, and where, if a line of `mountinfo` mounts groups.
fn mount(line: &str) -> Option<(&str, &str)> {
    let (left, right) = line.split_once(" - ")?;
    let mut left = left.split(' ').skip(3);
    right
        .starts_with("cgroup2 ")
        .then_some((left.next()?, left.next()?))
}

fn total(text: &str) -> Option<u64> {
    let rest = text
        .lines()
        .find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: u64 = rest.trim().strip_suffix(" kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

fn read(root: &Path, path: &str) -> Option<String> {
    fs::read_to_string(root.join(path)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIB: u64 = 1 << 20;

    fn system(files: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().expect("a folder");
        for (path, text) in files {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
            fs::write(path, text).expect("writable");
        }
        root
    }

    fn memory(files: &[(&str, &str)]) -> Option<(u64, &'static str)> {
        let memory = Memory::of(system(files).path());
        memory.map(|memory| (memory.bytes / MIB, memory.of))
    }

    const MACHINE: (&str, &str) = (
        "proc/meminfo",
        "MemTotal:        2097152 kB\nMemFree: 1 kB\n",
    );
    const V2: (&str, &str) = (
        "proc/self/mountinfo",
        "30 23 0:26 / /sys/fs/cgroup ro,nosuid - cgroup2 cgroup rw,nsdelegate\n",
    );

    #[test]
    fn a_group_of_version_2_bounds_the_memory() {
        let limits = [
            MACHINE,
            V2,
            ("proc/self/cgroup", "0::/pods/one\n"),
            ("sys/fs/cgroup/pods/one/memory.max", "max\n"),
            ("sys/fs/cgroup/pods/memory.max", "268435456\n"),
        ];
        assert_eq!(memory(&limits), Some((256, "the container (cgroup v2)")));
        // In a namespace of its own, the process is at the root of what it sees.
        let within = [
            MACHINE,
            V2,
            ("proc/self/cgroup", "0::/\n"),
            ("sys/fs/cgroup/memory.max", "67108864\n"),
        ];
        assert_eq!(memory(&within), Some((64, "the container (cgroup v2)")));
    }

    #[test]
    fn without_a_group_the_machine_bounds_the_memory() {
        assert_eq!(memory(&[MACHINE]), Some((2048, "the machine")));
        let unlimited = [
            MACHINE,
            V2,
            ("proc/self/cgroup", "0::/\n"),
            ("sys/fs/cgroup/memory.max", "max\n"),
        ];
        assert_eq!(memory(&unlimited), Some((2048, "the machine")));
        assert_eq!(memory(&[]), None);
    }
}
