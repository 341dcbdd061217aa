// The pump: goes on below one level and off above another, unless a service has stopped it.
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>
#include <std_srvs/SetBool.h>

class Pump
{
public:
  Pump() : own_("~")
  {
    own_.param("low", low_, 4.0);
    own_.param("high", high_, 6.0);
    publisher_ = node_.advertise<std_msgs::Bool>("pump", 1, true);
    subscriber_ = node_.subscribe("level", 10, &Pump::levelCame, this);
    server_ = own_.advertiseService("enable", &Pump::enable, this);
    turn(false);
  }

private:
  void levelCame(const std_msgs::Float64::ConstPtr &level)
  {
    if (level->data < 0.0)
    {
      ROS_ERROR_ONCE("the tank is empty");
    }
    if (on_ && level->data > high_)
    {
      turn(false);
    }
    else if (!on_ && enabled_ && level->data < low_)
    {
      turn(true);
    }
  }

  bool enable(std_srvs::SetBool::Request &request, std_srvs::SetBool::Response &response)
  {
    enabled_ = request.data;
    if (!enabled_ && on_)
    {
      turn(false);
    }
    response.success = true;
    response.message = enabled_ ? "enabled" : "stopped";
    return true;
  }

  void turn(bool on)
  {
    on_ = on;
    std_msgs::Bool message;
    message.data = on;
    publisher_.publish(message);
    ROS_INFO("pump %s", on ? "on" : "off");
  }

  ros::NodeHandle node_;
  ros::NodeHandle own_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::ServiceServer server_;
  double low_ = 0.0;
  double high_ = 0.0;
  bool on_ = false;
  bool enabled_ = true;
};

int main(int argc, char **argv)
{
  ros::init(argc, argv, "pump");
  Pump pump;
  ros::spin();
  return 0;
}
