// tf2::BufferCore: transforms of the last seconds, by the names of frames.
#ifndef TF2_BUFFER_CORE_H
#define TF2_BUFFER_CORE_H

#include <geometry_msgs/TransformStamped.h>

#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>

#include <string>
#include <utility>
#include <vector>

#include "ros/duration.h"
#include "ros/time.h"
#include "roscfe/frames/change_signal.h"
#include "roscfe/frames/messages.h"
#include "tf2/exceptions.h"
#include "tf2/transform_storage.h"

// How much a buffer holds; all of it is memory that is taken at its construction. A sample takes 80 bytes.
#ifndef ROSCFE_TF_FRAMES
#define ROSCFE_TF_FRAMES 128
#endif
#ifndef ROSCFE_TF_SAMPLES
#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
#define ROSCFE_TF_SAMPLES 1600 // a block of 131,072 bytes
#else
#define ROSCFE_TF_SAMPLES 16384
#endif
#endif
#ifndef ROSCFE_TF_NAME
#define ROSCFE_TF_NAME 64
#endif

namespace tf2
{

typedef std::pair<ros::Time, CompactFrameID> P_TimeAndFrameID;
typedef roscfe::frames::Name                 FrameName; // what std::string is here in ROS; nothing is copied

class BufferCore
{
  public:
    static constexpr int           DEFAULT_CACHE_TIME = 10; // in seconds
    static constexpr std::uint32_t MAX_GRAPH_DEPTH    = roscfe::frames::kDeepest;

    BufferCore(ros::Duration cache_time = ros::Duration(DEFAULT_CACHE_TIME))
        : frames_({ROSCFE_TF_FRAMES, ROSCFE_TF_SAMPLES, ROSCFE_TF_NAME}, cache_time.toNSec())
    {
    }
    virtual ~BufferCore() = default;

    void clear() { frames_.clear(); }

    // One that makes no sense is logged, and left out.
    bool setTransform(const geometry_msgs::TransformStamped &transform, const FrameName &authority,
                      bool is_static = false)
    {
        return frames_.set(FrameName(transform.child_frame_id), FrameName(transform.header.frame_id),
                           roscfe::frames::ns_of(transform.header.stamp),
                           roscfe::frames::rigid_of(transform.transform), authority, is_static);
    }

    // Throws LookupException, ConnectivityException, ExtrapolationException or InvalidArgumentException.
    geometry_msgs::TransformStamped lookupTransform(const FrameName &target_frame, const FrameName &source_frame,
                                                    const ros::Time &time) const
    {
        roscfe::frames::Rigid found;
        std::int64_t          when = 0;
        refuse(frames_.look_up(target_frame, source_frame, roscfe::frames::ns_of(time), found, when));
        return message(target_frame, source_frame, found, when);
    }
    geometry_msgs::TransformStamped lookupTransform(const FrameName &target_frame, const ros::Time &target_time,
                                                    const FrameName &source_frame, const ros::Time &source_time,
                                                    const FrameName &fixed_frame) const
    {
        roscfe::frames::Rigid found;
        std::int64_t          when = 0;
        refuse(frames_.look_up(target_frame, roscfe::frames::ns_of(target_time), source_frame,
                               roscfe::frames::ns_of(source_time), fixed_frame, found, when));
        return message(target_frame, source_frame, found, when);
    }

    bool canTransform(const FrameName &target_frame, const FrameName &source_frame, const ros::Time &time,
                      std::string *error_msg = nullptr) const
    {
        return can(error_msg, target_frame.view(), source_frame.view(), roscfe::frames::ns_of(time));
    }
    bool canTransform(const FrameName &target_frame, const ros::Time &target_time, const FrameName &source_frame,
                      const ros::Time &source_time, const FrameName &fixed_frame,
                      std::string *error_msg = nullptr) const
    {
        return can(error_msg, target_frame.view(), roscfe::frames::ns_of(target_time), source_frame.view(),
                   roscfe::frames::ns_of(source_time), fixed_frame.view());
    }

    std::string allFramesAsString() const
    {
        return roscfe::frames::text_of([this](roscfe::frames::Text &text) { frames_.all_as_string(text); });
    }
    std::string allFramesAsYAML(double current_time = 0.0) const
    {
        return roscfe::frames::text_of([=](roscfe::frames::Text &text) { frames_.all_as_yaml(text, current_time); });
    }
    std::string _allFramesAsDot(double current_time = 0.0) const
    {
        return roscfe::frames::text_of([=](roscfe::frames::Text &text) { frames_.all_as_dot(text, current_time); });
    }

    ros::Duration getCacheLength() const { return ros::Duration().fromNSec(frames_.keep_ns()); }

    // A node has one task here: a listener fills its buffers whenever the node waits for something.
    void setUsingDedicatedThread(bool value) { using_dedicated_thread_ = value; }
    bool isUsingDedicatedThread() const { return using_dedicated_thread_; }

    bool _frameExists(const FrameName &frame_id) const { return frames_.find(frame_id) != 0; }
    void _getFrameStrings(std::vector<std::string> &ids) const
    {
        ids.clear();
        for (CompactFrameID id = 1; id <= frames_.frame_count(); ++id)
        {
            ids.emplace_back(frames_.name_of(id));
        }
    }
    bool _getParent(const FrameName &frame_id, ros::Time time, std::string &parent) const
    {
        const CompactFrameID found = frames_.parent_at(frames_.find(frame_id), roscfe::frames::ns_of(time));
        if (found != 0)
        {
            parent = frames_.name_of(found);
        }
        return found != 0;
    }
    CompactFrameID _lookupFrameNumber(const FrameName &frame_id) const { return frames_.find(frame_id); }
    CompactFrameID _lookupOrInsertFrameNumber(const FrameName &frame_id) { return frames_.find_or_add(frame_id); }
    CompactFrameID _validateFrameId(const char *function_name_arg, const FrameName &frame_id) const
    {
        CompactFrameID id = 0;
        refuse(frames_.validate(function_name_arg, frame_id, id));
        return id;
    }

    // 0, or the number of an error, with its text.
    int _getLatestCommonTime(CompactFrameID target_frame, CompactFrameID source_frame, ros::Time &time,
                             std::string *error_string) const
    {
        std::int64_t                  common = 0;
        const roscfe::frames::Failure failure = frames_.latest_common_time(target_frame, source_frame, common);
        if (!failure)
        {
            time = roscfe::frames::time_of(common);
            return 0;
        }
        if (error_string != nullptr && failure.kind != roscfe::frames::Failure::undefined)
        {
            *error_string = roscfe::frames::text_of([&](roscfe::frames::Text &text) { frames_.describe(failure, text); });
        }
        return failure.kind == roscfe::frames::Failure::no_connection ? 2 : 1;
    }

    void _chainAsVector(const FrameName &target_frame, ros::Time target_time, const FrameName &source_frame,
                        ros::Time source_time, const FrameName &fixed_frame, std::vector<std::string> &output) const
    {
        output.clear();
        refuse(frames_.chain(target_frame, roscfe::frames::ns_of(target_time), source_frame,
                             roscfe::frames::ns_of(source_time), fixed_frame,
                             [&output](std::string_view name) { output.emplace_back(name); }));
    }

#ifdef BOOST_SIGNALS2_HPP
    // Call a function whenever transforms have come.
    boost::signals2::connection _addTransformsChangedListener(boost::function<void()> callback)
    {
        if (!changes_)
        {
            changes_.reset(new roscfe::frames::ChangeSignal(frames_));
        }
        return static_cast<roscfe::frames::ChangeSignal *>(changes_.get())->signal.connect(callback);
    }
    void _removeTransformsChangedListener(boost::signals2::connection listener) { listener.disconnect(); }
#endif

    // What is behind it, for what stands on a buffer.
    roscfe::frames::Buffer &frames() { return frames_; }

  private:
    static geometry_msgs::TransformStamped message(const FrameName &target, const FrameName &source,
                                                   const roscfe::frames::Rigid &found, std::int64_t when)
    {
        geometry_msgs::TransformStamped made;
        made.header.stamp    = roscfe::frames::time_of(when);
        made.header.frame_id = target.view();
        made.child_frame_id  = source.view();
        roscfe::frames::put(found, made.transform);
        return made;
    }

    template <class... Asked>
    bool can(std::string *error_msg, const Asked &...asked) const
    {
        if (error_msg == nullptr)
        {
            return frames_.can(asked..., nullptr);
        }
        bool              possible = false;
        const std::string why_not =
            roscfe::frames::text_of([&](roscfe::frames::Text &text) { possible = frames_.can(asked..., &text); });
        if (!why_not.empty())
        {
            *error_msg = why_not;
        }
        return possible;
    }

    // Throw what a failure is in ROS.
    void refuse(const roscfe::frames::Failure &failure) const
    {
        if (!failure)
        {
            return;
        }
        const std::string text = roscfe::frames::text_of([&](roscfe::frames::Text &to) { frames_.describe(failure, to); });
        switch (failure.kind)
        {
            case roscfe::frames::Failure::empty_name:
            case roscfe::frames::Failure::slash:
                ROSCFE_THROW(InvalidArgumentException(text));
            case roscfe::frames::Failure::no_connection:
                ROSCFE_THROW(ConnectivityException(text));
            case roscfe::frames::Failure::extrapolation:
                ROSCFE_THROW(ExtrapolationException(text));
            default:
                ROSCFE_THROW(LookupException(text));
        }
    }

    roscfe::frames::Buffer  frames_;
    bool                    using_dedicated_thread_ = false;
    boost::shared_ptr<void> changes_; // a ChangeSignal, where there are signals
};

} // namespace tf2

#endif
