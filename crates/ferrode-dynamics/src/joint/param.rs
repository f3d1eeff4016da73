//! ODE's parameter names.

use crate::Error;

/// Names of joint parameters (ODE manual, "Stop and motor parameters").
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Param {
    /// Low stop, in radians or metres; −∞ for none.
    LoStop = 0,
    /// High stop; +∞ for none.
    HiStop = 1,
    /// Motor velocity wanted, in rad/s or m/s.
    Vel = 2,
    /// A number of ODE's without effect.
    LoVel = 3,
    /// A number of ODE's without effect.
    HiVel = 4,
    /// Largest motor force or torque; 0 for no motor.
    FMax = 5,
    /// Part of the motor's force that acts when it drives away from a stop, 0 … 1.
    FudgeFactor = 6,
    /// Restitution at the stops.
    Bounce = 7,
    /// Constraint force mixing of the motor.
    Cfm = 8,
    /// Error reduction of the stops.
    StopErp = 9,
    /// Constraint force mixing of the stops.
    StopCfm = 10,
    /// Error reduction of the suspension (hinge-2).
    SuspensionErp = 11,
    /// Constraint force mixing of the suspension (hinge-2).
    SuspensionCfm = 12,
    /// Error reduction of the joint itself.
    Erp = 13,
}

impl Param {
    /// All names in the order of ODE's numbers.
    pub const ALL: [Self; 14] = [
        Self::LoStop,
        Self::HiStop,
        Self::Vel,
        Self::LoVel,
        Self::HiVel,
        Self::FMax,
        Self::FudgeFactor,
        Self::Bounce,
        Self::Cfm,
        Self::StopErp,
        Self::StopCfm,
        Self::SuspensionErp,
        Self::SuspensionCfm,
        Self::Erp,
    ];

    /// The parameter of ODE's number within a group.
    pub(crate) fn from_number(n: i32) -> Option<Self> {
        usize::try_from(n).ok().and_then(|n| Self::ALL.get(n).copied())
    }

    /// ODE's number of the parameter in group 1, 2 or 3.
    pub(crate) fn number_in_group(self, group: usize) -> Result<i32, Error> {
        match group {
            1..=3 => Ok(self as i32 + 0x100 * (group as i32 - 1)),
            _ => {
                Err(Error::OutOfRange { what: "parameter group", value: group as f64, expected: "1, 2 or 3" })
            }
        }
    }

    /// The manual's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LoStop => "LoStop",
            Self::HiStop => "HiStop",
            Self::Vel => "Vel",
            Self::LoVel => "LoVel",
            Self::HiVel => "HiVel",
            Self::FMax => "FMax",
            Self::FudgeFactor => "FudgeFactor",
            Self::Bounce => "Bounce",
            Self::Cfm => "CFM",
            Self::StopErp => "StopERP",
            Self::StopCfm => "StopCFM",
            Self::SuspensionErp => "SuspensionERP",
            Self::SuspensionCfm => "SuspensionCFM",
            Self::Erp => "ERP",
        }
    }
}

/// Sets ERP or CFM of a joint that has its own; ignores every other parameter.
pub(crate) fn set_own_softness(n: i32, value: f64, erp: &mut f64, cfm: &mut f64) {
    match Param::from_number(n) {
        Some(Param::Erp) => *erp = value,
        Some(Param::Cfm) => *cfm = value,
        _ => {}
    }
}

/// ERP or CFM of a joint that has its own; 0 for every other parameter.
pub(crate) fn own_softness(n: i32, erp: f64, cfm: f64) -> f64 {
    match Param::from_number(n) {
        Some(Param::Erp) => erp,
        Some(Param::Cfm) => cfm,
        _ => 0.0,
    }
}

/// The axis, 0 … 2, of a motor with numbered axes that ODE's parameter number is for: 0x100 an axis.
pub(crate) fn axis_index(n: i32) -> usize {
    (n >> 8).clamp(0, 2) as usize
}
