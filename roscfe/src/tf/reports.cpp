// What a buffer of transforms holds, and why it does not hold more, as text (the words are tf2's).
#include "moments.h"
#include "roscfe/frames/buffer.h"

#include <algorithm>

namespace roscfe
{
namespace frames
{

namespace
{

constexpr double kShortest = 0.0001; // a span of seconds below which a rate would mean nothing

} // namespace

void Buffer::describe(const Failure &failure, Text &text) const
{
    const auto frame_names = [&](const char *between) -> Text & {
        return text << name_of(failure.target) << between << name_of(failure.source);
    };
    switch (failure.kind)
    {
        case Failure::none:
        case Failure::undefined: // tf2 gives no reason
            break;
        case Failure::empty_name:
            text << "Invalid argument passed to " << failure.role << " in tf2 frame_ids cannot be empty";
            break;
        case Failure::slash:
            text << "Invalid argument \"" << failure.name << "\" passed to " << failure.role
                 << " in tf2 frame_ids cannot start with a '/' like: ";
            break;
        case Failure::unknown_frame:
            text << "\"" << failure.name << "\" passed to " << failure.role << " does not exist. ";
            break;
        case Failure::loop:
            text << "The tf tree is invalid because it contains a loop.\n";
            all_as_string(text);
            text << "\n";
            break;
        case Failure::no_connection:
            text << "Could not find a connection between '";
            frame_names("' and '") << "' because they are not part of the same tree."
                                   << "Tf has two or more unconnected trees.";
            break;
        case Failure::extrapolation:
            const Frame &frame = frames_[failure.frame];
            if (frame.newest != 0)
            {
                const std::int64_t first = samples_[frame.oldest].stamp, last = samples_[frame.newest].stamp;
                const bool         late = failure.time > last;
                text << "Lookup would require extrapolation ";
                if (frame.count == 1)
                {
                    text << "at time " << Fixed{seconds(failure.time), 9} << ", but only time "
                         << Fixed{seconds(last), 9} << " is in the buffer";
                }
                else
                {
                    text << Fixed{seconds(late ? failure.time - last : first - failure.time), 9} << "s into the "
                         << (late ? "future" : "past") << ".  Requested time " << Fixed{seconds(failure.time), 9}
                         << " but the " << (late ? "latest" : "earliest") << " data is at time "
                         << Fixed{seconds(late ? last : first), 9};
                }
            }
            text << ", when looking up transform from frame [" << name_of(failure.source) << "] to frame ["
                 << name_of(failure.target) << "]";
            break;
    }
}

void Buffer::all_as_string(Text &text) const
{
    for (FrameId id = 1; id <= frame_count_; ++id)
    {
        if (frames_[id].has_cache)
        {
            text << "Frame " << name_of(id) << " exists with parent " << name_of(newest(id).parent) << ".\n";
        }
    }
}

void Buffer::all_as_yaml(Text &text, double now) const
{
    if (frame_count_ == 0)
    {
        text << "{}";
    }
    for (FrameId id = 1; id <= frame_count_; ++id)
    {
        const Frame &frame  = frames_[id];
        const Step   latest = newest(id);
        if (latest.parent == 0)
        {
            continue;
        }
        const double last = seconds(latest.stamp), first = frame.is_static ? 0.0 : seconds(samples_[frame.oldest].stamp);
        text << name_of(id) << ": \n  parent: '" << name_of(latest.parent) << "'\n  broadcaster: '"
             << std::string_view(authority_at(id), frame.authority_length)
             << "'\n  rate: " << Fixed{frame.count / std::max(last - first, kShortest), 3}
             << "\n  most_recent_transform: " << Fixed{last, 3} << "\n  oldest_transform: " << Fixed{first, 3} << "\n";
        if (now > 0)
        {
            text << "  transform_delay: " << Fixed{now - last, 3} << "\n";
        }
        text << "  buffer_length: " << Fixed{last - first, 3} << "\n";
    }
}

void Buffer::all_as_dot(Text &text, double now) const
{
    if (frame_count_ == 0)
    {
        text << "digraph G {\n\"no tf data recieved\"}";
        return;
    }
    text << "digraph G {\n";
    for (FrameId id = 1; id <= frame_count_; ++id)
    {
        const Frame &frame  = frames_[id];
        const Step   latest = newest(id);
        if (latest.parent == 0)
        {
            continue;
        }
        const double last = seconds(latest.stamp), first = frame.is_static ? 0.0 : seconds(samples_[frame.oldest].stamp);
        text << "\"" << name_of(latest.parent) << "\" -> \"" << name_of(id) << "\"[label=\"Broadcaster: "
             << std::string_view(authority_at(id), frame.authority_length)
             << "\\nAverage rate: " << Fixed{frame.count / std::max(last - first, kShortest), 3}
             << " Hz\\nMost recent transform: " << Fixed{last, 3} << " ";
        if (now > 0)
        {
            text << "( " << Fixed{now - last, 3} << " sec old)";
        }
        text << "\\nBuffer length: " << Fixed{last - first, 3} << " sec\\n\"];\n";
    }
    for (FrameId id = 1; id <= frame_count_; ++id)
    {
        const bool is_root = frames_[id].has_cache ? newest(id).parent == 0 : now > 0;
        if (!is_root)
        {
            continue;
        }
        text << "edge [style=invis];\n"
             << " subgraph cluster_legend { style=bold; color=black; label =\"view_frames Result\";\n";
        if (now > 0)
        {
            text << "\"Recorded at time: " << Fixed{now, 3} << "\"[ shape=plaintext ] ;\n ";
        }
        text << "}->\"" << name_of(id) << "\";\n";
    }
    text << "}";
}

} // namespace frames
} // namespace roscfe
