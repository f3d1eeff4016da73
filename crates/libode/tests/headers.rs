//! The package's C and C++ headers against the installed ones of libode 0.16.2: the same names, types, values, layouts and
//! members; and the test programs, compiled against them, do what they do with the installed ones.
//!
//! Needs gcc and Debian's `libode-dev`; without them the tests say so and do nothing.

mod support;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{
    build_folder, differences, here, include, installed_headers, link_library, output, programs, run,
    scratch, skip, succeed,
};

const NEEDS: &str = "no gcc, or no libode-dev (apt install gcc g++ libode-dev)";

/// Names that only the headers' own text needed, or that describe building libode itself.
const OWN_MACROS: [&str; 4] = ["D_ALL_PARAM_NAMES", "D_ALL_PARAM_NAMES_X", "__ODE__", "X86_64_SYSTEM"];

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// A text that includes the library, in a file.
fn source(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a source file");
    path
}

/// What the preprocessor makes of ode.h, only the headers' own lines; with `-dD`, definitions of macros among them.
fn preprocessed(include: &Path, source: &Path, compiler: &str) -> Option<String> {
    let text = succeed(Command::new(compiler).args(["-E", "-dD"]).arg("-I").arg(include).arg(source))?;
    let mut inside = false;
    let mut own = String::new();
    for line in text.lines() {
        if line.starts_with("# ") {
            inside = line.split('"').nth(1).is_some_and(|file| file.contains("/ode/"));
        } else if inside && !line.is_empty() {
            own += line;
            own.push('\n');
        }
    }
    Some(own)
}

fn macros(text: &str) -> BTreeSet<String> {
    let names = text.lines().filter_map(|line| line.strip_prefix("#define "));
    names.map(|rest| rest.bytes().take_while(|b| is_word(*b)).map(char::from).collect()).collect()
}

/// All names in the braces of enums.
fn enumerators(text: &str) -> BTreeSet<String> {
    let code: String = text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join(" ");
    let mut names = BTreeSet::new();
    for part in code.split("enum").skip(1) {
        let Some((head, rest)) = part.split_once('{') else { continue };
        if !head.bytes().all(|b| is_word(b) || b == b' ') {
            continue;
        }
        let body = rest.split('}').next().unwrap_or_default();
        for item in body.split(',') {
            let name: String = item.trim().bytes().take_while(|b| is_word(*b)).map(char::from).collect();
            if !name.is_empty() {
                names.insert(name);
            }
        }
    }
    names
}

#[test]
fn values_and_layouts_are_the_same() {
    let (Some(theirs), folder) = (installed_headers(), scratch("header-facts")) else { return skip(NEEDS) };
    let plain = source(&folder, "plain.c", "#include <ode/ode.h>\n");
    let Some(text) = preprocessed(theirs, &plain, "gcc") else { return skip(NEEDS) };
    let names = enumerators(&text);
    assert!(names.len() > 200, "only {} enumerators were found", names.len());
    source(
        &folder,
        "enumerators.inc",
        &names.iter().map(|name| format!("INT({name});\n")).collect::<String>(),
    );
    let facts = here().join("tests/headers/facts.c");
    let build = |name: &str, compiler: &[&str], include: &Path| {
        let program = folder.join(name);
        let mut command = Command::new(compiler[0]);
        command.args(&compiler[1..]).args(["-O1", "-ffp-contract=off", "-Wno-deprecated-declarations", "-w"]);
        command.arg("-I").arg(include).arg("-I").arg(&folder).arg("-o").arg(&program).arg(&facts);
        succeed(command.args(["-lode", "-lm"]))?;
        succeed(&mut Command::new(&program))
    };
    for compiler in [&["gcc", "-std=c99"][..], &["g++", "-std=c++17", "-x", "c++"]] {
        let (Some(a), Some(b)) = (build("theirs", compiler, theirs), build("ours", compiler, &include()))
        else {
            return skip(NEEDS);
        };
        assert!(a.lines().count() > 500, "only {} lines", a.lines().count());
        let faults = differences(compiler[0], &a, &b, 0.0);
        assert!(faults.is_empty(), "{} facts differ:\n{}", faults.len(), faults.join("\n"));
        println!("{}: {} facts agree", compiler[0], a.lines().count());
    }
}

/// A declaration without the names of parameters, which gcc writes for the inline functions. `f()` stands for `f(void)`.
fn prototype(declaration: &str) -> String {
    let declaration = declaration.trim().replace("(/* ??? */)", "(void)").replace("(/* ???", "(void)");
    let inner = declaration.strip_prefix("static ").and_then(|rest| rest.strip_suffix(')'));
    let Some((head, parameters)) = inner.and_then(|rest| rest.split_once('(')) else { return declaration };
    let types =
        parameters.split(", ").map(|parameter| parameter.trim_end_matches(|c: char| is_word(c as u8)).trim());
    format!("static {head}({})", types.collect::<Vec<_>>().join(", "))
}

#[test]
fn macros_and_prototypes_are_all_there() {
    let (Some(theirs), folder) = (installed_headers(), scratch("header-names")) else { return skip(NEEDS) };
    let plain = source(&folder, "plain.c", "#include <ode/ode.h>\n");
    let (Some(a), Some(b)) = (preprocessed(theirs, &plain, "gcc"), preprocessed(&include(), &plain, "gcc"))
    else {
        return skip(NEEDS);
    };
    let ours = macros(&b);
    let missing: Vec<_> = macros(&a)
        .into_iter()
        .filter(|name| !ours.contains(name) && !name.starts_with("_ODE_") && !OWN_MACROS.contains(&&**name))
        .collect();
    assert!(missing.is_empty(), "macros that are missing: {missing:?}");

    // gcc writes all declarations down with their types.
    let declared = |include: &Path, name: &str| {
        let list = folder.join(name);
        succeed(
            Command::new("gcc")
                .arg("-aux-info")
                .arg(&list)
                .arg("-I")
                .arg(include)
                .arg("-fsyntax-only")
                .arg(&plain),
        )?;
        let text = std::fs::read_to_string(list).expect("gcc's list");
        let lines = text.lines().filter(|line| line.contains("/ode/"));
        let bare = lines
            .map(|line| line.split_once("*/").unwrap_or_default().1.split(';').next().unwrap_or_default());
        Some(bare.map(prototype).collect::<BTreeSet<String>>())
    };
    let (Some(a), Some(b)) = (declared(theirs, "theirs.txt"), declared(&include(), "ours.txt")) else {
        return skip(NEEDS);
    };
    // libode declares dJointAddPUTorque but does not have it: nothing can call it.
    let missing: Vec<_> = a.difference(&b).filter(|line| !line.contains("dJointAddPUTorque ")).collect();
    assert!(a.len() > 700, "only {} prototypes", a.len());
    assert!(missing.is_empty(), "{} prototypes are missing or differ: {missing:#?}", missing.len());
    println!("{} prototypes agree", a.len());
    for name in include_str!("data/symbols.txt").lines() {
        assert!(
            b.iter().any(|line| line.contains(&format!(" {name} (")) || line.contains(&format!("*{name} ("))),
            "{name}"
        );
    }
}

/// Explicit instantiations of all class templates.
const INSTANCES: &str = "#include <ode/ode.h>
#define JOINT(Kind) template class d##Kind##Template<dJointDynamicIDContainer, dWorldDynamicIDContainer, \\
        dBodyDynamicIDContainer>;
template class dWorldTemplate<dWorldDynamicIDContainer>;
template class dBodyTemplate<dBodyDynamicIDContainer, dWorldDynamicIDContainer>;
template class dJointGroupTemplate<dJointGroupDynamicIDContainer>;
JOINT(Joint) JOINT(BallJoint) JOINT(HingeJoint) JOINT(SliderJoint) JOINT(UniversalJoint) JOINT(Hinge2Joint)
JOINT(PRJoint) JOINT(PUJoint) JOINT(PistonJoint) JOINT(FixedJoint) JOINT(ContactJoint) JOINT(NullJoint)
JOINT(AMotorJoint) JOINT(LMotorJoint)
";

/// The members of all classes, with their parameters, as the compiler emits them; and the functions that they call.
fn members(folder: &Path, include: &Path) -> Option<(BTreeSet<String>, BTreeSet<String>)> {
    let object = folder.join("classes.o");
    let text = source(folder, "classes.cpp", INSTANCES);
    let mut command = Command::new("g++");
    command.args(["-std=c++17", "-fkeep-inline-functions", "-w", "-c", "-I"]).arg(include);
    succeed(command.arg("-o").arg(&object).arg(text))?;
    let symbols = succeed(Command::new("nm").arg("-C").arg(&object))?;
    let (mut members, mut calls) = (BTreeSet::new(), BTreeSet::new());
    for line in symbols.lines() {
        let (kind, name) = line.get(17..18).zip(line.get(19..)).expect("nm's columns");
        if kind == "U" {
            calls.insert(name.to_owned());
        } else if name.contains("::") {
            members.insert(name.trim_end_matches(" const").to_owned());
        }
    }
    calls.retain(|name| name.starts_with('d') && !name.contains('('));
    Some((members, calls))
}

#[test]
fn classes_have_all_members() {
    let (Some(theirs), folder) = (installed_headers(), scratch("header-classes")) else { return skip(NEEDS) };
    let (Some((a, called)), Some((b, calls))) = (members(&folder, theirs), members(&folder, &include()))
    else {
        return skip(NEEDS);
    };
    // A base's destructor may be emitted or not; the classes' own are compared by running programs.
    let missing: Vec<_> = a.difference(&b).filter(|name| !name.contains("SimpleIDContainer")).collect();
    assert!(a.len() > 500, "only {} members", a.len());
    assert!(missing.is_empty(), "{} members are missing or differ: {missing:#?}", missing.len());
    let uncalled: Vec<_> = called.difference(&calls).collect();
    println!(
        "{} members agree; they call {} functions; not called by ours: {uncalled:?}",
        a.len(),
        calls.len()
    );
}

/// Compiles a program against the package's headers with all warnings; those that name a header are faults.
fn compile(program: &Path, source: &Path, standard: &str, more: &[&str], libraries: &Path) -> Option<()> {
    let cpp = standard.contains("++");
    let mut command = Command::new(if cpp { "g++" } else { "gcc" });
    command.args([
        "-Wall",
        "-Wextra",
        "-pedantic",
        "-Wno-deprecated-declarations",
        "-D_POSIX_C_SOURCE=200809L",
    ]);
    command.arg(format!("-std={standard}")).args(more).arg("-I").arg(include());
    // C programs are not all clean C++: what they do is their own matter.
    command.args(if cpp { &["-fpermissive", "-x", "c++"][..] } else { &[] }).arg(source).args(["-x", "none"]);
    command.arg("-o").arg(program).arg("-L").arg(libraries).args(["-lode", "-lm", "-lpthread"]);
    let output = output(&mut command)?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{} as {standard}:\n{text}", source.display());
    let faults: Vec<_> =
        text.lines().filter(|line| line.contains("include/ode/") && line.contains("warning")).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    Some(())
}

#[test]
fn programs_do_the_same_by_either_headers() {
    let (Some(_), folder) = (installed_headers(), scratch("header-programs")) else { return skip(NEEDS) };
    link_library(&build_folder().join("libode.so"), &folder);
    let mut faults = Vec::new();
    for source in programs() {
        let name = source.file_stem().expect("a name").to_string_lossy().into_owned();
        let theirs = folder.join(format!("{name}-theirs"));
        let cpp = source.extension().is_some_and(|e| e == "cpp");
        let mut command = Command::new(if cpp { "g++" } else { "gcc" });
        let command = command.arg("-w").arg("-o").arg(&theirs).arg(&source).arg("-L").arg(&folder);
        let Some(_) = succeed(command.args(["-lode", "-lm", "-lpthread"])) else { return skip(NEEDS) };
        let wanted = run(&theirs, &folder);
        for standard in if cpp { ["c++11", "c++17"] } else { ["c99", "c++17"] } {
            let ours = folder.join(format!("{name}-{standard}"));
            let only_read = !cpp && standard == "c++17";
            let more: &[_] = if only_read { &["-fsyntax-only"] } else { &[] };
            if compile(&ours, &source, standard, more, &folder).is_none() {
                return skip(NEEDS);
            }
            if only_read {
                continue;
            }
            faults.extend(differences(
                &format!("{name} as {standard}"),
                &wanted,
                &run(&ours, &folder),
                1e-12,
            ));
        }
    }
    assert!(faults.is_empty(), "{} lines differ:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn every_header_stands_alone_in_every_standard() {
    let folder = scratch("header-alone");
    let headers = std::fs::read_dir(include().join("ode")).expect("the headers");
    let mut text = String::new();
    for header in headers {
        let name = header.expect("a header").file_name().into_string().expect("a name");
        text += &format!("#include <ode/{name}>\n");
        let alone = source(&folder, "alone.c", &format!("#include <ode/{name}>\nint alone;\n"));
        let mut command = Command::new("gcc");
        command
            .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I"])
            .arg(include());
        let Some(_) = succeed(command.arg(alone)) else { return skip("no gcc") };
    }
    let all = source(&folder, "all.c", &(text + "int all;\n"));
    for standard in ["c99", "c11", "c17", "c++98", "c++11", "c++17", "c++20"] {
        for precision in ["-DdDOUBLE", "-DdSINGLE", "-DdIDESINGLE"] {
            let mut command = Command::new(if standard.contains("++") { "g++" } else { "gcc" });
            command.args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", precision]);
            command.arg(format!("-std={standard}")).arg("-I").arg(include());
            command.args(if standard.contains("++") { &["-x", "c++"][..] } else { &[] });
            let Some(_) = succeed(command.arg(&all)) else { return skip("no g++") };
        }
    }
    let both = source(&folder, "both.c", "#define dSINGLE\n#define dDOUBLE\n#include <ode/ode.h>\n");
    let refused = output(Command::new("gcc").arg("-fsyntax-only").arg("-I").arg(include()).arg(both));
    assert!(refused.is_some_and(|refused| !refused.status.success()), "both precisions at once are an error");
}

#[test]
fn functions_of_older_and_newer_odes_work() {
    let folder = scratch("header-older-newer");
    link_library(&build_folder().join("libode.so"), &folder);
    let program = folder.join("older_and_newer");
    let source = here().join("tests/headers/older_and_newer.c");
    if compile(&program, &source, "c99", &[], &folder).is_none() {
        return skip("no gcc");
    }
    let said = run(&program, &folder);
    let broken: Vec<_> =
        said.lines().filter(|line| line.ends_with(" 0") && !line.starts_with("exit")).collect();
    assert!(broken.is_empty() && said.contains("end\n"), "{said}");
}
