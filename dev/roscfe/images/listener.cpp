#include "ros/ros.h"
#include "std_msgs/UInt32.h"

void heard(const std_msgs::UInt32::ConstPtr &message)
{
  ROS_INFO("heard %u", message->data);
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "listener");
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("chatter", 1, heard);
  ros::spin();
  return 0;
}
