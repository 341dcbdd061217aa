// interactive_markers::MenuHandler: a menu of entries, which several markers may have.
#ifndef ROSCFE_INTERACTIVE_MARKERS_MENU_HANDLER_H
#define ROSCFE_INTERACTIVE_MARKERS_MENU_HANDLER_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include "interactive_markers/interactive_marker_server.h"
#include "visualization_msgs/MenuEntry.h"

namespace interactive_markers
{

class MenuHandler
{
  public:
    typedef std::uint32_t                             EntryHandle;
    typedef InteractiveMarkerServer::FeedbackConstPtr FeedbackConstPtr;
    typedef InteractiveMarkerServer::FeedbackCallback FeedbackCallback;

    enum CheckState
    {
        NO_CHECKBOX,
        CHECKED,
        UNCHECKED
    };

    EntryHandle insert(const std::string &title, const FeedbackCallback &callback)
    {
        return add(0, title, "", visualization_msgs::MenuEntry::FEEDBACK, callback);
    }
    EntryHandle insert(const std::string &title, const std::uint8_t type = visualization_msgs::MenuEntry::FEEDBACK,
                       const std::string &command = "")
    {
        return add(0, title, command, type, FeedbackCallback());
    }
    EntryHandle insert(EntryHandle parent, const std::string &title, const FeedbackCallback &callback)
    {
        return add(parent, title, "", visualization_msgs::MenuEntry::FEEDBACK, callback);
    }
    EntryHandle insert(EntryHandle parent, const std::string &title,
                       const std::uint8_t type = visualization_msgs::MenuEntry::FEEDBACK,
                       const std::string &command = "")
    {
        return add(parent, title, command, type, FeedbackCallback());
    }

    bool setVisible(EntryHandle handle, bool visible)
    {
        const auto found = entries_.find(handle);
        if (found != entries_.end())
        {
            found->second.visible = visible;
        }
        return found != entries_.end();
    }
    bool setCheckState(EntryHandle handle, CheckState state)
    {
        const auto found = entries_.find(handle);
        if (found != entries_.end())
        {
            found->second.state = state;
        }
        return found != entries_.end();
    }
    bool getCheckState(EntryHandle handle, CheckState &state) const
    {
        const auto found = entries_.find(handle);
        state            = found != entries_.end() ? found->second.state : NO_CHECKBOX;
        return found != entries_.end();
    }
    bool getTitle(EntryHandle handle, std::string &title) const
    {
        const auto found = entries_.find(handle);
        if (found != entries_.end())
        {
            title = found->second.title;
        }
        return found != entries_.end();
    }

    // Give a marker of a server this menu; applyChanges of the server tells it.
    bool apply(InteractiveMarkerServer &server, const std::string &marker_name)
    {
        visualization_msgs::InteractiveMarker marker;
        if (!server.get(marker_name, marker))
        {
            markers_.erase(marker_name);
            return false;
        }
        marker.menu_entries.clear();
        push(top_, marker);
        server.insert(marker);
        server.setCallback(
            marker_name, [this](const FeedbackConstPtr &feedback) { choose(feedback); },
            visualization_msgs::InteractiveMarkerFeedback::MENU_SELECT);
        markers_.insert(marker_name);
        return true;
    }
    bool reApply(InteractiveMarkerServer &server)
    {
        bool good = true;
        for (const std::string &each : std::set<std::string>(markers_))
        {
            good = apply(server, each) && good;
        }
        return good;
    }

  private:
    struct Entry
    {
        std::string              title;
        std::string              command;
        std::uint8_t             type  = visualization_msgs::MenuEntry::FEEDBACK;
        EntryHandle              parent = 0;
        std::vector<EntryHandle> below;
        bool                     visible = true;
        CheckState               state   = NO_CHECKBOX;
        FeedbackCallback         callback;
    };

    EntryHandle add(EntryHandle parent, const std::string &title, const std::string &command, std::uint8_t type,
                    const FeedbackCallback &callback)
    {
        if (parent != 0 && entries_.count(parent) == 0)
        {
            ROS_ERROR("Parent menu entry %u not found.", parent);
            return 0;
        }
        const EntryHandle handle = ++last_;
        Entry &           entry  = entries_[handle];
        entry.title              = title;
        entry.command            = command;
        entry.type               = type;
        entry.parent             = parent;
        entry.callback           = callback;
        (parent == 0 ? top_ : entries_[parent].below).push_back(handle);
        return handle;
    }

    // Parents come before what is below them.
    void push(const std::vector<EntryHandle> &handles, visualization_msgs::InteractiveMarker &marker)
    {
        for (const EntryHandle handle : handles)
        {
            const Entry &entry = entries_[handle];
            if (!entry.visible)
            {
                continue;
            }
            const char *box = entry.state == CHECKED ? "[x] " : entry.state == UNCHECKED ? "[ ] " : "";
            marker.menu_entries.emplace_back();
            auto &told        = marker.menu_entries.back();
            told.id           = handle;
            told.parent_id    = entry.parent;
            told.title        = (box + entry.title).c_str();
            told.command      = entry.command.c_str();
            told.command_type = entry.type;
            push(entry.below, marker);
        }
    }

    void choose(const FeedbackConstPtr &feedback)
    {
        const auto found = entries_.find(feedback->menu_entry_id);
        if (found != entries_.end() && found->second.callback)
        {
            found->second.callback(feedback);
        }
    }

    std::map<EntryHandle, Entry> entries_;
    std::vector<EntryHandle>     top_;
    std::set<std::string>        markers_;
    EntryHandle                  last_ = 0;
};

} // namespace interactive_markers

#endif
