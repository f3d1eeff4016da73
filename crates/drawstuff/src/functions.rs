//! The functions that neither draw nor loop.

use crate::fault::export;
use crate::numbers::{Arguments, Array, Out};
use crate::state::{Phase, with};
use core::ffi::c_int;
use ferrode_render::Color;

export! {
    fn dsStop() {
        with(|state| state.stop = state.phase != Phase::Outside);
        Ok(())
    }
    fn dsElapsedTime() -> f64 { Ok(with(|state| state.clock.elapsed())) }
    fn dsInitializeConsole(_argc: c_int, _argv: Arguments) { Ok(()) }
    fn dsFinalizeConsole() { Ok(()) }

    /// A null pointer leaves that half as it is.
    fn dsSetViewpoint(xyz: Array<f32, 3>, hpr: Array<f32, 3>) {
        let (xyz, hpr) = (xyz.maybe(), hpr.maybe());
        let sound = |numbers: &[f32; 3]| numbers.iter().all(|number| number.is_finite());
        with(|state| {
            if let Some(xyz) = xyz.filter(sound) { state.view.xyz = xyz }
            if let Some(hpr) = hpr.filter(sound) { state.view.hpr = hpr }
        });
        Ok(())
    }
    fn dsGetViewpoint(xyz: Out<f32, 3>, hpr: Out<f32, 3>) {
        let view = with(|state| state.view);
        xyz.write(view.xyz);
        hpr.write(view.hpr);
        Ok(())
    }

    fn dsSetTexture(texture: c_int) {
        with(|state| state.drawing.pen.texture = texture);
        Ok(())
    }
    fn dsSetColor(red: f32, green: f32, blue: f32) {
        with(|state| state.drawing.pen.color = Color { r: red, g: green, b: blue, a: 1.0 });
        Ok(())
    }
    fn dsSetColorAlpha(red: f32, green: f32, blue: f32, alpha: f32) {
        with(|state| state.drawing.pen.color = Color { r: red, g: green, b: blue, a: alpha });
        Ok(())
    }
    fn dsSetDrawMode(mode: c_int) {
        with(|state| state.drawing.pen.wireframe = mode != 0);
        Ok(())
    }

    fn dsSetSphereQuality(n: c_int) {
        with(|state| state.drawing.fineness.sphere = n);
        Ok(())
    }
    fn dsSetCapsuleQuality(n: c_int) {
        with(|state| state.drawing.fineness.capsule = n);
        Ok(())
    }
}
