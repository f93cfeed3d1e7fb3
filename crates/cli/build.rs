//! Tells the program which compiler builds it, for `wheelrail report`.

use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let output = Command::new(rustc).arg("--version").output();
    let version = output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_string()).unwrap_or_default();
    let version = if version.is_empty() { "unknown compiler".into() } else { version };
    println!("cargo:rustc-env=WHEELRAIL_RUSTC={version}");
}
