//! Contact joints made by hand: marbles in a bowl, found to touch by a few lines of our own. The dynamics needs nothing
//! but contact points; no geom and no space appears.

use ferrode::dynamics::World;
use ferrode::prelude::{BodyKey, Error, Mass, Stepper, Surface, Vec3};
use ferrode::{Contact, ContactPoint};

const RADIUS: f64 = 0.1;
const BOWL: f64 = 1.0;

/// A marble against the inside of the bowl, a sphere about the origin. The normal points into the marble.
fn marble_in_bowl(p: Vec3) -> Option<ContactPoint> {
    let outward = p.normalized()?;
    let depth = p.length() + RADIUS - BOWL;
    (depth > 0.0).then_some(ContactPoint { position: outward * BOWL, normal: -outward, depth })
}

/// Two marbles. The normal points into the first.
fn marble_on_marble(p: Vec3, q: Vec3) -> Option<ContactPoint> {
    let normal = (p - q).normalized()?;
    let depth = 2.0 * RADIUS - (p - q).length();
    (depth > 0.0).then_some(ContactPoint { position: (p + q) * 0.5, normal, depth })
}

fn main() -> Result<(), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let mut marbles: Vec<BodyKey> = Vec::new();
    for i in 0..12 {
        let key = world.create_body();
        let (column, layer) = (f64::from(i % 4), f64::from(i / 4));
        let body = world.body_mut(key)?;
        body.set_mass(&Mass::sphere(2500.0, RADIUS)?)?;
        body.set_position(Vec3::new(0.22 * column - 0.3, 0.03 * column + 0.1 * layer, 0.25 * layer - 0.3))?;
        marbles.push(key);
    }

    // A little rolling resistance, so that they come to rest.
    let surface = Surface::with_friction(0.4).with_rolling(0.005, 0.005, 0.005);
    let group = world.create_group();
    let mut most = 0;
    for _ in 0..600 {
        // Everything that touches, as (contact, first body, second body). `None` is the static world: the bowl.
        let mut contacts: Vec<(ContactPoint, BodyKey, Option<BodyKey>)> = Vec::new();
        for (i, &a) in marbles.iter().enumerate() {
            let p = world.body(a)?.position();
            contacts.extend(marble_in_bowl(p).map(|c| (c, a, None)));
            for &b in &marbles[i + 1..] {
                let q = world.body(b)?.position();
                contacts.extend(marble_on_marble(p, q).map(|c| (c, a, Some(b))));
            }
        }
        most = most.max(contacts.len());
        for (point, a, b) in contacts {
            let joint = world.create_contact(Some(group), &Contact::at(point, surface))?;
            world.attach(joint, Some(a), b)?;
        }
        world.step(Stepper::Quick, 0.01)?;
        world.empty_group(group)?;
    }

    let mut fastest: f64 = 0.0;
    for &a in &marbles {
        let body = world.body(a)?;
        fastest = fastest.max(body.linear_velocity().length());
        assert!(body.position().z < 0.0, "all marbles lie in the bowl");
        assert!(body.position().length() + RADIUS < BOWL + 0.01, "none went through it");
    }
    println!("Up to {most} contacts; after 6 s the fastest marble moves at {fastest:.4} m/s.");
    assert!(fastest < 0.05);
    Ok(())
}
