//! Draws scenes into textures.
//!
//! One picture is: the shadow map as the sun sees it, if it changed → shapes, ground → sky where nothing is → lines with depths →
//! glass from far to near → the layer over all, on depths of its own. Shapes with the same mesh are drawn by one call, shapes
//! beside the picture not at all.

use crate::draws::{Draw, Draws, GLASS, OVER, SHADOW_ONLY, Shadowed, append, backdrop_looks};
use crate::instance::{INSTANCE_BYTES, Instance};
use crate::pipelines::{GLOBALS_BYTES, Kind, Look, Pipelines, pattern_level};
use crate::scene::{Item, SHAPES};
use crate::shadow::{SunView, sun_view};
use crate::targets::{DEPTH, Targets, texture};
use crate::uniforms::{globals, plane};
use crate::view_cone::ViewCone;
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
    /// What the shadow map was drawn from.
    shadowed: Option<Shadowed>,
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

/// Round shapes of a smaller radius, in pixels, need fewer corners.
const SMALL: f64 = 40.0;

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
            shadowed: None,
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
        let draws = self.upload(scene, camera, size);
        self.prepare(scene, &draws);
        if self.shadow_side(scene) > 0 {
            self.draw_shadows(encoder, &draws, &sun);
        }
        self.draw_world(encoder, into, (scene, camera), &draws);
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

    fn upload(&mut self, scene: &Scene, camera: &Camera, size: [u32; 2]) -> Draws {
        let eye = camera.eye - scene.origin;
        let view = ViewCone::new(camera, scene, size);
        let is_glass = |item: &Item| item.instance[23] < 1.0;
        // By kind (solid with and without shadow, over, glass), then by mesh; glass by distance, the farthest first.
        let mut order: Vec<(u8, u64, usize)> = Vec::with_capacity(scene.items.len());
        let mut finished: Vec<(Arc<Mesh>, Instance)> = Vec::with_capacity(scene.items.len());
        for (n, item) in scene.items.iter().enumerate() {
            finished.push(self.finished(item, view.pixels(item.ball)));
            let (seen, shadow) = (view.holds(item.ball), item.shadow && item.layer == Layer::World);
            if !(seen || shadow) {
                continue;
            }
            let far = u64::MAX - ((item.ball.0 - eye).length() * 1e4) as u64;
            let mesh = finished[n].0.id;
            order.push(match item.layer {
                _ if !seen => (SHADOW_ONLY, mesh, n),
                Layer::Over => (OVER, mesh, n),
                Layer::World if is_glass(item) => (GLASS, far, n),
                Layer::World => (u8::from(!item.shadow), mesh, n),
            });
        }
        order.sort_unstable();
        let mut draws = Draws::default();
        let mut instances: Vec<Instance> = Vec::with_capacity(order.len() + scene.loose.len());
        for (kind, _, n) in order {
            let (mesh, instance) = &finished[n];
            self.keep(mesh);
            let at = instances.len() as u32;
            instances.push(*instance);
            let look = Look {
                kind: match kind {
                    _ if is_glass(&scene.items[n]) && kind != OVER => Kind::Glass,
                    _ if mesh.closed => Kind::Closed,
                    _ => Kind::Open,
                },
                patterns: pattern_level(instance[15]),
                clouds: false,
            };
            match kind {
                SHADOW_ONLY => {}
                GLASS => append(&mut draws.glass, look, mesh.id, at),
                OVER => append(&mut draws.over, look, mesh.id, at),
                _ => append(&mut draws.solid, look, mesh.id, at),
            }
            if scene.items[n].shadow && kind != OVER {
                draws.casters.push((mesh.id, *instance));
                let outside = Look { kind: if mesh.closed { Kind::Closed } else { Kind::Open }, ..look };
                append(&mut draws.shadow, outside, mesh.id, at);
            }
        }
        let mut corners: Vec<[f32; 9]> = Vec::new();
        for loose in &scene.loose {
            let instance = instances.len() as u32;
            instances.push(loose.instance);
            let start = corners.len() as u32;
            corners.extend(&loose.vertices);
            let kind = if loose.instance[23] < 1.0 { Kind::Glass } else { Kind::Open };
            let look = Look { kind, patterns: pattern_level(loose.instance[15]), clouds: false };
            let draw = Draw::Loose { look, corners: start..corners.len() as u32, instance };
            let list = if loose.instance[23] < 1.0 { &mut draws.glass } else { &mut draws.solid };
            list.push(draw.clone());
            if loose.shadow {
                draws.loose_casters = true;
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

    /// The mesh and instance that are drawn for an item of a radius in pixels: fine pictures have rounded boxes.
    fn finished(&self, item: &Item, pixels: f64) -> (Arc<Mesh>, Instance) {
        let mut instance = item.instance;
        if self.quality.plain
            && pixels < SMALL
            && let Some(coarse) = SHAPES.coarse(&item.mesh)
        {
            return (Arc::clone(coarse), instance);
        }
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

    fn draw_shadows(&mut self, encoder: &mut wgpu::CommandEncoder, draws: &Draws, sun: &SunView) {
        let casters = (sun.clip, draws.casters.clone());
        if !draws.loose_casters && self.shadowed.as_ref() == Some(&casters) {
            return;
        }
        self.shadowed = Some(casters);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadows"),
            depth_stencil_attachment: Some(cleared(&self.shadow_view, 1.0)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.globals_group, &[]);
        self.draw_shapes(&mut pass, &draws.shadow, true);
    }

    fn draw_world(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::TextureView,
        (scene, camera): (&Scene, &Camera),
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
            self.bind(&mut pass);
            self.draw_shapes(&mut pass, &draws.solid, false);
            let [ground, sky, _] = backdrop_looks(scene);
            let grounds = 0..scene.grounds.len() as u32;
            let veiled = !grounds.is_empty() && scene.grounds.iter().any(|ground| is_veil(ground, camera));
            if !grounds.is_empty() && !veiled {
                self.use_program(&mut pass, ground);
                pass.set_vertex_buffer(0, self.planes.buffer.slice(..));
                pass.draw(0..4, grounds.clone());
            }
            self.use_program(&mut pass, sky);
            pass.draw(0..3, 0..1);
            if veiled {
                self.use_program(&mut pass, Look { kind: Kind::Veil, ..ground });
                pass.set_vertex_buffer(0, self.planes.buffer.slice(..));
                pass.draw(0..4, grounds);
            }
            self.draw_lines(&mut pass, 0..lines);
            self.draw_shapes(&mut pass, &draws.glass, false);
        }
        if over {
            let attachments = [color(wgpu::LoadOp::Load, true)];
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("over"),
                color_attachments: &attachments,
                depth_stencil_attachment: Some(cleared(&targets.depth, 0.0)),
                ..Default::default()
            });
            self.bind(&mut pass);
            self.draw_shapes(&mut pass, &draws.over, false);
            self.draw_lines(&mut pass, lines..lines + scene.lines_over.len() as u32);
        }
    }

    fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(0, &self.globals_group, &[]);
        pass.set_bind_group(1, &self.shadow_group, &[]);
        if let Some(Targets { size: [width, height], .. }) = self.targets {
            pass.set_scissor_rect(0, 0, width.saturating_sub(self.covered).max(1), height);
        }
    }

    fn draw_lines(&self, pass: &mut wgpu::RenderPass<'_>, lines: std::ops::Range<u32>) {
        if !lines.is_empty() {
            let look = Look { kind: Kind::Lines, patterns: 0, clouds: false };
            self.use_program(pass, look);
            pass.set_vertex_buffer(0, self.segments.buffer.slice(..));
            pass.draw(0..4, lines);
        }
    }

    /// Draws shapes by the programs that their looks need, or their shadows.
    fn draw_shapes(&self, pass: &mut wgpu::RenderPass<'_>, draws: &[Draw], shadows: bool) {
        let mut current = None;
        for draw in draws {
            let (Draw::Mesh { look, .. } | Draw::Loose { look, .. }) = *draw;
            if current != Some(look) {
                current = Some(look);
                let programs = &self.pipelines;
                match (shadows, look.kind) {
                    (true, Kind::Closed) => pass.set_pipeline(&programs.shadow_closed),
                    (true, _) => pass.set_pipeline(&programs.shadow_open),
                    (false, _) => self.use_program(pass, look),
                }
            }
            match draw {
                Draw::Mesh { id, instances, .. } => {
                    let Some(mesh) = self.meshes.get(id) else { continue };
                    pass.set_vertex_buffer(0, mesh.corners.slice(..));
                    pass.set_vertex_buffer(1, self.instances.buffer.slice(..));
                    pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..mesh.count, 0, instances.clone());
                }
                Draw::Loose { corners, instance, .. } => {
                    pass.set_vertex_buffer(0, self.corners.buffer.slice(..));
                    pass.set_vertex_buffer(1, self.instances.buffer.slice(..));
                    pass.draw(corners.clone(), *instance..*instance + 1);
                }
            }
        }
    }

    /// Draws with a program from now on; [`Renderer::prepare`] made it.
    fn use_program(&self, pass: &mut wgpu::RenderPass<'_>, look: Look) {
        if let Some(program) = self.pipelines.get(look) {
            pass.set_pipeline(program);
        }
    }

    /// Makes the programs that a picture needs and no picture before needed.
    fn prepare(&mut self, scene: &Scene, draws: &Draws) {
        for draw in draws.solid.iter().chain(&draws.glass).chain(&draws.over) {
            let (Draw::Mesh { look, .. } | Draw::Loose { look, .. }) = *draw;
            self.pipelines.prepare(look);
        }
        let [ground, sky, lines] = backdrop_looks(scene);
        for look in [ground, Look { kind: Kind::Veil, ..ground }, sky, lines] {
            let unused = scene.grounds.is_empty() && matches!(look.kind, Kind::Ground | Kind::Veil);
            if !unused {
                self.pipelines.prepare(look);
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

/// Whether what is behind a ground shines through, as seen from here: from below it is a veil that shows what stands on it.
fn is_veil(ground: &Ground, camera: &Camera) -> bool {
    ground.color.a < 1.0 || (camera.eye - ground.point).dot(ground.normal) < 0.0
}
