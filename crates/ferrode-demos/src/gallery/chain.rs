//! A chain between two posts, of links on ball joints, comes to rest in a catenary.

use super::prelude::*;
use ferrode_math::real;

const LINKS: usize = 30;
const LENGTH: f64 = 0.2;
const SPAN: f64 = 4.0;

pub(super) const DEMO: Demo = Demo {
    name: "chain",
    subject: Subject::Mechanisms,
    about: "a chain between two posts settles into a catenary",
    property: "its sag is that of the catenary of its length and span, within 1 %",
    seconds: 8.0,
    picture_at: 8.0,
    show: &[],
    camera: Camera::new([1.6, -5.6, 2.3], [0.0, 0.0, 1.6]),
    build,
};

/// Sag of a catenary of length `s` over a span `d`: with a from s = 2 a sinh(d/2a), a (cosh(d/2a) − 1).
fn sag(s: f64, d: f64) -> f64 {
    let (mut low, mut high) = (1e-3, 1e3);
    for _ in 0..200 {
        let a: f64 = 0.5 * (low + high);
        let x = (0.5 * d / a).min(700.0);
        let length = a * (real::exp(x) - real::exp(-x));
        if length > s { low = a } else { high = a }
    }
    let a = 0.5 * (low + high);
    let x = 0.5 * d / a;
    a * (0.5 * (real::exp(x) + real::exp(-x)) - 1.0)
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    damp(&mut world, 0.01, 0.01)?;
    for side in [-0.5, 0.5] {
        add_wall(&mut world, at(0.1, 0.1, 3.2), Pose::from_position(at(side * SPAN, 0.0, 1.6)))?;
    }
    // The links zigzag at first: every second one slants down, so that the chain is as long as it is.
    let half_step = 0.5 * SPAN / (LINKS as f64 / 2.0);
    let drop = (LENGTH * LENGTH - half_step * half_step).sqrt();
    let node =
        |i: usize| at(-0.5 * SPAN + half_step * i as f64, 0.0, 3.2 - if i % 2 == 1 { drop } else { 0.0 });
    let mut last = None;
    let mut middle = None;
    for i in 0..LINKS {
        let (from, to) = (node(i), node(i + 1));
        // Half of a link's mass in each of its ends: then the nodes hang like those of a string of weights.
        let link = BodyBuilder::new()
            .at((from + to) * 0.5)
            .rotated(from_z_to(to - from))
            .with_shape(Capsule::new(0.03, LENGTH - 0.06)?, 2000.0);
        let link = world.add_body(link)?;
        for geom in world.body_geoms(link)?.to_vec() {
            world.set_geom_bits(geom, 0, 0)?;
        }
        world.add_ball(Some(link), last, from)?;
        last = Some(link);
        if i == LINKS / 2 {
            middle = Some(link);
        }
    }
    world.add_ball(last, None, node(LINKS))?;
    Stage::new(world, 0.005, middle).check(|middle, world| {
        let middle = middle.ok_or(Failure::Refused("the chain has no middle".to_owned()))?;
        let low = body(world, middle)?.relative_point_position(at(0.0, 0.0, -0.5 * LENGTH));
        Ok(Findings::new()
            .near("sag (m)", 3.2 - low.z, sag(LINKS as f64 * LENGTH, SPAN), 0.01)
            .at_most("joints open by (m)", joint_errors(world)?.0, 1e-5)
            .at_most("speed (m/s)", fastest(world), 0.01))
    })
}
