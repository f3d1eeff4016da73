//! A swarm of boxes for the broad phase: all kinds of spaces must find the same pairs.

use super::prelude::*;
use ferrode::collide::Item;
use ferrode::{Colliders, Geom, SpaceKey, SpaceKind};
use ferrode_math::random::OdeRandom;

const COUNT: u32 = 600;
const HALF: f64 = 7.0;

pub(super) const DEMO: Demo = Demo {
    name: "space-stress",
    subject: Subject::Engine,
    about: "six hundred boxes drift through each other: which of their boxes overlap?",
    property: "a tree, a grid, a quadtree, a sweep and a list of all find the same pairs in every step",
    seconds: 3.0,
    picture_at: 1.0,
    show: &[],
    camera: Camera::new([17.0, -17.0, 14.0], [0.0, 0.0, 0.0]),
    build,
};

#[derive(Clone)]
struct Swarm {
    bodies: Vec<BodyKey>,
    /// The same geoms in each kind of space.
    spaces: Vec<(Colliders, SpaceKey, Vec<GeomKey>)>,
    pairs: usize,
    unequal: u32,
}

fn build() -> Result<Play, Failure> {
    let mut world = World::new();
    let mut random = OdeRandom::new(7);
    let (mut bodies, mut shapes) = (Vec::new(), Vec::new());
    for _ in 0..COUNT {
        let sides = random.next_vector(0.5).abs() + Vec3::splat(0.1);
        let shape = Cuboid::new(sides)?;
        let builder = BodyBuilder::new()
            .at(random.next_vector(HALF))
            .with_velocity(random.next_vector(2.0))
            .with_spin(random.next_vector(2.0))
            .with_shape(shape, 1.0)
            .kinematic(); // so that they pass through each other
        bodies.push(world.add_body(builder)?);
        shapes.push(shape);
    }
    let kinds = [
        SpaceKind::Simple,
        SpaceKind::HASH,
        SpaceKind::Quadtree { center: [0.0; 2], half_sides: [10.0; 2], depth: 5 },
        SpaceKind::SweepAndPrune(ferrode::collide::space::AxisOrder::XYZ),
        SpaceKind::Bvh,
    ];
    let mut spaces = Vec::new();
    for kind in kinds {
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind).map_err(ferrode::Error::from)?;
        let mut geoms = Vec::new();
        for (i, shape) in shapes.iter().enumerate() {
            let geom = Geom::new(*shape).with_user(i as u64);
            geoms.push(colliders.add_geom(Some(space), geom).map_err(ferrode::Error::from)?);
        }
        spaces.push((colliders, space, geoms));
    }
    Stage::new(world, 0.02, Swarm { bodies, spaces, pairs: 0, unequal: 0 })
        .before(|swarm, world| {
            // They turn back at the walls of a cube.
            for key in &swarm.bodies {
                let body = world.body_mut(*key)?;
                let (p, mut v) = (body.position(), body.linear_velocity());
                for i in 0..3 {
                    if p[i].abs() > HALF && p[i] * v[i] > 0.0 {
                        v[i] = -v[i];
                    }
                }
                body.set_linear_velocity(v)?;
            }
            Ok(())
        })
        .after(|swarm, world| {
            let mut lists = Vec::new();
            for (colliders, space, geoms) in &mut swarm.spaces {
                for (geom, key) in geoms.iter().zip(&swarm.bodies) {
                    colliders.set_pose(*geom, world.body(*key)?.pose()).map_err(ferrode::Error::from)?;
                }
                let mut pairs = Vec::new();
                colliders
                    .collide(*space, |colliders, a, b| {
                        let user = |item| match item {
                            Item::Geom(key) => colliders.geom(key).map(Geom::user),
                            Item::Space(_) => None,
                        };
                        if let (Some(a), Some(b)) = (user(a), user(b)) {
                            pairs.push((a.min(b), a.max(b)));
                        }
                    })
                    .map_err(ferrode::Error::from)?;
                pairs.sort_unstable();
                lists.push(pairs);
            }
            swarm.pairs = lists[0].len();
            swarm.unequal += u32::from(lists.iter().any(|list| *list != lists[0]));
            Ok(())
        })
        .check(|swarm, _| {
            Ok(Findings::new()
                .at_most("steps in which pairs differed", f64::from(swarm.unequal), 0.0)
                .at_least("pairs in the last step", swarm.pairs as f64, 50.0))
        })
}
