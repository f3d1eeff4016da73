//! Every exported function matters: a program that checks a function prints something else if that function does nothing.
//!
//! A library that is loaded first passes every call on, but for one function, which it answers with 0. For each of the
//! exported functions a program whose output has a line "name: ..." is run so, until one does not print what it did.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

mod support;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use support::{build_folder, include, link_library, output, programs, scratch, skip, succeed};

/// Functions whose absence no program can see, with the reason.
const SILENT: [(&str, &str); 5] = [
    ("dCleanupODEAllDataForThread", "nothing is kept for a thread"),
    ("dCooperativeDestroy", "what it gives back is a few bytes, less than the heap's own grain"),
    ("dGeomTriMeshClearTCCache", "contacts are the same with and without the cache"),
    ("dSpaceSetManualCleanup", "libode always answers 1, and so does this library"),
    ("dTestDataStructures", "returns nothing, and ends the process if a structure is broken"),
];

fn names() -> impl Iterator<Item = &'static str> {
    include_str!("data/symbols.txt").lines()
}

/// The library that mutes the function named by the environment. Whatever then hangs ends after some seconds.
fn muter(folder: &Path) -> Option<PathBuf> {
    let mut text = String::from(".text\n");
    for (i, name) in names().enumerate() {
        writeln!(text, ".globl {name}\n.type {name},@function\n{name}: jmp *slots+{}(%rip)", 8 * i)
            .expect("a string");
    }
    text += ".globl nothing\nnothing: xor %eax,%eax\npxor %xmm0,%xmm0\nret\n.section .rodata\n.globl names\nnames:\n";
    for name in names() {
        writeln!(text, ".asciz \"{name}\"").expect("a string");
    }
    write!(
        text,
        ".bss\n.globl slots\nslots: .zero {}\n.hidden slots\n.hidden names\n.hidden nothing\n\
         .section .note.GNU-stack,\"\",@progbits\n",
        8 * names().count()
    )
    .expect("a string");
    let start = format!(
        "#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
extern void *slots[];
extern const char names[];
extern void nothing(void);
__attribute__((constructor)) static void fill(void) {{
    const char *muted = getenv(\"MUTED\"), *name = names;
    struct rlimit none = {{0, 0}};
    for (int i = 0; i < {}; i++, name += strlen(name) + 1)
        slots[i] = !strcmp(muted, name) ? (void *)nothing : dlsym(RTLD_NEXT, name);
    setrlimit(RLIMIT_CORE, &none);
    alarm(10);
}}
",
        names().count()
    );
    std::fs::write(folder.join("slots.s"), text).expect("a source file");
    std::fs::write(folder.join("mute.c"), start).expect("a source file");
    let library = folder.join("mute.so");
    let mut command = Command::new("gcc");
    command.args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library);
    succeed(command.arg(folder.join("mute.c")).arg(folder.join("slots.s")).arg("-ldl"))?;
    Some(library)
}

/// What a program prints and how it ends with a function muted; none if it is "".
fn run_muted(program: &Path, libraries: &Path, muter: &Path, muted: &str) -> String {
    let mut command = Command::new(program);
    command.env("LD_LIBRARY_PATH", libraries).env("LD_PRELOAD", muter).env("MUTED", muted);
    let output = output(&mut command).expect("the program starts");
    format!("{}{}", String::from_utf8_lossy(&output.stdout), output.status)
}

#[test]
fn no_function_can_be_missing_unseen() {
    let folder = scratch("muted");
    link_library(&build_folder().join("libode.so"), &folder);
    let Some(muter) = muter(&folder) else { return skip("no gcc") };
    // By function: the programs that have a line of it, and what they print.
    let mut said = Vec::new();
    for source in programs() {
        let program = folder.join(source.file_stem().expect("a name"));
        let cpp = source.extension().is_some_and(|extension| extension == "cpp");
        let mut command = Command::new(if cpp { "g++" } else { "gcc" });
        command
            .arg("-w")
            .arg("-I")
            .arg(include())
            .arg("-o")
            .arg(&program)
            .arg(&source)
            .arg("-L")
            .arg(&folder);
        let Some(_) = succeed(command.args(["-lode", "-lm", "-lpthread"])) else {
            return skip("no gcc or g++");
        };
        said.push((run_muted(&program, &folder, &muter, ""), program));
    }
    let mut checked: BTreeMap<&str, Vec<usize>> = names().map(|name| (name, Vec::new())).collect();
    for (i, (text, _)) in said.iter().enumerate() {
        for line in text.lines() {
            let places = line.split_once(':').and_then(|(name, _)| checked.get_mut(name));
            if let Some(places) = places.filter(|places| places.last() != Some(&i)) {
                places.push(i);
            }
        }
    }
    let missed = |name: &str, places: &[usize]| {
        places.iter().all(|&i| run_muted(&said[i].1, &folder, &muter, name) == said[i].0)
    };
    let (work, unseen) = (Mutex::new(checked.iter()), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                loop {
                    let next = work.lock().expect("no thread panics").next();
                    let Some((&name, places)) = next else { break };
                    if missed(name, places) {
                        unseen.lock().expect("no thread panics").push(name);
                    }
                }
            });
        }
    });
    let unseen = unseen.into_inner().expect("no thread panicked");
    println!(
        "{} functions, of {} the absence shows; not of {:?}",
        checked.len(),
        checked.len() - unseen.len(),
        SILENT.iter().filter(|silent| unseen.contains(&silent.0)).collect::<Vec<_>>()
    );
    let faults: Vec<_> =
        unseen.into_iter().filter(|name| !SILENT.iter().any(|silent| silent.0 == *name)).collect();
    assert!(faults.is_empty(), "{} functions can be missing unseen: {faults:?}", faults.len());
}
