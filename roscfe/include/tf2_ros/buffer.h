// tf2_ros::Buffer: a buffer of transforms that can wait for them.
#ifndef TF2_ROS_BUFFER_H
#define TF2_ROS_BUFFER_H

#include <bitset> // these three come with ROS's header, and nodes rely on it
#include <deque>
#include <optional>

#include <tf2_msgs/FrameGraph.h>

#include <cstdio>
#include <string>

#include "ros/node_handle.h"
#include "ros/ros.h"
#include "tf2/buffer_core.h"
#include "tf2/convert.h"
#include "tf2_ros/buffer_interface.h"

namespace tf2_ros
{

inline const std::string threading_error =
    "Do not call canTransform or lookupTransform with a timeout unless you are using another thread for populating "
    "data. Without a dedicated thread it will always timeout.  If you have a separate thread servicing tf messages, "
    "call setUsingDedicatedThread(true) on your Buffer instance.";

class Buffer : public BufferInterface, public tf2::BufferCore
{
  public:
    using tf2::BufferCore::canTransform;
    using tf2::BufferCore::lookupTransform;

    // With `debug` the node offers the service ~tf2_frames, which tells the frames.
    Buffer(ros::Duration cache_time = ros::Duration(BufferCore::DEFAULT_CACHE_TIME), bool debug = false)
        : BufferCore(cache_time)
    {
        if (debug)
        {
            ros::NodeHandle node("~");
            frames_server_ = node.advertiseService("tf2_frames", &Buffer::getFrames, this);
        }
    }

    geometry_msgs::TransformStamped lookupTransform(const FrameName &target_frame, const FrameName &source_frame,
                                                    const ros::Time &time, const ros::Duration timeout) const override
    {
        canTransform(target_frame, source_frame, time, timeout);
        return lookupTransform(target_frame, source_frame, time);
    }
    geometry_msgs::TransformStamped lookupTransform(const FrameName &target_frame, const ros::Time &target_time,
                                                    const FrameName &source_frame, const ros::Time &source_time,
                                                    const FrameName &   fixed_frame,
                                                    const ros::Duration timeout) const override
    {
        canTransform(target_frame, target_time, source_frame, source_time, fixed_frame, timeout);
        return lookupTransform(target_frame, target_time, source_frame, source_time, fixed_frame);
    }

    bool canTransform(const FrameName &target_frame, const FrameName &source_frame, const ros::Time &time,
                      const ros::Duration timeout, std::string *errstr = nullptr) const override
    {
        return wait(timeout, errstr,
                    [&](std::string *text) { return canTransform(target_frame, source_frame, time, text); });
    }
    bool canTransform(const FrameName &target_frame, const ros::Time &target_time, const FrameName &source_frame,
                      const ros::Time &source_time, const FrameName &fixed_frame, const ros::Duration timeout,
                      std::string *errstr = nullptr) const override
    {
        return wait(timeout, errstr, [&](std::string *text) {
            return canTransform(target_frame, target_time, source_frame, source_time, fixed_frame, text);
        });
    }

  private:
    // Ask until the answer is yes or the time is over. The node's messages come in meanwhile, also those of /tf.
    template <class Ask>
    bool wait(const ros::Duration &timeout, std::string *errstr, const Ask &ask) const
    {
        if (!timeout.isZero() && !isUsingDedicatedThread())
        {
            if (errstr != nullptr)
            {
                *errstr = threading_error;
            }
            ROS_ERROR("%s", threading_error.c_str());
            return false;
        }
        const ros::Time     start = ros::Time::now(), end = start + timeout;
        const ros::Duration pause(0, 10000000), big_jump(3, 0); // of the clock backwards: waiting makes no sense
        while (ros::Time::now() < end && !ask(nullptr) && ros::Time::now() + big_jump >= start &&
               (ros::ok() || !ros::isInitialized()))
        {
            pause.sleep();
        }
        const bool possible = ask(errstr);
        if (errstr != nullptr)
        {
            char took[96];
            std::snprintf(took, sizeof took, ". canTransform returned after %g timeout was %g.",
                          (ros::Time::now() - start).toSec(), timeout.toSec());
            *errstr += took;
        }
        return possible;
    }

    bool getFrames(tf2_msgs::FrameGraph::Request &, tf2_msgs::FrameGraph::Response &response)
    {
        response.frame_yaml = allFramesAsYAML();
        return true;
    }

    ros::ServiceServer frames_server_;
};

} // namespace tf2_ros

#endif
