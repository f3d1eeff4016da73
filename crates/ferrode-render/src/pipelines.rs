//! How each kind of thing is drawn.

use crate::Quality;
use crate::instance::INSTANCE_BYTES;
use crate::targets::DEPTH;
use std::collections::BTreeMap;
use wgpu::{VertexFormat, VertexStepMode};

/// Size of the shader's `Globals` in bytes.
pub const GLOBALS_BYTES: u64 = (2 * 16 + 8 * 4) * 4;

/// A kind of thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Shapes that are seen from outside only.
    Closed,
    /// Shapes that are seen from both sides.
    Open,
    /// Shapes through which others shine.
    Glass,
    /// Grounds that nothing shines through.
    Ground,
    /// Grounds as veils.
    Veil,
    /// Behind all else, where nothing was drawn.
    Sky,
    /// Lines.
    Lines,
}

/// A kind of thing, and what its program must be able to do: each program does no more than it must.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Look {
    /// The kind.
    pub kind: Kind,
    /// Which patterns there are: none (0), some without noise (1), any (2).
    pub patterns: u8,
    /// There are clouds in the sky.
    pub clouds: bool,
}

/// The level of a pattern's number for [`Look::patterns`].
pub fn pattern_level(pattern: f32) -> u8 {
    match pattern {
        p if p < 0.5 => 0,
        p if p < 3.5 => 1,
        _ => 2,
    }
}

/// The programs of the graphics card, made when they are first needed.
#[derive(Debug)]
pub struct Pipelines {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    quality: Quality,
    module: wgpu::ShaderModule,
    lit: wgpu::PipelineLayout,
    pub globals_layout: wgpu::BindGroupLayout,
    pub shadow_layout: wgpu::BindGroupLayout,
    /// Shadows of shapes of either kind.
    pub shadow_closed: wgpu::RenderPipeline,
    pub shadow_open: wgpu::RenderPipeline,
    made: BTreeMap<Look, wgpu::RenderPipeline>,
}

/// Formats of the corners of shapes: local, core, normal.
const CORNER: [VertexFormat; 3] = [VertexFormat::Float32x3; 3];
const SIX: [VertexFormat; 6] = [VertexFormat::Float32x4; 6];

struct Attributes(Vec<wgpu::VertexAttribute>, u64);

impl Attributes {
    fn new(formats: &[VertexFormat], first: u32) -> Self {
        let mut offset = 0;
        let list = formats.iter().zip(first..).map(|(format, shader_location)| {
            let attribute = wgpu::VertexAttribute { format: *format, offset, shader_location };
            offset += format.size();
            attribute
        });
        let list = list.collect();
        Self(list, offset)
    }

    fn layout(&self, step_mode: VertexStepMode) -> Option<wgpu::VertexBufferLayout<'_>> {
        Some(wgpu::VertexBufferLayout { array_stride: self.1, step_mode, attributes: &self.0 })
    }
}

fn shape_attributes() -> [Attributes; 2] {
    let instance = Attributes::new(&SIX, 3);
    debug_assert_eq!(instance.1, INSTANCE_BYTES);
    [Attributes::new(&CORNER, 0), instance]
}

/// What a pipeline does with depths, which are 1 at the near plane and 0 infinitely far away.
#[derive(Clone, Copy, PartialEq)]
enum Depth {
    /// Nearer things hide farther ones.
    Written,
    /// What was drawn before hides what is behind it.
    Compared,
    /// At infinity: hidden by everything.
    Behind,
}

impl Kind {
    /// Prefix of the entry points.
    fn name(self, plain: bool) -> &'static str {
        match self {
            Self::Closed if plain => "solid",
            Self::Ground if plain => "floor",
            Self::Closed | Self::Open | Self::Glass => "shape",
            Self::Ground | Self::Veil => "ground",
            Self::Sky => "sky",
            Self::Lines => "line",
        }
    }

    fn depth(self) -> Depth {
        match self {
            Self::Closed | Self::Open | Self::Ground | Self::Veil | Self::Lines => Depth::Written,
            Self::Glass => Depth::Compared,
            Self::Sky => Depth::Behind,
        }
    }

    fn blends(self) -> bool {
        matches!(self, Self::Glass | Self::Veil | Self::Lines)
    }

    fn primitive(self) -> wgpu::PrimitiveState {
        let strip = matches!(self, Self::Ground | Self::Veil | Self::Lines);
        wgpu::PrimitiveState {
            topology: if strip {
                wgpu::PrimitiveTopology::TriangleStrip
            } else {
                wgpu::PrimitiveTopology::TriangleList
            },
            cull_mode: (self == Self::Closed).then_some(wgpu::Face::Back),
            ..Default::default()
        }
    }
}

impl Pipelines {
    /// For a colour format.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, quality: &Quality) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("shader.wgsl"));
        let globals_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("globals"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let map = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let compare = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
        let shadow_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow map"),
            entries: &[entry(0, map), entry(1, compare)],
        });
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let lit = layout(&[Some(&globals_layout), Some(&shadow_layout)]);
        let only_globals = layout(&[Some(&globals_layout)]);
        let shadow = |cull_mode| shadow_pipeline(device, &module, &only_globals, cull_mode);
        Self {
            shadow_closed: shadow(Some(wgpu::Face::Back)),
            shadow_open: shadow(None),
            device: device.clone(),
            format,
            quality: *quality,
            module,
            lit,
            globals_layout,
            shadow_layout,
            made: BTreeMap::new(),
        }
    }

    /// Sees to it that a program is there.
    pub fn prepare(&mut self, look: Look) {
        if !self.made.contains_key(&look) {
            let made = self.make(look);
            self.made.insert(look, made);
        }
    }

    /// The program for a look, which was [prepared](Self::prepare).
    pub fn get(&self, look: Look) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&look)
    }

    fn make(&self, look: Look) -> wgpu::RenderPipeline {
        let kind = look.kind;
        let constants = [
            ("shadow_samples", f64::from(self.quality.shadow_samples.max(1))),
            ("patterns", f64::from(look.patterns)),
            ("clouded", f64::from(u8::from(look.clouds))),
        ];
        let options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let shape = shape_attributes();
        let planes = Attributes::new(&SIX[..5], 0);
        let segments = Attributes::new(&SIX[..3], 0);
        let buffers = match kind {
            Kind::Closed | Kind::Open | Kind::Glass => {
                vec![shape[0].layout(VertexStepMode::Vertex), shape[1].layout(VertexStepMode::Instance)]
            }
            Kind::Ground | Kind::Veil => vec![planes.layout(VertexStepMode::Instance)],
            Kind::Lines => vec![segments.layout(VertexStepMode::Instance)],
            Kind::Sky => vec![],
        };
        let name = kind.name(self.quality.plain);
        let (vertex, fragment) = (format!("{name}_vertex"), format!("{name}_fragment"));
        let compare = match kind.depth() {
            Depth::Behind => wgpu::CompareFunction::Equal,
            Depth::Written | Depth::Compared => wgpu::CompareFunction::Greater,
        };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: Some(&self.lit),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(&vertex),
                compilation_options: options(),
                buffers: &buffers,
            },
            primitive: kind.primitive(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(kind.depth() == Depth::Written),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.quality.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(&fragment),
                compilation_options: options(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.format,
                    blend: kind.blends().then_some(wgpu::BlendState::ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn shadow_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    cull_mode: Option<wgpu::Face>,
) -> wgpu::RenderPipeline {
    let shape = shape_attributes();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadow"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("shadow_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[shape[0].layout(VertexStepMode::Vertex), shape[1].layout(VertexStepMode::Instance)],
        },
        primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState { constant: 1, slope_scale: 1.5, clamp: 0.0 },
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}
