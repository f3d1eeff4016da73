//! The documentation's pictures: there, of their size, not blank, and of what the scenes are now.

mod common;

use common::canvas;
use ferrode_demos::{ALL, Mark};
use ferrode_view::gallery::{SIZE, Studio, joints, page};
use ferrode_view::render::{Camera, Picture, Quality};
use image::RgbImage;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

fn demo_picture(name: &str) -> PathBuf {
    docs().join(format!("img/gallery/{name}.png"))
}

fn joint_picture(name: &str) -> PathBuf {
    docs().join(format!("book/img/joint-{name}.png"))
}

fn opened(path: &Path) -> RgbImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgb8()
}

#[test]
fn the_page_says_what_the_demos_say() {
    let text = std::fs::read_to_string(docs().join("gallery.md")).unwrap();
    assert_eq!(text, page(), "`cargo run --release -p ferrode-view -- gallery docs` writes it anew");
    for demo in ALL {
        assert_eq!(text.matches(&format!("**{}**", demo.name)).count(), 1, "{}", demo.name);
        assert_eq!(text.matches(&format!("img/gallery/{}.png", demo.name)).count(), 1, "{}", demo.name);
    }
}

#[test]
fn every_demo_and_joint_has_its_picture_and_none_is_blank() {
    let demos = ALL.iter().map(|demo| demo_picture(demo.name));
    let joints = joints::ALL.iter().map(|joint| joint_picture(joint.name));
    let mut bytes = 0;
    for path in demos.chain(joints) {
        let name = path.display();
        let size = std::fs::metadata(&path).unwrap_or_else(|error| panic!("{name}: {error}")).len();
        bytes += size;
        assert!(size < 60_000, "{name}: {size} bytes");
        let picture = opened(&path);
        assert_eq!(picture.dimensions(), (SIZE[0], SIZE[1]), "{name}");
        // Sky and ground alone have few colours, all of them pale: the subject is what has others.
        let colors: BTreeSet<[u8; 3]> = picture.pixels().map(|pixel| pixel.0).collect();
        let strong = |[r, g, b]: [u8; 3]| r.max(g).max(b) - r.min(g).min(b) > 60;
        let subject = picture.pixels().filter(|pixel| strong(pixel.0)).count();
        let all = (SIZE[0] * SIZE[1]) as usize;
        assert!(colors.len() > 100, "{name}: {} colours", colors.len());
        assert!(subject * 300 > all, "{name}: {subject} pixels of {all} are of a strong colour");
    }
    assert!(bytes < 1_500_000, "{bytes} bytes in all");
    let kept = std::fs::read_dir(docs().join("img/gallery")).unwrap().count();
    assert_eq!(kept, ALL.len(), "pictures of demos that are no more");
}

#[test]
fn every_page_of_a_joint_shows_its_picture() {
    for entry in std::fs::read_dir(docs().join("book/joints")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        // The joint that does nothing looks like nothing.
        if name == "null" {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(&format!("(../img/joint-{name}.png)")), "{name}");
        assert!(joints::ALL.iter().any(|joint| joint.name == name), "{name}");
    }
}

/// The mean difference of two pictures' pixels, of 255.
fn difference(now: &Picture, kept: &RgbImage) -> f64 {
    assert_eq!((now.width, now.height), kept.dimensions());
    let pairs = now.pixels.chunks_exact(4).zip(kept.pixels());
    let sum: u64 = pairs.map(|(a, b)| (0..3).map(|i| u64::from(a[i].abs_diff(b.0[i]))).sum::<u64>()).sum();
    // `len` counts each colour of each pixel.
    sum as f64 / kept.len() as f64
}

#[test]
fn pictures_drawn_now_are_those_that_are_kept() {
    if canvas([16, 16], Quality::live()).is_none() {
        return;
    }
    let mut studio = Studio::open(SIZE).unwrap();
    let kept = opened(&demo_picture("newtons-cradle"));
    for name in ["newtons-cradle", "cards", "amotor", "bounce", "slider"] {
        let demo = ferrode_demos::find(name).unwrap();
        let now = studio.demo(demo).unwrap();
        let off = difference(&now, &opened(&demo_picture(name)));
        // What 256 colours lose, and drivers round; another scene is off by more than ten times that.
        assert!(off < 2.0, "{name}: off by {off}");
        assert!(name == "newtons-cradle" || difference(&now, &kept) > 5.0, "{name} looks like another");
    }
    for joint in joints::ALL {
        let now = studio.joint(joint).unwrap();
        let off = difference(&now, &opened(&joint_picture(joint.name)));
        assert!(off < 2.0, "{}: off by {off}", joint.name);
    }
}

#[test]
fn bodies_are_in_their_picture_and_fill_it() {
    let mut wrong = Vec::new();
    // The largest scene's picture is checked by eye: it takes as long as all others.
    for demo in ALL.iter().filter(|demo| demo.name != "ten-thousand") {
        let mut play = demo.start().unwrap();
        for _ in 0..play.steps_to(demo.picture_at) {
            play.step().unwrap();
        }
        let camera = Camera::look_at(demo.camera.eye, demo.camera.target);
        let [width, height] = SIZE.map(f64::from);
        let (mut seen, mut count) = (0, 0);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let geoms = play.world.geoms().map(|info| {
            let geom = play.world.geom(info.key).unwrap();
            (info.body.is_some(), geom.shape().aabb(geom.pose()))
        });
        let stands = play.drawing().marks.into_iter().filter_map(|mark| match mark {
            Mark::Solid { shape, pose, .. } => Some((false, shape.aabb(&pose))),
            _ => None,
        });
        for (moves, aabb) in geoms.chain(stands) {
            // Planes have no end, and hills go on beyond the picture.
            if !aabb.is_finite() || aabb.extent().abs_max() > 10.0 {
                continue;
            }
            let Some(([x, y], _)) = camera.project(aabb.center(), SIZE) else { continue };
            if moves {
                count += 1;
                seen += usize::from((0.0..width).contains(&x) && (0.0..height).contains(&y));
            }
            for corner in [aabb.min, aabb.max] {
                let Some((p, _)) = camera.project(corner, SIZE) else { continue };
                for i in 0..2 {
                    (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
                }
            }
        }
        let share = |i: usize, side: f64| (high[i].min(side) - low[i].max(0.0)) / side;
        let fills = share(0, width).max(share(1, height));
        if seen * 10 < count * 8 || fills < 0.25 {
            wrong.push(format!("{}: {seen} of {count} in the picture, fill {fills:.2} of a side", demo.name));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
