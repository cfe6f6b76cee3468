//! The return of free memory to the system, where the allocator is glibc's.
//!
//! Workers allocate answers and the sockets' threads free them; glibc keeps most of what is freed. So the memory that
//! requests do not account for is looked at now and then, and when it has grown, what is free of it is returned. With
//! jemalloc, which does so by itself, and on other systems this does nothing.

use std::time::{Duration, Instant};

use strew_service::Budget;

use super::metrics::resident;

/// Whether the allocator keeps freed memory and returns it on request.
const KEEPS: bool = cfg!(all(
    target_os = "linux",
    target_env = "gnu",
    not(feature = "jemalloc")
));

const PACE: Duration = Duration::from_secs(2);

pub(super) async fn watch(budget: Budget) {
    let mut kept = Kept::default();
    while KEEPS {
        tokio::time::sleep(PACE).await;
        if !kept.has_grown(resident(), budget.held()) {
            continue;
        }
        // Some milliseconds for hundreds of MiB, in which others may wait to allocate.
        let begun = Instant::now();
        let _ = tokio::task::spawn_blocking(trim).await;
        let (after, took) = (resident(), begun.elapsed());
        tracing::debug!(resident = after, ?took, "free memory is returned");
        kept.is_trimmed(after, budget.held());
    }
}

/// The growth that is worth a look through all that is free, in bytes.
const WORTH: u64 = 4 << 20;

/// The least memory beyond that of requests since it was last returned.
#[derive(Debug, Default)]
struct Kept(Option<u64>);

impl Kept {
    /// Whether more than that, by far, is resident now, `held` bytes of it for requests.
    fn has_grown(&mut self, resident: u64, held: usize) -> bool {
        let beyond = resident.saturating_sub(held as u64);
        let least = self.0.map_or(beyond, |least| least.min(beyond));
        self.0 = Some(least);
        beyond - least > WORTH
    }

    fn is_trimmed(&mut self, resident: u64, held: usize) {
        self.0 = Some(resident.saturating_sub(held as u64));
    }
}

fn trim() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the C library has no safe interface")]
    // SAFETY: it takes and returns a number, leaves alone what is allocated, and is safe beside other threads.
    unsafe {
        libc::malloc_trim(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIB: u64 = 1 << 20;

    #[test]
    fn what_requests_hold_is_not_returned_and_what_they_leave_is() {
        let mut kept = Kept::default();
        assert!(!kept.has_grown(30 * MIB, 0));
        assert!(!kept.has_grown(330 * MIB, 300 << 20));
        assert!(!kept.has_grown(300 * MIB, 267 << 20));
        assert!(kept.has_grown(330 * MIB, 10 << 20));
        // Half of it is in use, such as by a table.
        kept.is_trimmed(160 * MIB, 10 << 20);
        assert!(!kept.has_grown(153 * MIB, 0));
        assert!(!kept.has_grown(40 * MIB, 20 << 20));
        assert!(kept.has_grown(40 * MIB, 0));
    }
}
