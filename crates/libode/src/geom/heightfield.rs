//! Heightfields: data that geoms share. The samples are read when the data are built and given to a geom.

use super::{GeomId, GeomRecord, class};
use crate::fault::{Fault, Outcome, export};
use crate::real::{Real, f};
use crate::record::{Required, record};
use crate::slab::{Handle, Pool, Record, Tag};
use core::cell::{Cell, RefCell};
use core::ffi::{c_double, c_float, c_int, c_short, c_uchar, c_void};
use ferrode_collide::Shape;
use ferrode_collide::shape::Heightfield;

pub type FieldId = Handle<FieldRecord>;

/// `dHeightfieldGetHeight`.
type GetHeight = unsafe extern "C-unwind" fn(*mut c_void, c_int, c_int) -> Real;

/// A heightfield's data.
#[derive(Default)]
pub struct FieldRecord {
    tag: Tag,
    field: RefCell<Option<Heightfield>>,
    /// Scale, offset and thickness, for bounds given later.
    scaling: Cell<[f64; 3]>,
    version: Cell<u64>,
}
record!(FieldRecord, FIELDS, 15);

/// What only a heightfield's geom has.
#[derive(Default)]
pub struct FieldGeom {
    data: Cell<FieldId>,
    version: Cell<u64>,
    pub placeable: Cell<bool>,
}

/// Sizes and scaling, as the build functions take them.
struct Grid {
    width: Real,
    depth: Real,
    columns: c_int,
    rows: c_int,
    scale: Real,
    offset: Real,
    thickness: Real,
    wrap: c_int,
}

impl FieldRecord {
    fn build(&self, grid: &Grid, sample: impl Fn(usize, usize, usize) -> f64) -> Outcome<()> {
        let size =
            |n: c_int| usize::try_from(n).ok().filter(|n| *n >= 2).ok_or(Fault::user("not enough samples"));
        let (columns, rows) = (size(grid.columns)?, size(grid.rows)?);
        let (scale, offset, thickness) = (f(grid.scale), f(grid.offset), f(grid.thickness));
        let heights =
            (0..columns * rows).map(|i| sample(i % columns, i / columns, i) * scale + offset).collect();
        let field = Heightfield::new(f(grid.width), f(grid.depth), columns, rows, heights, thickness);
        let field = field.map_err(|_| Fault::ARGUMENT)?;
        *self.field.borrow_mut() = Some(if grid.wrap != 0 { field.wrapped() } else { field });
        self.scaling.set([scale, offset, thickness]);
        self.version.set(self.version.get() + 1);
        Ok(())
    }

    /// From an array of samples.
    fn build_from<T: Copy>(&self, samples: *const T, grid: &Grid, number: impl Fn(T) -> f64) -> Outcome<()> {
        if samples.is_null() {
            return Err(Fault::ARGUMENT);
        }
        // SAFETY: not null, and as many samples as columns times rows (the contract of the build functions).
        self.build(grid, |_, _, i| number(unsafe { samples.add(i).read() }))
    }
}

impl GeomRecord {
    /// Takes over the field's latest build.
    pub fn refresh_field(&self) {
        if self.class.get() != class::HEIGHTFIELD {
            return;
        }
        let Some(data) = self.field.data.get().live() else { return };
        if self.field.version.replace(data.version.get()) != data.version.get() {
            self.shape.set(data.field.borrow().clone().map(Shape::Heightfield));
        }
    }
}

fn field_geom(geom: GeomId) -> Outcome<&'static GeomRecord> {
    let geom = geom.get()?;
    geom.require_class(class::HEIGHTFIELD, "argument not a heightfield")?;
    Ok(geom)
}

macro_rules! builders {
    ($($name:ident $sample:ty;)+) => {
        export! { $(
            #[allow(clippy::too_many_arguments)]
            fn $name(
                data: FieldId, samples: *const $sample, _copy: c_int, width: Real, depth: Real, columns: c_int,
                rows: c_int, scale: Real, offset: Real, thickness: Real, wrap: c_int,
            ) {
                let grid = Grid { width, depth, columns, rows, scale, offset, thickness, wrap };
                data.get()?.build_from(samples, &grid, |sample| f64::from(sample))?
            }
        )+ }
    };
}

builders! {
    dGeomHeightfieldDataBuildByte c_uchar;
    dGeomHeightfieldDataBuildShort c_short;
    dGeomHeightfieldDataBuildSingle c_float;
    dGeomHeightfieldDataBuildDouble c_double;
}

export! {
    fn dGeomHeightfieldDataCreate() -> FieldId { FieldId::of(FieldRecord::pool().create()) }
    fn dGeomHeightfieldDataDestroy(data: FieldId) {
        let data = data.get()?;
        *data.field.borrow_mut() = None;
        FieldRecord::pool().destroy(data)
    }
    #[allow(clippy::too_many_arguments)]
    fn dGeomHeightfieldDataBuildCallback(
        data: FieldId, user: *mut c_void, callback: Option<GetHeight>, width: Real, depth: Real, columns: c_int,
        rows: c_int, scale: Real, offset: Real, thickness: Real, wrap: c_int,
    ) {
        let callback = callback.ok_or(Fault::ARGUMENT)?;
        let grid = Grid { width, depth, columns, rows, scale, offset, thickness, wrap };
        // SAFETY: the program's own function with its data, called as the header says.
        data.get()?.build(&grid, |x, z, _| f(unsafe { callback(user, x as c_int, z as c_int) }))?
    }
    fn dGeomHeightfieldDataSetBounds(data: FieldId, low: Real, high: Real) {
        let data = data.get()?;
        let [scale, offset, _] = data.scaling.get();
        let field = data.field.borrow_mut().take();
        *data.field.borrow_mut() = field.map(|field| field.with_bounds(f(low) * scale + offset, f(high) * scale + offset));
        data.version.set(data.version.get() + 1)
    }
    fn dCreateHeightfield(space: GeomId, data: FieldId, placeable: c_int) -> GeomId {
        data.get()?;
        let handle = GeomRecord::create(class::HEIGHTFIELD, None, None, space)?;
        let geom = handle.get()?;
        geom.field.data.set(data);
        geom.field.placeable.set(placeable != 0);
        handle
    }
    fn dGeomHeightfieldSetHeightfieldData(geom: GeomId, data: FieldId) {
        let geom = field_geom(geom)?;
        data.get()?;
        geom.field.data.set(data);
        geom.field.version.set(0)
    }
    fn dGeomHeightfieldGetHeightfieldData(geom: GeomId) -> FieldId { field_geom(geom)?.field.data.get() }
}
