//! The chapters of `docs/book`, so that their code is compiled and run with the documentation tests. The packaged crate
//! does not contain them.

macro_rules! chapters {
    ($($name:ident = $path:literal;)+) => {
        $(#[doc = include_str!(concat!("../../../docs/book/", $path))] struct $name;)+
    };
}

chapters! {
    Introduction = "introduction.md";
    Install = "install.md";
    Concepts = "concepts.md";
    Typical = "typical.md";
    ErpCfm = "erp_cfm.md";
    Friction = "friction.md";
    DataTypes = "data_types.md";
    WorldChapter = "world.md";
    Bodies = "bodies.md";
    Joints = "joints.md";
    JointBall = "joints/ball.md";
    JointHinge = "joints/hinge.md";
    JointSlider = "joints/slider.md";
    JointUniversal = "joints/universal.md";
    JointHinge2 = "joints/hinge2.md";
    JointPr = "joints/pr.md";
    JointPu = "joints/pu.md";
    JointPiston = "joints/piston.md";
    JointFixed = "joints/fixed.md";
    JointAmotor = "joints/amotor.md";
    JointLmotor = "joints/lmotor.md";
    JointPlane2d = "joints/plane2d.md";
    JointContact = "joints/contact.md";
    JointDball = "joints/dball.md";
    JointDhinge = "joints/dhinge.md";
    JointTransmission = "joints/transmission.md";
    JointNull = "joints/null.md";
    StepFast = "stepfast.md";
    Support = "support.md";
    Collision = "collision.md";
    Faq = "faq.md";
    Migrating = "migrating.md";
}
