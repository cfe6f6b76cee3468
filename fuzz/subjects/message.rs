//! Messages of gRPC: a byte that chooses the method, then the message.

use super::protocols;

const METHODS: [&str; 6] = [
    "StreamPoints",
    "CountPoints",
    "SplitPoints",
    "GetPoint",
    "FindNearest",
    "ListProfiles",
];

/// The codes with which a server says that the fault is its own: UNKNOWN, INTERNAL, DATA_LOSS.
const OURS: [u32; 3] = [2, 13, 15];

pub fn run(data: &[u8]) {
    let Some((&first, message)) = data.split_first() else {
        return;
    };
    let method = METHODS[usize::from(first) % METHODS.len()];
    let (status, text) = protocols::call(method, message);
    assert!(!OURS.contains(&status), "{method}: {status} {text}");
}
