// tf::TransformBroadcaster: tells transforms on /tf as they change.
#ifndef TF_TRANSFORMBROADCASTER_H
#define TF_TRANSFORMBROADCASTER_H

#include <vector>

#include "tf/tf.h"
#include "tf2_ros/transform_broadcaster.h"

namespace tf
{

class TransformBroadcaster
{
  public:
    void sendTransform(const StampedTransform &transform) { tf2_broadcaster_.sendTransform(message(transform)); }
    void sendTransform(const std::vector<StampedTransform> &transforms)
    {
        std::vector<geometry_msgs::TransformStamped> messages;
        messages.reserve(transforms.size());
        for (const StampedTransform &each : transforms)
        {
            messages.push_back(message(each));
        }
        tf2_broadcaster_.sendTransform(messages);
    }
    void sendTransform(const geometry_msgs::TransformStamped &transform) { tf2_broadcaster_.sendTransform(transform); }
    void sendTransform(const std::vector<geometry_msgs::TransformStamped> &transforms)
    {
        tf2_broadcaster_.sendTransform(transforms);
    }

  private:
    static geometry_msgs::TransformStamped message(const StampedTransform &transform)
    {
        geometry_msgs::TransformStamped made;
        transformStampedTFToMsg(transform, made);
        return made;
    }

    tf2_ros::TransformBroadcaster tf2_broadcaster_;
};

} // namespace tf

#endif
