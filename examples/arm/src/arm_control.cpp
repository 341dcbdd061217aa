// The drives and encoders of an arm with seven joints: motor currents in, joint states out, 1,000 times a second.
//
// Subscribes: motor_command (std_msgs/Float64MultiArray, A)
// Publishes:  joint_states (sensor_msgs/JointState), and once a second samples (std_msgs/UInt32) and
//             peak_current (std_msgs/Float32, A)
// Parameters: ~rate (1000 Hz), ~cycles (0: goes on until shutdown)
#include <algorithm>
#include <cmath>

#include <arm/arm.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/UInt32.h>

class ArmControl
{
public:
  ArmControl() : own_("~"), rate_(own_.param("rate", 1000.0)), cycles_(own_.param("cycles", 0))
  {
    states_ = nh_.advertise<sensor_msgs::JointState>("joint_states", 1);
    samples_ = nh_.advertise<std_msgs::UInt32>("samples", 1);
    peaks_ = nh_.advertise<std_msgs::Float32>("peak_current", 1);
    commands_ = nh_.subscribe("motor_command", 1, &ArmControl::heard, this, ros::TransportHints().tcpNoDelay());
    state_.position.assign(arm::kStowed, arm::kStowed + arm::kJoints);
    state_.velocity.assign(arm::kJoints, 0.0);
    state_.effort.assign(arm::kJoints, 0.0);
  }

  void run()
  {
    while (ros::ok() && states_.getNumSubscribers() == 0)
    {
      ros::Duration(0.01).sleep();
    }
    const ros::Time begin = ros::Time::now();
    const int once_a_second = std::max(1, static_cast<int>(rate_));
    ros::Rate rate(rate_);
    int cycle = 0;
    for (; ros::ok() && (cycles_ == 0 || cycle < cycles_); ++cycle)
    {
      state_.header.stamp = ros::Time::now();
      states_.publish(state_);
      if (cycle % once_a_second == 0)
      {
        report(cycle);
      }
      rate.sleep();
      ros::spinOnce();
      step(1.0 / rate_);
    }
    const double seconds = (ros::Time::now() - begin).toSec();
    ros::Duration(0.1).sleep();  // for what is under way
    ros::spinOnce();
    ROS_INFO("%d states in %.3f s, %.1f Hz; %d commands came", cycle, seconds, cycle / seconds, heard_);
    report(cycle);
    ros::spin();
  }

private:
  void heard(const std_msgs::Float64MultiArray::ConstPtr& command)
  {
    ++heard_;
    for (size_t i = 0; i < state_.effort.size() && i < command->data.size(); ++i)
    {
      state_.effort[i] = std::max(-arm::kCurrentLimit, std::min(arm::kCurrentLimit, command->data[i]));
      peak_ = std::max(peak_, static_cast<float>(std::fabs(state_.effort[i])));
    }
  }

  // The current is constant in a period, so that the motion of a joint has a closed form.
  void step(double period)
  {
    for (int i = 0; i < arm::kJoints; ++i)
    {
      const double lost = -std::expm1(-arm::kFriction[i] / arm::kInertia[i] * period);
      const double glide = lost * arm::kInertia[i] / arm::kFriction[i];
      const double settled = state_.effort[i] * arm::kTorquePerAmp[i] / arm::kFriction[i];  // rad/s in the end
      state_.position[i] += glide * state_.velocity[i] + (period - glide) * settled;
      state_.velocity[i] += lost * (settled - state_.velocity[i]);
    }
  }

  void report(int cycle)
  {
    std_msgs::UInt32 samples;
    samples.data = cycle;
    samples_.publish(samples);
    std_msgs::Float32 peak;
    peak.data = peak_;
    peaks_.publish(peak);
    peak_ = 0;
  }

  ros::NodeHandle nh_, own_;
  const double rate_;
  const int cycles_;
  ros::Publisher states_, samples_, peaks_;
  ros::Subscriber commands_;
  sensor_msgs::JointState state_;
  int heard_ = 0;
  float peak_ = 0;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "arm_control");
  ArmControl().run();
  return 0;
}
