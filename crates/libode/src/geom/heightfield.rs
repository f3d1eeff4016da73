//! Heightfields: data that geoms share.
//!
//! As in ODE the program's arrays and functions are asked at each collision, for the samples around the other geom only;
//! samples that it wants copied are read once.

use super::{GeomId, GeomRecord, class, of_class};
use crate::fault::{Fault, Outcome, export};
use crate::geom::kept::Kept;
use crate::real::{Real, f};
use crate::record::{Required, record};
use crate::slab::{Handle, Held, Pool, Record, Tag};
use core::cell::Cell;
use core::ffi::{c_double, c_float, c_int, c_short, c_uchar, c_void};
use core::sync::atomic::{AtomicU64, Ordering};
use ferrode_collide::shape::Heightfield;
use ferrode_collide::{Frame, Shape};
use ferrode_math::{Aabb, Vec3};

pub type FieldId = Handle<FieldRecord>;

/// `dHeightfieldGetHeight`.
type GetHeight = unsafe extern "C-unwind" fn(*mut c_void, c_int, c_int) -> Real;

/// Most samples that are asked for in one collision: a geom over more of an endless field meets nothing.
const MOST_SAMPLES: i64 = 1 << 24;

/// Where heights come from.
#[derive(Clone, Copy, Default)]
enum Samples {
    /// Nowhere any more: they were copied.
    #[default]
    Copied,
    Byte(*const c_uchar),
    Short(*const c_short),
    Single(*const c_float),
    Double(*const c_double),
    Function(GetHeight, *mut c_void),
}

/// Sizes and scaling, as the build functions take them.
#[derive(Clone, Copy)]
struct Grid {
    width: f64,
    depth: f64,
    columns: i64,
    rows: i64,
    scale: f64,
    offset: f64,
    thickness: f64,
    wrap: bool,
}

/// A heightfield's data.
#[derive(Default)]
pub struct FieldRecord {
    tag: Tag,
    grid: Cell<Option<Grid>>,
    samples: Cell<Samples>,
    /// All heights as they were when the data were built; of a function only the field's bounds.
    field: Kept<Option<Heightfield>>,
    /// Whether a function's heights have no bounds.
    unbounded: Cell<bool>,
    version: AtomicU64,
}
record!(FieldRecord, FIELDS, 15);

/// What only a heightfield's geom has.
#[derive(Default)]
pub struct FieldGeom {
    data: Cell<FieldId>,
    version: AtomicU64,
    pub placeable: Cell<bool>,
}

/// What of a field a geom may touch.
pub enum View {
    /// The field as it was built.
    Whole,
    /// The part under the geom, as the program tells it now, and where that is.
    Part(Box<Shape>, Frame),
    Nothing,
}

impl View {
    /// The shape that counts: that of the geom or of its part.
    pub fn with<R>(&self, geom: &GeomRecord, work: impl FnOnce(Option<&Shape>) -> R) -> R {
        match self {
            Self::Whole => geom.shape.with(|shape| work(shape.as_ref())),
            Self::Part(shape, _) => work(Some(shape)),
            Self::Nothing => work(None),
        }
    }

    /// Where that shape is, for a geom that is at `own`.
    pub fn frame(&self, own: Frame) -> Frame {
        match self {
            Self::Part(_, frame) => *frame,
            _ => own,
        }
    }
}

impl Grid {
    fn new(
        (width, depth): (Real, Real),
        (columns, rows): (c_int, c_int),
        (scale, offset, thickness): (Real, Real, Real),
        wrap: c_int,
    ) -> Outcome<Self> {
        let size = |n: c_int| if n >= 2 { Ok(i64::from(n)) } else { Err(Fault::user("not enough samples")) };
        Ok(Self {
            width: f(width),
            depth: f(depth),
            columns: size(columns)?,
            rows: size(rows)?,
            scale: f(scale),
            offset: f(offset),
            thickness: f(thickness),
            wrap: wrap != 0,
        })
    }

    fn field(&self, columns: i64, rows: i64, heights: Vec<f64>) -> Option<Heightfield> {
        let field = Heightfield::new(
            self.width,
            self.depth,
            columns as usize,
            rows as usize,
            heights,
            self.thickness,
        );
        let field = field.ok()?;
        Some(if self.wrap { field.wrapped() } else { field })
    }

    /// Places of the samples around a box in the field's frame along one axis, one cell more on each side since what lies
    /// beyond an edge counts: the first, and how many. `None` beside the field.
    fn places(&self, size: f64, count: i64, low: f64, high: f64) -> Option<(i64, i64)> {
        let cell = size / (count - 1) as f64;
        // Casts saturate: a box without end covers all.
        let first = (((low + 0.5 * size) / cell) as i64).saturating_sub(2);
        let last = (((high + 0.5 * size) / cell) as i64).saturating_add(3);
        let (first, last) = if self.wrap { (first, last) } else { (first.max(0), last.min(count - 1)) };
        let number = last.saturating_sub(first).saturating_add(1);
        (number >= 2).then_some((first, number))
    }
}

impl Samples {
    /// A sample of the program's, not scaled yet; `x` and `z` are within the grid.
    fn at(self, x: i64, z: i64, grid: &Grid) -> f64 {
        let i = (x + z * grid.columns) as usize;
        // SAFETY: the program keeps its arrays, as many samples as columns times rows, until it builds the data anew or
        // destroys them; its function is called as the header says.
        unsafe {
            match self {
                Self::Copied => 0.0,
                Self::Byte(samples) => f64::from(samples.add(i).read()),
                Self::Short(samples) => f64::from(samples.add(i).read()),
                Self::Single(samples) => f64::from(samples.add(i).read()),
                Self::Double(samples) => samples.add(i).read(),
                Self::Function(height, user) => f(height(user, x as c_int, z as c_int)),
            }
        }
    }

    fn is_null(self) -> bool {
        match self {
            Self::Copied => false,
            Self::Byte(samples) => samples.is_null(),
            Self::Short(samples) => samples.is_null(),
            Self::Single(samples) => samples.is_null(),
            Self::Double(samples) => samples.is_null(),
            Self::Function(..) => false,
        }
    }
}

impl FieldRecord {
    fn build(&self, grid: Grid, samples: Samples, copy: bool) -> Outcome<()> {
        if samples.is_null() {
            return Err(Fault::ARGUMENT);
        }
        let function = matches!(samples, Samples::Function(..));
        let field = if function {
            grid.field(2, 2, vec![0.0; 4])
        } else {
            let heights = (0..grid.columns * grid.rows)
                .map(|i| samples.at(i % grid.columns, i / grid.columns, &grid) * grid.scale + grid.offset);
            grid.field(grid.columns, grid.rows, heights.collect())
        };
        self.field.set(Some(field.ok_or(Fault::ARGUMENT)?));
        self.grid.set(Some(grid));
        self.samples.set(if copy { Samples::Copied } else { samples });
        self.unbounded.set(function);
        self.version.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }

    fn set_bounds(&self, low: f64, high: f64) {
        let Some(grid) = self.grid.get() else { return };
        let field = self.field.with(Option::clone);
        self.field.set(
            field.map(|field| {
                field.with_bounds(low * grid.scale + grid.offset, high * grid.scale + grid.offset)
            }),
        );
        self.unbounded.set(false);
        self.version.fetch_add(1, Ordering::Relaxed);
    }

    /// What a geom with this box in the field's frame may touch. The program's function may be asked, so nothing is
    /// borrowed meanwhile.
    fn view(&self, aabb: &Aabb, frame: &Frame) -> View {
        let (Some(grid), samples) = (self.grid.get(), self.samples.get()) else { return View::Nothing };
        if matches!(samples, Samples::Copied) {
            return View::Whole;
        }
        let x = grid.places(grid.width, grid.columns, aabb.min.x, aabb.max.x);
        let z = grid.places(grid.depth, grid.rows, aabb.min.z, aabb.max.z);
        let (Some((x0, columns)), Some((z0, rows))) = (x, z) else { return View::Nothing };
        if columns.saturating_mul(rows) > MOST_SAMPLES {
            return if matches!(samples, Samples::Function(..)) { View::Nothing } else { View::Whole };
        }
        let within = |i: i64, count: i64| if grid.wrap { i.rem_euclid(count - 1) } else { i };
        let height = |x: i64, z: i64| {
            samples.at(within(x, grid.columns), within(z, grid.rows), &grid) * grid.scale + grid.offset
        };
        if !matches!(samples, Samples::Function(..)) {
            let unchanged = self.field.with(|field| {
                let same = |field: &Heightfield, x, z| field.height(x, z).to_bits() == height(x, z).to_bits();
                field.as_ref().is_some_and(|field| {
                    (z0..z0 + rows).all(|z| (x0..x0 + columns).all(|x| same(field, x, z)))
                })
            });
            if unchanged {
                return View::Whole;
            }
        }
        let (cell_x, cell_z) = (grid.width / (grid.columns - 1) as f64, grid.depth / (grid.rows - 1) as f64);
        let part = Grid {
            width: cell_x * (columns - 1) as f64,
            depth: cell_z * (rows - 1) as f64,
            wrap: false,
            ..grid
        };
        let heights = (0..columns * rows).map(|i| height(x0 + i % columns, z0 + i / columns)).collect();
        let Some(field) = part.field(columns, rows, heights) else { return View::Nothing };
        let middle = Vec3::new(
            cell_x * x0 as f64 + 0.5 * (part.width - grid.width),
            0.0,
            cell_z * z0 as f64 + 0.5 * (part.depth - grid.depth),
        );
        View::Part(
            Box::new(Shape::Heightfield(field)),
            Frame::new(frame.point_to_world(middle), frame.rotation),
        )
    }
}

impl GeomRecord {
    /// Takes over the field's latest build.
    pub fn refresh_field(&self) {
        if self.class.get() != class::HEIGHTFIELD {
            return;
        }
        let Some(data) = self.field.data.get().live() else { return };
        let version = data.version.load(Ordering::Relaxed);
        if self.field.version.load(Ordering::Acquire) == version {
            return;
        }
        // The first of several threads that find a new build takes it over.
        let _held = Held::content(self);
        if self.field.version.load(Ordering::Acquire) != version {
            self.shape.set(data.field.with(Option::clone).map(Shape::Heightfield));
            self.field.version.store(version, Ordering::Release);
        }
    }

    /// What of this heightfield another geom may touch; the whole of any other geom.
    pub fn view_for(&self, frame: &Frame, other: &Self, other_frame: &Frame) -> View {
        if self.class.get() != class::HEIGHTFIELD {
            return View::Whole;
        }
        let Some(data) = self.field.data.get().live() else { return View::Nothing };
        let position = frame.point_to_local(other_frame.position);
        let local = Frame::new(position, frame.rotation.transpose() * other_frame.rotation);
        match other.shape.with(|shape| shape.as_ref().map(|shape| shape.aabb_in(&local))) {
            Some(aabb) => data.view(&aabb, frame),
            None => View::Nothing,
        }
    }

    /// The box of a field whose heights have no bounds: without end wherever its height points to.
    pub fn unbounded_field_aabb(&self, frame: &Frame) -> Option<Aabb> {
        let data =
            (self.class.get() == class::HEIGHTFIELD).then(|| self.field.data.get().live()).flatten()?;
        if !data.unbounded.get() {
            return None;
        }
        let mut aabb = data.field.with(|field| field.as_ref().map(|field| field.aabb(frame)))?;
        for i in 0..3 {
            if frame.rotation.rows[i][1] != 0.0 {
                aabb.min[i] = f64::NEG_INFINITY;
                aabb.max[i] = f64::INFINITY;
            }
        }
        Some(aabb)
    }
}

fn field_geom(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::HEIGHTFIELD, "argument not a heightfield")
}

fn required(data: FieldId) -> Outcome<&'static FieldRecord> {
    data.get().map_err(|_| Fault::user("argument not Heightfield data"))
}

macro_rules! builders {
    ($($name:ident $samples:ident $sample:ty;)+) => {
        export! { $(
            #[allow(clippy::too_many_arguments)]
            fn $name(
                data: FieldId, samples: *const $sample, copy: c_int, width: Real, depth: Real, columns: c_int,
                rows: c_int, scale: Real, offset: Real, thickness: Real, wrap: c_int,
            ) {
                let data = required(data)?;
                let grid = Grid::new((width, depth), (columns, rows), (scale, offset, thickness), wrap)?;
                data.build(grid, Samples::$samples(samples), copy != 0)?
            }
        )+ }
    };
}

builders! {
    dGeomHeightfieldDataBuildByte Byte c_uchar;
    dGeomHeightfieldDataBuildShort Short c_short;
    dGeomHeightfieldDataBuildSingle Single c_float;
    dGeomHeightfieldDataBuildDouble Double c_double;
}

export! {
    fn dGeomHeightfieldDataCreate() -> FieldId { FieldId::of(FieldRecord::pool().create()) }
    fn dGeomHeightfieldDataDestroy(data: FieldId) {
        let data = required(data)?;
        data.field.set(None);
        FieldRecord::pool().destroy(data)
    }
    #[allow(clippy::too_many_arguments)]
    fn dGeomHeightfieldDataBuildCallback(
        data: FieldId, user: *mut c_void, callback: Option<GetHeight>, width: Real, depth: Real, columns: c_int,
        rows: c_int, scale: Real, offset: Real, thickness: Real, wrap: c_int,
    ) {
        let data = required(data)?;
        let callback = callback.ok_or(Fault::ARGUMENT)?;
        let grid = Grid::new((width, depth), (columns, rows), (scale, offset, thickness), wrap)?;
        data.build(grid, Samples::Function(callback, user), false)?
    }
    fn dGeomHeightfieldDataSetBounds(data: FieldId, low: Real, high: Real) {
        required(data)?.set_bounds(f(low), f(high))
    }
    /// Data may come later.
    fn dCreateHeightfield(space: GeomId, data: FieldId, placeable: c_int) -> GeomId {
        if !data.is_null() {
            data.get()?;
        }
        let handle = GeomRecord::create(class::HEIGHTFIELD, None, None, space)?;
        let geom = handle.get()?;
        geom.field.data.set(data);
        geom.field.placeable.set(placeable != 0);
        geom.refresh_field();
        handle
    }
    fn dGeomHeightfieldSetHeightfieldData(geom: GeomId, data: FieldId) {
        let geom = field_geom(geom)?;
        data.get()?;
        geom.field.data.set(data);
        geom.field.version.store(super::NO_BUILD, Ordering::Release)
    }
    fn dGeomHeightfieldGetHeightfieldData(geom: GeomId) -> FieldId { field_geom(geom)?.field.data.get() }
}
