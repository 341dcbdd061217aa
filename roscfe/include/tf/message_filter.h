// tf::MessageFilter: passes messages on when their frame can be transformed at their time.
#ifndef TF_MESSAGE_FILTER_H
#define TF_MESSAGE_FILTER_H

#include "tf/tf.h"
#include "tf2_ros/message_filter.h"

namespace tf
{

namespace filter_failure_reasons = tf2_ros::filter_failure_reasons;
typedef tf2_ros::FilterFailureReason FilterFailureReason;
typedef tf2_ros::MessageFilterBase   MessageFilterBase;

template <class M>
class MessageFilter : public tf2_ros::MessageFilter<M>
{
  public:
    // In ROS `max_rate` is how often transforms are looked at; here that is done as they come.
    MessageFilter(Transformer &tf, const std::string &target_frame, std::uint32_t queue_size,
                  ros::NodeHandle nh = ros::NodeHandle(), ros::Duration = ros::Duration(0, 10000000))
        : tf2_ros::MessageFilter<M>(*tf.getTF2BufferPtr(), target_frame, queue_size, nh)
    {
    }
    template <class F>
    MessageFilter(F &f, Transformer &tf, const std::string &target_frame, std::uint32_t queue_size,
                  ros::NodeHandle nh = ros::NodeHandle(), ros::Duration = ros::Duration(0, 10000000))
        : tf2_ros::MessageFilter<M>(f, *tf.getTF2BufferPtr(), target_frame, queue_size, nh)
    {
    }
};

} // namespace tf

#endif
