// A ROS 2 node that follows a policy written by `policy-align export model.json --to c -o policy.c`.
//
// It subscribes to sensor_msgs/JointState, finds the joints of the policy by name, and publishes velocity commands for a
// forward_command_controller. Where nothing was learnt, or a joint is missing, it commands zero.
//
// Text to start from: it is compiled by nothing here. In a package: add_executable(policy_node policy_node.cpp policy.c).

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>

#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/joint_state.hpp"
#include "std_msgs/msg/float64_multi_array.hpp"

extern "C" int policy(const double *x, double *u, double *phi);

// As the head of policy.c names them, in its order.
static const std::array<std::string, 2> JOINTS = {"x", "y"};
static constexpr double FASTEST = 0.5;  // of any joint, in its unit per second

class PolicyNode : public rclcpp::Node {
public:
  PolicyNode() : Node("policy_align") {
    commands_ = create_publisher<std_msgs::msg::Float64MultiArray>("velocity_controller/commands", 1);
    states_ = create_subscription<sensor_msgs::msg::JointState>(
        "joint_states", rclcpp::SensorDataQoS(), [this](const sensor_msgs::msg::JointState &state) { act(state); });
    // A robot whose states stop coming must not go on with the last command.
    watchdog_ = create_wall_timer(std::chrono::milliseconds(100), [this] {
      if ((now() - seen_).seconds() > 0.1) command({});
    });
  }

private:
  void act(const sensor_msgs::msg::JointState &state) {
    std::array<double, JOINTS.size()> x{}, u{};
    for (size_t k = 0; k < JOINTS.size(); k++) {
      const auto at = std::find(state.name.begin(), state.name.end(), JOINTS[k]) - state.name.begin();
      if (static_cast<size_t>(at) >= state.position.size()) return;  // grippers publish on the same topic
      x[k] = state.position[at];
    }
    seen_ = now();
    if (!policy(x.data(), u.data(), nullptr)) {
      RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 1000, "outside the data: stopped");
      u.fill(0.0);
    }
    // All joints slower by one factor, so that the direction stays.
    double fastest = FASTEST;
    for (double v : u) fastest = std::max(fastest, std::abs(v));
    for (double &v : u) v *= FASTEST / fastest;
    command(u);
  }

  void command(const std::array<double, JOINTS.size()> &u) {
    std_msgs::msg::Float64MultiArray message;
    message.data.assign(u.begin(), u.end());
    commands_->publish(message);
  }

  rclcpp::Publisher<std_msgs::msg::Float64MultiArray>::SharedPtr commands_;
  rclcpp::Subscription<sensor_msgs::msg::JointState>::SharedPtr states_;
  rclcpp::TimerBase::SharedPtr watchdog_;
  rclcpp::Time seen_{now()};
};

int main(int argc, char **argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<PolicyNode>());
  rclcpp::shutdown();
}
