//! `install.sh`, into an empty prefix: the manual's lines to compile and link, by pkg-config and by ode-config, shared and
//! static; a CMake project; and nothing left after taking it out again.
//!
//! Needs a Unix shell, gcc, pkg-config and CMake; without them the tests say so and leave that part out.
#![cfg(target_os = "linux")]

mod support;

use std::path::{Path, PathBuf};
use std::process::Command;
use support::{build_folder, here, scratch, skip, succeed};

fn root() -> PathBuf {
    here().join("../..")
}

fn has(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

fn install(prefix: &Path, more: &[&str]) {
    let mut command = Command::new("sh");
    command.arg(root().join("install.sh")).arg("--prefix").arg(prefix).args(more);
    succeed(&mut command).expect("a shell");
}

/// A line of the manual, in a folder, with the prefix's programs and pkg-config files first.
fn line(folder: &Path, prefix: &Path, line: &str) -> String {
    let path = format!("{}:{}", prefix.join("bin").display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new("sh");
    command.args(["-c", line]).current_dir(folder).env("PATH", path);
    command.env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"));
    succeed(&mut command).expect("a shell")
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// What the tutorial prints last: the ball has come to rest.
const AT_REST: &str = "5.00 s  height 0.500 m";

#[test]
fn the_manuals_lines_work_and_it_can_be_taken_out() {
    if !(has("gcc") && has("pkg-config")) {
        return skip("no gcc, or no pkg-config (apt install gcc pkg-config)");
    }
    let folder = scratch("install");
    let prefix = folder.join("prefix");
    let built = build_folder();
    install(&prefix, &["--from", &built.to_string_lossy()]);
    let lib = prefix.join("lib");
    std::fs::copy(root().join("examples/c/bouncing_ball.c"), folder.join("myprogram.c"))
        .expect("the tutorial");
    let run = format!("LD_LIBRARY_PATH={} ./myprogram", lib.display());
    let works = |what: &str, run: &str| {
        let printed = line(&folder, &prefix, run);
        assert!(printed.trim_end().ends_with(AT_REST), "{what}: {printed}");
        std::fs::remove_file(folder.join("myprogram")).expect("the program was linked");
    };

    // Verbatim from the manual, comments included.
    line(&folder, &prefix, " gcc -c myprogram.c `pkg-config ode --cflags`                  # compile");
    line(&folder, &prefix, " gcc myprogram.o -o myprogram `pkg-config ode --libs`          # link");
    works("pkg-config", &run);
    line(
        &folder,
        &prefix,
        " gcc myprogram.c -o myprogram `pkg-config ode --cflags --libs` # compile and link",
    );
    let needed = line(&folder, &prefix, "readelf -d myprogram");
    assert!(needed.contains("libode.so.8"), "{needed}");
    works("pkg-config at once", &run);
    line(&folder, &prefix, " gcc -c myprogram.c `ode-config --cflags`                      # compile");
    line(&folder, &prefix, "gcc myprogram.o -o myprogram `ode-config --libs`");
    works("ode-config", &run);

    // The static library needs nothing at run time.
    let static_lib = lib.join("libode.a");
    line(
        &folder,
        &prefix,
        &format!(
            "gcc myprogram.o -o myprogram {} `pkg-config ode --static --libs-only-l | sed s/-lode//`",
            static_lib.display()
        ),
    );
    assert!(!line(&folder, &prefix, "readelf -d myprogram").contains("libode.so"));
    works("libode.a", "./myprogram");
    line(
        &folder,
        &prefix,
        "gcc myprogram.o -o myprogram -Wl,-Bstatic `ode-config --libs` -Wl,-Bdynamic -lm -lpthread -ldl -lgcc_s",
    );
    works("libode.a by ode-config", "./myprogram");

    let said = line(
        &folder,
        &prefix,
        "ode-config --version; ode-config --prefix; pkg-config --modversion --variable=precision ode",
    );
    assert!(said.starts_with(&format!("0.16.2\n{}\n", prefix.display())), "{said}");
    assert!(said.contains("dDOUBLE"), "{said}");
    let links = |name: &str| std::fs::read_link(lib.join(name)).expect("a link");
    assert_eq!(links("libode.so"), Path::new("libode.so.8"));
    assert_eq!(links("libode.so.8"), Path::new("libode.so.8.0.2"));
    assert_eq!(
        std::fs::read_dir(prefix.join("include/ode")).expect("the headers").count(),
        std::fs::read_dir(here().join("include/ode")).expect("the headers").count()
    );

    install(&prefix, &["--uninstall"]);
    assert_eq!(files(&prefix), Vec::<PathBuf>::new());
    assert!(!prefix.join("lib").exists() && !prefix.join("include").exists());
}

const PROJECT: &str = "cmake_minimum_required(VERSION 3.10)
project(tutorial C)
find_package(ode 0.16 REQUIRED CONFIG)
add_executable(shared_program myprogram.c)
target_link_libraries(shared_program PRIVATE ODE::ODE)
add_executable(static_program myprogram.c)
target_link_libraries(static_program PRIVATE ODE::ODE_STATIC)
";

#[test]
fn a_cmake_project_finds_it() {
    if !(has("cmake") && has("gcc") && has("make")) {
        return skip("no CMake, gcc or make (apt install cmake gcc make)");
    }
    let folder = scratch("install-cmake");
    // Elsewhere than it was installed: the package finds itself.
    install(&folder.join("first"), &["--from", &build_folder().to_string_lossy()]);
    let prefix = folder.join("moved");
    std::fs::rename(folder.join("first"), &prefix).expect("the prefix can be moved");
    std::fs::copy(root().join("examples/c/bouncing_ball.c"), folder.join("myprogram.c"))
        .expect("the tutorial");
    std::fs::write(folder.join("CMakeLists.txt"), PROJECT).expect("the project");
    line(
        &folder,
        &prefix,
        &format!("cmake -S . -B build -DCMAKE_PREFIX_PATH={} && cmake --build build", prefix.display()),
    );
    for program in ["shared_program", "static_program"] {
        let printed = line(&folder, &prefix, &format!("build/{program}"));
        assert!(printed.trim_end().ends_with(AT_REST), "{program}: {printed}");
    }
}
