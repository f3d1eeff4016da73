//! The functions of the joint types, as a table: kind, exported name, the engine's method.

use super::{change, get_real, get_vector, joint_functions, param, push, read, set_param};
use crate::fault::export;
use crate::real::{Out, OutVector, Real, f, r, vec3};
use crate::record::JointId;
use core::ffi::c_int;
use ferrode_dynamics::{
    Ball, DBall, DHinge, Fixed, Hinge, Hinge2, JointType, PR, PU, Piston, Slider, Transmission, Universal,
};

joint_functions! { Ball:
    vector dJointSetBallAnchor set_anchor;
    vector dJointSetBallAnchor2 set_anchor2;
    params dJointSetBallParam dJointGetBallParam;
    get_vector dJointGetBallAnchor anchor;
    get_vector dJointGetBallAnchor2 anchor2;
}

joint_functions! { Hinge:
    vector dJointSetHingeAnchor set_anchor;
    vector_offset dJointSetHingeAnchorDelta set_anchor_delta;
    vector dJointSetHingeAxis set_axis;
    axis_angle dJointSetHingeAxisOffset set_axis_offset;
    params dJointSetHingeParam dJointGetHingeParam;
    push dJointAddHingeTorque add_torque;
    get_vector dJointGetHingeAnchor anchor;
    get_vector dJointGetHingeAnchor2 anchor2;
    get_vector dJointGetHingeAxis axis;
    get_real dJointGetHingeAngle angle;
    get_real dJointGetHingeAngleRate angle_rate;
}

joint_functions! { Slider:
    vector dJointSetSliderAxis set_axis;
    vector_offset dJointSetSliderAxisDelta set_axis_delta;
    params dJointSetSliderParam dJointGetSliderParam;
    push dJointAddSliderForce add_force;
    get_vector dJointGetSliderAxis axis;
    get_real dJointGetSliderPosition position;
    get_real dJointGetSliderPositionRate position_rate;
}

joint_functions! { Universal:
    vector dJointSetUniversalAnchor set_anchor;
    vector dJointSetUniversalAxis1 set_axis1;
    vector dJointSetUniversalAxis2 set_axis2;
    axis_angles dJointSetUniversalAxis1Offset set_axis1_offset;
    axis_angles dJointSetUniversalAxis2Offset set_axis2_offset;
    params dJointSetUniversalParam dJointGetUniversalParam;
    push2 dJointAddUniversalTorques add_torques;
    get_vector dJointGetUniversalAnchor anchor;
    get_vector dJointGetUniversalAnchor2 anchor2;
    get_vector dJointGetUniversalAxis1 axis1;
    get_vector dJointGetUniversalAxis2 axis2;
    get_reals dJointGetUniversalAngles angles;
    get_real dJointGetUniversalAngle1 angle1;
    get_real dJointGetUniversalAngle2 angle2;
    get_real dJointGetUniversalAngle1Rate angle1_rate;
    get_real dJointGetUniversalAngle2Rate angle2_rate;
}

joint_functions! { Hinge2:
    vector dJointSetHinge2Anchor set_anchor;
    vector dJointSetHinge2Axis1 set_axis1;
    vector dJointSetHinge2Axis2 set_axis2;
    params dJointSetHinge2Param dJointGetHinge2Param;
    push2 dJointAddHinge2Torques add_torques;
    get_vector dJointGetHinge2Anchor anchor;
    get_vector dJointGetHinge2Anchor2 anchor2;
    get_vector dJointGetHinge2Axis1 axis1;
    get_vector dJointGetHinge2Axis2 axis2;
    get_real dJointGetHinge2Angle1 angle1;
    get_real dJointGetHinge2Angle2 angle2;
    get_real dJointGetHinge2Angle1Rate angle1_rate;
    get_real dJointGetHinge2Angle2Rate angle2_rate;
}

joint_functions! { PR:
    vector dJointSetPRAnchor set_anchor;
    vector dJointSetPRAxis1 set_axis1;
    vector dJointSetPRAxis2 set_axis2;
    params dJointSetPRParam dJointGetPRParam;
    push dJointAddPRTorque add_torque;
    get_vector dJointGetPRAnchor anchor;
    get_vector dJointGetPRAxis1 axis1;
    get_vector dJointGetPRAxis2 axis2;
    get_real dJointGetPRPosition position;
    get_real dJointGetPRPositionRate position_rate;
    get_real dJointGetPRAngle angle;
    get_real dJointGetPRAngleRate angle_rate;
}

joint_functions! { PU:
    vector dJointSetPUAnchor set_anchor;
    vector_offset dJointSetPUAnchorDelta set_anchor_delta;
    vector_offset dJointSetPUAnchorOffset set_anchor_offset;
    vector dJointSetPUAxis1 set_axis1;
    vector dJointSetPUAxis2 set_axis2;
    vector dJointSetPUAxis3 set_axis3;
    vector dJointSetPUAxisP set_axis_p;
    params dJointSetPUParam dJointGetPUParam;
    push2 dJointAddPUTorques add_torques;
    get_vector dJointGetPUAnchor anchor;
    get_vector dJointGetPUAxis1 axis1;
    get_vector dJointGetPUAxis2 axis2;
    get_vector dJointGetPUAxis3 axis3;
    get_vector dJointGetPUAxisP axis_p;
    get_reals dJointGetPUAngles angles;
    get_real dJointGetPUAngle1 angle1;
    get_real dJointGetPUAngle2 angle2;
    get_real dJointGetPUAngle1Rate angle1_rate;
    get_real dJointGetPUAngle2Rate angle2_rate;
    get_real dJointGetPUPosition position;
    get_real dJointGetPUPositionRate position_rate;
}

joint_functions! { Piston:
    vector dJointSetPistonAnchor set_anchor;
    vector_offset dJointSetPistonAnchorOffset set_anchor_offset;
    vector dJointSetPistonAxis set_axis;
    vector_offset dJointSetPistonAxisDelta set_axis_delta;
    params dJointSetPistonParam dJointGetPistonParam;
    push dJointAddPistonForce add_force;
    get_vector dJointGetPistonAnchor anchor;
    get_vector dJointGetPistonAnchor2 anchor2;
    get_vector dJointGetPistonAxis axis;
    get_real dJointGetPistonPosition position;
    get_real dJointGetPistonPositionRate position_rate;
    get_real dJointGetPistonAngle angle;
    get_real dJointGetPistonAngleRate angle_rate;
}

joint_functions! { Fixed:
    params dJointSetFixedParam dJointGetFixedParam;
}

joint_functions! { DBall:
    real dJointSetDBallDistance set_distance;
}

fn is_double_hinge(joint: JointId) -> bool {
    joint.live().is_some_and(|joint| joint.joint_type.get() == Some(JointType::DHinge))
}

/// As in libode a double hinge is a double ball too.
macro_rules! either {
    ($joint:ident, $work:ident($($arg:expr),*)) => {
        if is_double_hinge($joint) { $work::<DHinge>($joint, $($arg),*) } else { $work::<DBall>($joint, $($arg),*) }
    };
    ($joint:ident, $work:ident<_>($($arg:expr),*)) => {
        if is_double_hinge($joint) { $work::<DHinge, _>($joint, $($arg),*) } else { $work::<DBall, _>($joint, $($arg),*) }
    };
}

export! {
    fn dJointSetDBallAnchor1(joint: JointId, x: Real, y: Real, z: Real) {
        either!(joint, change(|j| j.set_anchor1(vec3(x, y, z))))?
    }
    fn dJointSetDBallAnchor2(joint: JointId, x: Real, y: Real, z: Real) {
        either!(joint, change(|j| j.set_anchor2(vec3(x, y, z))))?
    }
    fn dJointSetDBallParam(joint: JointId, parameter: c_int, value: Real) {
        either!(joint, set_param(parameter, f(value)))?
    }
    fn dJointGetDBallParam(joint: JointId, parameter: c_int) -> Real { either!(joint, param(parameter))? }
    fn dJointGetDBallAnchor1(joint: JointId, result: OutVector) {
        either!(joint, get_vector<_>(result, |j| j.anchor1()))?
    }
    fn dJointGetDBallAnchor2(joint: JointId, result: OutVector) {
        either!(joint, get_vector<_>(result, |j| j.anchor2()))?
    }
    fn dJointGetDBallDistance(joint: JointId) -> Real { either!(joint, get_real<_>(|j| j.distance()))? }
}

joint_functions! { DHinge:
    vector dJointSetDHingeAxis set_axis;
    vector dJointSetDHingeAnchor1 set_anchor1;
    vector dJointSetDHingeAnchor2 set_anchor2;
    params dJointSetDHingeParam dJointGetDHingeParam;
    get_vector dJointGetDHingeAxis axis;
    get_vector dJointGetDHingeAnchor1 anchor1;
    get_vector dJointGetDHingeAnchor2 anchor2;
    get_real dJointGetDHingeDistance distance;
}

joint_functions! { Transmission:
    vector dJointSetTransmissionAnchor1 set_anchor1;
    vector dJointSetTransmissionAnchor2 set_anchor2;
    vector dJointSetTransmissionAxis set_axis;
    vector dJointSetTransmissionAxis1 set_axis1;
    vector dJointSetTransmissionAxis2 set_axis2;
    real dJointSetTransmissionRatio set_ratio;
    real dJointSetTransmissionRadius1 set_radius1;
    real dJointSetTransmissionRadius2 set_radius2;
    real dJointSetTransmissionBacklash set_backlash;
    params dJointSetTransmissionParam dJointGetTransmissionParam;
    get_vector dJointGetTransmissionContactPoint1 contact_point1;
    get_vector dJointGetTransmissionContactPoint2 contact_point2;
    get_vector dJointGetTransmissionAnchor1 anchor1;
    get_vector dJointGetTransmissionAnchor2 anchor2;
    get_vector dJointGetTransmissionAxis axis;
    get_vector dJointGetTransmissionAxis1 axis1;
    get_vector dJointGetTransmissionAxis2 axis2;
    get_real dJointGetTransmissionAngle1 angle1;
    get_real dJointGetTransmissionAngle2 angle2;
    get_real dJointGetTransmissionRadius1 radius1;
    get_real dJointGetTransmissionRadius2 radius2;
    get_real dJointGetTransmissionRatio ratio;
    get_real dJointGetTransmissionBacklash backlash;
}
