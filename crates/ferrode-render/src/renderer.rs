//! Draws scenes into textures.
//!
//! One picture is: the shadow map as the sun sees it → sky → shapes, ground, lines with depths → glass from far to near → the
//! layer over all, on depths of its own. Shapes with the same mesh are drawn by one call.

use crate::instance::{INSTANCE_BYTES, Instance};
use crate::mesh::to_f32;
use crate::pipelines::{GLOBALS_BYTES, Pipelines};
use crate::scene::{Item, SHAPES};
use crate::shadow::{SunView, sun_view};
use crate::targets::{DEPTH, Targets, texture};
use crate::{Camera, Gpu, Ground, Layer, Mesh, Quality, Scene};
use ferrode_math::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Draws scenes into textures of one format.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    quality: Quality,
    format: wgpu::TextureFormat,
    pipelines: Pipelines,
    globals: wgpu::Buffer,
    globals_group: wgpu::BindGroup,
    shadow_view: wgpu::TextureView,
    shadow_group: wgpu::BindGroup,
    targets: Option<Targets>,
    instances: Dynamic,
    corners: Dynamic,
    planes: Dynamic,
    segments: Dynamic,
    meshes: BTreeMap<u64, MeshBuffers>,
    pictures: u64,
    /// Columns on the right that need not be drawn.
    pub(crate) covered: u32,
}

/// A mesh on the graphics card.
#[derive(Debug)]
struct MeshBuffers {
    corners: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    /// When it was last drawn.
    seen: u64,
}

/// Pictures after which a mesh that is not drawn any more is forgotten.
const FORGET: u64 = 600;

/// A buffer that is filled anew for each picture and grows when it must.
#[derive(Debug)]
struct Dynamic {
    buffer: wgpu::Buffer,
}

impl Dynamic {
    fn new(device: &wgpu::Device) -> Self {
        Self { buffer: vertex_buffer(device, 1 << 12) }
    }

    fn fill(&mut self, gpu: &Gpu, bytes: &[u8]) {
        let size = bytes.len() as u64;
        if size > self.buffer.size() {
            self.buffer = vertex_buffer(&gpu.device, size.next_power_of_two());
        }
        if size > 0 {
            gpu.queue.write_buffer(&self.buffer, 0, bytes);
        }
    }
}

fn vertex_buffer(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// What to draw: so many corners of a mesh or of the loose triangles, for a range of instances.
#[derive(Clone, Debug)]
enum Draw {
    Mesh { id: u64, instances: std::ops::Range<u32> },
    Loose { corners: std::ops::Range<u32>, instance: u32 },
}

/// The draws of a picture by their kind.
#[derive(Debug, Default)]
struct Draws {
    solid: Vec<Draw>,
    shadow: Vec<Draw>,
    glass: Vec<Draw>,
    over: Vec<Draw>,
}

/// The radius that edges of boxes are rounded with in fine pictures.
fn rounding(half: [f32; 3]) -> f32 {
    let least = half[0].min(half[1]).min(half[2]);
    (0.07 * least).min(0.03)
}

impl Renderer {
    /// A renderer for textures of a format; one that ends in `Srgb` shows the right brightness.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, quality: Quality) -> Self {
        let device = &gpu.device;
        let pipelines = Pipelines::new(device, format, &quality);
        let globals = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("globals"),
            size: GLOBALS_BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let globals_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globals"),
            layout: &pipelines.globals_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: globals.as_entire_binding() }],
        });
        let side = quality.shadow_map.max(1);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let shadow_view = texture(device, [side; 2], 1, DEPTH, usage).create_view(&Default::default());
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow map"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let shadow_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow map"),
            layout: &pipelines.shadow_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&shadow_view),
                },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self {
            gpu: gpu.clone(),
            quality,
            format,
            pipelines,
            globals,
            globals_group,
            shadow_view,
            shadow_group,
            targets: None,
            instances: Dynamic::new(device),
            corners: Dynamic::new(device),
            planes: Dynamic::new(device),
            segments: Dynamic::new(device),
            meshes: BTreeMap::new(),
            pictures: 0,
            covered: 0,
        }
    }

    /// The quality it draws with.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Draws a scene as a camera sees it into a texture of a size. The commands are added to `encoder`; at most one scene may be
    /// drawn by it before it is submitted.
    pub fn draw(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::TextureView,
        size: [u32; 2],
        scene: &Scene,
        camera: &Camera,
    ) {
        self.pictures += 1;
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(Targets::new(&self.gpu.device, size, &self.quality, self.format));
        }
        let sun = self.sun(scene, camera);
        let globals = globals(scene, camera, &sun, size, self.shadow_side(scene));
        self.gpu.queue.write_buffer(&self.globals, 0, bytemuck::cast_slice(&globals));
        let draws = self.upload(scene, camera);
        if self.shadow_side(scene) > 0 {
            self.draw_shadows(encoder, &draws);
        }
        self.draw_world(encoder, into, scene, &draws);
        self.meshes.retain(|_, mesh| mesh.seen + FORGET > self.pictures);
    }

    fn shadow_side(&self, scene: &Scene) -> u32 {
        if scene.light.shadow > 0.0 && scene.light.strength > 0.0 { self.quality.shadow_map } else { 0 }
    }

    fn sun(&self, scene: &Scene, camera: &Camera) -> SunView {
        let middle = camera.target - scene.origin;
        let reach = (6.0 * camera.distance()).max(5.0);
        let items = scene.items.iter().filter(|item| item.shadow && item.layer == Layer::World);
        let loose = scene.loose.iter().filter(|loose| loose.shadow).flat_map(|loose| {
            loose.vertices.iter().map(|v| {
                let p = [f64::from(v[0]), f64::from(v[1]), f64::from(v[2])];
                let row = |k: usize| {
                    let r = &loose.instance[4 * k..4 * k + 4];
                    (0..3).map(|i| f64::from(r[i]) * p[i]).sum::<f64>() + f64::from(r[3])
                };
                (Vec3::new(row(0), row(1), row(2)), 0.0)
            })
        });
        let balls = items.map(|item| item.ball).chain(loose);
        sun_view(&scene.light, balls, middle, reach, self.quality.shadow_map)
    }

    fn upload(&mut self, scene: &Scene, camera: &Camera) -> Draws {
        let eye = camera.eye - scene.origin;
        let is_glass = |item: &Item| item.instance[23] < 1.0;
        // By kind (solid with and without shadow, over, glass), then by mesh; glass by distance, the farthest first.
        let mut order: Vec<(u8, u64, usize)> = Vec::with_capacity(scene.items.len());
        for (n, item) in scene.items.iter().enumerate() {
            let far = u64::MAX - ((item.ball.0 - eye).length() * 1e4) as u64;
            order.push(match item.layer {
                Layer::Over => (3, item.mesh.id, n),
                Layer::World if is_glass(item) => (2, far, n),
                Layer::World => (u8::from(!item.shadow), item.mesh.id, n),
            });
        }
        order.sort_unstable();
        let mut draws = Draws::default();
        let mut instances: Vec<Instance> = Vec::with_capacity(order.len() + scene.loose.len());
        for (kind, _, n) in order {
            let item = &scene.items[n];
            let (mesh, instance) = self.finished(item);
            self.keep(&mesh);
            let at = instances.len() as u32;
            instances.push(instance);
            let list = match kind {
                0 | 1 => &mut draws.solid,
                2 => &mut draws.glass,
                _ => &mut draws.over,
            };
            append(list, mesh.id, at);
            if item.shadow && kind != 3 {
                append(&mut draws.shadow, mesh.id, at);
            }
        }
        let mut corners: Vec<[f32; 9]> = Vec::new();
        for loose in &scene.loose {
            let instance = instances.len() as u32;
            instances.push(loose.instance);
            let start = corners.len() as u32;
            corners.extend(&loose.vertices);
            let draw = Draw::Loose { corners: start..corners.len() as u32, instance };
            let list = if loose.instance[23] < 1.0 { &mut draws.glass } else { &mut draws.solid };
            list.push(draw.clone());
            if loose.shadow {
                draws.shadow.push(draw);
            }
        }
        let planes: Vec<[f32; 20]> =
            scene.grounds.iter().map(|ground| plane(ground, scene.origin, camera)).collect();
        let segments = [&scene.lines[..], &scene.lines_over[..]].concat();
        self.instances.fill(&self.gpu, bytemuck::cast_slice(&instances));
        self.corners.fill(&self.gpu, bytemuck::cast_slice(&corners));
        self.planes.fill(&self.gpu, bytemuck::cast_slice(&planes));
        self.segments.fill(&self.gpu, bytemuck::cast_slice(&segments));
        draws
    }

    /// The mesh and instance that are drawn for an item: fine pictures have rounded boxes.
    fn finished(&self, item: &Item) -> (Arc<Mesh>, Instance) {
        let mut instance = item.instance;
        if !(self.quality.rounded_boxes && Arc::ptr_eq(&item.mesh, &SHAPES.cuboid)) {
            return (Arc::clone(&item.mesh), instance);
        }
        let r = rounding([instance[16], instance[17], instance[18]]);
        instance[12..15].fill(r);
        instance[16..19].iter_mut().for_each(|half| *half -= r);
        (Arc::clone(&SHAPES.rounded_cuboid), instance)
    }

    /// Sees to it that a mesh is on the graphics card.
    fn keep(&mut self, mesh: &Mesh) {
        let seen = self.pictures;
        if let Some(known) = self.meshes.get_mut(&mesh.id) {
            known.seen = seen;
            return;
        }
        let corners: Vec<[f32; 9]> = mesh.vertices.iter().map(|v| v.to_array()).collect();
        let filled = |bytes: &[u8]| {
            let buffer = vertex_buffer(&self.gpu.device, (bytes.len() as u64).max(4));
            self.gpu.queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        let buffers = MeshBuffers {
            corners: filled(bytemuck::cast_slice(&corners)),
            indices: filled(bytemuck::cast_slice(&mesh.indices)),
            count: mesh.indices.len() as u32,
            seen,
        };
        self.meshes.insert(mesh.id, buffers);
    }

    fn draw_shadows(&self, encoder: &mut wgpu::CommandEncoder, draws: &Draws) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadows"),
            depth_stencil_attachment: Some(cleared(&self.shadow_view, 1.0)),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipelines.shadow);
        pass.set_bind_group(0, &self.globals_group, &[]);
        self.draw_shapes(&mut pass, &draws.shadow);
    }

    fn draw_world(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::TextureView,
        scene: &Scene,
        draws: &Draws,
    ) {
        let Some(targets) = &self.targets else { return };
        let over = !(draws.over.is_empty() && scene.lines_over.is_empty());
        let color = |load, last: bool| {
            let (view, resolve_target) = match &targets.samples {
                Some(samples) => (samples, last.then_some(into)),
                None => (into, None),
            };
            let store =
                if last && resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
            let ops = wgpu::Operations { load, store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops })
        };
        let lines = scene.lines.len() as u32;
        {
            let attachments = [color(wgpu::LoadOp::Clear(wgpu::Color::BLACK), !over)];
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("world"),
                color_attachments: &attachments,
                depth_stencil_attachment: Some(cleared(&targets.depth, 0.0)),
                ..Default::default()
            });
            self.bind(&mut pass, &self.pipelines.sky);
            pass.draw(0..3, 0..1);
            pass.set_pipeline(&self.pipelines.shapes);
            self.draw_shapes(&mut pass, &draws.solid);
            if !scene.grounds.is_empty() {
                pass.set_pipeline(&self.pipelines.ground);
                pass.set_vertex_buffer(0, self.planes.buffer.slice(..));
                pass.draw(0..4, 0..scene.grounds.len() as u32);
            }
            self.draw_lines(&mut pass, 0..lines);
            pass.set_pipeline(&self.pipelines.glass);
            self.draw_shapes(&mut pass, &draws.glass);
        }
        if over {
            let attachments = [color(wgpu::LoadOp::Load, true)];
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("over"),
                color_attachments: &attachments,
                depth_stencil_attachment: Some(cleared(&targets.depth, 0.0)),
                ..Default::default()
            });
            self.bind(&mut pass, &self.pipelines.shapes);
            self.draw_shapes(&mut pass, &draws.over);
            self.draw_lines(&mut pass, lines..lines + scene.lines_over.len() as u32);
        }
    }

    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_bind_group(0, &self.globals_group, &[]);
        pass.set_bind_group(1, &self.shadow_group, &[]);
        pass.set_pipeline(pipeline);
        if let Some(Targets { size: [width, height], .. }) = self.targets {
            pass.set_scissor_rect(0, 0, width.saturating_sub(self.covered).max(1), height);
        }
    }

    fn draw_lines(&self, pass: &mut wgpu::RenderPass<'_>, lines: std::ops::Range<u32>) {
        if !lines.is_empty() {
            pass.set_pipeline(&self.pipelines.lines);
            pass.set_vertex_buffer(0, self.segments.buffer.slice(..));
            pass.draw(0..4, lines);
        }
    }

    fn draw_shapes(&self, pass: &mut wgpu::RenderPass<'_>, draws: &[Draw]) {
        for draw in draws {
            match draw {
                Draw::Mesh { id, instances } => {
                    let Some(mesh) = self.meshes.get(id) else { continue };
                    pass.set_vertex_buffer(0, mesh.corners.slice(..));
                    pass.set_vertex_buffer(1, self.instances.buffer.slice(..));
                    pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..mesh.count, 0, instances.clone());
                }
                Draw::Loose { corners, instance } => {
                    pass.set_vertex_buffer(0, self.corners.buffer.slice(..));
                    pass.set_vertex_buffer(1, self.instances.buffer.slice(..));
                    pass.draw(corners.clone(), *instance..*instance + 1);
                }
            }
        }
    }
}

const _: () = assert!(std::mem::size_of::<Instance>() as u64 == INSTANCE_BYTES);

fn cleared(view: &wgpu::TextureView, depth: f32) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

/// Adds an instance to the last draw if that has the same mesh and ends there, else a new draw.
fn append(list: &mut Vec<Draw>, mesh: u64, at: u32) {
    if let Some(Draw::Mesh { id, instances }) = list.last_mut()
        && *id == mesh
        && instances.end == at
    {
        instances.end += 1;
        return;
    }
    list.push(Draw::Mesh { id: mesh, instances: at..at + 1 });
}

/// The shader's `Globals`.
fn globals(scene: &Scene, camera: &Camera, sun: &SunView, size: [u32; 2], shadow_side: u32) -> [f32; 64] {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let tall = ferrode_math::real::tan(0.5 * camera.field_of_view);
    let axes = camera.axes();
    let four = |v: Vec3, w: f64| {
        let [x, y, z] = to_f32(v);
        [x, y, z, w as f32]
    };
    let tint = |color: crate::Color, w: f32| {
        let [r, g, b, _] = color.linear();
        [r, g, b, w]
    };
    let fade = (7.0 * camera.distance()).max(8.0);
    let vectors: [[f32; 4]; 16] = {
        let c = camera.clip_matrix(scene.origin, aspect);
        let s = sun.clip;
        [
            c[0],
            c[1],
            c[2],
            c[3],
            s[0],
            s[1],
            s[2],
            s[3],
            four(camera.eye - scene.origin, camera.near()),
            four(sun.direction, f64::from(scene.light.strength)),
            tint(scene.sky.zenith, scene.light.shadow),
            tint(scene.sky.horizon, fade as f32),
            four(axes.right * (tall * aspect), f64::from(scene.sky.clouds.clamp(0.0, 1.0))),
            four(axes.up * tall, 0.0),
            four(axes.forward, 0.0),
            [size[0] as f32, size[1] as f32, shadow_side as f32, sun.texel as f32],
        ]
    };
    core::array::from_fn(|n| vectors[n / 4][n % 4])
}

/// Patterns on a ground look the same so much further, m (`PERIOD` in the shader).
const PATTERN_PERIOD: f64 = 64.0;

/// A ground as the shader wants it.
fn plane(ground: &Ground, origin: Vec3, camera: &Camera) -> [f32; 20] {
    let normal = ground.normal.normalized_or(Vec3::Z);
    let aside = if normal.x.abs() < 0.9 { Vec3::X } else { Vec3::Y };
    let first = (aside - normal * aside.dot(normal)).normalized_or(Vec3::X);
    let second = normal.cross(first);
    let middle = camera.target - normal * (camera.target - ground.point).dot(normal);
    // The grid counts from the crossing nearest to the middle, of those at whole tens of steps from the given point: single
    // precision is enough there.
    let (grid, tens) = match ground.pattern {
        crate::Pattern::Plain => (ground.grid, ground.grid * 10.0),
        _ => (0.0, PATTERN_PERIOD),
    };
    let snap = |axis: Vec3| {
        let along = (middle - ground.point).dot(axis);
        if tens > 0.0 { (along / tens).round() * tens } else { along }
    };
    let point = ground.point + first * snap(first) + second * snap(second);
    let reach = (60.0 * camera.distance()).max(60.0);
    let mut out = [0.0; 20];
    let parts = [(point - origin, grid), (first, reach), (second, 0.0)];
    for (n, (v, w)) in parts.into_iter().enumerate() {
        out[4 * n..4 * n + 3].copy_from_slice(&to_f32(v));
        out[4 * n + 3] = w as f32;
    }
    out[12..16].copy_from_slice(&ground.color.linear());
    out[16..19].copy_from_slice(&to_f32(middle - origin));
    out[19] = f32::from(ground.pattern as u8);
    out
}
