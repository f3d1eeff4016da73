//! Broken files: each gives an error that names the line and says what is wrong, and none panics.

use ferrode_scene::{BuildOptions, LoadOptions, build, load_str};

struct Broken {
    name: &'static str,
    text: &'static str,
    /// Part of the message.
    says: &'static str,
    line: usize,
}

const fn broken(name: &'static str, says: &'static str, line: usize, text: &'static str) -> Broken {
    Broken { name, text, says, line }
}

const BROKEN: &[Broken] = &[
    // XML
    broken("empty file", "holds no element", 1, ""),
    broken("no XML", "the XML is broken", 1, "this is not XML"),
    broken(
        "tag not closed",
        "`</model>` closes `<link>`",
        3,
        "<sdf version='1.7'>\n<model name='m'><link name='l'>\n</model></sdf>",
    ),
    broken(
        "file cut off",
        "before its elements are closed",
        2,
        "<sdf version='1.7'><world name='w'>\n<model name='m'>",
    ),
    broken(
        "attribute twice",
        "attribute `name` is given twice",
        2,
        "<sdf version='1.7'>\n<model name='a' name='b'/></sdf>",
    ),
    broken("unquoted attribute", "the XML is broken", 1, "<sdf version=1.7/>"),
    broken("unknown entity", "the XML is broken", 2, "<sdf version='1.7'>\n<model name='&m;'/></sdf>"),
    broken("two roots", "the XML is broken", 2, "<sdf version='1.7'/>\n<sdf version='1.7'/>"),
    broken("binary zeros", "the XML is broken", 1, "<sdf>\u{0}\u{0}</sdf>"),
    // The file as a whole
    broken("other root", "neither SDF nor URDF", 2, "<?xml version='1.0'?>\n<html/>"),
    broken("old root", "SDF 1.2 or older", 1, "<gazebo version='1.2'/>"),
    broken("no version", "needs an attribute `version`", 1, "<sdf><model name='m'/></sdf>"),
    broken("odd version", "is not an SDF version", 1, "<sdf version='new'/>"),
    broken("old version", "SDF 1.3 is too old", 1, "<sdf version='1.3'/>"),
    broken("nothing inside", "neither a world nor a model", 1, "<sdf version='1.7'/>"),
    // Names
    broken(
        "model without a name",
        "needs an attribute `name`",
        2,
        "<sdf version='1.7'>\n<model><link name='l'/></model></sdf>",
    ),
    broken(
        "empty name",
        "is empty: a name expected",
        2,
        "<sdf version='1.7'>\n<model name=''><link name='l'/></model></sdf>",
    ),
    broken(
        "reserved name",
        "the name `__model__` is reserved",
        3,
        "<sdf version='1.7'><model name='m'>\n<link name='l'/>\n<link name='__model__'/></model></sdf>",
    ),
    broken(
        "delimiter in a name",
        "delimiter of scopes",
        2,
        "<sdf version='1.8'>\n<model name='a::b'><link name='l'/></model></sdf>",
    ),
    broken(
        "two links of a name",
        "the name `l` is already taken by a link",
        3,
        "<sdf version='1.5'><model name='m'>\n<link name='l'/>\n<link name='l'/></model></sdf>",
    ),
    broken(
        "link and frame of a name",
        "the name `l` is already taken by a link",
        3,
        "<sdf version='1.7'><model name='m'>\n<link name='l'/>\n<frame name='l'/></model></sdf>",
    ),
    broken(
        "two models of a name",
        "already taken by a model",
        3,
        "<sdf version='1.7'><world name='w'>\n<model name='m'><link name='l'/></model>\n<model name='m'><link name='l'/></model></world></sdf>",
    ),
    broken(
        "two collisions of a name",
        "has another collision `c`",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'>\n<collision name='c'><geometry><sphere/></geometry></collision>\n<collision name='c'><geometry><sphere/></geometry></collision></link></model></sdf>",
    ),
    // Values
    broken(
        "number with letters",
        "<mass> should be a finite number, found `1kg`",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<mass>1kg</mass></inertial></link></model></sdf>",
    ),
    broken(
        "not a number",
        "<mass> should be a finite number, found `nan`",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<mass>nan</mass></inertial></link></model></sdf>",
    ),
    broken(
        "empty value",
        "<mass> is empty",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<mass/></inertial></link></model></sdf>",
    ),
    broken(
        "overflowing number",
        "<gravity> should hold finite numbers",
        2,
        "<sdf version='1.7'><world name='w'>\n<gravity>0 0 -1e999</gravity></world></sdf>",
    ),
    broken(
        "odd truth value",
        "<static> should be true or false, found `maybe`",
        2,
        "<sdf version='1.7'><model name='m'>\n<static>maybe</static><link name='l'/></model></sdf>",
    ),
    broken(
        "five numbers in a pose",
        "<pose> should be 6 numbers, found 5",
        2,
        "<sdf version='1.7'><model name='m'>\n<pose>0 0 0 0 0</pose><link name='l'/></model></sdf>",
    ),
    broken(
        "letters in a pose",
        "found `x`",
        2,
        "<sdf version='1.7'><model name='m'>\n<pose>x 0 0 0 0 0</pose><link name='l'/></model></sdf>",
    ),
    broken(
        "quaternion of six",
        "<pose> should be 7 numbers, found 6",
        2,
        "<sdf version='1.9'><model name='m'>\n<pose rotation_format='quat_xyzw'>0 0 0 0 0 0</pose><link name='l'/></model></sdf>",
    ),
    broken(
        "quaternion of zeros",
        "the quaternion is zero",
        2,
        "<sdf version='1.9'><model name='m'>\n<pose rotation_format='quat_xyzw'>0 0 0 0 0 0 0</pose><link name='l'/></model></sdf>",
    ),
    broken(
        "unknown rotation format",
        "rotation format `matrix` is unknown",
        2,
        "<sdf version='1.9'><model name='m'>\n<pose rotation_format='matrix'>0 0 0 0 0 0</pose><link name='l'/></model></sdf>",
    ),
    broken(
        "negative step",
        "<max_step_size> must be positive",
        2,
        "<sdf version='1.7'><world name='w'><physics type='ode'>\n<max_step_size>-0.001</max_step_size></physics></world></sdf>",
    ),
    broken(
        "unknown solver",
        "the solver `quik` is unknown",
        2,
        "<sdf version='1.7'><world name='w'><physics type='ode'><ode><solver>\n<type>quik</type></solver></ode></physics></world></sdf>",
    ),
    broken(
        "no iterations",
        "at least one iteration",
        2,
        "<sdf version='1.7'><world name='w'><physics type='ode'><ode><solver>\n<iters>0</iters></solver></ode></physics></world></sdf>",
    ),
    broken(
        "error reduction above 1",
        "between 0 and 1, found 1.5",
        2,
        "<sdf version='1.7'><world name='w'><physics type='ode'><ode><constraints>\n<erp>1.5</erp></constraints></ode></physics></world></sdf>",
    ),
    // Mass
    broken(
        "negative mass",
        "the mass must be positive, found -2",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'>\n<inertial>\n<mass>-2</mass></inertial></link></model></sdf>",
    ),
    broken(
        "no mass",
        "the mass must be positive, found 0",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<mass>0</mass></inertial></link></model></sdf>",
    ),
    broken(
        "triangle inequality",
        "violates the triangle inequality",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<inertia><ixx>1</ixx><iyy>1</iyy><izz>5</izz></inertia></inertial></link></model></sdf>",
    ),
    broken(
        "negative moment",
        "not positive definite",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<inertia><ixx>-1</ixx></inertia></inertial></link></model></sdf>",
    ),
    broken(
        "products too large",
        "not positive definite",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><inertial>\n<inertia><ixy>2</ixy></inertia></inertial></link></model></sdf>",
    ),
    broken(
        "automatic without collision",
        "no collision gives it a volume",
        2,
        "<sdf version='1.11'><model name='m'><link name='l'>\n<inertial auto='true'/></link></model></sdf>",
    ),
    broken(
        "negative density",
        "<density> must be positive",
        2,
        "<sdf version='1.11'><model name='m'><link name='l'><inertial auto='true'>\n<density>-1</density></inertial></link></model></sdf>",
    ),
    // Shapes
    broken(
        "no geometry",
        "<collision> needs a <geometry>",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'>\n<collision name='c'/></link></model></sdf>",
    ),
    broken(
        "no shape",
        "holds no shape",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'>\n<geometry/></collision></link></model></sdf>",
    ),
    broken(
        "two shapes",
        "holds a box and a sphere",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><box/>\n<sphere/></geometry></collision></link></model></sdf>",
    ),
    broken(
        "radius of zero",
        "<radius> must be positive, found 0",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><sphere>\n<radius>0</radius></sphere></geometry></collision></link></model></sdf>",
    ),
    broken(
        "flat box",
        "must be positive, found -1",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><box>\n<size>1 1 -1</size></box></geometry></collision></link></model></sdf>",
    ),
    broken(
        "plane without direction",
        "normal of a plane must not be zero",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><plane>\n<normal>0 0 0</normal></plane></geometry></collision></link></model></sdf>",
    ),
    broken(
        "mesh without uri",
        "<mesh> needs a <uri>",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry>\n<mesh/></geometry></collision></link></model></sdf>",
    ),
    broken(
        "polyline of two points",
        "needs 3 points, found 2",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry>\n<polyline><point>0 0</point><point>1 0</point></polyline></geometry></collision></link></model></sdf>",
    ),
    broken(
        "negative friction",
        "<mu> must not be negative",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><box/></geometry><surface><friction><ode>\n<mu>-1</mu></ode></friction></surface></collision></link></model></sdf>",
    ),
    broken(
        "restitution above 1",
        "lies between 0 and 1, found 2",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><box/></geometry><surface><bounce>\n<restitution_coefficient>2</restitution_coefficient></bounce></surface></collision></link></model></sdf>",
    ),
    // Frames
    broken("model without links", "model `m` has no link", 2, "<sdf version='1.7'>\n<model name='m'/></sdf>"),
    broken(
        "unknown frame",
        "no link, joint, frame or model `x` in model `m`",
        2,
        "<sdf version='1.7'><model name='m'>\n<link name='l'><pose relative_to='x'/></link></model></sdf>",
    ),
    broken(
        "pose relative to itself",
        "the pose of `l` is relative to itself",
        2,
        "<sdf version='1.7'><model name='m'>\n<link name='l'><pose relative_to='l'/></link></model></sdf>",
    ),
    broken(
        "poses in a circle",
        "relative to each other in a circle",
        2,
        "<sdf version='1.7'><model name='m'>\n<link name='a'><pose relative_to='b'/></link>\n<link name='b'><pose relative_to='f'/></link>\n<frame name='f' attached_to='a'/></model></sdf>",
    ),
    broken(
        "frames attached in a circle",
        "circle",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n\n<frame name='a' attached_to='b'><pose relative_to='l'/></frame><frame name='b' attached_to='a'><pose relative_to='l'/></frame></model></sdf>",
    ),
    broken(
        "looking out of a model",
        "no link, joint, frame or model `o`",
        3,
        "<sdf version='1.8'><model name='m'><link name='o'/>\n<model name='n'>\n<link name='l'><pose relative_to='o'/></link></model></model></sdf>",
    ),
    broken(
        "canonical link is none",
        "canonical link `f` is not a link",
        2,
        "<sdf version='1.7'>\n<model name='m' canonical_link='f'><link name='l'/><frame name='f'/></model></sdf>",
    ),
    broken(
        "unknown placement frame",
        "no link, joint, frame or model `p`",
        2,
        "<sdf version='1.8'>\n<model name='m' placement_frame='p'><link name='l'/></model></sdf>",
    ),
    // Joints
    broken(
        "unknown joint type",
        "joint type `hinge` is unknown",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='hinge'/></model></sdf>",
    ),
    broken(
        "joint without a parent",
        "<joint> needs a <parent>",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='fixed'><child>l</child></joint></model></sdf>",
    ),
    broken(
        "unknown child",
        "`arn` in model `m`",
        3,
        "<sdf version='1.7'><model name='m'><link name='arm'/>\n<joint name='j' type='fixed'><parent>world</parent>\n<child>arn</child></joint></model></sdf>",
    ),
    broken(
        "child is the world",
        "cannot be the world",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='fixed'><parent>l</parent>\n<child>world</child></joint></model></sdf>",
    ),
    broken(
        "joined to itself",
        "which is the same body",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='fixed'><parent>l</parent>\n<child>l</child></joint></model></sdf>",
    ),
    broken(
        "joined to its own frame",
        "which is the same body",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/><frame name='f' attached_to='l'/>\n<joint name='j' type='fixed'><parent>f</parent>\n<child>l</child></joint></model></sdf>",
    ),
    broken(
        "no axis",
        "a revolute joint needs an <axis>",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child></joint></model></sdf>",
    ),
    broken(
        "no second axis",
        "a universal joint needs an <axis2>",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='universal'><parent>world</parent><child>l</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>",
    ),
    broken(
        "axis of zero",
        "axis of a joint must not be zero",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child><axis>\n<xyz>0 0 0</xyz></axis></joint></model></sdf>",
    ),
    broken(
        "axis in an unknown frame",
        "`base` in model `m`",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child><axis>\n<xyz expressed_in='base'>0 0 1</xyz></axis></joint></model></sdf>",
    ),
    broken(
        "limits crossed",
        "the lower limit 1 is above the upper limit -1",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child><axis><limit>\n<lower>1</lower><upper>-1</upper></limit></axis></joint></model></sdf>",
    ),
    broken(
        "negative damping",
        "<damping> must not be negative",
        3,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child><axis><dynamics>\n<damping>-1</damping></dynamics></axis></joint></model></sdf>",
    ),
    broken(
        "screw without pitch",
        "pitch of a screw must not be zero",
        3,
        "<sdf version='1.10'><model name='m'><link name='l'/>\n<joint name='j' type='screw'><parent>world</parent><child>l</child><axis/>\n<screw_thread_pitch>0</screw_thread_pitch></joint></model></sdf>",
    ),
    broken(
        "gearbox without reference",
        "needs a <gearbox_reference_body>",
        2,
        "<sdf version='1.7'><model name='m'><link name='l'/>\n<joint name='j' type='gearbox'><parent>world</parent><child>l</child></joint></model></sdf>",
    ),
    broken(
        "mimic of a link",
        "it is not a joint",
        3,
        "<sdf version='1.11'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child><axis>\n<mimic joint='l'/></axis></joint></model></sdf>",
    ),
    broken(
        "mimic of itself",
        "cannot mimic itself",
        3,
        "<sdf version='1.11'><model name='m'><link name='l'/>\n<joint name='j' type='revolute'><parent>world</parent><child>l</child><axis>\n<mimic joint='j'/></axis></joint></model></sdf>",
    ),
    broken(
        "mimics in a circle",
        "mimics itself, by way of others",
        2,
        "<sdf version='1.11'><model name='m'><link name='l'/><link name='k'/>\n<joint name='i' type='revolute'><parent>world</parent><child>l</child><axis><mimic joint='j'/></axis></joint>\n<joint name='j' type='revolute'><parent>l</parent><child>k</child><axis><mimic joint='i'/></axis></joint></model></sdf>",
    ),
    // Includes
    broken(
        "include without uri",
        "<include> needs a <uri>",
        2,
        "<sdf version='1.7'><world name='w'>\n<include/></world></sdf>",
    ),
    broken(
        "include not found",
        "`model://nowhere_at_all` is not found",
        3,
        "<sdf version='1.7'><world name='w'>\n<include>\n<uri>model://nowhere_at_all</uri></include></world></sdf>",
    ),
    broken(
        "include from the net",
        "`https://` is not supported",
        2,
        "<sdf version='1.7'><world name='w'><include>\n<uri>https://example.org/model</uri></include></world></sdf>",
    ),
    // URDF
    broken("robot without links", "the robot has no link", 1, "<robot name='r'/>"),
    broken("robot without a name", "needs an attribute `name`", 1, "<robot><link name='l'/></robot>"),
    broken(
        "link twice",
        "the name `l` is already taken by a link",
        3,
        "<robot name='r'>\n<link name='l'/>\n<link name='l'/></robot>",
    ),
    broken(
        "joint to nowhere",
        "names a link `arn`, which there is not",
        4,
        "<robot name='r'>\n<link name='base'/><link name='arm'/>\n<joint name='j' type='fixed'><parent link='base'/>\n<child link='arn'/></joint></robot>",
    ),
    broken(
        "two parents",
        "is the child of joint `i` and of joint `j`",
        4,
        "<robot name='r'>\n<link name='a'/><link name='b'/><link name='c'/>\n<joint name='i' type='fixed'><parent link='a'/><child link='c'/></joint>\n<joint name='j' type='fixed'><parent link='b'/><child link='c'/></joint></robot>",
    ),
    broken(
        "two roots in a robot",
        "one root is allowed",
        3,
        "<robot name='r'>\n<link name='a'/>\n<link name='b'/></robot>",
    ),
    broken(
        "joints in a circle",
        "go round in a circle",
        3,
        "<robot name='r'>\n<link name='a'/><link name='b'/>\n<joint name='i' type='fixed'><parent link='a'/><child link='b'/></joint>\n<joint name='j' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
    ),
    broken(
        "link on itself",
        "joins link `a` to itself",
        3,
        "<robot name='r'>\n<link name='a'/>\n<joint name='i' type='fixed'><parent link='a'/><child link='a'/></joint></robot>",
    ),
    broken(
        "unknown URDF joint type",
        "joint type `ball` is unknown",
        3,
        "<robot name='r'>\n<link name='a'/><link name='b'/>\n<joint name='i' type='ball'><parent link='a'/><child link='b'/></joint></robot>",
    ),
    broken(
        "revolute without limit",
        "a revolute joint needs a <limit>",
        3,
        "<robot name='r'>\n<link name='a'/><link name='b'/>\n<joint name='i' type='revolute'><parent link='a'/><child link='b'/></joint></robot>",
    ),
    broken(
        "URDF negative mass",
        "must not be negative, found -1",
        2,
        "<robot name='r'><link name='a'><inertial>\n<mass value='-1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link></robot>",
    ),
    broken(
        "URDF mass is a word",
        "attribute `value` should be a finite number",
        2,
        "<robot name='r'><link name='a'><inertial>\n<mass value='heavy'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link></robot>",
    ),
    broken(
        "URDF without mass",
        "<inertial> needs a <mass>",
        2,
        "<robot name='r'><link name='a'>\n<inertial><inertia ixx='1' iyy='1' izz='1'/></inertial></link></robot>",
    ),
    broken(
        "URDF triangle inequality",
        "violates the triangle inequality",
        3,
        "<robot name='r'><link name='a'><inertial>\n<mass value='1'/>\n<inertia ixx='1' iyy='1' izz='3'/></inertial></link></robot>",
    ),
    broken(
        "URDF box of two",
        "should be 3 numbers, found 2",
        2,
        "<robot name='r'><link name='a'><collision><geometry>\n<box size='1 1'/></geometry></collision></link></robot>",
    ),
    broken(
        "URDF origin of two",
        "attribute `xyz` should be 3 numbers, found 2",
        2,
        "<robot name='r'><link name='a'><collision>\n<origin xyz='1 1'/><geometry><sphere radius='1'/></geometry></collision></link></robot>",
    ),
    broken(
        "URDF sphere without radius",
        "<sphere> needs an attribute `radius`",
        2,
        "<robot name='r'><link name='a'><collision><geometry>\n<sphere/></geometry></collision></link></robot>",
    ),
    broken(
        "URDF mimic of nothing",
        "no link, joint, frame or model `x`",
        4,
        "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\n<link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\n<joint name='j' type='continuous'><parent link='a'/><child link='b'/>\n<mimic joint='x'/></joint></robot>",
    ),
    broken(
        "URDF moving without mass",
        "can move but has no mass",
        2,
        "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\n<link name='b'/>\n<link name='c'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\n<joint name='i' type='continuous'><parent link='a'/><child link='b'/></joint>\n<joint name='j' type='continuous'><parent link='b'/><child link='c'/></joint></robot>",
    ),
];

fn options() -> LoadOptions {
    LoadOptions { use_environment: false, ..LoadOptions::default() }
}

#[test]
fn each_broken_file_gives_an_error_with_its_line() {
    let mut wrong = Vec::new();
    for case in BROKEN {
        match load_str("broken.xml", case.text, &options()) {
            Ok(_) => wrong.push(format!("{}: was read", case.name)),
            Err(error) => {
                if !error.message().contains(case.says) || error.line() != Some(case.line) {
                    wrong.push(format!("{}: line {:?}: {}", case.name, error.line(), error.message()));
                }
                let text = error.to_string();
                let place = format!("broken.xml:{}:", case.line);
                if !text.contains(&place) || error.file() != Some("broken.xml") {
                    wrong.push(format!("{}: printed as {text}", case.name));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {} are wrong:\n{}", wrong.len(), BROKEN.len(), wrong.join("\n"));
    assert!(BROKEN.len() >= 50);
}

#[test]
fn suggestions_are_made_for_slips() {
    let help = |name: &str| {
        let case = BROKEN.iter().find(|case| case.name == name).expect("a case of this name");
        load_str("t", case.text, &options()).expect_err(name).help().map(str::to_owned)
    };
    assert_eq!(help("unknown child").as_deref(), Some("did you mean `arm`?"));
    assert_eq!(help("unknown solver").as_deref(), Some("did you mean `quick`?"));
    assert_eq!(help("joint to nowhere").as_deref(), Some("did you mean `arm`?"));
}

/// Files that are cut off or have a character lost or changed: whatever comes out, nothing panics.
#[test]
fn damaged_files_do_not_panic() {
    let whole = include_str!("data/kitchen_sink.sdf");
    let robot = include_str!("data/robot.urdf");
    let (mut read, mut refused) = (0, 0);
    for text in [whole, robot] {
        let places: Vec<usize> = text.char_indices().map(|(at, _)| at).step_by(7).collect();
        for &at in &places {
            let end = at + text[at..].chars().next().map_or(0, char::len_utf8);
            for damaged in [
                text[..at].to_owned(),
                format!("{}{}", &text[..at], &text[end..]),
                format!("{}9{}", &text[..at], &text[end..]),
                format!("{}<{}", &text[..at], &text[at..]),
            ] {
                match load_str("damaged", &damaged, &options()) {
                    Ok(loaded) => {
                        read += 1;
                        if let Ok(mut world) = build(&loaded.scene, &BuildOptions::default()) {
                            // A step may be refused, but nothing more.
                            let _ = world.step().and_then(|_| world.step());
                        }
                    }
                    Err(error) => {
                        refused += 1;
                        assert!(!error.to_string().is_empty());
                    }
                }
            }
        }
    }
    assert!(read > 100 && refused > 100, "{read} read, {refused} refused");
}

#[test]
fn models_nested_without_end_are_refused() {
    let deep = 5_000;
    let mut text = String::from("<sdf version='1.8'>\n");
    for level in 0..deep {
        text.push_str(&format!("<model name='m{level}'><link name='l'/>"));
    }
    text.push_str(&"</model>".repeat(deep));
    text.push_str("</sdf>");
    let error = load_str("deep", &text, &options()).expect_err("too deep");
    assert!(error.message().contains("nested more than"), "{}", error.message());
    assert_eq!(error.line(), Some(2));
}

#[test]
fn long_chains_of_frames_are_followed() {
    let links = 20_000;
    let mut text = String::from("<sdf version='1.8'><model name='m'><link name='l0'/>");
    for link in 1..links {
        text.push_str(&format!(
            "<link name='l{link}'><pose relative_to='l{}'>1 0 0 0 0 0</pose></link>",
            link - 1
        ));
    }
    text.push_str("</model></sdf>");
    let scene = load_str("chain", &text, &options()).expect("a long chain").scene;
    assert_eq!(scene.links[links - 1].pose.position.x, (links - 1) as f64);
}
