//! The text of `docs/gallery.md`, from what demos say of themselves.

use super::SIZE;
use ferrode_demos::{ALL, Subject};

/// Width of the pictures on the page: finer than the screen's points where it has more pixels.
const WIDTH: u32 = 400;

const HEAD: &str = "\
# Gallery

Scenes that show what the engine does, and measure it: each has a physical property that it checks when it has run
(`ferrode demo --all --headless` runs them all). `ferrode demo NAME` opens one in a window, `ferrode demo NAME -o out.png` draws
it ([The viewer](viewer.md)); the sources, one short file a scene, are in
[crates/ferrode-demos](../crates/ferrode-demos/src/gallery).

This page and its pictures are written by one command, from the scenes themselves:
`cargo run --release -p ferrode-view -- gallery docs`.
";

/// The page.
pub fn page() -> String {
    let mut text = HEAD.to_owned();
    for subject in Subject::ALL {
        text.push_str(&format!("\n## {}\n\n| | |\n|---|---|\n", subject.title()));
        for demo in ALL.iter().filter(|demo| demo.subject == subject) {
            let name = demo.name;
            text.push_str(&format!(
                "| <img src=\"img/gallery/{name}.png\" alt=\"{name}\" width=\"{}\" height=\"{}\"> | **{name}**: {}. *Checked:* {}. |\n",
                WIDTH, WIDTH * SIZE[1] / SIZE[0], demo.about, demo.property
            ));
        }
    }
    text
}
