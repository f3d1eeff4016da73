//! Draws a world file as an SVG picture: `cargo run --release -p ferrode-scene --example picture -- FILE OUT.svg [SECONDS]`.
//!
//! A painter's algorithm over flat-shaded facets: enough for a still picture in a document. Far facets are painted first.

use ferrode::{Pose, Shape, Vec3, World};
use std::fmt::Write as _;

/// Where the eye is and what it looks at; an orthographic view.
struct Camera {
    right: Vec3,
    up: Vec3,
    /// Towards the eye.
    back: Vec3,
}

impl Camera {
    fn new(azimuth: f64, elevation: f64) -> Self {
        use ferrode::math::real::{cos, sin};
        let back = Vec3::new(cos(azimuth) * cos(elevation), sin(azimuth) * cos(elevation), sin(elevation));
        let right = Vec3::Z.cross(back).normalized_or(Vec3::X);
        Self { right, up: back.cross(right), back }
    }

    fn project(&self, p: Vec3) -> [f64; 2] {
        [self.right.dot(p), -self.up.dot(p)]
    }
}

/// A flat polygon of one colour.
struct Facet {
    corners: Vec<Vec3>,
    colour: [u8; 3],
}

impl Facet {
    fn normal(&self) -> Vec3 {
        let c = &self.corners;
        (c[1] - c[0]).cross(c[2] - c[0]).normalized_or(Vec3::Z)
    }

    fn centre(&self) -> Vec3 {
        self.corners.iter().fold(Vec3::ZERO, |sum, c| sum + *c) / self.corners.len() as f64
    }
}

/// Cuts quadrilaterals into pieces of at most `size`: the painter sorts small facets better than large ones.
fn cut(facets: Vec<Facet>, size: f64) -> Vec<Facet> {
    let mut out = Vec::new();
    for facet in facets {
        let [a, b, c, d] = facet.corners[..] else {
            out.push(facet);
            continue;
        };
        let pieces = |p: Vec3, q: Vec3| ((q - p).length() / size).ceil().max(1.0) as u32;
        let (m, n) = (pieces(a, b), pieces(a, d));
        let at = |i: u32, j: u32| {
            let (u, v) = (f64::from(i) / f64::from(m), f64::from(j) / f64::from(n));
            a.lerp(b, u).lerp(d.lerp(c, u), v)
        };
        for i in 0..m {
            for j in 0..n {
                let corners = vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                out.push(Facet { corners, colour: facet.colour });
            }
        }
    }
    out
}

/// A chequered floor at z = 0 under everything.
fn floor(low: Vec3, high: Vec3) -> Vec<Facet> {
    let (x0, y0) = ((low.x - 0.7).floor() as i32, (low.y - 0.7).floor() as i32);
    let (x1, y1) = ((high.x + 0.7).ceil() as i32, (high.y + 0.7).ceil() as i32);
    let tiles = (x0..x1).flat_map(|x| (y0..y1).map(move |y| (x, y)));
    tiles
        .map(|(x, y)| {
            let corner = |i: i32, j: i32| Vec3::new(f64::from(x + i), f64::from(y + j), 0.0);
            let colour = if (x + y).rem_euclid(2) == 0 { [236, 232, 224] } else { [226, 221, 211] };
            Facet { corners: vec![corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)], colour }
        })
        .collect()
}

/// A grid of quadrilaterals on a surface of revolution about local z: `profile` lists (radius, z) from bottom to top.
fn revolved(profile: &[(f64, f64)], pose: &Pose, colour: [u8; 3], out: &mut Vec<Facet>) {
    use ferrode::math::real::{cos, sin};
    const SIDES: usize = 20;
    let point = |(r, z): (f64, f64), k: usize| {
        let angle = k as f64 * core::f64::consts::TAU / SIDES as f64;
        pose.transform_point(Vec3::new(r * cos(angle), r * sin(angle), z))
    };
    for pair in profile.windows(2) {
        for k in 0..SIDES {
            let mut corners =
                vec![point(pair[0], k), point(pair[0], k + 1), point(pair[1], k + 1), point(pair[1], k)];
            corners.dedup_by(|a, b| (*a - *b).length() < 1e-12);
            if corners.len() >= 3 {
                out.push(Facet { corners, colour });
            }
        }
    }
}

/// Quarter circle from (0, −r) to (r, 0) or its mirror image, as a profile around `z`.
fn cap(r: f64, z: f64, top: bool) -> Vec<(f64, f64)> {
    use ferrode::math::real::{cos, sin};
    (0..=6)
        .map(|i| {
            let a = f64::from(i) / 6.0 * core::f64::consts::FRAC_PI_2;
            if top { (r * cos(a), z + r * sin(a)) } else { (r * sin(a), z - r * cos(a)) }
        })
        .collect()
}

fn facets(shape: &Shape, pose: &Pose, colour: [u8; 3], out: &mut Vec<Facet>) {
    match shape {
        Shape::Cuboid(b) => {
            let h = b.sides() * 0.5;
            let corner = |i: u8| {
                let s = |bit: u8| if i & bit != 0 { 1.0 } else { -1.0 };
                pose.transform_point(Vec3::new(s(1) * h.x, s(2) * h.y, s(4) * h.z))
            };
            for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
                out.push(Facet { corners: face.map(corner).to_vec(), colour });
            }
        }
        Shape::Sphere(s) => {
            let mut profile = cap(s.radius(), 0.0, false);
            profile.extend(cap(s.radius(), 0.0, true).into_iter().skip(1));
            revolved(&profile, pose, colour, out);
        }
        Shape::Capsule(c) => {
            let half = 0.5 * c.length();
            let mut profile = cap(c.radius(), -half, false);
            profile.extend(cap(c.radius(), half, true));
            revolved(&profile, pose, colour, out);
        }
        Shape::Cylinder(c) => {
            let (r, half) = (c.radius(), 0.5 * c.length());
            revolved(&[(0.0, -half), (r, -half), (r, half), (0.0, half)], pose, colour, out);
        }
        _ => {}
    }
}

/// A colour for the n-th thing: well apart, neither too light nor too dark.
fn colour_of(n: usize) -> [u8; 3] {
    const COLOURS: [[u8; 3]; 8] = [
        [214, 96, 77],
        [67, 147, 195],
        [90, 174, 97],
        [245, 184, 65],
        [153, 112, 171],
        [53, 151, 143],
        [223, 129, 157],
        [140, 140, 140],
    ];
    COLOURS[n % COLOURS.len()]
}

/// The world as an SVG picture of the given width in pixels.
fn picture(world: &World, width: f64) -> String {
    let camera = Camera::new(-1.0, 0.62);
    let mut list = Vec::new();
    for (n, info) in world.geoms().enumerate() {
        if let Ok(geom) = world.geom(info.key) {
            let colour = if info.body.is_some() { colour_of(n) } else { [188, 180, 168] };
            facets(geom.shape(), geom.pose(), colour, &mut list);
        }
    }
    let all = || list.iter().flat_map(|f: &Facet| &f.corners);
    let low = all().fold(Vec3::splat(f64::INFINITY), |low, c| low.min(*c));
    let high = all().fold(Vec3::splat(f64::NEG_INFINITY), |high, c| high.max(*c));
    let mut list = cut(list, 0.15);
    list.retain(|f| f.normal().dot(camera.back) > 0.0);
    list.sort_by(|a, b| camera.back.dot(a.centre()).total_cmp(&camera.back.dot(b.centre())));
    let list: Vec<Facet> = floor(low, high).into_iter().chain(list).collect();

    let corners = list.iter().flat_map(|f| &f.corners).map(|c| camera.project(*c));
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in corners {
        for i in 0..2 {
            low[i] = low[i].min(p[i]);
            high[i] = high[i].max(p[i]);
        }
    }
    let scale = 0.94 * width / (high[0] - low[0]).max(1e-9);
    let (mx, my) = (0.03 * width, 0.03 * width);
    let height = (high[1] - low[1]) * scale + 2.0 * my;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#f7f5f0\"/>\n"
    );
    let light = Vec3::new(0.25, -0.55, 0.8).normalized_or(Vec3::Z);
    for facet in &list {
        let shade = 0.45 + 0.55 * facet.normal().dot(light).max(0.0);
        let [r, g, b] = facet.colour.map(|c| (f64::from(c) * shade) as u8);
        let mut points = String::new();
        for c in &facet.corners {
            let [x, y] = camera.project(*c);
            let _ = write!(points, "{:.1},{:.1} ", (x - low[0]) * scale + mx, (y - low[1]) * scale + my);
        }
        let fill = format!("#{r:02x}{g:02x}{b:02x}");
        let _ = writeln!(svg, "<path d=\"M{}Z\" fill=\"{fill}\" stroke=\"{fill}\"/>", points.trim_end());
    }
    svg.push_str("</svg>\n");
    svg
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [file, out, ..] = args.as_slice() else {
        return Err("usage: picture FILE OUT.svg [SECONDS]".into());
    };
    let seconds: f64 = args.get(2).map_or(Ok(0.0), |s| s.parse())?;
    let loaded = ferrode_scene::load(file, &ferrode_scene::LoadOptions::default())?;
    let mut named = ferrode_scene::build(&loaded.scene, &ferrode_scene::BuildOptions::default())?;
    for _ in 0..(seconds / named.step_size()).round() as u64 {
        named.step()?;
    }
    std::fs::write(out, picture(&named.world, 900.0))?;
    Ok(())
}
