//! Names the shared library as its users load it.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let system = std::env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let name = match system.as_str() {
        "linux" | "android" | "freebsd" => "-Wl,-soname,libstrew.so.0",
        "macos" => "-Wl,-install_name,@rpath/libstrew.0.dylib",
        _ => return,
    };
    println!("cargo::rustc-cdylib-link-arg={name}");
}
