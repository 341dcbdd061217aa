// tf2_ros::TransformListener: fills a buffer with what is told on /tf and /tf_static.
#ifndef TF2_ROS_TRANSFORMLISTENER_H
#define TF2_ROS_TRANSFORMLISTENER_H

#include <tf2_msgs/TFMessage.h>

#include <boost/thread/recursive_mutex.hpp>

#include <std_msgs/Empty.h>

#if defined(ROSCFE_PROFILE_HOST) // these three come with ROS's header, and nodes rely on it
#include "boost/thread/condition_variable.hpp"
#include "boost/thread/shared_mutex.hpp"
#include "boost/thread/thread_only.hpp"
#endif

#include "ros/callback_queue.h"
#include "ros/ros.h"
#include "roscfe/frames/transforms_message.h"
#include "tf2_ros/buffer.h"

namespace tf2_ros
{

// In ROS it has a thread of its own, if `spin_thread` says so. A node on cFE has one task: the buffer is filled whenever
// it waits for anything, in spin, a Rate, a sleep, or a lookup with a timeout.
class TransformListener
{
  public:
    TransformListener(tf2::BufferCore &buffer, bool spin_thread = true,
                      ros::TransportHints transport_hints = ros::TransportHints())
        : TransformListener(buffer, ros::NodeHandle(), spin_thread, transport_hints)
    {
    }
    TransformListener(tf2::BufferCore &buffer, const ros::NodeHandle &nh, bool spin_thread = true,
                      ros::TransportHints = ros::TransportHints())
        : tf_(roscfe::frames::hear(buffer.frames(), nh.resolveName("/tf"), false)),
          tf_static_(roscfe::frames::hear(buffer.frames(), nh.resolveName("/tf_static"), true))
    {
        if (spin_thread)
        {
            buffer.setUsingDedicatedThread(true);
        }
    }
    ~TransformListener()
    {
        roscfe::unsubscribe(tf_);
        roscfe::unsubscribe(tf_static_);
    }
    TransformListener(const TransformListener &) = delete;
    TransformListener &operator=(const TransformListener &) = delete;

  private:
    boost::shared_ptr<roscfe::Subscription> tf_, tf_static_;
};

} // namespace tf2_ros

#endif
