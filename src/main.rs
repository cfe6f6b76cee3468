//! The `strew` program: the command line of the library, and the pages, which only this file embeds.

#[path = "../page/mod.rs"]
mod page;

/// glibc keeps the pages of a burst for later; this allocator returns them to the system within
/// some seconds, from a thread of its own.
#[cfg(all(target_os = "linux", feature = "jemalloc"))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> std::process::ExitCode {
    strew::cli::main(page::all)
}
