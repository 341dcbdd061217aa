// tf2_ros::TransformBroadcaster: tells transforms on /tf as they change.
#ifndef TF2_ROS_TRANSFORMBROADCASTER_H
#define TF2_ROS_TRANSFORMBROADCASTER_H

#include <geometry_msgs/TransformStamped.h>

#include <vector>

#include "ros/ros.h"
#include "roscfe/frames/transforms_message.h"

namespace tf2_ros
{

class TransformBroadcaster
{
  public:
    TransformBroadcaster() { publisher_ = node_.advertise<roscfe::frames::Transforms>("/tf", 100); }

    void sendTransform(const geometry_msgs::TransformStamped &transform)
    {
        publisher_.publish(roscfe::frames::Transforms{&transform, 1});
    }
    void sendTransform(const std::vector<geometry_msgs::TransformStamped> &transforms)
    {
        publisher_.publish(roscfe::frames::Transforms{transforms.data(), transforms.size()});
    }

  private:
    ros::NodeHandle node_;
    ros::Publisher  publisher_;
};

} // namespace tf2_ros

#endif
