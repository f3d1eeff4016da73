//! The C-variadic functions, which Rust can't define.

unsafe extern "C" {
    fn ferrode_drawstuff_error();
    fn ferrode_drawstuff_debug();
    fn ferrode_drawstuff_print();
}

/// A linker hides what only C defines. So each is one jump that leaves all arguments where they are.
macro_rules! trampolines {
    ($($name:ident => $target:ident;)+) => {
        $(
            // SAFETY: a jump with all registers and the stack as they are: the target is called as the program called.
            #[unsafe(no_mangle)]
            #[unsafe(naked)]
            pub unsafe extern "C-unwind" fn $name() {
                #[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
                core::arch::naked_asm!("jmp {}", sym $target);
                #[cfg(any(target_arch = "aarch64", target_arch = "arm"))]
                core::arch::naked_asm!("b {}", sym $target);
                #[cfg(any(target_arch = "riscv64", target_arch = "riscv32"))]
                core::arch::naked_asm!("tail {}", sym $target);
            }
        )+
    };
}

trampolines! {
    dsError => ferrode_drawstuff_error;
    dsDebug => ferrode_drawstuff_debug;
    dsPrint => ferrode_drawstuff_print;
}
