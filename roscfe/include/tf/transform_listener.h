// tf::TransformListener: a buffer with tf's interface that is filled with what is told on /tf and /tf_static.
#ifndef TF_TRANSFORMLISTENER_H
#define TF_TRANSFORMLISTENER_H

#include <sensor_msgs/PointCloud.h>

#include <std_msgs/Empty.h>

#include <string>

#if defined(ROSCFE_PROFILE_HOST) // these three come with ROS's header, and nodes rely on it
#include "boost/thread/condition_variable.hpp"
#include "boost/thread/shared_mutex.hpp"
#include "boost/thread/thread_only.hpp"
#endif

#include "ros/callback_queue.h"
#include "ros/ros.h"
#include "tf/tf.h"
#include "tf2_ros/transform_listener.h"

namespace tf
{

inline std::string getPrefixParam(ros::NodeHandle &nh)
{
    std::string key, prefix;
    if (nh.searchParam("tf_prefix", key))
    {
        nh.getParam(key, prefix);
    }
    return prefix;
}

inline std::string remap(const FrameName &frame_id)
{
    ros::NodeHandle node("~");
    return resolve(getPrefixParam(node), frame_id);
}

class TransformListener : public Transformer
{
  public:
    TransformListener(ros::Duration max_cache_time = ros::Duration(DEFAULT_CACHE_TIME), bool spin_thread = true)
        : TransformListener(ros::NodeHandle(), max_cache_time, spin_thread)
    {
    }
    TransformListener(const ros::NodeHandle &nh, ros::Duration max_cache_time = ros::Duration(DEFAULT_CACHE_TIME),
                      bool spin_thread = true)
        : Transformer(true, max_cache_time), node_(nh), tf2_listener_(*tf2_buffer_ptr_, nh, spin_thread)
    {
    }

    using Transformer::transformPoint;
    using Transformer::transformPose;
    using Transformer::transformQuaternion;
    using Transformer::transformVector;

    void transformQuaternion(const FrameName &target_frame, const geometry_msgs::QuaternionStamped &stamped_in,
                             geometry_msgs::QuaternionStamped &stamped_out) const
    {
        Stamped<Quaternion> in, out;
        assertQuaternionValid(stamped_in.quaternion);
        quaternionStampedMsgToTF(stamped_in, in);
        transformQuaternion(target_frame, in, out);
        quaternionStampedTFToMsg(out, stamped_out);
    }
    void transformVector(const FrameName &target_frame, const geometry_msgs::Vector3Stamped &stamped_in,
                         geometry_msgs::Vector3Stamped &stamped_out) const
    {
        Stamped<Vector3> in, out;
        vector3StampedMsgToTF(stamped_in, in);
        transformVector(target_frame, in, out);
        vector3StampedTFToMsg(out, stamped_out);
    }
    void transformPoint(const FrameName &target_frame, const geometry_msgs::PointStamped &stamped_in,
                        geometry_msgs::PointStamped &stamped_out) const
    {
        Stamped<Point> in, out;
        pointStampedMsgToTF(stamped_in, in);
        transformPoint(target_frame, in, out);
        pointStampedTFToMsg(out, stamped_out);
    }
    void transformPose(const FrameName &target_frame, const geometry_msgs::PoseStamped &stamped_in,
                       geometry_msgs::PoseStamped &stamped_out) const
    {
        Stamped<Pose> in, out;
        assertQuaternionValid(stamped_in.pose.orientation);
        poseStampedMsgToTF(stamped_in, in);
        transformPose(target_frame, in, out);
        poseStampedTFToMsg(out, stamped_out);
    }

    // The same at another time, by way of a frame that does not move in between.
    void transformQuaternion(const FrameName &target_frame, const ros::Time &target_time,
                             const geometry_msgs::QuaternionStamped &qin, const FrameName &fixed_frame,
                             geometry_msgs::QuaternionStamped &qout) const
    {
        Stamped<Quaternion> in, out;
        assertQuaternionValid(qin.quaternion);
        quaternionStampedMsgToTF(qin, in);
        transformQuaternion(target_frame, target_time, in, fixed_frame, out);
        quaternionStampedTFToMsg(out, qout);
    }
    void transformVector(const FrameName &target_frame, const ros::Time &target_time,
                         const geometry_msgs::Vector3Stamped &vin, const FrameName &fixed_frame,
                         geometry_msgs::Vector3Stamped &vout) const
    {
        Stamped<Vector3> in, out;
        vector3StampedMsgToTF(vin, in);
        transformVector(target_frame, target_time, in, fixed_frame, out);
        vector3StampedTFToMsg(out, vout);
    }
    void transformPoint(const FrameName &target_frame, const ros::Time &target_time,
                        const geometry_msgs::PointStamped &pin, const FrameName &fixed_frame,
                        geometry_msgs::PointStamped &pout) const
    {
        Stamped<Point> in, out;
        pointStampedMsgToTF(pin, in);
        transformPoint(target_frame, target_time, in, fixed_frame, out);
        pointStampedTFToMsg(out, pout);
    }
    void transformPose(const FrameName &target_frame, const ros::Time &target_time,
                       const geometry_msgs::PoseStamped &pin, const FrameName &fixed_frame,
                       geometry_msgs::PoseStamped &pout) const
    {
        Stamped<Pose> in, out;
        assertQuaternionValid(pin.pose.orientation);
        poseStampedMsgToTF(pin, in);
        transformPose(target_frame, target_time, in, fixed_frame, out);
        poseStampedTFToMsg(out, pout);
    }

    // Clouds are sensor_msgs/PointCloud, which the node includes.
    template <class Cloud>
    void transformPointCloud(const FrameName &target_frame, const Cloud &pcin, Cloud &pcout) const
    {
        StampedTransform transform;
        lookupTransform(target_frame, pcin.header.frame_id, pcin.header.stamp, transform);
        transform_cloud(target_frame, transform, pcin.header.stamp, pcin, pcout);
    }
    template <class Cloud>
    void transformPointCloud(const FrameName &target_frame, const ros::Time &target_time, const Cloud &pcin,
                             const FrameName &fixed_frame, Cloud &pcout) const
    {
        StampedTransform transform;
        lookupTransform(target_frame, target_time, pcin.header.frame_id, pcin.header.stamp, fixed_frame, transform);
        transform_cloud(target_frame, transform, target_time, pcin, pcout);
    }

    // Callback for a service of type tf/FrameGraph.
    template <class Request, class Response>
    bool getFrames(Request &, Response &res)
    {
        res.dot_graph = allFramesAsDot();
        return true;
    }

    std::string resolve(const FrameName &frame_name)
    {
        ros::NodeHandle node("~");
        return tf::resolve(getPrefixParam(node), frame_name);
    }

  protected:
    bool ok() const override { return ros::ok(); }

  private:
    template <class Cloud>
    static void transform_cloud(const FrameName &target_frame, const Transform &transform, const ros::Time &time,
                                const Cloud &pcin, Cloud &pcout)
    {
        pcout                 = pcin;
        pcout.header.stamp    = time;
        pcout.header.frame_id = target_frame.view();
        for (auto &each : pcout.points)
        {
            const Vector3 point = transform * Vector3(each.x, each.y, each.z);
            each.x              = static_cast<float>(point.x());
            each.y              = static_cast<float>(point.y());
            each.z              = static_cast<float>(point.z());
        }
    }

    ros::NodeHandle            node_;
    tf2_ros::TransformListener tf2_listener_;
};

} // namespace tf

#endif
