//! The self-tests that `dTestSolveLCP` and `dTestDataStructures` run.

use ferrode_dynamics::{Ball, World};
use ferrode_lcp::dense::{multiply2, pad};
use ferrode_lcp::{BoxedLcp, DantzigWorkspace, cholesky, ldlt, natural_residual, solve_dantzig};
use ferrode_math::random::OdeRandom;

/// Solves random boxed problems; true if each answer meets its conditions.
pub fn lcp() -> bool {
    let mut random = OdeRandom::new(1);
    (0..100).all(|_| one_lcp(&mut random, 40))
}

fn one_lcp(random: &mut OdeRandom, n: usize) -> bool {
    let stride = pad(n);
    let mut factor = vec![0.0; n * stride];
    for row in factor.chunks_mut(stride) {
        random.fill(&mut row[..n], 1.0);
    }
    let mut a = vec![0.0; n * stride];
    if multiply2(&mut a, &factor, &factor, n, n, n).is_err() {
        return false;
    }
    let mut b = vec![0.0; n];
    random.fill(&mut b, 1.0);
    let unbounded = random.next_below(10) as usize;
    let mut bound = |infinite: f64, sign: f64, i: usize| {
        if i < unbounded { infinite } else { sign * random.next_real() }
    };
    let lo: Vec<f64> = (0..n).map(|i| bound(f64::NEG_INFINITY, -1.0, i)).collect();
    let hi: Vec<f64> = (0..n).map(|i| bound(f64::INFINITY, 1.0, i)).collect();
    let findex = vec![-1; n];
    let (mut x, mut w) = (vec![0.0; n], vec![0.0; n]);
    let mut problem = BoxedLcp {
        n,
        a: &a,
        stride,
        first: None,
        b: &b,
        lo: &lo,
        hi: &hi,
        findex: &findex,
        x: &mut x,
        w: &mut w,
    };
    if solve_dantzig(&mut problem, &mut DantzigWorkspace::new()).is_err() {
        return false;
    }
    // The answer is checked by itself: w = A x - b, and each row within its bounds or held by them.
    natural_residual(&a, stride, &b, &lo, &hi, &x).is_ok_and(|residual| residual < 1e-8)
}

/// Creates, links and destroys bodies and joints in random order, checking all links; factors and updates matrices.
pub fn structures() -> bool {
    lists() && factors()
}

fn lists() -> bool {
    let mut random = OdeRandom::new(7);
    let mut world = World::new();
    let mut bodies = Vec::new();
    for _ in 0..200 {
        match random.next_below(4) {
            0 | 1 => bodies.push(world.create_body()),
            2 if bodies.len() >= 2 => {
                let Ok(joint) = world.create_joint::<Ball>(None) else { return false };
                let first = bodies[random.next_below(bodies.len() as u32) as usize];
                let second = bodies[random.next_below(bodies.len() as u32) as usize];
                let second = (first != second).then_some(second);
                if world.attach(joint, Some(first), second).is_err() {
                    return false;
                }
            }
            3 if !bodies.is_empty() => {
                let body = bodies.swap_remove(random.next_below(bodies.len() as u32) as usize);
                if world.destroy_body(body).is_err() {
                    return false;
                }
            }
            _ => {}
        }
        if world.check().is_err() {
            return false;
        }
    }
    true
}

fn factors() -> bool {
    let n = 12;
    let stride = pad(n);
    let mut random = OdeRandom::new(3);
    let mut factor = vec![0.0; n * stride];
    for row in factor.chunks_mut(stride) {
        random.fill(&mut row[..n], 1.0);
    }
    let mut a = vec![0.0; n * stride];
    let mut b = vec![0.0; n];
    random.fill(&mut b, 1.0);
    if multiply2(&mut a, &factor, &factor, n, n, n).is_err() {
        return false;
    }
    for i in 0..n {
        a[i * stride + i] += 1.0;
    }
    let (mut l, mut d) = (a.clone(), vec![0.0; n]);
    let (mut by_ldlt, mut by_cholesky) = (b.clone(), b);
    let mut c = a;
    let solved = ldlt::factor_ldlt(&mut l, &mut d, n, stride)
        .and_then(|()| ldlt::solve_ldlt(&l, &d, &mut by_ldlt, n, stride))
        .and_then(|()| cholesky::factor_cholesky(&mut c, n, stride))
        .and_then(|_| cholesky::solve_cholesky(&c, &mut by_cholesky, n, stride));
    solved.is_ok() && by_ldlt.iter().zip(&by_cholesky).all(|(x, y)| (x - y).abs() < 1e-9)
}
