"""A ROS 2 node that follows a policy written by `policy-align export model.json --to onnx -o policy.onnx`.

It subscribes to sensor_msgs/JointState, finds the joints of the policy by name, and publishes velocity commands for a
forward_command_controller. Where nothing was learnt, or a joint is missing, it commands zero.

Text to start from: it is run by nothing here. It needs rclpy, numpy and onnxruntime.
"""

import sys

import numpy as np
import onnxruntime
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

FASTEST = 0.5  # of any joint, in its unit per second
SILENCE = 0.1  # seconds without a state, after which the robot stands still


class PolicyNode(Node):
    def __init__(self, path):
        super().__init__("policy_align")
        self.session = onnxruntime.InferenceSession(path)
        about = self.session.get_modelmeta().custom_metadata_map
        self.joints = about["state"].split(",")
        if about["trust"] == "do not use":
            raise SystemExit(f"{path}: its trust report says: do not use")
        self.get_logger().info(f"joints {self.joints}, learnt at {1 / float(about['time_step']):.0f} Hz")
        self.seen = self.get_clock().now()
        self.commands = self.create_publisher(Float64MultiArray, "velocity_controller/commands", 1)
        self.create_subscription(JointState, "joint_states", self.act, qos_profile_sensor_data)
        self.create_timer(SILENCE, self.watch)

    def act(self, state):
        position = dict(zip(state.name, state.position))
        if not all(joint in position for joint in self.joints):
            return  # grippers publish on the same topic
        self.seen = self.get_clock().now()
        x = np.array([[position[joint] for joint in self.joints]])
        u, support = self.session.run(["u", "support"], {"x": x})
        if not support[0]:
            self.get_logger().warning("outside the data: stopped", throttle_duration_sec=1.0)
            u = np.zeros_like(u)
        # All joints slower by one factor, so that the direction stays.
        self.command(u[0] * (FASTEST / max(FASTEST, np.abs(u).max())))

    def watch(self):
        if (self.get_clock().now() - self.seen).nanoseconds > SILENCE * 1e9:
            self.command(np.zeros(len(self.joints)))

    def command(self, u):
        self.commands.publish(Float64MultiArray(data=u.tolist()))


def main():
    rclpy.init()
    rclpy.spin(PolicyNode(sys.argv[1]))


if __name__ == "__main__":
    main()
