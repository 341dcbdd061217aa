// tf::Transformer: a buffer of transforms with tf's interface; names of frames may begin with a slash.
#ifndef TF_TF_H
#define TF_TF_H

#include <bitset> // these three come with ROS's header, and nodes rely on it
#include <deque>
#include <optional>

#include <geometry_msgs/TwistStamped.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tf/exceptions.h"
#include "tf/transform_datatypes.h"
#include "tf2_ros/buffer.h"

namespace tf
{

enum ErrorValues
{
    NO_ERROR = 0,
    LOOKUP_ERROR,
    CONNECTIVITY_ERROR,
    EXTRAPOLATION_ERROR
};

namespace detail
{

inline std::string_view bare(std::string_view frame)
{
    return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

inline void require(bool good, const char *what, double value)
{
    if (!good)
    {
        std::ostringstream text;
        text << what;
        if (!std::isnan(value))
        {
            text << value << " should be 1.0";
        }
        text << "\n";
        ROSCFE_THROW(InvalidArgument(text.str()));
    }
}

} // namespace detail

inline std::string strip_leading_slash(const FrameName &frame_name)
{
    return std::string(detail::bare(frame_name));
}

// A frame's name behind a prefix, unless it begins with a slash.
inline std::string resolve(const FrameName &prefix, const FrameName &frame_name)
{
    const std::string_view name = frame_name;
    if ((!name.empty() && name[0] == '/') || prefix.view().empty())
    {
        return strip_leading_slash(frame_name);
    }
    return strip_leading_slash(prefix).append("/").append(name);
}

inline std::string remap(const FrameName &prefix, const FrameName &frame_name)
{
    return resolve(prefix, frame_name);
}

// Throw InvalidArgument unless a quaternion has numbers, and about length 1.
inline void assertQuaternionValid(const Quaternion &q)
{
    const double length2 = q.x() * q.x() + q.y() * q.y() + q.z() * q.z() + q.w() * q.w();
    detail::require(!std::isnan(q.x()) && !std::isnan(q.y()) && !std::isnan(q.z()) && !std::isnan(q.w()),
                    "Quaternion contains a NaN", NAN);
    detail::require(!(std::fabs(length2 - 1) > 0.01), "Quaternion malformed, magnitude: ", length2);
}

inline void assertQuaternionValid(const geometry_msgs::Quaternion &q)
{
    assertQuaternionValid(Quaternion(q.x, q.y, q.z, q.w));
}

class Transformer
{
  public:
    static constexpr unsigned int MAX_GRAPH_DEPTH                    = 100;
    static constexpr double       DEFAULT_CACHE_TIME                 = 10.0; // in seconds
    static constexpr int64_t      DEFAULT_MAX_EXTRAPOLATION_DISTANCE = 0;

    Transformer(bool = true, ros::Duration cache_time = ros::Duration(DEFAULT_CACHE_TIME))
        : fall_back_to_wall_time_(false), tf2_buffer_ptr_(std::make_shared<tf2_ros::Buffer>(cache_time))
    {
    }
    virtual ~Transformer() = default;

    void clear() { tf2_buffer_ptr_->clear(); }

    bool setTransform(const StampedTransform &transform, const FrameName &authority = "default_authority")
    {
        geometry_msgs::TransformStamped message;
        transformStampedTFToMsg(transform, message);
        return tf2_buffer_ptr_->setTransform(message, authority);
    }

    // -- transforms ------------------------------------------------------------------------------------------------

    // Throws as tf2::BufferCore::lookupTransform.
    void lookupTransform(const FrameName &target_frame, const FrameName &source_frame, const ros::Time &time,
                         StampedTransform &transform) const
    {
        transformStampedMsgToTF(
            tf2_buffer_ptr_->lookupTransform(detail::bare(target_frame), detail::bare(source_frame), time), transform);
    }
    void lookupTransform(const FrameName &target_frame, const ros::Time &target_time, const FrameName &source_frame,
                         const ros::Time &source_time, const FrameName &fixed_frame, StampedTransform &transform) const
    {
        transformStampedMsgToTF(tf2_buffer_ptr_->lookupTransform(detail::bare(target_frame), target_time,
                                                                 detail::bare(source_frame), source_time,
                                                                 detail::bare(fixed_frame)),
                                transform);
    }

    bool canTransform(const FrameName &target_frame, const FrameName &source_frame, const ros::Time &time,
                      std::string *error_msg = nullptr) const
    {
        return tf2_buffer_ptr_->canTransform(detail::bare(target_frame), detail::bare(source_frame), time, error_msg);
    }
    bool canTransform(const FrameName &target_frame, const ros::Time &target_time, const FrameName &source_frame,
                      const ros::Time &source_time, const FrameName &fixed_frame,
                      std::string *error_msg = nullptr) const
    {
        return tf2_buffer_ptr_->canTransform(detail::bare(target_frame), target_time, detail::bare(source_frame),
                                             source_time, detail::bare(fixed_frame), error_msg);
    }

    bool waitForTransform(const FrameName &target_frame, const FrameName &source_frame, const ros::Time &time,
                          const ros::Duration &timeout, const ros::Duration & = ros::Duration(0, 10000000),
                          std::string *error_msg = nullptr) const
    {
        return tf2_buffer_ptr_->canTransform(detail::bare(target_frame), detail::bare(source_frame), time, timeout,
                                             error_msg);
    }
    bool waitForTransform(const FrameName &target_frame, const ros::Time &target_time, const FrameName &source_frame,
                          const ros::Time &source_time, const FrameName &fixed_frame, const ros::Duration &timeout,
                          const ros::Duration & = ros::Duration(0, 10000000), std::string *error_msg = nullptr) const
    {
        return tf2_buffer_ptr_->canTransform(detail::bare(target_frame), target_time, detail::bare(source_frame),
                                             source_time, detail::bare(fixed_frame), timeout, error_msg);
    }

    // 0, or a number of ErrorValues with its text.
    int getLatestCommonTime(const FrameName &source_frame, const FrameName &target_frame, ros::Time &time,
                            std::string *error_string) const
    {
        return tf2_buffer_ptr_->_getLatestCommonTime(
            tf2_buffer_ptr_->_lookupFrameNumber(detail::bare(target_frame)),
            tf2_buffer_ptr_->_lookupFrameNumber(detail::bare(source_frame)), time, error_string);
    }

    // -- velocities ------------------------------------------------------------------------------------------------

    // How a frame moves, as seen from another one, averaged over a time; expressed in a third frame and of a point.
    void lookupTwist(const FrameName &tracking_frame, const FrameName &observation_frame,
                     const FrameName &reference_frame, const Point &reference_point,
                     const FrameName &reference_point_frame, const ros::Time &time,
                     const ros::Duration &averaging_interval, geometry_msgs::Twist &twist) const
    {
        ros::Time latest;
        getLatestCommonTime(observation_frame, tracking_frame, latest, nullptr);
        const ros::Time at        = time.isZero() ? latest : time;
        const ros::Time end_time  = std::min(at + averaging_interval * 0.5, latest);
        const ros::Time from_zero = ros::Time(0, 10000) + averaging_interval; // the start must not be 0
        const ros::Time start_time = std::max(from_zero, end_time) - averaging_interval;
        const double    seconds    = (end_time - start_time).toSec();

        StampedTransform start, end, tracked;
        lookupTransform(observation_frame, tracking_frame, start_time, start);
        lookupTransform(observation_frame, tracking_frame, end_time, end);
        Quaternion turn;
        (start.getBasis().inverse() * end.getBasis()).getRotation(turn);
        const Vector3 way     = end.getOrigin() - start.getOrigin();
        const Vector3 linear  = Vector3(way.x() / seconds, way.y() / seconds, way.z() / seconds);
        const Vector3 angular = start.getBasis() * turn.getAxis() * (turn.getAngle() / seconds);

        lookupTransform(reference_frame, tracking_frame, at, tracked);
        const Vector3 out_angular = tracked.getBasis() * angular;
        const Vector3 out_linear  = tracked.getBasis() * linear + tracked.getOrigin().cross(out_angular);

        Stamped<Point> origin(Point(0, 0, 0), at, tracking_frame), wanted(reference_point, at, reference_point_frame);
        transformPoint(reference_frame, origin, origin);
        transformPoint(reference_frame, wanted, wanted);
        // tf multiplies by element where a vector product would be right; so does this.
        vector3TFToMsg(out_linear + out_angular * (wanted - origin), twist.linear);
        vector3TFToMsg(out_angular, twist.angular);
    }
    void lookupTwist(const FrameName &tracking_frame, const FrameName &observation_frame, const ros::Time &time,
                     const ros::Duration &averaging_interval, geometry_msgs::Twist &twist) const
    {
        lookupTwist(tracking_frame, observation_frame, observation_frame, Point(0, 0, 0), tracking_frame, time,
                    averaging_interval, twist);
    }

    // -- data in other frames --------------------------------------------------------------------------------------

    void transformQuaternion(const FrameName &target_frame, const Stamped<Quaternion> &stamped_in,
                             Stamped<Quaternion> &stamped_out) const
    {
        assertQuaternionValid(stamped_in);
        apply(target_frame, stamped_in, stamped_out, times<Quaternion>);
    }
    void transformVector(const FrameName &target_frame, const Stamped<Vector3> &stamped_in,
                         Stamped<Vector3> &stamped_out) const
    {
        apply(target_frame, stamped_in, stamped_out, turned);
    }
    void transformPoint(const FrameName &target_frame, const Stamped<Point> &stamped_in,
                        Stamped<Point> &stamped_out) const
    {
        apply(target_frame, stamped_in, stamped_out, times<Point>);
    }
    void transformPose(const FrameName &target_frame, const Stamped<Pose> &stamped_in, Stamped<Pose> &stamped_out) const
    {
        apply(target_frame, stamped_in, stamped_out, times<Pose>);
    }

    void transformQuaternion(const FrameName &target_frame, const ros::Time &target_time,
                             const Stamped<Quaternion> &stamped_in, const FrameName &fixed_frame,
                             Stamped<Quaternion> &stamped_out) const
    {
        assertQuaternionValid(stamped_in);
        apply(target_frame, target_time, stamped_in, fixed_frame, stamped_out, times<Quaternion>);
    }
    void transformVector(const FrameName &target_frame, const ros::Time &target_time,
                         const Stamped<Vector3> &stamped_in, const FrameName &fixed_frame,
                         Stamped<Vector3> &stamped_out) const
    {
        apply(target_frame, target_time, stamped_in, fixed_frame, stamped_out, turned);
    }
    void transformPoint(const FrameName &target_frame, const ros::Time &target_time, const Stamped<Point> &stamped_in,
                        const FrameName &fixed_frame, Stamped<Point> &stamped_out) const
    {
        apply(target_frame, target_time, stamped_in, fixed_frame, stamped_out, times<Point>);
    }
    void transformPose(const FrameName &target_frame, const ros::Time &target_time, const Stamped<Pose> &stamped_in,
                       const FrameName &fixed_frame, Stamped<Pose> &stamped_out) const
    {
        apply(target_frame, target_time, stamped_in, fixed_frame, stamped_out, times<Pose>);
    }

    // -- frames ----------------------------------------------------------------------------------------------------

    void chainAsVector(const FrameName &target_frame, ros::Time target_time, const FrameName &source_frame,
                       ros::Time source_time, const FrameName &fixed_frame, std::vector<std::string> &output) const
    {
        tf2_buffer_ptr_->_chainAsVector(target_frame, target_time, source_frame, source_time, fixed_frame, output);
    }
    std::string allFramesAsString() const { return tf2_buffer_ptr_->allFramesAsString(); }
    std::string allFramesAsDot(double current_time = 0) const { return tf2_buffer_ptr_->_allFramesAsDot(current_time); }
    void        getFrameStrings(std::vector<std::string> &ids) const { tf2_buffer_ptr_->_getFrameStrings(ids); }
    bool        getParent(const FrameName &frame_id, ros::Time time, std::string &parent) const
    {
        return tf2_buffer_ptr_->_getParent(detail::bare(frame_id), time, parent);
    }
    bool frameExists(const FrameName &frame_id) const
    {
        return tf2_buffer_ptr_->_frameExists(detail::bare(frame_id));
    }
    void          setExtrapolationLimit(const ros::Duration &) {} // without effect in ROS, too
    ros::Duration getCacheLength() { return tf2_buffer_ptr_->getCacheLength(); }
    std::string   getTFPrefix() const { return tf_prefix_; }

    void setUsingDedicatedThread(bool value) { tf2_buffer_ptr_->setUsingDedicatedThread(value); }
    bool isUsingDedicatedThread() { return tf2_buffer_ptr_->isUsingDedicatedThread(); }
    std::shared_ptr<tf2_ros::Buffer> getTF2BufferPtr() { return tf2_buffer_ptr_; }

    bool fall_back_to_wall_time_;

  protected:
    ros::Time    now() const { return ros::Time::now(); }
    virtual bool ok() const { return true; }

    std::string                      tf_prefix_;
    std::shared_ptr<tf2_ros::Buffer> tf2_buffer_ptr_;

  private:
    template <class T>
    static T times(const Transform &transform, const T &data)
    {
        return transform * data;
    }
    static Vector3 turned(const Transform &transform, const Vector3 &v)
    {
        return transform * v - transform * Vector3(0, 0, 0);
    }

    template <class T>
    void apply(const FrameName &target_frame, const Stamped<T> &in, Stamped<T> &out,
               T (*function)(const Transform &, const T &)) const
    {
        StampedTransform transform;
        lookupTransform(target_frame, in.frame_id_, in.stamp_, transform);
        put(function(transform, in), transform, target_frame, out);
    }
    template <class T>
    void apply(const FrameName &target_frame, const ros::Time &target_time, const Stamped<T> &in,
               const FrameName &fixed_frame, Stamped<T> &out, T (*function)(const Transform &, const T &)) const
    {
        StampedTransform transform;
        lookupTransform(target_frame, target_time, in.frame_id_, in.stamp_, fixed_frame, transform);
        put(function(transform, in), transform, target_frame, out);
    }
    template <class T>
    static void put(const T &data, const StampedTransform &transform, const FrameName &target_frame, Stamped<T> &out)
    {
        out.setData(data);
        out.stamp_    = transform.stamp_;
        out.frame_id_ = target_frame.view();
    }
};

} // namespace tf

#endif
