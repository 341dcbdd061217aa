// interactive_markers::InteractiveMarkerServer: markers that users move, and what the node does then.
#ifndef ROSCFE_INTERACTIVE_MARKERS_INTERACTIVE_MARKER_SERVER_H
#define ROSCFE_INTERACTIVE_MARKERS_INTERACTIVE_MARKER_SERVER_H

#include <cstdint>
#include <map>
#include <string>

#include <boost/thread/mutex.hpp> // which nodes take from here, as from the original
#include <boost/thread/recursive_mutex.hpp>

#include "ros/ros.h"
#include "visualization_msgs/InteractiveMarker.h"
#include "visualization_msgs/InteractiveMarkerFeedback.h"
#include "visualization_msgs/InteractiveMarkerInit.h"
#include "visualization_msgs/InteractiveMarkerUpdate.h"

namespace interactive_markers
{

// Changes wait until applyChanges. All callbacks run where the node spins, whether it asked for a thread or not.
class InteractiveMarkerServer
{
  public:
    typedef visualization_msgs::InteractiveMarkerFeedbackConstPtr FeedbackConstPtr;
    typedef boost::function<void(const FeedbackConstPtr &)>       FeedbackCallback;

    static constexpr std::uint8_t DEFAULT_FEEDBACK_CB = 255; // also has a place in memory, for a reference to it

    InteractiveMarkerServer(const std::string &topic_ns, const std::string &server_id = "", bool = false)
    {
        const std::string name = ros::this_node::getName();
        server_id_             = server_id.empty() ? name : name + "/" + server_id;
        updates_   = node_.advertise<visualization_msgs::InteractiveMarkerUpdate>(topic_ns + "/update", 100);
        init_      = node_.advertise<visualization_msgs::InteractiveMarkerInit>(topic_ns + "/update_full", 100, true);
        feedback_  = node_.subscribe<visualization_msgs::InteractiveMarkerFeedback>(
            topic_ns + "/feedback", 100, [this](const FeedbackConstPtr &feedback) { take(feedback); });
        keep_alive_ = node_.createTimer(ros::Duration(0.5), [this](const ros::TimerEvent &) { keep_alive(); });
        publish_init();
    }
    ~InteractiveMarkerServer()
    {
        if (node_.ok())
        {
            clear();
            applyChanges();
        }
    }
    InteractiveMarkerServer(const InteractiveMarkerServer &) = delete;
    InteractiveMarkerServer &operator=(const InteractiveMarkerServer &) = delete;

    void insert(const visualization_msgs::InteractiveMarker &marker)
    {
        Change &change = pending_[marker.name.c_str()];
        change.kind    = Change::kWhole;
        change.marker  = marker;
    }
    void insert(const visualization_msgs::InteractiveMarker &marker, FeedbackCallback callback,
                std::uint8_t type = DEFAULT_FEEDBACK_CB)
    {
        insert(marker);
        setCallback(marker.name.c_str(), callback, type);
    }

    bool setPose(const std::string &name, const geometry_msgs::Pose &pose,
                 const std_msgs::Header &header = std_msgs::Header())
    {
        const auto there   = markers_.find(name);
        const auto pending = pending_.find(name);
        if (there == markers_.end() && (pending == pending_.end() || pending->second.kind != Change::kWhole))
        {
            return false;
        }
        const bool             is_new = there == markers_.end() || (pending != pending_.end() &&
                                                        pending->second.kind == Change::kWhole);
        const std_msgs::Header kept   = is_new ? pending->second.marker.header : there->second.marker.header;
        set_pose(name, pose, header.frame_id.empty() ? kept : header);
        return true;
    }

    bool erase(const std::string &name)
    {
        if (markers_.count(name) == 0 && pending_.count(name) == 0)
        {
            return false;
        }
        pending_[name].kind = Change::kErase;
        return true;
    }

    void clear()
    {
        pending_.clear();
        for (const auto &each : markers_)
        {
            erase(each.first);
        }
    }

    bool        empty() const { return markers_.empty(); }
    std::size_t size() const { return markers_.size(); }

    bool setCallback(const std::string &name, FeedbackCallback callback, std::uint8_t type = DEFAULT_FEEDBACK_CB)
    {
        const auto there   = markers_.find(name);
        const auto pending = pending_.find(name);
        if (there == markers_.end() && (pending == pending_.end() || pending->second.kind == Change::kErase))
        {
            return false;
        }
        if (there != markers_.end())
        {
            there->second.callbacks[type] = callback;
        }
        if (pending != pending_.end())
        {
            pending->second.callbacks[type] = callback;
        }
        return true;
    }

    void applyChanges()
    {
        if (pending_.empty())
        {
            return;
        }
        visualization_msgs::InteractiveMarkerUpdate update;
        update.type = visualization_msgs::InteractiveMarkerUpdate::UPDATE;
        for (auto &each : pending_)
        {
            apply(each.first, each.second, update);
        }
        ++sequence_;
        publish(update);
        publish_init();
        pending_.clear();
    }

    bool get(std::string name, visualization_msgs::InteractiveMarker &marker) const
    {
        const auto pending = pending_.find(name);
        const auto there   = markers_.find(name);
        if (pending != pending_.end() && pending->second.kind == Change::kWhole)
        {
            marker = pending->second.marker;
            return true;
        }
        if (there == markers_.end() || (pending != pending_.end() && pending->second.kind == Change::kErase))
        {
            return false;
        }
        marker = there->second.marker;
        if (pending != pending_.end())
        {
            marker.pose = pending->second.marker.pose;
        }
        return true;
    }

  private:
    typedef std::map<std::uint8_t, FeedbackCallback> Callbacks;

    struct Held
    {
        visualization_msgs::InteractiveMarker marker;
        Callbacks                             callbacks;
        ros::Time                             last_feedback;
        std::string                           last_client;
    };

    struct Change
    {
        enum Kind
        {
            kPose,
            kWhole,
            kErase
        };
        Kind                                  kind = kPose;
        visualization_msgs::InteractiveMarker marker;
        Callbacks                             callbacks;
    };

    void apply(const std::string &name, Change &change, visualization_msgs::InteractiveMarkerUpdate &update)
    {
        const auto there = markers_.find(name);
        if (change.kind == Change::kErase)
        {
            markers_.erase(name);
            update.erases.emplace_back(name.c_str());
            return;
        }
        if (change.kind == Change::kWhole)
        {
            Held &held  = markers_[name];
            held.marker = change.marker;
            for (const auto &each : change.callbacks)
            {
                held.callbacks[each.first] = each.second;
            }
            update.markers.push_back(held.marker);
            return;
        }
        if (there == markers_.end())
        {
            ROS_ERROR("Pending pose update for non-existing marker found. This is a bug in InteractiveMarkerInterface.");
            return;
        }
        there->second.marker.pose   = change.marker.pose;
        there->second.marker.header = change.marker.header;
        update.poses.emplace_back();
        update.poses.back().header = change.marker.header;
        update.poses.back().pose   = change.marker.pose;
        update.poses.back().name   = name.c_str();
    }

    void take(const FeedbackConstPtr &feedback)
    {
        const auto found = markers_.find(feedback->marker_name.c_str());
        if (found == markers_.end())
        {
            return;
        }
        Held &          held = found->second;
        const ros::Time now  = ros::Time::now();
        if (held.last_client != feedback->client_id.c_str() && (now - held.last_feedback).toSec() < 1.0)
        {
            return; // somebody else moves it
        }
        held.last_feedback = now;
        held.last_client   = feedback->client_id.c_str();
        if (feedback->event_type == visualization_msgs::InteractiveMarkerFeedback::POSE_UPDATE)
        {
            // A marker without a stamp keeps its frame.
            const bool keeps = held.marker.header.stamp == ros::Time(0);
            set_pose(feedback->marker_name.c_str(), feedback->pose, keeps ? held.marker.header : feedback->header);
        }
        const auto own   = held.callbacks.find(feedback->event_type);
        const auto other = held.callbacks.find(DEFAULT_FEEDBACK_CB);
        const auto call  = own != held.callbacks.end() && own->second ? own : other;
        if (call != held.callbacks.end() && call->second)
        {
            const FeedbackCallback callback = call->second; // it may take the marker away
            callback(feedback);
        }
    }

    void set_pose(const std::string &name, const geometry_msgs::Pose &pose, const std_msgs::Header &header)
    {
        Change &change       = pending_[name];
        change.kind          = change.kind == Change::kErase ? Change::kPose : change.kind;
        change.marker.pose   = pose;
        change.marker.header = header;
    }

    void publish(visualization_msgs::InteractiveMarkerUpdate &update)
    {
        update.server_id = server_id_.c_str();
        update.seq_num   = sequence_;
        updates_.publish(update);
    }
    void publish_init()
    {
        visualization_msgs::InteractiveMarkerInit init;
        init.server_id = server_id_.c_str();
        init.seq_num   = sequence_;
        for (const auto &each : markers_)
        {
            init.markers.push_back(each.second.marker);
        }
        init_.publish(init);
    }
    void keep_alive()
    {
        visualization_msgs::InteractiveMarkerUpdate update;
        update.type = visualization_msgs::InteractiveMarkerUpdate::KEEP_ALIVE;
        publish(update);
    }

    ros::NodeHandle               node_;
    std::string                   server_id_;
    std::uint64_t                 sequence_ = 0;
    std::map<std::string, Held>   markers_;
    std::map<std::string, Change> pending_;
    ros::Publisher                updates_;
    ros::Publisher                init_;
    ros::Subscriber               feedback_;
    ros::Timer                    keep_alive_;
};

} // namespace interactive_markers

#endif
