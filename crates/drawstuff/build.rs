//! Compiles the C shim and names the shared library.

fn main() {
    println!("cargo:rerun-if-changed=csrc/shim.c");
    cc::Build::new().file("csrc/shim.c").flag_if_supported("-fexceptions").compile("ferrode_drawstuff_shim");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libdrawstuff.so.0");
    }
}
