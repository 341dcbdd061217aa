// All functions of the paper's first table, and nothing else of roscpp.
#include "ros/ros.h"
#include "std_msgs/UInt32.h"

uint32_t heard = 0;

void callback(const std_msgs::UInt32 &message)
{
  heard = message.data;
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "table_one");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<std_msgs::UInt32>("chatter", 1);
  ros::Subscriber subscriber = node.subscribe("chatter", 1, callback);
  ros::Rate rate(100);
  std_msgs::UInt32 message;
  while (ros::ok() && heard < 1000)
  {
    message.data = ros::Time::now().sec;
    publisher.publish(message);
    ros::spinOnce();
    rate.sleep();
  }
  ros::spin();
  return 0;
}
