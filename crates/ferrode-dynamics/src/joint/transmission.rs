//! Transmission: gears, bevel gears, chain drive. Couples the rotation of two bodies; other joints hold the wheels.
//!
//! A wheel's phase is the angle of its contact point in a frame that turns with the wheel, counted over turns. The arc
//! length that one wheel rolled must equal the other's; their difference `delta` is what the one row corrects.

use super::{JointError, JointModel, JointMut, JointRef};
use crate::Error;
use crate::ends::{Ends, Frame, StepContext};
use crate::error::{finite, finite_number, unit};
use crate::rows::{JointRows, RowCount};
use core::f64::consts::{FRAC_PI_2, PI};
use ferrode_math::{Vec3, real};

/// What connects the two wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TransmissionMode {
    /// Gears on parallel axes.
    #[default]
    ParallelAxes,
    /// Bevel gears on intersecting axes. The contact points are exact for perpendicular axes only, as ODE's.
    IntersectingAxes,
    /// A chain or belt around two wheels. ODE's contact geometry is right for special layouts only, e.g. an axis +z
    /// with the second wheel in the direction +x of the first.
    ChainDrive,
}

/// One wheel, in its body's coordinates.
#[derive(Clone, Copy, Debug)]
struct Wheel {
    anchor: Vec3,
    axis: Vec3,
    radius: f64,
    /// Directions from which the phase counts, perpendicular to the axis.
    reference: [Vec3; 2],
    /// Angle turned, in radians, as of the latest step's start.
    phase: f64,
    /// Where the wheel met the other in the latest step, in world coordinates.
    contact: Vec3,
}

impl Wheel {
    const NEW: Self = Self {
        anchor: Vec3::ZERO,
        axis: Vec3::X,
        radius: 0.0,
        reference: [Vec3::Y, Vec3::Z],
        phase: 0.0,
        contact: Vec3::ZERO,
    };

    /// The phase next to where the wheel's speed lets expect it, with the contact point at `arm` from the wheel's
    /// centre.
    fn phase_at(&self, body: &Frame, arm: Vec3, h: f64) -> f64 {
        let local = body.rotation.transpose_mul(arm);
        let mut theta = real::atan2(self.reference[1].dot(local), self.reference[0].dot(local));
        let expected = self.phase + h * body.angular_velocity.dot(body.rotation * self.axis);
        if expected > FRAC_PI_2 {
            if theta < 0.0 {
                theta += 2.0 * PI;
            }
            theta += 2.0 * PI * (expected / (2.0 * PI)).floor();
        } else if expected < -FRAC_PI_2 {
            if theta > 0.0 {
                theta -= 2.0 * PI;
            }
            theta += 2.0 * PI * (expected / (2.0 * PI)).ceil();
        }
        if expected - theta > PI {
            theta + 2.0 * PI
        } else if expected - theta < -PI {
            theta - 2.0 * PI
        } else {
            theta
        }
    }
}

/// Where the wheels touch: contact points and directions of motion there, in the world.
#[derive(Clone, Copy, Debug)]
struct Mesh {
    contacts: [Vec3; 2],
    tangents: [Vec3; 2],
}

impl Mesh {
    fn is_finite(&self) -> bool {
        self.contacts.iter().chain(&self.tangents).all(|v| v.is_finite())
    }
}

/// The transmission joint's data: mode, wheels, ratio, backlash, and its own ERP and CFM.
#[derive(Clone, Debug)]
pub struct Transmission {
    mode: TransmissionMode,
    wheels: [Wheel; 2],
    ratio: f64,
    backlash: f64,
    erp: f64,
    cfm: f64,
    /// Radii and reference directions are to be found anew in the next step.
    update: bool,
    /// Difference of the arc lengths as of the latest step's start, in metres.
    delta: f64,
    /// This step's row, between counting and writing: `None` inside the backlash gap.
    mesh: Option<Mesh>,
}

impl Transmission {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self {
            mode: TransmissionMode::default(),
            wheels: [Wheel::NEW; 2],
            ratio: 1.0,
            backlash: 0.0,
            erp,
            cfm,
            update: true,
            delta: 0.0,
            mesh: None,
        }
    }

    /// The wheels' centres in the world.
    fn centres(&self, bodies: [&Frame; 2]) -> [Vec3; 2] {
        [0, 1].map(|i| bodies[i].to_world_point(self.wheels[i].anchor))
    }

    /// Contact points and tangents; `None` where the layout has none (coinciding wheels, parallel bevel axes).
    fn mesh(&self, bodies: [&Frame; 2]) -> Option<Mesh> {
        let centres = self.centres(bodies);
        let axes = [0, 1].map(|i| bodies[i].rotation * self.wheels[i].axis);
        let mesh = match self.mode {
            TransmissionMode::ParallelAxes => {
                let d = centres[1] - centres[0];
                let contact = centres[0] + d * (self.ratio / (1.0 + self.ratio));
                let d = d.normalized()?;
                Mesh { contacts: [contact; 2], tangents: axes.map(|n| d.cross(n)) }
            }
            TransmissionMode::IntersectingAxes => {
                let tangent = axes[0].cross(axes[1]);
                let s = axes[0].dot(axes[1]);
                let h = [0, 1].map(|i| axes[i].dot(centres[i]));
                let det = 1.0 - s * s;
                if det <= 0.0 {
                    return None;
                }
                let apex = axes[0] * ((h[0] - h[1] * s) / det) + axes[1] * ((h[1] - h[0] * s) / det);
                let contacts = centres.map(|c| apex + tangent * (c - apex).dot(tangent));
                Mesh { contacts, tangents: [tangent; 2] }
            }
            TransmissionMode::ChainDrive => {
                let d = centres[0] - centres[1];
                let radii = self.wheels.map(|wheel| wheel.radius);
                let cos = ((radii[1] - radii[0]) / d.length()).clamp(-1.0, 1.0);
                let sin = (1.0 - cos * cos).sqrt();
                let d = d.normalized()?;
                // ODE multiplies by the transposed basis.
                let arms = [0, 1].map(|i| {
                    let u = Vec3::new(radii[i] * cos, 0.0, radii[i] * sin);
                    Vec3::new(d.dot(u), axes[i].dot(u), d.cross(axes[i]).dot(u))
                });
                let tangents = [arms[0].cross(axes[0]).normalized()?, arms[1].cross(axes[1]).normalized()?];
                Mesh { contacts: [centres[0] + arms[0], centres[1] + arms[1]], tangents }
            }
        };
        mesh.is_finite().then_some(mesh)
    }

    /// Makes the present pose the zero of both phases, with the radii that it shows. `None` if a wheel has no radius.
    fn restart(&mut self, bodies: [&Frame; 2], mesh: &Mesh) -> Option<()> {
        let centres = self.centres(bodies);
        let mut wheels = self.wheels;
        for (i, wheel) in wheels.iter_mut().enumerate() {
            let arm = mesh.contacts[i] - centres[i];
            let x = bodies[i].rotation.transpose_mul(arm).normalized()?;
            wheel.radius = arm.length();
            wheel.reference = [x, wheel.axis.cross(x)];
            wheel.phase = 0.0;
        }
        let ratio = wheels[0].radius / wheels[1].radius;
        if !ratio.is_finite() {
            return None;
        }
        (self.wheels, self.ratio, self.update) = (wheels, ratio, false);
        Some(())
    }

    /// Follows the wheels to the present pose: phases, contact points, `delta`. `None` if the layout is impossible.
    fn follow(&mut self, bodies: [&Frame; 2], h: f64) -> Option<Mesh> {
        if self.update
            && (bodies[0].rotation * self.wheels[0].axis).dot(bodies[1].rotation * self.wheels[1].axis) < 0.0
        {
            self.wheels[0].axis = -self.wheels[0].axis;
        }
        let mut mesh = self.mesh(bodies)?;
        if self.update {
            self.restart(bodies, &mesh)?;
        }
        let centres = self.centres(bodies);
        let mut arc = [0.0; 2];
        for (i, wheel) in self.wheels.iter_mut().enumerate() {
            let arm = mesh.contacts[i] - centres[i];
            wheel.phase = wheel.phase_at(bodies[i], arm, h);
            arc[i] = arm.length() * wheel.phase;
        }
        let chain = self.mode == TransmissionMode::ChainDrive;
        self.delta = if chain { arc[0] - arc[1] } else { arc[0] + arc[1] };
        if chain && self.delta < 0.0 {
            // The other run of the chain is the tight one. ODE mirrors about a plane through the world's origin.
            let d = centres[0] - centres[1];
            for (i, wheel) in self.wheels.iter().enumerate() {
                let n = (bodies[i].rotation * wheel.axis).cross(d);
                let (contact, tangent) = (mesh.contacts[i], mesh.tangents[i]);
                mesh.contacts[i] = contact - n * (2.0 * contact.dot(n) / n.dot(n));
                mesh.tangents[i] = n * (2.0 * tangent.dot(n) / n.dot(n)) - tangent;
            }
        }
        for (wheel, contact) in self.wheels.iter_mut().zip(mesh.contacts) {
            wheel.contact = contact;
        }
        mesh.is_finite().then_some(mesh)
    }
}

impl JointModel for Transmission {
    /// One row, which stays empty inside the backlash gap, as ODE's. None where ODE would have NaN or a singular
    /// system: an impossible layout, or an empty row without CFM.
    fn row_count(&mut self, ends: &Ends<'_>, ctx: &StepContext) -> RowCount {
        self.mesh = None;
        let (Some(first), Some(second)) = (ends.first, ends.second) else { return RowCount::default() };
        let Some(mesh) = self.follow([first, second], ctx.h) else { return RowCount::default() };
        if self.backlash == 0.0 || self.delta.abs() > self.backlash {
            self.mesh = Some(mesh);
        } else if self.cfm <= 0.0 {
            return RowCount::default();
        }
        RowCount::new(1, if self.backlash > 0.0 { 0 } else { 1 })
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let [row, ..] = out.rows else { return };
        row.cfm = self.cfm;
        let Some(Mesh { contacts, tangents }) = self.mesh.take() else { return };
        let arms = [contacts[0] - ends.a().position, contacts[1] - ends.b().position];
        row.set_jacobian(tangents[0], arms[0].cross(tangents[0]), -tangents[1], tangents[1].cross(arms[1]));
        let k = ctx.fps * self.erp;
        if self.delta > 0.0 {
            row.correct(k, -(self.delta - self.backlash));
            if self.backlash > 0.0 {
                row.hi = 0.0;
            }
        } else {
            row.correct(k, -(self.delta + self.backlash));
            if self.backlash > 0.0 {
                row.lo = 0.0;
            }
        }
    }

    fn set_param(&mut self, n: i32, value: f64) {
        super::param::set_own_softness(n, value, &mut self.erp, &mut self.cfm);
    }

    fn param(&self, n: i32) -> f64 {
        super::param::own_softness(n, self.erp, self.cfm)
    }

    /// The arc length beyond the backlash, as of the latest step's start.
    fn error(&self, _ends: &Ends<'_>) -> JointError {
        JointError { position: (self.delta.abs() - self.backlash).max(0.0), angle: 0.0 }
    }
}

impl JointRef<'_, Transmission> {
    /// What connects the wheels.
    pub fn mode(&self) -> TransmissionMode {
        self.data.mode
    }

    /// The point where the first wheel met the other in the latest step, in world coordinates; the origin before.
    pub fn contact_point1(&self) -> Vec3 {
        self.data.wheels[0].contact
    }

    /// The point where the second wheel met the other in the latest step, in world coordinates; the origin before.
    pub fn contact_point2(&self) -> Vec3 {
        self.data.wheels[1].contact
    }

    /// The common axis of parallel wheels, in world coordinates.
    ///
    /// # Errors
    /// [`Error::WrongMode`] in other modes than [`TransmissionMode::ParallelAxes`].
    pub fn axis(&self) -> Result<Vec3, Error> {
        match self.data.mode {
            TransmissionMode::ParallelAxes => Ok(self.axis1()),
            _ => Err(Error::WrongMode { what: "a common transmission axis exists with parallel axes only" }),
        }
    }

    /// The first wheel's axis, in world coordinates.
    pub fn axis1(&self) -> Vec3 {
        self.ends().a().rotation * self.data.wheels[0].axis
    }

    /// The second wheel's axis, in world coordinates.
    pub fn axis2(&self) -> Vec3 {
        self.ends().b().rotation * self.data.wheels[1].axis
    }

    /// The first wheel's centre, in world coordinates.
    pub fn anchor1(&self) -> Vec3 {
        self.ends().a().to_world_point(self.data.wheels[0].anchor)
    }

    /// The second wheel's centre, in world coordinates.
    pub fn anchor2(&self) -> Vec3 {
        self.ends().b().to_world_point(self.data.wheels[1].anchor)
    }

    /// The first wheel's radius over the second's: what was set until the first step, then what the contact shows.
    pub fn ratio(&self) -> f64 {
        self.data.ratio
    }

    /// The first wheel's angle in radians, counted over turns, as of the latest step's start.
    pub fn angle1(&self) -> f64 {
        self.data.wheels[0].phase
    }

    /// The second wheel's angle in radians, counted over turns, as of the latest step's start.
    pub fn angle2(&self) -> f64 {
        self.data.wheels[1].phase
    }

    /// The first wheel's radius in metres.
    pub fn radius1(&self) -> f64 {
        self.data.wheels[0].radius
    }

    /// The second wheel's radius in metres.
    pub fn radius2(&self) -> f64 {
        self.data.wheels[1].radius
    }

    /// The play between the wheels, as an arc length in metres.
    pub fn backlash(&self) -> f64 {
        self.data.backlash
    }
}

impl JointMut<'_, Transmission> {
    /// Sets what connects the wheels. Set an axis or anchor afterwards, as only those have the next step measure anew.
    pub fn set_mode(&mut self, mode: TransmissionMode) {
        self.parts().0.mode = mode;
    }

    /// Sets the axis of both wheels from one world vector of any length. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::WrongMode`] with intersecting axes.
    pub fn set_axis(&mut self, axis: Vec3) -> Result<(), Error> {
        let axis = unit("transmission axis", axis)?;
        if self.parts().0.mode == TransmissionMode::IntersectingAxes {
            return Err(Error::WrongMode {
                what: "a transmission with intersecting axes needs axis 1 and axis 2",
            });
        }
        self.set_wheel_axis(0, axis);
        self.set_wheel_axis(1, axis);
        Ok(())
    }

    /// Sets the first wheel's axis from a world vector of any length. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::WrongMode`] unless axes intersect.
    pub fn set_axis1(&mut self, axis: Vec3) -> Result<(), Error> {
        let axis = unit("transmission axis 1", axis)?;
        self.require_intersecting_axes()?;
        self.set_wheel_axis(0, axis);
        Ok(())
    }

    /// Sets the second wheel's axis from a world vector of any length. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::WrongMode`] unless axes intersect.
    pub fn set_axis2(&mut self, axis: Vec3) -> Result<(), Error> {
        let axis = unit("transmission axis 2", axis)?;
        self.require_intersecting_axes()?;
        self.set_wheel_axis(1, axis);
        Ok(())
    }

    /// Sets the first wheel's centre, in world coordinates. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor1(&mut self, anchor: Vec3) -> Result<(), Error> {
        self.set_wheel_anchor(0, finite("transmission anchor 1", anchor)?);
        Ok(())
    }

    /// Sets the second wheel's centre, in world coordinates. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor2(&mut self, anchor: Vec3) -> Result<(), Error> {
        self.set_wheel_anchor(1, finite("transmission anchor 2", anchor)?);
        Ok(())
    }

    /// Sets the first wheel's radius over the second's, for parallel axes.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is positive and finite; [`Error::WrongMode`] in other modes.
    pub fn set_ratio(&mut self, ratio: f64) -> Result<(), Error> {
        let what = "transmission ratio";
        finite_number(what, ratio)?;
        if ratio <= 0.0 {
            return Err(Error::OutOfRange { what, value: ratio, expected: "a positive number" });
        }
        let joint = self.parts().0;
        if joint.mode != TransmissionMode::ParallelAxes {
            return Err(Error::WrongMode { what: "a transmission ratio is set with parallel axes only" });
        }
        joint.ratio = ratio;
        Ok(())
    }

    /// Sets the first wheel's radius in metres, for a chain drive.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is positive and finite; [`Error::WrongMode`] in other modes.
    pub fn set_radius1(&mut self, radius: f64) -> Result<(), Error> {
        self.set_radius(0, "transmission radius 1", radius)
    }

    /// Sets the second wheel's radius in metres, for a chain drive.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is positive and finite; [`Error::WrongMode`] in other modes.
    pub fn set_radius2(&mut self, radius: f64) -> Result<(), Error> {
        self.set_radius(1, "transmission radius 2", radius)
    }

    /// Sets the play between the wheels, as an arc length in metres.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is finite.
    pub fn set_backlash(&mut self, backlash: f64) -> Result<(), Error> {
        self.parts().0.backlash = finite_number("transmission backlash", backlash)?;
        Ok(())
    }

    fn require_intersecting_axes(&mut self) -> Result<(), Error> {
        match self.parts().0.mode {
            TransmissionMode::IntersectingAxes => Ok(()),
            _ => Err(Error::WrongMode {
                what: "transmission axes 1 and 2 are set apart with intersecting axes only",
            }),
        }
    }

    fn set_wheel_axis(&mut self, wheel: usize, unit_axis: Vec3) {
        let (joint, ends) = self.parts();
        if let Some(body) = [ends.first, ends.second][wheel] {
            joint.wheels[wheel].axis = body.rotation.transpose_mul(unit_axis);
            joint.update = true;
        }
    }

    fn set_wheel_anchor(&mut self, wheel: usize, anchor: Vec3) {
        let (joint, ends) = self.parts();
        if let Some(body) = [ends.first, ends.second][wheel] {
            joint.wheels[wheel].anchor = body.to_local_point(anchor);
            joint.update = true;
        }
    }

    fn set_radius(&mut self, wheel: usize, what: &'static str, radius: f64) -> Result<(), Error> {
        finite_number(what, radius)?;
        if radius <= 0.0 {
            return Err(Error::OutOfRange { what, value: radius, expected: "a positive number" });
        }
        let joint = self.parts().0;
        if joint.mode != TransmissionMode::ChainDrive {
            return Err(Error::WrongMode { what: "transmission radii are set for a chain drive only" });
        }
        joint.wheels[wheel].radius = radius;
        Ok(())
    }
}
