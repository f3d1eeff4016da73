//! ODE's joint functions by name, as calls of this crate.

use super::data::Call;
use ferrode_dynamics::*;
use ferrode_math::Vec3;

pub fn joint_type(name: &str) -> JointType {
    match name {
        "Ball" => JointType::Ball,
        "Hinge" => JointType::Hinge,
        "Slider" => JointType::Slider,
        "Contact" => JointType::Contact,
        "Universal" => JointType::Universal,
        "Hinge2" => JointType::Hinge2,
        "Fixed" => JointType::Fixed,
        "Null" => JointType::Null,
        "AMotor" => JointType::AMotor,
        "LMotor" => JointType::LMotor,
        "Plane2D" => JointType::Plane2D,
        "PR" => JointType::PR,
        "PU" => JointType::PU,
        "Piston" => JointType::Piston,
        "DBall" => JointType::DBall,
        "DHinge" => JointType::DHinge,
        "Transmission" => JointType::Transmission,
        _ => panic!("no joint type {name}"),
    }
}

/// The name and group of ODE's parameter number.
pub fn param(n: f64) -> (Param, usize) {
    let n = n as usize;
    (Param::ALL[n & 0xff], (n >> 8) + 1)
}

fn axis_frame(rel: f64) -> AxisFrame {
    match rel as i32 {
        0 => AxisFrame::World,
        1 => AxisFrame::First,
        2 => AxisFrame::Second,
        _ => panic!("no frame {rel}"),
    }
}

/// Calls a function that changes the joint.
pub fn call(world: &mut World, j: JointKey, call: &Call) -> Result<(), Error> {
    let a = &call.arguments[..];
    let v = |i: usize| Vec3::new(a[i], a[i + 1], a[i + 2]);
    let name = call.function.strip_prefix("dJoint").expect("a joint function");
    match name {
        "SetPlane2DXParam" => return world.joint_mut::<Plane2D>(j)?.set_x_param(param(a[0]).0, a[1]),
        "SetPlane2DYParam" => return world.joint_mut::<Plane2D>(j)?.set_y_param(param(a[0]).0, a[1]),
        "SetPlane2DAngleParam" => return world.joint_mut::<Plane2D>(j)?.set_angle_param(param(a[0]).0, a[1]),
        _ if name.ends_with("Param") => {
            let (param, group) = param(a[0]);
            return world.set_joint_param(j, param, group, a[1]);
        }
        _ => {}
    }
    match name {
        "SetBallAnchor" => world.joint_mut::<Ball>(j)?.set_anchor(v(0)),
        "SetBallAnchor2" => world.joint_mut::<Ball>(j)?.set_anchor2(v(0)),

        "SetHingeAnchor" => world.joint_mut::<Hinge>(j)?.set_anchor(v(0)),
        "SetHingeAnchorDelta" => world.joint_mut::<Hinge>(j)?.set_anchor_delta(v(0), v(3)),
        "SetHingeAxis" => world.joint_mut::<Hinge>(j)?.set_axis(v(0)),
        "SetHingeAxisOffset" => world.joint_mut::<Hinge>(j)?.set_axis_offset(v(0), a[3]),
        "AddHingeTorque" => world.joint_mut::<Hinge>(j)?.add_torque(a[0]),

        "SetSliderAxis" => world.joint_mut::<Slider>(j)?.set_axis(v(0)),
        "SetSliderAxisDelta" => world.joint_mut::<Slider>(j)?.set_axis_delta(v(0), v(3)),
        "AddSliderForce" => world.joint_mut::<Slider>(j)?.add_force(a[0]),

        "SetUniversalAnchor" => world.joint_mut::<Universal>(j)?.set_anchor(v(0)),
        "SetUniversalAxis1" => world.joint_mut::<Universal>(j)?.set_axis1(v(0)),
        "SetUniversalAxis2" => world.joint_mut::<Universal>(j)?.set_axis2(v(0)),
        "SetUniversalAxis1Offset" => world.joint_mut::<Universal>(j)?.set_axis1_offset(v(0), a[3], a[4]),
        "SetUniversalAxis2Offset" => world.joint_mut::<Universal>(j)?.set_axis2_offset(v(0), a[3], a[4]),
        "AddUniversalTorques" => world.joint_mut::<Universal>(j)?.add_torques(a[0], a[1]),

        "SetHinge2Anchor" => world.joint_mut::<Hinge2>(j)?.set_anchor(v(0)),
        "SetHinge2Axes" => world.joint_mut::<Hinge2>(j)?.set_axes(Some(v(0)), Some(v(3))),
        "AddHinge2Torques" => world.joint_mut::<Hinge2>(j)?.add_torques(a[0], a[1]),

        "SetPRAnchor" => world.joint_mut::<PR>(j)?.set_anchor(v(0)),
        "SetPRAxis1" => world.joint_mut::<PR>(j)?.set_axis1(v(0)),
        "SetPRAxis2" => world.joint_mut::<PR>(j)?.set_axis2(v(0)),
        "AddPRTorque" => world.joint_mut::<PR>(j)?.add_torque(a[0]),

        "SetPUAnchor" => world.joint_mut::<PU>(j)?.set_anchor(v(0)),
        "SetPUAnchorDelta" => world.joint_mut::<PU>(j)?.set_anchor_delta(v(0), v(3)),
        "SetPUAnchorOffset" => world.joint_mut::<PU>(j)?.set_anchor_offset(v(0), v(3)),
        "SetPUAxis1" => world.joint_mut::<PU>(j)?.set_axis1(v(0)),
        "SetPUAxis2" => world.joint_mut::<PU>(j)?.set_axis2(v(0)),
        "SetPUAxis3" => world.joint_mut::<PU>(j)?.set_axis_p(v(0)),

        "SetPistonAnchor" => world.joint_mut::<Piston>(j)?.set_anchor(v(0)),
        "SetPistonAnchorOffset" => world.joint_mut::<Piston>(j)?.set_anchor_offset(v(0), v(3)),
        "SetPistonAxis" => world.joint_mut::<Piston>(j)?.set_axis(v(0)),
        "SetPistonAxisDelta" => world.joint_mut::<Piston>(j)?.set_axis_delta(v(0), v(3)),
        "AddPistonForce" => world.joint_mut::<Piston>(j)?.add_force(a[0]),

        "SetFixed" => {
            world.joint_mut::<Fixed>(j)?.set_fixed();
            Ok(())
        }

        "SetAMotorMode" => {
            let mode = if a[0] == 0.0 { AMotorMode::User } else { AMotorMode::Euler };
            world.joint_mut::<AMotor>(j)?.set_mode(mode);
            Ok(())
        }
        "SetAMotorNumAxes" => {
            world.joint_mut::<AMotor>(j)?.set_axis_count(a[0] as usize);
            Ok(())
        }
        "SetAMotorAxis" => world.joint_mut::<AMotor>(j)?.set_axis(a[0] as usize, axis_frame(a[1]), v(2)),
        "SetAMotorAngle" => world.joint_mut::<AMotor>(j)?.set_angle(a[0] as usize, a[1]),
        "AddAMotorTorques" => world.joint_mut::<AMotor>(j)?.add_torques(a[0], a[1], a[2]),

        "SetLMotorNumAxes" => {
            world.joint_mut::<LMotor>(j)?.set_axis_count(a[0] as usize);
            Ok(())
        }
        "SetLMotorAxis" => world.joint_mut::<LMotor>(j)?.set_axis(a[0] as usize, axis_frame(a[1]), v(2)),

        "SetDBallAnchor1" => world.joint_mut::<DBall>(j)?.set_anchor1(v(0)),
        "SetDBallAnchor2" => world.joint_mut::<DBall>(j)?.set_anchor2(v(0)),
        "SetDBallDistance" => world.joint_mut::<DBall>(j)?.set_distance(a[0]),

        "SetDHingeAxis" => world.joint_mut::<DHinge>(j)?.set_axis(v(0)),
        "SetDHingeAnchor1" => world.joint_mut::<DHinge>(j)?.set_anchor1(v(0)),
        "SetDHingeAnchor2" => world.joint_mut::<DHinge>(j)?.set_anchor2(v(0)),

        "SetTransmissionMode" => {
            let mode = match a[0] as i32 {
                0 => TransmissionMode::ParallelAxes,
                1 => TransmissionMode::IntersectingAxes,
                _ => TransmissionMode::ChainDrive,
            };
            world.joint_mut::<Transmission>(j)?.set_mode(mode);
            Ok(())
        }
        "SetTransmissionAxis" => world.joint_mut::<Transmission>(j)?.set_axis(v(0)),
        "SetTransmissionAxis1" => world.joint_mut::<Transmission>(j)?.set_axis1(v(0)),
        "SetTransmissionAxis2" => world.joint_mut::<Transmission>(j)?.set_axis2(v(0)),
        "SetTransmissionAnchor1" => world.joint_mut::<Transmission>(j)?.set_anchor1(v(0)),
        "SetTransmissionAnchor2" => world.joint_mut::<Transmission>(j)?.set_anchor2(v(0)),
        "SetTransmissionRatio" => world.joint_mut::<Transmission>(j)?.set_ratio(a[0]),
        "SetTransmissionRadius1" => world.joint_mut::<Transmission>(j)?.set_radius1(a[0]),
        "SetTransmissionRadius2" => world.joint_mut::<Transmission>(j)?.set_radius2(a[0]),
        "SetTransmissionBacklash" => world.joint_mut::<Transmission>(j)?.set_backlash(a[0]),
        _ => panic!("no call for {name}"),
    }
}

/// What a getter returns: a vector, some numbers, or one.
pub struct Answer(pub Vec<f64>);

impl From<Vec3> for Answer {
    fn from(v: Vec3) -> Self {
        Self(v.to_array().to_vec())
    }
}

impl From<f64> for Answer {
    fn from(x: f64) -> Self {
        Self(vec![x])
    }
}

impl From<[f64; 2]> for Answer {
    fn from(x: [f64; 2]) -> Self {
        Self(x.to_vec())
    }
}

impl From<AxisFrame> for Answer {
    fn from(frame: AxisFrame) -> Self {
        Self::from(match frame {
            AxisFrame::World => 0.0,
            AxisFrame::First => 1.0,
            AxisFrame::Second => 2.0,
        })
    }
}

/// Reads what an ODE getter, given with its argument in brackets, would.
pub fn get(world: &World, j: JointKey, getter: &str) -> Result<Answer, Error> {
    let name = getter.strip_prefix("dJointGet").expect("a joint's getter");
    let (name, argument) = match name.split_once('(') {
        Some((name, rest)) => (name, rest.trim_end_matches(')')),
        None => (name, ""),
    };
    if name.ends_with("Param") {
        let param = match argument {
            "dParamERP" => Param::Erp,
            "dParamCFM" => Param::Cfm,
            _ => panic!("no parameter {argument}"),
        };
        return Ok(world.joint_param(j, param, 1)?.into());
    }
    let axis = || argument.parse::<usize>().expect("the number of an axis");
    // One line a getter: the type, ODE's name without it, and the call.
    macro_rules! table {
        ($($kind:ident $ode:literal => |$joint:ident| $call:expr;)+) => {
            match name {
                $($ode => {
                    let $joint = world.joint::<$kind>(j)?;
                    Answer::from($call)
                })+
                _ => panic!("no getter {getter}"),
            }
        };
    }
    Ok(table! {
        Ball "BallAnchor" => |j| j.anchor();
        Ball "BallAnchor2" => |j| j.anchor2();
        Hinge "HingeAnchor" => |j| j.anchor();
        Hinge "HingeAnchor2" => |j| j.anchor2();
        Hinge "HingeAxis" => |j| j.axis();
        Hinge "HingeAngle" => |j| j.angle();
        Hinge "HingeAngleRate" => |j| j.angle_rate();
        Slider "SliderAxis" => |j| j.axis();
        Slider "SliderPosition" => |j| j.position()?;
        Slider "SliderPositionRate" => |j| j.position_rate()?;
        Universal "UniversalAnchor" => |j| j.anchor();
        Universal "UniversalAnchor2" => |j| j.anchor2();
        Universal "UniversalAxis1" => |j| j.axis1();
        Universal "UniversalAxis2" => |j| j.axis2();
        Universal "UniversalAngles" => |j| j.angles();
        Universal "UniversalAngle1" => |j| j.angle1();
        Universal "UniversalAngle2" => |j| j.angle2();
        Universal "UniversalAngle1Rate" => |j| j.angle1_rate();
        Universal "UniversalAngle2Rate" => |j| j.angle2_rate();
        Hinge2 "Hinge2Anchor" => |j| j.anchor();
        Hinge2 "Hinge2Anchor2" => |j| j.anchor2();
        Hinge2 "Hinge2Axis1" => |j| j.axis1();
        Hinge2 "Hinge2Axis2" => |j| j.axis2();
        Hinge2 "Hinge2Angle1" => |j| j.angle1();
        Hinge2 "Hinge2Angle2" => |j| j.angle2();
        Hinge2 "Hinge2Angle1Rate" => |j| j.angle1_rate();
        Hinge2 "Hinge2Angle2Rate" => |j| j.angle2_rate();
        PR "PRAnchor" => |j| j.anchor();
        PR "PRAxis1" => |j| j.axis1();
        PR "PRAxis2" => |j| j.axis2();
        PR "PRPosition" => |j| j.position()?;
        PR "PRPositionRate" => |j| j.position_rate()?;
        PR "PRAngle" => |j| j.angle();
        PR "PRAngleRate" => |j| j.angle_rate();
        PU "PUAnchor" => |j| j.anchor();
        PU "PUAxis1" => |j| j.axis1();
        PU "PUAxis2" => |j| j.axis2();
        PU "PUAxis3" => |j| j.axis_p();
        PU "PUAngles" => |j| j.angles();
        PU "PUAngle1" => |j| j.angle1();
        PU "PUAngle2" => |j| j.angle2();
        PU "PUAngle1Rate" => |j| j.angle1_rate();
        PU "PUAngle2Rate" => |j| j.angle2_rate();
        PU "PUPosition" => |j| j.position()?;
        PU "PUPositionRate" => |j| j.position_rate();
        Piston "PistonAnchor" => |j| j.anchor();
        Piston "PistonAnchor2" => |j| j.anchor2();
        Piston "PistonAxis" => |j| j.axis();
        Piston "PistonPosition" => |j| j.position();
        Piston "PistonPositionRate" => |j| j.position_rate();
        Piston "PistonAngle" => |j| j.angle();
        Piston "PistonAngleRate" => |j| j.angle_rate();
        AMotor "AMotorMode" => |j| if j.mode() == AMotorMode::Euler { 1.0 } else { 0.0 };
        AMotor "AMotorNumAxes" => |j| j.axis_count() as f64;
        AMotor "AMotorAxis" => |j| j.axis(axis());
        AMotor "AMotorAxisRel" => |j| j.axis_frame(axis());
        AMotor "AMotorAngle" => |j| j.angle(axis());
        AMotor "AMotorAngleRate" => |j| j.angle_rate(axis());
        LMotor "LMotorNumAxes" => |j| j.axis_count() as f64;
        LMotor "LMotorAxis" => |j| j.axis(axis());
        DBall "DBallAnchor1" => |j| j.anchor1();
        DBall "DBallAnchor2" => |j| j.anchor2();
        DBall "DBallDistance" => |j| j.distance();
        DHinge "DHingeAxis" => |j| j.axis();
        DHinge "DHingeAnchor1" => |j| j.anchor1();
        DHinge "DHingeAnchor2" => |j| j.anchor2();
        DHinge "DHingeDistance" => |j| j.distance();
        Transmission "TransmissionMode" => |j| j.mode() as i32 as f64;
        Transmission "TransmissionAnchor1" => |j| j.anchor1();
        Transmission "TransmissionAnchor2" => |j| j.anchor2();
        Transmission "TransmissionAxis1" => |j| j.axis1();
        Transmission "TransmissionAxis2" => |j| j.axis2();
        Transmission "TransmissionRatio" => |j| j.ratio();
        Transmission "TransmissionRadius1" => |j| j.radius1();
        Transmission "TransmissionRadius2" => |j| j.radius2();
        Transmission "TransmissionBacklash" => |j| j.backlash();
    })
}
