//! The viewer without a window: winding back and forth, and what changes keep.

use super::Viewer;
use super::input::{Input, Key};
use super::playback::Playback;
use crate::overlay::Overlays;
use crate::painter::Coloring;
use crate::setup::Setup;
use crate::view_point::ViewPoint;
use ferrode::{Stepper, Vec3};
use ferrode_render::Camera;
use ferrode_scene::description::LinkId;
use ferrode_scene::{BuildOptions, LoadOptions, build, load_str};
use std::time::Duration;

/// A ball that falls onto a plane and bounces.
const BALL: &str = r#"<sdf version="1.10"><world name="w">
  <physics type="ode"><max_step_size>0.005</max_step_size></physics>
  <model name="ground"><static>true</static><link name="l"><collision name="c">
    <geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
  <model name="ball"><pose>0 0 2 0 0 0</pose><link name="body">
    <inertial auto="true"><density>200</density></inertial>
    <collision name="c"><geometry><sphere><radius>0.3</radius></sphere></geometry></collision></link></model>
</world></sdf>"#;

fn viewer() -> Viewer {
    seen([320, 200], &ViewPoint::default())
}

fn seen(size: [u32; 2], view: &ViewPoint) -> Viewer {
    let loaded = load_str("ball", BALL, &LoadOptions::default()).unwrap();
    let named = build(&loaded.scene, &BuildOptions::default()).unwrap();
    let playback = Playback::new(Setup::default(), named);
    Viewer::new(playback, size, view, Overlays::default())
}

fn run(viewer: &mut Viewer, frames: usize) {
    for _ in 0..frames {
        viewer.advance(1.0 / 60.0, Duration::MAX);
    }
}

fn ball(viewer: &Viewer) -> Vec3 {
    let named = &viewer.playback.named;
    named
        .link_pose(LinkId(named.scene.links.iter().position(|link| link.name == "ball::body").unwrap()))
        .position
}

#[test]
fn time_is_wound_back_and_forth_until_it_runs_on() {
    let mut viewer = viewer();
    run(&mut viewer, 120);
    let (end, last) = (viewer.playback.time(), ball(&viewer));
    assert!((end - 2.0).abs() < 0.01, "{end}");
    let range = viewer.playback.range();
    assert_eq!(range, [0.0, end]);
    // A slider asks for the same time again and again while it is held.
    for _ in 0..5 {
        viewer.seek(0.5);
        let time = viewer.playback.time();
        assert!(time <= 0.5 && time > 0.5 - 0.08, "{time}");
        assert_eq!(viewer.playback.range(), range);
    }
    let half = ball(&viewer);
    let (time, fall) = (viewer.playback.time(), 2.0 - half.z);
    assert!((fall - 0.5 * 9.8 * time * time).abs() < 0.03, "{half:?}");
    viewer.seek(1.5);
    let time = viewer.playback.time();
    assert!(time <= 1.5 && time > 1.5 - 0.08, "{time}");
    viewer.seek(0.5);
    assert_eq!(ball(&viewer), half);
    viewer.seek(end);
    assert_eq!((viewer.playback.time(), ball(&viewer)), (end, last));
    // What is done in the past makes another future, or the same anew.
    viewer.seek(0.5);
    let time = viewer.playback.time();
    viewer.input(Input::Key(Key::Char('.'), true));
    assert!((viewer.playback.time() - time - 0.005).abs() < 1e-12);
    assert_eq!(viewer.playback.range(), [0.0, viewer.playback.time()]);
    while viewer.playback.time() < end - 1e-9 {
        viewer.playback.single_step(&mut |_, _| {}).unwrap();
    }
    assert_eq!(ball(&viewer), last);
    // The state that was gone back to is still kept.
    viewer.seek(time);
    assert_eq!((viewer.playback.time(), ball(&viewer)), (time, half));
    viewer.seek(1.0);
    viewer.input(Input::Key(Key::Char('b'), true));
    assert_eq!(viewer.playback.range(), [0.0, viewer.playback.time()], "a dropped body is not there later");
    viewer.seek(0.0);
    assert_eq!((viewer.playback.time(), viewer.playback.named.world.body_count()), (0.0, 1));
}

#[test]
fn keys_that_are_held_down_go_on_through_time_and_others_do_not() {
    let mut viewer = viewer();
    run(&mut viewer, 60);
    for key in [Key::Left, Key::Char(',')] {
        let before = viewer.playback.time();
        for _ in 0..3 {
            viewer.input(Input::Key(key, true));
        }
        let gone = before - viewer.playback.time();
        assert!((gone - 3.0 / 15.0).abs() < 0.05, "{key:?} went {gone} s back");
    }
    let before = viewer.playback.time();
    for _ in 0..3 {
        viewer.input(Input::Key(Key::Right, true));
    }
    assert!((viewer.playback.time() - before - 0.015).abs() < 1e-9);
    for _ in 0..3 {
        viewer.input(Input::Key(Key::Char('b'), true));
    }
    assert_eq!(viewer.playback.named.world.body_count(), 2, "one cube a stroke");
}

#[test]
fn what_was_chosen_stays_when_time_or_step_size_change() {
    let mut viewer = viewer();
    viewer.painter.coloring = Coloring::Islands;
    run(&mut viewer, 30);
    viewer.playback.set_stepper(Stepper::Direct);
    viewer.back();
    assert_eq!(viewer.playback.stepper(), Stepper::Direct);
    let (time, place) = (viewer.playback.time(), ball(&viewer));
    viewer.set_step_size(0.0025);
    assert_eq!(viewer.message, "");
    assert_eq!(viewer.playback.stepper(), Stepper::Direct);
    assert_eq!(viewer.painter.coloring, Coloring::Islands);
    assert!((viewer.playback.time() - time).abs() < 1e-12 && (ball(&viewer) - place).length() < 1e-12);
    viewer.reset();
    assert_eq!((viewer.playback.stepper(), viewer.playback.time()), (Stepper::Direct, 0.0));
}

#[test]
fn what_a_picture_shows_fits_beside_the_panel() {
    let (eye, target) = (Vec3::new(0.0, -7.0, 2.0), Vec3::new(0.0, 0.0, 0.7));
    let mut viewer = seen([800, 600], &ViewPoint::LookAt { eye, target });
    let camera = Camera::look_at(eye, target);
    let edges = [[0.0, 300.0], [800.0, 300.0]].map(|pixel| {
        let along = camera.ray(pixel, [800, 600]);
        eye + along * ((target - eye).dot(camera.directions()[2]) / along.dot(camera.directions()[2]))
    });
    viewer.make_room();
    let across = |viewer: &Viewer| edges.map(|p| viewer.camera().project(p, [800, 600]).unwrap().0[0]);
    let [left, right] = across(&viewer);
    assert!(left.abs() < 1e-6 && (right - 510.0).abs() < 1e-6, "{left} {right}");
    viewer.input(Input::Key(Key::Tab, true));
    let [left, right] = across(&viewer);
    assert!(
        (left - 145.0).abs() < 1e-6 && (right - 655.0).abs() < 1e-6,
        "without it, in the middle: {left} {right}"
    );
}
