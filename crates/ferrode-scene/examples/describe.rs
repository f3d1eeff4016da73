//! Prints what a world or robot file says, and what is wrong with it: `cargo run --example describe -- FILE…`
use std::process::ExitCode;

use ferrode_scene::{LoadOptions, load};

fn main() -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for path in std::env::args().skip(1) {
        match load(&path, &LoadOptions::default()) {
            Ok(loaded) => {
                let scene = &loaded.scene;
                println!(
                    "{path}: {} models, {} links, {} joints, {} frames, {} kg that can move",
                    scene.models.len(),
                    scene.links.len(),
                    scene.joints.len(),
                    scene.frames.len(),
                    scene.moving_mass()
                );
                for warning in &loaded.warnings {
                    println!("{warning}");
                }
            }
            Err(error) => {
                eprintln!("{error}");
                code = ExitCode::FAILURE;
            }
        }
    }
    code
}
