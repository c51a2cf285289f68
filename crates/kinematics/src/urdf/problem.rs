use thiserror::Error;

use crate::names::proposal;

/// Largest length (metres), angle (radians), scale or multiplier of a robot. No real robot reaches it, and products
/// of such numbers along a tree stay far below the floating-point limit.
pub(crate) const LARGEST: f64 = 1e6;

/// Largest number of attributes of a tag. An XML reader compares each with all before it.
pub(super) const MOST_ATTRIBUTES: usize = 256;

/// The rule of URDF that a file breaks. Attributes are written `tag.attribute`.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum UrdfProblem {
    /// The outermost tag is not `robot`.
    #[error("the outermost tag is <{found}>, a URDF starts with <robot>; expand xacro files first")]
    RootTag {
        /// The tag found.
        found: String,
    },
    /// The text declares an entity, by which a short text can stand for a very long one.
    #[error("line {line} declares an entity (<!ENTITY); write out in the text what it stands for")]
    Entity {
        /// The line, counted from 1.
        line: usize,
    },
    /// A tag has more attributes than any tag of URDF.
    #[error("a tag that begins in line {line} has more than {MOST_ATTRIBUTES} attributes")]
    ManyAttributes {
        /// The line, counted from 1.
        line: usize,
    },
    /// The version is not one of 1.0, 1.1 and 1.2.
    #[error("URDF version \"{found}\" is not supported; 1.0, 1.1 and 1.2 are")]
    Version {
        /// The version found.
        found: String,
    },
    /// There are no links.
    #[error("it has no links; a robot has at least one")]
    NoLinks,
    /// Two links, or two joints, share one name.
    #[error("its name is used twice; names of links are unique, and so are names of joints")]
    DuplicateName,
    /// A required tag is missing.
    #[error("<{tag}> is missing")]
    MissingTag {
        /// The tag.
        tag: &'static str,
    },
    /// A required attribute is missing.
    #[error("attribute {attribute} is missing")]
    MissingAttribute {
        /// The attribute.
        attribute: &'static str,
    },
    /// A text is not a number.
    #[error("{attribute}: \"{text}\" is not a number (decimal mark is a point, numbers are separated by spaces)")]
    Number {
        /// The attribute.
        attribute: &'static str,
        /// The text.
        text: String,
    },
    /// A number is NaN or infinite.
    #[error("{attribute}: \"{text}\" is not a finite number")]
    NotFinite {
        /// The attribute.
        attribute: &'static str,
        /// The text.
        text: String,
    },
    /// A length, an angle or a factor is too large for any robot; sums along the robot may overflow.
    #[error("{attribute}: {value:e} is too large, {LARGEST:e} is the most; lengths are metres, angles radians")]
    TooLarge {
        /// The attribute.
        attribute: &'static str,
        /// The number, or the product or sum computed from it for mimic joints.
        value: f64,
    },
    /// There are too few or too many numbers.
    #[error("{attribute} has {found} numbers, it needs {expected}")]
    NumberCount {
        /// The attribute.
        attribute: &'static str,
        /// Number found.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// The axis has no direction.
    #[error("axis.xyz is zero and has no direction")]
    ZeroAxis,
    /// The quaternion is zero, which is not a rotation.
    #[error("origin.quat_xyzw is zero, which is not a rotation")]
    ZeroQuaternion,
    /// The joint type does not exist in URDF.
    #[error("unknown joint type \"{found}\"; types are revolute, continuous, prismatic and fixed")]
    JointType {
        /// The given type.
        found: String,
    },
    /// The joint has several degrees of freedom.
    #[error(
        "{kind} joints are not supported; model the base by single joints, or make the joint fixed and place the base outside"
    )]
    UnsupportedJoint {
        /// `floating` or `planar`.
        kind: &'static str,
    },
    /// A joint names a link that does not exist.
    #[error("its {role} link \"{link}\" does not exist{}", proposal(near))]
    UnknownLink {
        /// `parent` or `child`.
        role: &'static str,
        /// The name.
        link: String,
        /// Similar link names, nearest first.
        near: Vec<String>,
    },
    /// A revolute or prismatic joint has no `<limit>`.
    #[error("<limit> is missing; revolute and prismatic joints need one (an unlimited rotation is \"continuous\")")]
    MissingLimit,
    /// A `<limit>` lacks lower or upper, which URDF 1.2 requires.
    #[error("limit.{bound} is missing; URDF 1.2 asks for it")]
    MissingBound {
        /// `lower` or `upper`.
        bound: &'static str,
    },
    /// The lower limit lies above the upper.
    #[error("its lower limit {lower} is above its upper limit {upper}")]
    LimitsInverted {
        /// Lower limit, in radians or metres.
        lower: f64,
        /// Upper limit, in radians or metres.
        upper: f64,
    },
    /// A mimic joint follows a joint that does not exist.
    #[error("it mimics joint \"{target}\", which does not exist{}", proposal(near))]
    MimicTarget {
        /// The name.
        target: String,
        /// Similar joint names, nearest first.
        near: Vec<String>,
    },
    /// A mimic joint follows a joint that cannot move.
    #[error("it mimics joint \"{target}\", which is fixed")]
    MimicOfFixed {
        /// The fixed joint.
        target: String,
    },
    /// Mimic joints follow each other in a cycle, or one follows itself.
    #[error("it mimics itself: {}", path.join(" follows "))]
    MimicCycle {
        /// The joints of the cycle; first and last are the same.
        path: Vec<String>,
    },
    /// A link is the child of two joints.
    #[error("it is the child of joints \"{first}\" and \"{second}\"; loops cannot be modelled, cut one")]
    TwoParents {
        /// The joint that comes first in the file.
        first: String,
        /// The other joint.
        second: String,
    },
    /// Joints lead from a link back to itself.
    #[error("joints form a cycle that hangs on no root: {}", joints.join(", "))]
    Cycle {
        /// The joints of the cycle.
        joints: Vec<String>,
    },
    /// A `<geometry>` has no known shape.
    #[error("its collision geometry has no shape; shapes are box, sphere, cylinder, capsule and mesh")]
    UnknownShape,
    /// A length is negative.
    #[error("{attribute}: {value} is negative; lengths are not")]
    NegativeSize {
        /// The attribute.
        attribute: &'static str,
        /// The length, in metres.
        value: f64,
    },
    /// A mass is negative.
    #[error("mass.value: {mass} is negative; masses are not")]
    NegativeMass {
        /// The mass, in kilograms.
        mass: f64,
    },
    /// Several links have no parent.
    #[error("it has several roots: {}; exactly one link may be without a parent joint", roots.join(", "))]
    SeveralRoots {
        /// The links without a parent.
        roots: Vec<String>,
    },
}
