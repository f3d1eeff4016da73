// Light, shadow, ground, sky and lines. Positions are relative to the scene's origin.

struct Globals {
    clip: mat4x4f,          // to the camera's clip space
    sun_clip: mat4x4f,      // to the shadow map
    eye: vec4f,             // w: near plane
    sun: vec4f,             // unit vector towards the sun; w: strength
    zenith: vec4f,          // w: how dark shadows are
    horizon: vec4f,         // w: where the ground begins to fade, m from the eye
    right: vec4f,           // camera axes, scaled to the edges of the picture; w: how much of the sky clouds hide
    up: vec4f,
    forward: vec4f,
    screen: vec4f,          // width and height in pixels; z: texels of the shadow map a side (0: none); w: metres a texel
};

@group(0) @binding(0) var<uniform> globals: Globals;
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

override shadow_samples: u32 = 4u;
// Which patterns are drawn: none (0), those without noise (1), all (2). A processor computes all branches for all pixels.
override patterns: u32 = 2u;
// Whether there are clouds in the sky.
override clouded: bool = true;

// ---------------------------------------------------------------- shapes

struct Shape {
    @location(0) local: vec3f,
    @location(1) core: vec3f,
    @location(2) normal: vec3f,
    @location(3) row0: vec4f,
    @location(4) row1: vec4f,
    @location(5) row2: vec4f,
    @location(6) radii: vec4f,   // w: pattern
    @location(7) half: vec4f,    // w: flags
    @location(8) color: vec4f,
};

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) normal: vec3f,
    @location(2) local: vec3f,
    @location(3) @interpolate(flat) color: vec4f,
    @location(4) @interpolate(flat) kind: vec2f,   // pattern, flags
    @location(5) own: vec3f,                       // normal in the shape's own coordinates
};

fn placed(s: Shape) -> vec3f {
    let p = s.local * s.radii.xyz + s.core * s.half.xyz;
    return vec3f(dot(s.row0.xyz, p) + s.row0.w, dot(s.row1.xyz, p) + s.row1.w, dot(s.row2.xyz, p) + s.row2.w);
}

@vertex
fn shape_vertex(s: Shape) -> Surface {
    var out: Surface;
    out.place = placed(s);
    let n = s.normal / max(abs(s.radii.xyz), vec3f(1e-9)) * sign(s.radii.xyz);
    out.normal = vec3f(dot(s.row0.xyz, n), dot(s.row1.xyz, n), dot(s.row2.xyz, n));
    out.local = s.local * s.radii.xyz + s.core * s.half.xyz;
    out.clip = globals.clip * vec4f(out.place, 1.0);
    out.color = s.color;
    out.kind = vec2f(s.radii.w, s.half.w);
    out.own = n;
    return out;
}

@vertex
fn shadow_vertex(s: Shape) -> @builtin(position) vec4f {
    return globals.sun_clip * vec4f(placed(s), 1.0);
}

// Patterns on a ground repeat themselves after so many metres; lattices of noise have a whole number of fields in it.
const PERIOD: f32 = 64.0;

// A number from 0 to 1 for a corner of a lattice (Jarzynski and Olano, "Hash functions for GPU rendering", JCGT 9(3), 2020:
// the generator "pcg", applied to each coordinate in turn).
fn scrambled(n: u32) -> u32 {
    let state = n * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn corner(cell: vec2f, fields: f32) -> f32 {
    let turn = cell - fields * floor(cell / fields);
    return f32(scrambled(u32(turn.x) + scrambled(u32(turn.y))) >> 8u) / 16777216.0;
}

// Smooth noise with a mean of 0.5; `fields` a period.
fn noise(p: vec2f, fields: f32) -> f32 {
    let at = p * (fields / PERIOD);
    let cell = floor(at);
    let part = at - cell;
    let s = part * part * (3.0 - 2.0 * part);
    let low = mix(corner(cell, fields), corner(cell + vec2f(1.0, 0.0), fields), s.x);
    let high = mix(corner(cell + vec2f(0.0, 1.0), fields), corner(cell + vec2f(1.0, 1.0), fields), s.x);
    return mix(low, high, s.y);
}

// Several noises, finer and fainter; those finer than some pixels (of `pixel` m) are left out before they flicker.
fn layered(p: vec2f, first: f32, count: u32, pixel: f32) -> f32 {
    var sum = 0.5;
    var strength = 0.5;
    var fields = first;
    for (var i = 0u; i < count; i++) {
        let seen = clamp(PERIOD / fields / max(pixel, 1e-6) * 0.5 - 0.5, 0.0, 1.0);
        sum += strength * seen * (noise(p, fields) - 0.5);
        strength *= 0.6;
        fields *= 2.0;
    }
    return clamp(sum, 0.0, 1.0);
}

fn earthen(color: vec3f, p: vec2f, pixel: f32) -> vec3f {
    let blotches = smoothstep(0.3, 0.7, layered(p, 32.0, 4u, pixel));
    let grains = layered(p + vec2f(17.3, 5.1), 1024.0, 3u, pixel);
    let tint = mix(vec3f(0.62, 0.60, 0.42), vec3f(0.60, 0.68, 0.44), blotches);
    return color * tint * (0.72 + 0.5 * grains);
}

fn cloudy(p: vec2f, pixel: f32) -> f32 {
    return smoothstep(0.45, 0.78, layered(p, 16.0, 5u, pixel));
}

// A shape's pattern by the two coordinates that its surface runs along most.
fn unrolled(p: vec3f, normal: vec3f) -> vec2f {
    let n = abs(normal);
    if n.z >= n.x && n.z >= n.y {
        return p.xy;
    }
    return select(p.xz, p.yz, n.x > n.y);
}

fn patterned(color: vec3f, pattern: f32, p: vec3f, normal: vec3f) -> vec3f {
    if patterns == 0u || pattern < 0.5 {
        return color;
    }
    if patterns > 1u && pattern > 4.5 {
        return mix(color * vec3f(0.55, 0.72, 0.95), color, cloudy(unrolled(p, normal) * 4.0, 0.0));
    }
    if patterns > 1u && pattern > 3.5 {
        return earthen(color, unrolled(p, normal) * 2.0, 0.0);
    }
    if pattern < 1.5 {
        let field = floor(p * 4.0 + vec3f(1e-3));
        let odd = fract((field.x + field.y + field.z) * 0.5) * 2.0;
        return color * mix(1.0, 0.62, odd);
    }
    if pattern < 2.5 {
        let ring = length(p.yz * vec2f(1.0, 0.8) + 0.03 * vec2f(sin(p.x * 3.1), cos(p.x * 2.3)));
        let grain = 0.5 + 0.5 * sin(ring * 90.0 + 2.0 * sin(p.x * 5.0 + ring * 14.0));
        return color * mix(vec3f(0.78, 0.68, 0.55), vec3f(1.0, 0.93, 0.82), grain);
    }
    let side = select(vec3f(-1.0), vec3f(1.0), p >= vec3f(0.0));
    return color * mix(0.7, 1.0, 0.5 + 0.5 * side.x * side.y * side.z);
}

// How much of the sun reaches a point: a disc of comparisons, turned from pixel to pixel so that few look like many.
fn sunlight(place: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let size = globals.screen.z;
    if size == 0.0 {
        return 1.0;
    }
    let facing = dot(normal, globals.sun.xyz);
    let slope = sqrt(max(0.0, 1.0 - facing * facing));
    let lifted = place + normal * globals.screen.w * (1.0 + 2.5 * slope);
    let clip = globals.sun_clip * vec4f(lifted, 1.0);
    let at = clip.xy * vec2f(0.5, -0.5) + 0.5;
    if any(at < vec2f(0.0)) || any(at > vec2f(1.0)) || clip.z < 0.0 {
        return 1.0;
    }
    // What is beyond all that throws shadows can still be hit by them.
    let depth = min(clip.z, 1.0);
    let turn = 6.2831853 * fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
    let reach = select(1.2, 2.8, shadow_samples > 8u) / size;
    var light = 0.0;
    var along = vec2f(cos(turn), sin(turn));
    for (var i = 0u; i < shadow_samples; i++) {
        let offset = along * (reach * sqrt((f32(i) + 0.5) / f32(shadow_samples)));
        light += textureSampleCompareLevel(shadow_map, shadow_sampler, at + offset, depth);
        // On by the golden angle, 2.3999632.
        along = vec2f(-0.7373688 * along.x - 0.6754903 * along.y, 0.6754903 * along.x - 0.7373688 * along.y);
    }
    return mix(1.0, light / f32(shadow_samples), globals.zenith.w);
}

// From light without limit to what a screen can show: bright parts are pressed together, colours stay (Narkowicz, "ACES
// filmic tone mapping curve", 2015).
fn filmic(x: vec3f) -> vec3f {
    return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), vec3f(0.0), vec3f(1.0));
}

fn ambient(normal: vec3f) -> vec3f {
    let bounce = vec3f(0.34, 0.32, 0.30);
    return mix(bounce, mix(globals.zenith.rgb, globals.horizon.rgb, 0.5), 0.5 + 0.5 * normal.z) * 0.62;
}

const WARM: vec3f = vec3f(1.18, 1.121, 1.0266);
const EXPOSURE: f32 = 0.78;

fn sun_on(place: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let facing = dot(normal, globals.sun.xyz);
    if facing <= 0.0 {
        return 0.0;
    }
    return facing * sunlight(place, normal, pixel) * globals.sun.w;
}

// Dull surfaces.
fn matt(color: vec3f, place: vec3f, normal: vec3f, pixel: vec2f) -> vec3f {
    return filmic(color * (ambient(normal) + WARM * sun_on(place, normal, pixel)) * EXPOSURE);
}

// Surfaces with a highlight (Blinn, "Models of light reflection", 1977) and a rim of sky.
fn glossy(color: vec3f, place: vec3f, normal: vec3f, pixel: vec2f) -> vec3f {
    let view = normalize(globals.eye.xyz - place);
    let sun = sun_on(place, normal, pixel);
    let middle = normalize(view + globals.sun.xyz);
    let shine = pow(max(dot(normal, middle), 0.0), 48.0) * sun * 0.22;
    let away = 1.0 - max(dot(normal, view), 0.0);
    let rim = away * away * away * away * 0.10;
    let light = color * (ambient(normal) + WARM * sun) + vec3f(shine) + globals.horizon.rgb * rim;
    return filmic(light * EXPOSURE);
}

@fragment
fn shape_fragment(s: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let color = patterned(s.color.rgb, s.kind.x, s.local, s.own);
    if s.kind.y > 0.5 {
        return vec4f(color, s.color.a);
    }
    var normal = normalize(s.normal);
    // Loose triangles and open meshes are seen from both sides.
    if !front {
        normal = -normal;
    }
    return vec4f(glossy(color, s.place, normal, s.clip.xy), s.color.a);
}

// ---------------------------------------------------------------- sky

struct Backdrop {
    @builtin(position) clip: vec4f,
    @location(0) along: vec3f,
};

fn sky(along: vec3f) -> vec3f {
    let height = clamp(along.z, 0.0, 1.0);
    let low = 1.0 - height;
    let clear = mix(globals.horizon.rgb, globals.zenith.rgb, 1.0 - low * low);
    if !clouded {
        return clear;
    }
    if globals.right.w <= 0.0 || along.z < 0.01 {
        return clear;
    }
    // Clouds lie on a plane overhead, and melt into the horizon.
    let p = along.xy / along.z * 6.0;
    let clouds = cloudy(p, 12.0 * length(globals.up.xyz) / (globals.screen.y * along.z * along.z));
    return mix(clear, vec3f(0.93), globals.right.w * clouds * smoothstep(0.02, 0.25, along.z));
}

@vertex
fn sky_vertex(@builtin(vertex_index) n: u32) -> Backdrop {
    let corner = vec2f(f32(n & 1u) * 4.0 - 1.0, f32(n >> 1u) * 4.0 - 1.0);
    var out: Backdrop;
    out.clip = vec4f(corner, 0.0, 1.0);
    out.along = globals.forward.xyz + globals.right.xyz * corner.x + globals.up.xyz * corner.y;
    return out;
}

@fragment
fn sky_fragment(s: Backdrop) -> @location(0) vec4f {
    return vec4f(sky(normalize(s.along)), 1.0);
}

// ---------------------------------------------------------------- ground

struct Plane {
    @location(0) point: vec4f,    // a point of it; w: distance of grid lines, 0 for none
    @location(1) first: vec4f,    // unit vectors along it; w: how far it is drawn
    @location(2) second: vec4f,
    @location(3) color: vec4f,
    @location(4) middle: vec4f,   // the point of it that is nearest to the target; w: pattern
};

struct Floor {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) grid: vec2f,
    @location(2) @interpolate(flat) color: vec4f,
    @location(3) @interpolate(flat) normal: vec3f,
    @location(4) @interpolate(flat) step: vec3f,   // distance of grid lines, how far it is drawn, pattern
};

fn floor_corner(n: u32, plane: Plane) -> Floor {
    let corner = (vec2f(f32(n & 1u), f32(n >> 1u)) * 2.0 - 1.0) * plane.first.w;
    var out: Floor;
    out.place = plane.middle.xyz + plane.first.xyz * corner.x + plane.second.xyz * corner.y;
    let offset = out.place - plane.point.xyz;
    out.grid = vec2f(dot(offset, plane.first.xyz), dot(offset, plane.second.xyz));
    out.clip = globals.clip * vec4f(out.place, 1.0);
    out.color = plane.color;
    out.normal = cross(plane.first.xyz, plane.second.xyz);
    out.step = vec3f(plane.point.w, plane.first.w, plane.middle.w);
    return out;
}

@vertex
fn ground_vertex(@builtin(vertex_index) n: u32, plane: Plane) -> Floor {
    return floor_corner(n, plane);
}

// How much of a pixel lines cover that are `step` apart and some pixels wide.
fn ruled(at: vec2f, step: f32, width: f32) -> f32 {
    let scaled = at / step;
    let pixel = max(fwidth(scaled), vec2f(1e-6));
    let away = abs(fract(scaled - 0.5) - 0.5) / pixel;
    let line = clamp(vec2f(0.5 * width + 0.5) - away, vec2f(0.0), vec2f(1.0));
    // Lines that are closer than some pixels melt into a tint.
    let clear = clamp(vec2f(1.0) - pixel * 2.0, vec2f(0.0), vec2f(1.0));
    let seen = line * clear;
    return max(seen.x, seen.y);
}

@fragment
fn ground_fragment(s: Floor) -> @location(0) vec4f {
    var normal = s.normal;
    let below = dot(normal, globals.eye.xyz - s.place) < 0.0;
    var color = s.color.rgb;
    let footprint = max(length(fwidth(s.grid)), 1e-6);
    if patterns > 1u && s.step.z > 4.5 {
        color *= mix(vec3f(0.55, 0.72, 0.95), vec3f(1.0), cloudy(s.grid, footprint));
    } else if patterns > 1u && s.step.z > 3.5 {
        color = earthen(color, s.grid, footprint);
    } else if patterns > 0u && s.step.z > 0.5 {
        color = patterned(color, s.step.z, vec3f(s.grid, 0.0), vec3f(0.0, 0.0, 1.0));
    }
    if s.step.x > 0.0 {
        let fine = ruled(s.grid, s.step.x, 1.0);
        let strong = ruled(s.grid, s.step.x * 10.0, 1.6);
        color = mix(color, color * 0.55, max(fine * 0.42, strong * 0.8));
    }
    if below {
        normal = -normal;
    }
    let lit = matt(color, s.place, normal, s.clip.xy);
    let away = distance(s.place, globals.eye.xyz);
    let haze = max(away - globals.horizon.w, 0.0) / (globals.horizon.w * 4.0);
    let fade = haze / (haze + 1.2);
    let edge = smoothstep(0.7, 1.0, away / s.step.y);
    let far = sky((s.place - globals.eye.xyz) / away);
    // From below, a ground is a veil that shows what stands on it.
    let alpha = select(s.color.a, 0.35, below);
    return vec4f(mix(lit, far, max(fade, edge)), alpha);
}

// ---------------------------------------------------------------- plain shapes and grounds, for processors

// Light is computed at the corners; what is left for each pixel is whether the sun reaches it.

// Where the shadow map is asked about a point: its texture coordinates and depth.
fn shadow_place(place: vec3f, normal: vec3f, facing: f32) -> vec3f {
    let slope = sqrt(max(0.0, 1.0 - facing * facing));
    let lifted = place + normal * globals.screen.w * (1.0 + 2.5 * slope);
    let clip = globals.sun_clip * vec4f(lifted, 1.0);
    return vec3f(clip.xy * vec2f(0.5, -0.5) + 0.5, clip.z);
}

// As `sunlight`, by one sample, which compares with four texels.
fn sun_at(at: vec3f) -> f32 {
    let outside = any(at.xy < vec2f(0.0)) || any(at.xy > vec2f(1.0)) || at.z < 0.0 || globals.screen.z == 0.0;
    let seen = textureSampleCompareLevel(shadow_map, shadow_sampler, at.xy, min(at.z, 1.0));
    return select(mix(1.0, seen, globals.zenith.w), 1.0, outside);
}

struct Solid {
    @builtin(position) clip: vec4f,
    @location(0) dark: vec3f,
    @location(1) lit: vec3f,
    @location(2) sun: vec3f,
    @location(3) local: vec3f,
    @location(4) own: vec3f,
    @location(5) @interpolate(flat) kind: vec2f,   // pattern, opacity
};

@vertex
fn solid_vertex(s: Shape) -> Solid {
    var out: Solid;
    let place = placed(s);
    let n = s.normal / max(abs(s.radii.xyz), vec3f(1e-9)) * sign(s.radii.xyz);
    let normal = normalize(vec3f(dot(s.row0.xyz, n), dot(s.row1.xyz, n), dot(s.row2.xyz, n)));
    let facing = dot(normal, globals.sun.xyz);
    out.clip = globals.clip * vec4f(place, 1.0);
    out.dark = filmic(s.color.rgb * ambient(normal) * EXPOSURE);
    out.lit = filmic(s.color.rgb * (ambient(normal) + WARM * max(facing, 0.0) * globals.sun.w) * EXPOSURE);
    if s.half.w > 0.5 {
        out.dark = s.color.rgb;
        out.lit = s.color.rgb;
    }
    out.sun = shadow_place(place, normal, facing);
    out.local = s.local * s.radii.xyz + s.core * s.half.xyz;
    out.own = n;
    out.kind = vec2f(s.radii.w, s.color.a);
    return out;
}

@fragment
fn solid_fragment(s: Solid) -> @location(0) vec4f {
    var color = mix(s.dark, s.lit, sun_at(s.sun));
    if patterns > 0u {
        color *= patterned(vec3f(1.0), s.kind.x, s.local, s.own);
    }
    return vec4f(color, s.kind.y);
}

struct PlainFloor {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,                     // relative to the eye
    @location(1) grid: vec2f,
    @location(2) sun: vec3f,
    @location(3) @interpolate(flat) dark: vec3f,
    @location(4) @interpolate(flat) lit: vec3f,
    @location(5) @interpolate(flat) step: vec3f,
};

@vertex
fn floor_vertex(@builtin(vertex_index) n: u32, plane: Plane) -> PlainFloor {
    let full = floor_corner(n, plane);
    let facing = dot(full.normal, globals.sun.xyz);
    var out: PlainFloor;
    out.clip = full.clip;
    out.place = full.place - globals.eye.xyz;
    out.grid = full.grid;
    out.sun = shadow_place(full.place, full.normal, facing);
    out.dark = filmic(full.color.rgb * ambient(full.normal) * EXPOSURE);
    let light = ambient(full.normal) + WARM * max(facing, 0.0) * globals.sun.w;
    out.lit = filmic(full.color.rgb * light * EXPOSURE);
    out.step = full.step;
    return out;
}

@fragment
fn floor_fragment(s: PlainFloor) -> @location(0) vec4f {
    var color = mix(s.dark, s.lit, sun_at(s.sun));
    if patterns > 0u {
        let footprint = max(length(fwidth(s.grid)), 1e-6);
        if patterns > 1u && s.step.z > 4.5 {
            color *= mix(vec3f(0.55, 0.72, 0.95), vec3f(1.0), cloudy(s.grid, footprint));
        } else if patterns > 1u && s.step.z > 3.5 {
            color = earthen(color, s.grid, footprint);
        } else {
            color = patterned(color, s.step.z, vec3f(s.grid, 0.0), vec3f(0.0, 0.0, 1.0));
        }
    }
    if s.step.x > 0.0 {
        let fine = ruled(s.grid, s.step.x, 1.0);
        let strong = ruled(s.grid, s.step.x * 10.0, 1.6);
        color *= 1.0 - 0.30 * max(fine * 0.42, strong * 0.8);
    }
    let away = length(s.place);
    let haze = max(away - globals.horizon.w, 0.0) / (globals.horizon.w * 4.0);
    let edge = clamp(away / s.step.y * 3.33 - 2.33, 0.0, 1.0);
    var far = globals.horizon.rgb;
    if clouded {
        far = sky(s.place / away);
    }
    return vec4f(mix(color, far, max(haze / (haze + 1.2), edge)), 1.0);
}

// ---------------------------------------------------------------- lines

struct Segment {
    @location(0) from_: vec4f,   // w: width in pixels
    @location(1) to_: vec4f,
    @location(2) color: vec4f,
};

struct Stroke {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) color: vec4f,
};

@vertex
fn line_vertex(@builtin(vertex_index) n: u32, s: Segment) -> Stroke {
    var a = globals.clip * vec4f(s.from_.xyz, 1.0);
    var b = globals.clip * vec4f(s.to_.xyz, 1.0);
    let near = globals.eye.w;
    var out: Stroke;
    out.color = s.color;
    if a.w < near && b.w < near {
        out.clip = vec4f(2.0, 2.0, 2.0, 1.0);
        return out;
    }
    if a.w < near {
        a = mix(a, b, (near - a.w) / (b.w - a.w));
    } else if b.w < near {
        b = mix(b, a, (near - b.w) / (a.w - b.w));
    }
    let along = (b.xy / b.w - a.xy / a.w) * globals.screen.xy;
    let unit = along / max(length(along), 1e-6);
    let across = vec2f(-unit.y, unit.x) * select(-1.0, 1.0, (n & 1u) == 0u);
    let start = n < 2u;
    let end = select(b, a, start);
    let beyond = unit * select(0.5, -0.5, start);
    let shift = (across + beyond) * s.from_.w / globals.screen.xy;
    // A hair nearer than the surfaces that lines are drawn on.
    out.clip = vec4f(end.xy + shift * end.w, end.z * 1.0005, end.w);
    return out;
}

@fragment
fn line_fragment(s: Stroke) -> @location(0) vec4f {
    return s.color;
}
