//! The `strew` program.

fn main() -> std::process::ExitCode {
    strew::cli::main()
}
