//! What `--version` tells: precision, SIMD level, threads.

/// The highest SIMD level that this machine has, of those that the engine knows.
pub fn simd_level() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx512f") {
            "AVX-512"
        } else if std::arch::is_x86_feature_detected!("avx2") {
            "AVX2"
        } else {
            "SSE2"
        }
    }
    #[cfg(target_arch = "aarch64")]
    {
        "NEON"
    }
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    {
        "none"
    }
}

/// The long text of `--version`.
pub fn long() -> String {
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    format!(
        "{}\nprecision: double (f64)\nSIMD:      {} (of this machine)\nthreads:   {threads} (of this machine)",
        env!("CARGO_PKG_VERSION"),
        simd_level(),
    )
}
