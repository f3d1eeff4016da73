//! Orders of members and pairs while unit balls move, come and go, against what libode 0.16.2 did on the same calls.

use ferrode_collide::space::AxisOrder;
use ferrode_collide::{Colliders, Geom, GeomKey, Item, SpaceKey, SpaceKind, Sphere};
use ferrode_math::{Pose, Vec3};

struct Balls {
    colliders: Colliders,
    space: SpaceKey,
    keys: Vec<GeomKey>,
}

impl Balls {
    fn new(kind: SpaceKind, count: usize) -> Self {
        let mut colliders = Colliders::new();
        let space = colliders.add_space(None, kind).unwrap();
        let ball = Geom::new(Sphere::new(1.0).unwrap());
        let keys = (0..count).map(|_| colliders.add_geom(Some(space), ball.clone()).unwrap()).collect();
        Self { colliders, space, keys }
    }

    fn number(&self, item: Item) -> usize {
        self.keys.iter().position(|k| item == Item::Geom(*k)).unwrap()
    }

    fn members(&self) -> Vec<usize> {
        self.colliders.members(self.space).map(|m| self.number(m)).collect()
    }

    fn put(&mut self, ball: usize, x: f64, y: f64) {
        self.colliders.set_pose(self.keys[ball], Pose::from_position(Vec3::new(x, y, 0.0))).unwrap();
    }

    fn leave(&mut self, ball: usize) {
        self.colliders.set_parent(self.keys[ball], None).unwrap();
    }

    fn enter(&mut self, ball: usize) {
        self.colliders.set_parent(self.keys[ball], Some(self.space)).unwrap();
    }

    fn pairs(&mut self) -> Vec<(usize, usize)> {
        let mut list = Vec::new();
        self.colliders.collide(self.space, |_, a, b| list.push((a, b))).unwrap();
        list.into_iter().map(|(a, b)| (self.number(a), self.number(b))).collect()
    }

    fn pairs_with(&mut self, ball: usize) -> Vec<(usize, usize)> {
        let mut list = Vec::new();
        self.colliders.collide2(self.space, self.keys[ball], |_, a, b| list.push((a, b))).unwrap();
        list.into_iter().map(|(a, b)| (self.number(a), self.number(b))).collect()
    }
}

/// All pairs of a list, in order.
fn all(list: &[usize]) -> Vec<(usize, usize)> {
    list.iter().enumerate().flat_map(|(k, &a)| list[k + 1..].iter().map(move |&b| (a, b))).collect()
}

#[test]
fn sweep_and_prune() {
    let mut balls = Balls::new(SpaceKind::SweepAndPrune(AxisOrder::XZY), 8);
    assert_eq!(balls.members(), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(balls.pairs(), all(&[0, 1, 2, 3, 4, 5, 6, 7]));
    balls.put(2, 0.0, 0.0);
    assert_eq!(balls.members(), [2, 0, 1, 7, 3, 4, 5, 6]);
    balls.put(5, 0.0, 0.0);
    assert_eq!(balls.members(), [2, 5, 0, 1, 7, 3, 4, 6]);
    balls.put(0, 0.0, 0.0);
    assert_eq!(balls.members(), [2, 5, 0, 6, 1, 7, 3, 4]);
    assert_eq!(balls.pairs(), all(&[6, 1, 7, 3, 4, 2, 5, 0]));
    for ball in [7, 1, 3] {
        balls.put(ball, 0.1, 0.0);
    }
    assert_eq!(balls.members(), [7, 1, 3, 6, 5, 0, 2, 4]);
    balls.leave(7);
    assert_eq!(balls.members(), [3, 1, 6, 5, 0, 2, 4]);
    balls.leave(4);
    assert_eq!(balls.members(), [3, 1, 6, 5, 0, 2]);
    balls.enter(4);
    assert_eq!(balls.members(), [3, 1, 4, 6, 5, 0, 2]);
    // Equal negative bounds are turned round by the sort.
    assert_eq!(balls.pairs(), all(&[4, 2, 0, 5, 6, 1, 3]));
    assert_eq!(balls.members(), [6, 5, 0, 2, 3, 1, 4]);
    balls.leave(6);
    assert_eq!(balls.members(), [4, 5, 0, 2, 3, 1]);
    assert_eq!(balls.pairs(), all(&[4, 5, 0, 2, 3, 1]));
}

#[test]
fn quadtree() {
    let kind = SpaceKind::Quadtree { center: [0.0; 2], half_sides: [4.0; 2], depth: 2 };
    let mut balls = Balls::new(kind, 6);
    assert_eq!(balls.pairs(), all(&[5, 4, 3, 2, 1, 0]));
    // What stays in its block keeps its place.
    balls.put(1, 0.1, 0.0);
    balls.put(3, 0.1, 0.0);
    assert_eq!(balls.pairs(), all(&[5, 4, 3, 2, 1, 0]));
    let small = Sphere::new(0.5).unwrap();
    balls.put(2, 2.0, 2.0);
    balls.colliders.set_shape(balls.keys[2], small).unwrap();
    assert_eq!(balls.pairs(), all(&[5, 4, 3, 1, 0]));
    balls.put(2, 0.1, 0.0);
    assert_eq!(balls.pairs(), all(&[2, 5, 4, 3, 1, 0]));
    // libode reports the ball with itself as well.
    assert_eq!(balls.pairs_with(2), [(5, 2), (4, 2), (3, 2), (1, 2), (0, 2)]);
    balls.leave(1);
    balls.enter(1);
    assert_eq!(balls.pairs(), all(&[1, 2, 5, 4, 3, 0]));
    for (ball, y) in [(4, 2.0), (0, 2.1)] {
        balls.put(ball, 2.1, y);
        balls.colliders.set_shape(balls.keys[ball], small).unwrap();
    }
    assert_eq!(balls.pairs_with(4), [(0, 4)]);
    assert_eq!(balls.pairs(), [(1, 2), (1, 5), (1, 3), (2, 5), (2, 3), (5, 3), (0, 4)]);
}

#[test]
fn spaces_that_cannot_be() {
    let quadtree = |x, half, depth| SpaceKind::Quadtree { center: [x, 0.0], half_sides: [half; 2], depth };
    let mut colliders = Colliders::new();
    for kind in [quadtree(f64::NAN, 1.0, 2), quadtree(0.0, -1.0, 2), quadtree(0.0, 1.0, 30)] {
        let error = colliders.add_space(None, kind).unwrap_err().to_string();
        assert!(error.contains("quadtree"), "{error}");
    }
    assert_eq!(AxisOrder::from_ode(24), Some(AxisOrder::XZY));
    assert_eq!(AxisOrder::from_ode(6), Some(AxisOrder::ZYX));
    assert!([-1, 0, 25, 63, 64, 88].iter().all(|&n| AxisOrder::from_ode(n).is_none()));
}

#[test]
fn cleanup_by_mode() {
    let mut c = Colliders::new();
    let outer = c.add_space(None, SpaceKind::Simple).unwrap();
    let keeping = c.add_space(Some(outer), SpaceKind::HASH).unwrap();
    let ball = Geom::new(Sphere::new(1.0).unwrap());
    let kept = c.add_geom(Some(keeping), ball.clone()).unwrap();
    let gone = c.add_geom(Some(outer), ball).unwrap();
    assert_eq!((c.cleanup(keeping), c.manual_cleanup(keeping)), (Some(true), Some(false)));
    c.set_cleanup(keeping, false).unwrap();
    c.set_manual_cleanup(keeping, true).unwrap();
    assert_eq!((c.cleanup(keeping), c.manual_cleanup(keeping)), (Some(false), Some(true)));
    assert!(c.remove_space(outer) && !c.remove_space(outer));
    assert!(c.geom(kept).is_some() && c.parent(kept).is_none());
    assert!(c.geom(gone).is_none() && !c.contains_space(keeping));
    assert!(c.set_cleanup(keeping, true).is_err());
}
