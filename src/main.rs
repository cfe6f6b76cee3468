//! The `strew` program: the command line of the library, and the pages, which only this file embeds.

#[path = "../page/mod.rs"]
mod page;

/// It takes fewer instructions than glibc's, and returns memory by itself. Without it, `ops::trim` does.
#[cfg(all(target_os = "linux", feature = "jemalloc"))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> std::process::ExitCode {
    strew::cli::main(page::all)
}
