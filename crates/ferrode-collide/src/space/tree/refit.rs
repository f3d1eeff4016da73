use super::AabbTree;
use crate::space::f32_box::Box32;
use ferrode_math::Aabb;

impl AabbTree {
    /// Brings the boxes up to date after the items have moved; which items lie together stays as it was built. `around`
    /// gives the box of an item, and the items are as many as ever.
    ///
    /// Linear in the number of items. A tree whose items have moved far from their neighbours finds the same items, but
    /// looks at more; [`AabbTree::build`] it anew then.
    pub fn refit(&mut self, around: impl Fn(u32) -> Aabb) {
        let Self { nodes, packed, items } = self;
        let leaf = |first, count| {
            let items = items[first as usize..(first + count) as usize].iter();
            Box32::around(&items.fold(Aabb::EMPTY, |all, &item| all.union(&around(item))))
        };
        nodes.refit(leaf);
        packed.refit(leaf);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Probe;
    use ferrode_math::Vec3;

    #[test]
    fn finds_what_a_new_tree_finds() {
        let at = |i: u32, t: f64| {
            let x = f64::from(i);
            let p = Vec3::new(
                x.rem_euclid(7.0) + t * x,
                (x * 0.37).rem_euclid(5.0) - t,
                (x * 0.11).rem_euclid(3.0),
            );
            Aabb::from_center(p, Vec3::splat(0.2))
        };
        for count in [0, 1, 4, 5, 100] {
            let boxes = |t: f64| (0..count).map(|i| at(i, t)).collect::<Vec<_>>();
            let mut moved = AabbTree::build(&boxes(0.0));
            moved.refit(|i| at(i, 0.3));
            let fresh = AabbTree::build(&boxes(0.3));
            for probe in 0..40u32 {
                let around = Aabb::from_center(at(probe, 0.3).center(), Vec3::splat(0.5));
                let hits = |tree: &AabbTree| {
                    let mut found = Vec::new();
                    tree.query(&around, |i| found.push(i));
                    found.retain(|&i| at(i, 0.3).overlaps(&around));
                    found.sort_unstable();
                    found
                };
                assert_eq!(hits(&moved), hits(&fresh));
                // Rays, one of them too far away for the packed tree.
                let from = at(probe * 7, 0.1).center() - Vec3::X * if probe == 39 { 1e9 } else { 2.0 };
                let ray = Probe::ray(from, at(probe, 0.3).center() - from);
                let met = |tree: &AabbTree| {
                    let mut found = Vec::new();
                    tree.seek(&ray, &mut 2.0, |i, _| found.push(i));
                    found.retain(|&i| ray.enter_aabb(&at(i, 0.3), 2.0).is_some());
                    found.sort_unstable();
                    found
                };
                let all: Vec<u32> =
                    (0..count).filter(|&i| ray.enter_aabb(&at(i, 0.3), 2.0).is_some()).collect();
                assert_eq!(met(&moved), all);
                assert_eq!(met(&fresh), all);
            }
        }
    }
}
