//! How each kind of thing is drawn.

use crate::Quality;
use crate::instance::INSTANCE_BYTES;
use crate::targets::DEPTH;
use wgpu::{VertexFormat, VertexStepMode};

/// Size of the shader's `Globals` in bytes.
pub const GLOBALS_BYTES: u64 = (2 * 16 + 8 * 4) * 4;

/// The programs of the graphics card.
#[derive(Debug)]
pub struct Pipelines {
    pub globals_layout: wgpu::BindGroupLayout,
    pub shadow_layout: wgpu::BindGroupLayout,
    pub shadow: wgpu::RenderPipeline,
    pub shapes: wgpu::RenderPipeline,
    pub glass: wgpu::RenderPipeline,
    pub sky: wgpu::RenderPipeline,
    pub ground: wgpu::RenderPipeline,
    pub lines: wgpu::RenderPipeline,
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

/// What differs from one pipeline to the next.
struct Kind<'a> {
    name: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    strip: bool,
    blend: bool,
    /// Depths are compared and, if `true`, written; `None`: always in front, and nothing written.
    depth: Option<bool>,
}

impl Pipelines {
    /// Compiles all for a colour format.
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
        let constants = [("shadow_samples", f64::from(quality.shadow_samples.max(1)))];
        let options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let make = |kind: Kind<'_>| {
            let (vertex, fragment) = (format!("{}_vertex", kind.name), format!("{}_fragment", kind.name));
            let compare = if kind.depth.is_some() {
                wgpu::CompareFunction::Greater
            } else {
                wgpu::CompareFunction::Always
            };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(kind.name),
                layout: Some(&lit),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(&vertex),
                    compilation_options: options(),
                    buffers: kind.buffers,
                },
                primitive: wgpu::PrimitiveState {
                    topology: if kind.strip {
                        wgpu::PrimitiveTopology::TriangleStrip
                    } else {
                        wgpu::PrimitiveTopology::TriangleList
                    },
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(kind.depth == Some(true)),
                    depth_compare: Some(compare),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState { count: quality.samples, ..Default::default() },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(&fragment),
                    compilation_options: options(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format,
                        blend: kind.blend.then_some(wgpu::BlendState::ALPHA_BLENDING),
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let corner = Attributes::new(&CORNER, 0);
        let instance = Attributes::new(&SIX, 3);
        debug_assert_eq!(instance.1, INSTANCE_BYTES);
        let shape = [corner.layout(VertexStepMode::Vertex), instance.layout(VertexStepMode::Instance)];
        let plane = Attributes::new(&SIX[..5], 0);
        let segment = Attributes::new(&SIX[..3], 0);
        let kind = |name, buffers| Kind { name, buffers, strip: false, blend: false, depth: Some(true) };
        let only_globals = layout(&[Some(&globals_layout)]);
        let shadow = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("shadow"),
            layout: Some(&only_globals),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("shadow_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &shape,
            },
            primitive: wgpu::PrimitiveState::default(),
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
        });
        Self {
            shadow,
            shapes: make(kind("shape", &shape)),
            glass: make(Kind { blend: true, depth: Some(false), ..kind("shape", &shape) }),
            sky: make(Kind { depth: None, ..kind("sky", &[]) }),
            ground: make(Kind {
                strip: true,
                blend: true,
                ..kind("ground", &[plane.layout(VertexStepMode::Instance)])
            }),
            lines: make(Kind {
                strip: true,
                blend: true,
                ..kind("line", &[segment.layout(VertexStepMode::Instance)])
            }),
            globals_layout,
            shadow_layout,
        }
    }
}
