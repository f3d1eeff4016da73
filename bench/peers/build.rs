//! Compiles the part of the Bullet driver that has to be C++.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    #[cfg(feature = "bullet")]
    bullet();
}

/// `src/engines/bullet.cpp`, against the Bullet that pkg-config knows (single precision, as Debian names it).
#[cfg(feature = "bullet")]
fn bullet() {
    let source = "src/engines/bullet.cpp";
    println!("cargo:rerun-if-changed={source}");
    let output = std::process::Command::new("pkg-config").args(["--cflags", "--libs", "bullet"]).output();
    let output = output.expect("pkg-config runs");
    assert!(output.status.success(), "pkg-config knows no bullet (Debian: libbullet-dev)");
    let words = String::from_utf8(output.stdout).expect("pkg-config writes text");
    let mut shim = cc::Build::new();
    shim.cpp(true).std("c++17").file(source).warnings(true);
    for word in words.split_whitespace() {
        if let Some(folder) = word.strip_prefix("-I") {
            shim.flag("-isystem").flag(folder);
        } else if let Some(define) = word.strip_prefix("-D") {
            shim.define(define, None);
        }
    }
    shim.compile("ferrode_bench_bullet");
    for word in words.split_whitespace() {
        if let Some(folder) = word.strip_prefix("-L") {
            println!("cargo:rustc-link-search=native={folder}");
        } else if let Some(name) = word.strip_prefix("-l").filter(|name| *name != "BulletSoftBody") {
            println!("cargo:rustc-link-lib=dylib={name}");
        }
    }
}
