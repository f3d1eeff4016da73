//! `ferrode view`, `render` and `replay` start `ferrode-view`.

mod common;

use common::scratch;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

/// A program that is being written cannot be started, and a test that starts another inherits the file as open: one at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// A copy of the command in a folder of its own.
fn alone(test: &str) -> PathBuf {
    let folder = scratch(test);
    std::fs::create_dir_all(&folder).unwrap();
    let copy = folder.join(format!("ferrode{}", std::env::consts::EXE_SUFFIX));
    std::fs::copy(env!("CARGO_BIN_EXE_ferrode"), &copy).unwrap();
    copy
}

#[test]
fn without_the_viewer_one_line_says_how_to_install_it() {
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let ferrode = alone("no-viewer");
    for (name, what) in [("view", "a.sdf"), ("render", "a.sdf"), ("replay", "a.jsonl"), ("demo", "hinge")] {
        let done = Command::new(&ferrode).args([name, what]).env("PATH", "").output().unwrap();
        let told = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{told}");
        assert!(told.trim().lines().count() == 1 && told.contains("cargo install ferrode-view"), "{told}");
        assert_eq!(told.contains("ferrode demo hinge --headless"), name == "demo", "{told}");
    }
}

#[cfg(unix)]
#[test]
fn the_viewer_beside_the_command_gets_all_arguments_and_its_code_is_handed_back() {
    use std::os::unix::fs::PermissionsExt;
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let ferrode = alone("stand-in-viewer");
    let viewer = ferrode.with_file_name("ferrode-view");
    std::fs::write(&viewer, "#!/bin/sh\nprintf '[%s]' \"$@\"\nexit 4\n").unwrap();
    std::fs::set_permissions(&viewer, std::fs::Permissions::from_mode(0o755)).unwrap();
    let line = ["render", "my world.sdf", "-o", "out.png", "--camera", "-30,20", "--help"];
    let done = Command::new(&ferrode).args(line).output().unwrap();
    let want: String = line.iter().map(|argument| format!("[{argument}]")).collect();
    assert_eq!((String::from_utf8(done.stdout).unwrap(), done.status.code()), (want, Some(4)));

    // On servers, Mesa is kept from complaining of a Wayland that is not there.
    std::fs::write(&viewer, "#!/bin/sh\necho \"<$NODEVICE_SELECT>\"\n").unwrap();
    let told = |folder: Option<&str>| {
        let mut command = Command::new(&ferrode);
        command.args(["view", "a.sdf"]).env_remove("NODEVICE_SELECT").env_remove("XDG_RUNTIME_DIR");
        command.envs(folder.map(|folder| ("XDG_RUNTIME_DIR", folder)));
        String::from_utf8(command.output().unwrap().stdout).unwrap()
    };
    assert_eq!((told(None), told(Some("/tmp"))), ("<1>\n".to_owned(), "<>\n".to_owned()));
}
