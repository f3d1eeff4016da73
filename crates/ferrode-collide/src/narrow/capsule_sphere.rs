use super::spheres;
use crate::{Capsule, Contacts, Frame, Sphere};

/// A capsule and a ball: the ball against a ball at the nearest point of the capsule's axis.
pub fn capsule_sphere(capsule: &Capsule, fc: &Frame, sphere: &Sphere, fs: &Frame, out: &mut Contacts<'_>) {
    let u = fc.axis(2);
    let half = 0.5 * capsule.length();
    let along = u.dot(fs.position - fc.position);
    let along = if along > half {
        half
    } else if along < -half {
        -half
    } else {
        along
    };
    spheres(fc.position + u * along, capsule.radius(), fs.position, sphere.radius(), out);
}
