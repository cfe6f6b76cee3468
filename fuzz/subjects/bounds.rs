//! The memory and the processor time that reading one input may take, whatever the input says.
//!
//! Both are measured for the whole process, because subjects work on several threads. So subjects run one
//! after another.

use std::time::Duration;

use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The most bytes that an input may allocate at a time, besides those in proportion to its length: a table and
/// its sampler, which stay in the cache, take most of them.
const MOST_BYTES: usize = 64 << 20;
/// The most bytes for each byte of an input.
const BYTES_FOR_A_BYTE: usize = 64;
/// The most time of the processor, in a build without optimization.
const MOST_TIME: Duration = Duration::from_secs(2);

/// Runs a subject on an input. Panics if it takes more than it may.
pub fn within(name: &str, run: fn(&[u8]), data: &[u8]) {
    let most = MOST_BYTES + BYTES_FOR_A_BYTE * data.len();
    let held = PeakAlloc.current_usage();
    PeakAlloc.reset_peak_usage();
    let start = processor_time();
    run(data);
    let (time, peak) = (processor_time() - start, PeakAlloc.peak_usage());
    let bytes = peak.saturating_sub(held);
    let beginning = &data[..data.len().min(64)];
    let input = format!("{name}: {} bytes, {beginning:x?}…", data.len());
    assert!(bytes <= most, "{bytes} bytes of memory for {input}");
    assert!(time <= MOST_TIME, "{time:?} of the processor for {input}");
}

#[cfg(unix)]
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Elsewhere the tests bound the memory alone.
#[cfg(not(unix))]
const fn processor_time() -> Duration {
    Duration::ZERO
}
