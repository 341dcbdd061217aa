// tf2_ros::StaticTransformBroadcaster: tells transforms that hold for ever, on /tf_static, also to those who come later.
#ifndef TF2_ROS_STATICTRANSFORMBROADCASTER_H
#define TF2_ROS_STATICTRANSFORMBROADCASTER_H

#include <tf2_msgs/TFMessage.h>

#include <geometry_msgs/TransformStamped.h>

#include <vector>

#include "ros/ros.h"
#include "roscfe/frames/transforms_message.h"

namespace tf2_ros
{

class StaticTransformBroadcaster
{
  public:
    StaticTransformBroadcaster()
    {
        publisher_ = node_.advertise<roscfe::frames::Transforms>("/tf_static", 100, true);
    }

    // All that were sent are sent again with each new one, since only the last message is kept.
    void sendTransform(const geometry_msgs::TransformStamped &transform)
    {
        keep(transform);
        send();
    }
    void sendTransform(const std::vector<geometry_msgs::TransformStamped> &transforms)
    {
        for (const geometry_msgs::TransformStamped &each : transforms)
        {
            keep(each);
        }
        send();
    }

  private:
    void keep(const geometry_msgs::TransformStamped &transform)
    {
        for (geometry_msgs::TransformStamped &each : sent_)
        {
            if (each.child_frame_id == transform.child_frame_id)
            {
                each = transform;
                return;
            }
        }
        sent_.push_back(transform);
    }
    void send() { publisher_.publish(roscfe::frames::Transforms{sent_.data(), sent_.size()}); }

    ros::NodeHandle                              node_;
    ros::Publisher                               publisher_;
    std::vector<geometry_msgs::TransformStamped> sent_;
};

} // namespace tf2_ros

#endif
