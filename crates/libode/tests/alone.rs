//! C++ programs on this library alone, for what libode does not survive or is no measure of.

mod support;

use std::process::Command;
use support::{build_folder, here, include, link_library, run, scratch, skip};

/// Compiles a program against our headers and runs it.
fn check(name: &str, wanted: &str) {
    let folder = scratch(&format!("alone-{name}"));
    link_library(&build_folder().join("libode.so"), &folder);
    let source = here().join("tests/alone").join(format!("{name}.cpp"));
    let program = folder.join(name);
    let mut compiler = Command::new("c++");
    compiler.args(["-std=c++17", "-w", "-I"]).arg(include()).arg("-o").arg(&program).arg(&source);
    let Ok(output) = compiler.arg("-L").arg(&folder).args(["-lode", "-lm", "-lpthread"]).output() else {
        return skip("no C++ compiler");
    };
    assert!(output.status.success(), "{name}:\n{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(run(&program, &folder), format!("{wanted}exit status: 0"), "{name}");
}

#[test]
fn callbacks_that_do_not_come_back_leave_the_library_usable() {
    let mut wanted = String::new();
    let mut say = |name: &str, after: &str| {
        for way in 0..2 {
            wanted += &format!("{name} {way} 1 1\n");
        }
        wanted += after;
    };
    say("aabb", "box -1 1\n");
    say("collider", "");
    say("collider turned", "contacts 1\n");
    say("cleaning", "");
    say("near", "");
    say("near2", "");
    say("test", "pairs 1\n");
    say("moved", "");
    say("moved", "body 0.1\n");
    say("memory", "step 1\n");
    say("height", "contacts 1\n");
    say("triangle", "");
    say("triangles", "");
    say("ray", "hits 1\n");
    say("debug", "");
    say("debug", "");
    say("error", "");
    say("message", "");
    say("destructor", "");
    check("escapes", &wanted);
}

#[test]
fn objects_may_be_destroyed_last_of_all() {
    let wanted =
        "early all\ncontacts 1\nmain ends\nexit handler\nlate contacts 1\nlate all\nlate pair\nlate end\n";
    check("last_things", wanted);
}

#[test]
fn worlds_that_come_and_go_leave_no_memory_behind() {
    check("many_worlds", "steady\n");
}

#[test]
fn nothing_that_programs_do_makes_it_unsound() {
    check("hostile", "faults were told\nfalls to -5.050000\nall was given back\n");
}
