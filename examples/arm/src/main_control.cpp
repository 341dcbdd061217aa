// Moves the arm to the debris: computed torque along a minimum-jerk curve, 1,000 times a second.
//
// Subscribes: joint_states (sensor_msgs/JointState)
// Publishes:  motor_command (std_msgs/Float64MultiArray, A), phase (std_msgs/String, latched)
// Parameters: ~rate (1000 Hz), ~cycles (0: goes on until shutdown), ~move_time (4 s), ~tolerance (0.001 rad)
#include <algorithm>
#include <cmath>
#include <string>

#include <arm/arm.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/String.h>

static const double kFrequency = 20.0;  // rad/s, of what is left of an error; it is damped critically

class MainControl
{
public:
  MainControl()
    : own_("~")
    , rate_(own_.param("rate", 1000.0))
    , cycles_(own_.param("cycles", 0))
    , move_time_(own_.param("move_time", 4.0))
    , tolerance_(own_.param("tolerance", 0.001))
  {
    commands_ = nh_.advertise<std_msgs::Float64MultiArray>("motor_command", 1);
    phase_ = nh_.advertise<std_msgs::String>("phase", 1, true);
    states_ = nh_.subscribe("joint_states", 1, &MainControl::heard, this, ros::TransportHints().tcpNoDelay());
    command_.data.assign(arm::kJoints, 0.0);
  }

  void run()
  {
    ros::Rate rate(rate_);
    enter("wait");
    while (ros::ok() && !state_)
    {
      rate.sleep();
      ros::spinOnce();
    }
    const ros::Time begin = ros::Time::now();
    enter("approach");
    int cycle = 0;
    bool there = false;
    for (; ros::ok() && (cycles_ == 0 || cycle < cycles_); ++cycle)
    {
      const double progress = (state_->header.stamp - first_).toSec() / move_time_;
      control(std::min(progress, 1.0));
      commands_.publish(command_);
      if (progress >= 1.1 && !there)
      {
        there = true;
        enter("hold");
        judge();
      }
      rate.sleep();
      ros::spinOnce();
    }
    const double seconds = (ros::Time::now() - begin).toSec();
    ros::Duration(0.1).sleep();  // for what is under way
    ros::spinOnce();
    ROS_INFO("%d commands in %.3f s, %.1f Hz; %d states came", cycle, seconds, cycle / seconds, heard_);
    ros::spin();
  }

private:
  void heard(const sensor_msgs::JointState::ConstPtr& state)
  {
    if (++heard_ == 1)
    {
      first_ = state->header.stamp;
    }
    state_ = state;
  }

  void enter(const std::string& name)
  {
    std_msgs::String message;
    message.data = name;
    phase_.publish(message);
    ROS_INFO("phase %s", name.c_str());
  }

  void control(double x)
  {
    const double rest = 1.0 - x;
    const double way = x * x * x * (10.0 - x * (15.0 - 6.0 * x));
    const double pace = 30.0 * x * x * rest * rest / move_time_;
    const double surge = 60.0 * x * rest * (rest - x) / (move_time_ * move_time_);
    for (int i = 0; i < arm::kJoints; ++i)
    {
      const double span = arm::kContact[i] - arm::kStowed[i];
      const double error = arm::kStowed[i] + span * way - state_->position[i];
      const double drift = span * pace - state_->velocity[i];
      const double acceleration = span * surge + 2.0 * kFrequency * drift + kFrequency * kFrequency * error;
      command_.data[i] =
          (arm::kInertia[i] * acceleration + arm::kFriction[i] * span * pace) / arm::kTorquePerAmp[i];
    }
  }

  void judge()
  {
    double largest = 0;
    for (int i = 0; i < arm::kJoints; ++i)
    {
      largest = std::max(largest, std::fabs(arm::kContact[i] - state_->position[i]));
    }
    if (largest < tolerance_)
    {
      ROS_INFO("capture complete: largest joint error %.6f rad", largest);
    }
    else
    {
      ROS_ERROR("largest joint error %.6f rad, tolerance %g", largest, tolerance_);
    }
  }

  ros::NodeHandle nh_, own_;
  const double rate_;
  const int cycles_;
  const double move_time_, tolerance_;
  ros::Publisher commands_, phase_;
  ros::Subscriber states_;
  sensor_msgs::JointState::ConstPtr state_;
  std_msgs::Float64MultiArray command_;
  ros::Time first_;
  int heard_ = 0;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "main_control");
  MainControl().run();
  return 0;
}
