//! Forward kinematics, Jacobians and self-collision of robots described by URDF.
