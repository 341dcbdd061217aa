// The tank and its gauge: publishes the level, which rises while the pump runs and falls all the time.
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>

namespace
{

bool g_pumping = false;

void pumpSwitched(const std_msgs::Bool::ConstPtr &on)
{
  g_pumping = on->data;
}

} // namespace

int main(int argc, char **argv)
{
  ros::init(argc, argv, "gauge");
  ros::NodeHandle node;
  ros::NodeHandle own("~");
  double rate = 10.0;
  double outflow = 0.5;
  own.getParam("rate", rate);
  own.getParam("outflow", outflow);
  ros::Publisher publisher = node.advertise<std_msgs::Float64>("level", 10);
  ros::Subscriber subscriber = node.subscribe("pump", 10, pumpSwitched);
  double level = 5.0;
  ros::Rate pace(rate);
  while (ros::ok())
  {
    level += ((g_pumping ? 2.0 : 0.0) - outflow) / rate;
    std_msgs::Float64 message;
    message.data = level;
    publisher.publish(message);
    ros::spinOnce();
    pace.sleep();
  }
  return 0;
}
