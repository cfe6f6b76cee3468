//! The memory that the system allows this process, to which limits are fitted at the start.
//!
//! Linux bounds a container by control groups, of which there are two versions: each group of the path from the
//! process up to the root may have a limit, and the least one counts. Inside a container the path may begin at the
//! container's own group or at the root of the machine, depending on namespaces: `/proc/self/mountinfo` says where the
//! groups that can be seen begin.

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
const V1: &str = "the container (cgroup v1)";
const V2: &str = "the container (cgroup v2)";

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
        let groups = groups(root).into_iter().filter_map(|(folder, file, of)| {
            let levels = folder
                .ancestors()
                .take_while(|level| level.starts_with(root));
            let limits = levels.filter_map(|level| {
                let text = fs::read_to_string(level.join(file)).ok()?;
                // Version 2 writes `max` for no limit, version 1 a number beyond all memory.
                text.trim().parse().ok()
            });
            Some(Self {
                bytes: limits.min()?,
                of,
            })
        });
        groups.chain(machine).min_by_key(|memory| memory.bytes)
    }
}

/// The folders of this process's groups, each with the name of the file of its limit.
fn groups(root: &Path) -> Vec<(PathBuf, &'static str, &'static str)> {
    let paths = read(root, "proc/self/cgroup").unwrap_or_default();
    let mounts = read(root, "proc/self/mountinfo").unwrap_or_default();
    let mut found = vec![];
    for line in paths.lines() {
        // `0::/path` in version 2, `4:memory:/path` in version 1.
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else {
            continue;
        };
        let (kind, file, of) = match controllers {
            "" => ("cgroup2", "memory.max", V2),
            some if has(some, "memory") => ("cgroup", "memory.limit_in_bytes", V1),
            _ => continue,
        };
        let mount = mounts.lines().find_map(|line| mount(line, kind));
        if let Some((begins, place)) = mount {
            let below = Path::new(path).strip_prefix(begins);
            let below = below.unwrap_or(Path::new(""));
            let place = root.join(place.strip_prefix('/').unwrap_or(place));
            found.push((place.join(below), file, of));
        }
    }
    found
}

fn has(list: &str, name: &str) -> bool {
    list.split(',').any(|one| one == name)
}

/// The group that is mounted, and where, if a line of `mountinfo` mounts the groups of memory of a kind.
fn mount<'a>(line: &'a str, kind: &str) -> Option<(&'a str, &'a str)> {
    let (left, right) = line.split_once(" - ")?;
    let mut right = right.split(' ');
    let is_kind = right.next()? == kind;
    let options = right.nth(1)?;
    let has_memory = kind == "cgroup2" || has(options, "memory");
    let mut left = left.split(' ').skip(3);
    (is_kind && has_memory).then_some((left.next()?, left.next()?))
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
    fn a_group_of_version_1_bounds_the_memory() {
        let mounts = "31 30 0:27 /docker/abc /sys/fs/cgroup/cpu ro - cgroup cgroup rw,cpu\n\
                      32 30 0:28 /docker/abc /sys/fs/cgroup/memory ro master:9 - cgroup cgroup rw,memory\n\
                      33 30 0:29 / /sys/fs/cgroup/unified ro - cgroup2 cgroup2 rw\n";
        let limits = [
            MACHINE,
            ("proc/self/mountinfo", mounts),
            (
                "proc/self/cgroup",
                "5:cpu:/docker/abc\n4:memory:/docker/abc\n0::/docker/abc\n",
            ),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "134217728\n"),
        ];
        assert_eq!(memory(&limits), Some((128, "the container (cgroup v1)")));
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
