#include "ros/ros.h"
#include "std_msgs/UInt32.h"

int main(int argc, char **argv)
{
  ros::init(argc, argv, "talker");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<std_msgs::UInt32>("chatter", 1);
  ros::Rate rate(100);
  std_msgs::UInt32 message;
  while (ros::ok())
  {
    ++message.data;
    publisher.publish(message);
    ros::spinOnce();
    rate.sleep();
  }
  return 0;
}
