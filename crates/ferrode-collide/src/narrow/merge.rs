use crate::{Contacts, GeomContact};
use ferrode_math::Vec3;

/// Whether the contacts of a ball with a mesh, one for each triangle, become fewer (ODE's `dGeomLowLevelControl` with
/// `dGeomTriMeshSetSphereContactsMerge…`; manual chapter "Trimesh class").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactMerge {
    /// As they are.
    #[default]
    None,
    /// All get one normal: the mean of theirs, by depth.
    Normals,
    /// They become one, at their mean place, with the mean normal, as deep as parts the ball from each along it.
    Full,
}

/// Cosines less than this count as this: a depth grows to no more than twice.
const LEAST_COSINE: f64 = 0.5;

/// Merges contacts; if their normals cancel, or one points the other way than their mean, they stay as they are.
pub(crate) fn merge(merge: ContactMerge, out: &mut Contacts<'_>) {
    let list = out.added();
    if merge == ContactMerge::None || list.len() < 2 {
        return;
    }
    let sum = list.iter().fold(Vec3::ZERO, |s, c| s + c.point.normal * c.point.depth);
    let Some(mean) = sum.normalized() else { return };
    if merge == ContactMerge::Normals {
        list.iter_mut().for_each(|c| c.point.normal = mean);
        return;
    }
    if list.iter().any(|c| mean.dot(c.point.normal) < f64::EPSILON) {
        return;
    }
    let share = 1.0 / list.len() as f64;
    let place = list.iter().fold(Vec3::ZERO, |s, c| s + c.point.position * share);
    let along = |c: &GeomContact| c.point.depth / mean.dot(c.point.normal).max(LEAST_COSINE);
    let depth = list.iter().map(along).fold(0.0, f64::max);
    // Of several triangles.
    list[0] = GeomContact::new(place, mean, depth);
    out.truncate(1);
}
