// Transforms over time, frame by frame: what tf2 calls a TimeCache, or a StaticCache for what holds for ever.
//
// The samples of all frames are in one array; those of a frame are a list, from the newest to the oldest.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "moments.h"
#include "roscfe/frames/buffer.h"
#include "ros/console.h"
#include "tf2/LinearMath/Quaternion.h"

namespace roscfe
{
namespace frames
{

namespace
{

constexpr double kTolerance = 10e-3; // of a quaternion's squared length

const char *const kOldData =
    "TF_OLD_DATA ignoring data from the past (Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained)";
const char *const kRepeatedData = "TF_REPEATED_DATA ignoring data with redundant timestamp";
const char *const kNoRoom       = "there is no memory for another frame, or its name is too long, ignoring data";

std::string_view without_slash(std::string_view name)
{
    return !name.empty() && name[0] == '/' ? name.substr(1) : name;
}

// A line of the log, written piece by piece.
template <class Write>
void complain(const Write &write)
{
    char line[512];
    Text text(line, sizeof line);
    write(text);
    ROS_ERROR("%s", line);
}

struct Translation
{
    const Rigid &of;
};
struct Rotation
{
    const Rigid &of;
};

Text &operator<<(Text &text, Translation t)
{
    return text << "(" << Fixed{t.of.x, 6} << " " << Fixed{t.of.y, 6} << " " << Fixed{t.of.z, 6} << ")";
}

Text &operator<<(Text &text, Rotation r)
{
    return text << "(" << Fixed{r.of.qx, 6} << " " << Fixed{r.of.qy, 6} << " " << Fixed{r.of.qz, 6} << " "
                << Fixed{r.of.qw, 6} << ")";
}

bool has_nan(const Rigid &r)
{
    return std::isnan(r.x) || std::isnan(r.y) || std::isnan(r.z) || std::isnan(r.qx) || std::isnan(r.qy) ||
           std::isnan(r.qz) || std::isnan(r.qw);
}

// Say all that is wrong with a transform; true when it makes sense.
bool makes_sense(std::string_view child, std::string_view parent, const Rigid &rigid, std::string_view authority)
{
    bool good = true;
    if (child == parent)
    {
        complain([&](Text &text) {
            text << "TF_SELF_TRANSFORM: Ignoring transform from authority \"" << authority
                 << "\" with frame_id and child_frame_id  \"" << child << "\" because they are the same";
        });
        good = false;
    }
    if (child.empty())
    {
        complain([&](Text &text) {
            text << "TF_NO_CHILD_FRAME_ID: Ignoring transform from authority \"" << authority
                 << "\" because child_frame_id not set ";
        });
        good = false;
    }
    if (parent.empty())
    {
        complain([&](Text &text) {
            text << "TF_NO_FRAME_ID: Ignoring transform with child_frame_id \"" << child << "\"  from authority \""
                 << authority << "\" because frame_id not set";
        });
        good = false;
    }
    if (has_nan(rigid))
    {
        complain([&](Text &text) {
            text << "TF_NAN_INPUT: Ignoring transform for child_frame_id \"" << child << "\" from authority \""
                 << authority << "\" because of a nan value in the transform " << Translation{rigid} << " "
                 << Rotation{rigid};
        });
        good = false;
    }
    const double length2 =
        rigid.qw * rigid.qw + rigid.qx * rigid.qx + rigid.qy * rigid.qy + rigid.qz * rigid.qz;
    if (!(std::fabs(length2 - 1.0) < kTolerance))
    {
        complain([&](Text &text) {
            text << "TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id \"" << child
                 << "\" from authority \"" << authority << "\" because of an invalid quaternion in the transform "
                 << Rotation{rigid};
        });
        good = false;
    }
    return good;
}

// The transform at a point between two: translation linearly, rotation along the shortest arc at constant speed.
Rigid between(const Rigid &older, const Rigid &newer, double ratio)
{
    tf2::Vector3 moved;
    moved.setInterpolate3(tf2::Vector3(older.x, older.y, older.z), tf2::Vector3(newer.x, newer.y, newer.z), ratio);
    const tf2::Quaternion from(older.qx, older.qy, older.qz, older.qw), to(newer.qx, newer.qy, newer.qz, newer.qw);
    const tf2::Quaternion turned = from.slerp(to, ratio);
    return {moved.x(), moved.y(), moved.z(), turned.x(), turned.y(), turned.z(), turned.w()};
}

} // namespace

bool Buffer::set(std::string_view child, std::string_view parent, std::int64_t stamp, const Rigid &rigid,
                 std::string_view authority, bool is_static)
{
    child  = without_slash(child);
    parent = without_slash(parent);
    if (!makes_sense(child, parent, rigid, authority))
    {
        return false;
    }
    const FrameId id = find_or_add(child), parent_id = find_or_add(parent);
    const char *  refused = kNoRoom;
    if (id != 0 && parent_id != 0)
    {
        Frame &frame = frames_[id];
        if (!frame.has_cache)
        {
            frame.has_cache = true;
            frame.is_static = is_static;
        }
        refused = insert(id, stamp, rigid, parent_id);
    }
    if (refused != nullptr)
    {
        char line[512];
        Text text(line, sizeof line);
        text << refused << " for frame " << child << " (parent " << parent << ") at time " << Fixed{seconds(stamp), 6}
             << " according to authority " << authority;
        ROS_WARN("%s", line);
        return false;
    }
    frames_[id].authority_length =
        static_cast<std::uint32_t>(std::min<std::size_t>(authority.size(), capacity_.name));
    std::memcpy(authority_at(id), authority.data(), frames_[id].authority_length);
    for (Watcher *each = watchers_; each != nullptr; each = each->next_)
    {
        each->transforms_changed();
    }
    return true;
}

const char *Buffer::insert(FrameId id, std::int64_t stamp, const Rigid &rigid, FrameId parent)
{
    Frame &frame = frames_[id];
    if (frame.is_static)
    {
        if (frame.newest == 0)
        {
            frame.newest = frame.oldest = new_sample(id);
            frame.count                 = 1;
        }
        samples_[frame.newest] = {stamp, rigid, parent, 0, 0};
        return nullptr;
    }
    if (frame.newest != 0 && samples_[frame.newest].stamp > stamp + keep_ns_)
    {
        return kOldData;
    }
    SampleId older = not_after(frame, stamp);
    if (older != 0 && samples_[older].stamp == stamp)
    {
        return kRepeatedData;
    }
    const SampleId made  = new_sample(id);
    older                = not_after(frame, stamp); // another one may have gone for it
    const SampleId newer = older != 0 ? samples_[older].newer : frame.oldest;
    samples_[made]       = {stamp, rigid, parent, older, newer};
    (newer != 0 ? samples_[newer].older : frame.newest) = made;
    (older != 0 ? samples_[older].newer : frame.oldest) = made;
    ++frame.count;
    while (samples_[frame.oldest].stamp + keep_ns_ < samples_[frame.newest].stamp)
    {
        drop_oldest(id);
    }
    return nullptr;
}

Buffer::SampleId Buffer::not_after(const Frame &frame, std::int64_t stamp) const
{
    SampleId at = frame.newest;
    while (at != 0 && samples_[at].stamp > stamp)
    {
        at = samples_[at].older;
    }
    return at;
}

Buffer::SampleId Buffer::new_sample(FrameId id)
{
    if (free_ == 0 && sample_count_ < capacity_.samples)
    {
        return ++sample_count_;
    }
    if (free_ == 0)
    {
        // The longest history becomes shorter; this frame's, when it is as long as another.
        FrameId longest = id;
        for (FrameId each = 1; each <= frame_count_; ++each)
        {
            if (frames_[each].count > frames_[longest].count)
            {
                longest = each;
            }
        }
        ++cut_short_;
        ROS_WARN_ONCE("The buffer of transforms is full: %lu samples. The longest histories become shorter.",
                      static_cast<unsigned long>(capacity_.samples));
        drop_oldest(longest);
    }
    const SampleId found = free_;
    free_                = samples_[found].older;
    return found;
}

void Buffer::drop_oldest(FrameId id)
{
    Frame &        frame = frames_[id];
    const SampleId gone  = frame.oldest;
    frame.oldest         = samples_[gone].newer;
    (frame.oldest != 0 ? samples_[frame.oldest].older : frame.newest) = 0;
    --frame.count;
    samples_[gone].older = free_;
    free_                = gone;
}

void Buffer::clear()
{
    for (FrameId id = 1; id <= frame_count_; ++id)
    {
        while (!frames_[id].is_static && frames_[id].newest != 0)
        {
            drop_oldest(id);
        }
    }
}

bool Buffer::sample_at(FrameId id, std::int64_t time, Rigid &rigid, FrameId &parent) const
{
    const Frame &frame = frames_[id];
    SampleId     at = frame.newest;
    if (at == 0 || (!frame.is_static && time != 0 && frame.count == 1 && samples_[at].stamp != time))
    {
        return false;
    }
    if (frame.is_static || time == 0 || samples_[at].stamp == time)
    {
        rigid  = samples_[at].rigid;
        parent = samples_[at].parent;
        return true;
    }
    if (time > samples_[at].stamp || time < samples_[frame.oldest].stamp)
    {
        return false;
    }
    at = not_after(frame, time);
    const Sample &one = samples_[at], &two = samples_[samples_[at].newer];
    parent = one.parent;
    if (at == frame.oldest && one.stamp == time)
    {
        rigid = one.rigid;
    }
    else if (one.parent != two.parent) // the frame got another parent in between
    {
        rigid = one.rigid;
    }
    else
    {
        rigid = between(one.rigid, two.rigid,
                        seconds(time - one.stamp) / seconds(two.stamp - one.stamp));
    }
    return true;
}

Buffer::Step Buffer::newest(FrameId id) const
{
    const Frame &frame = frames_[id];
    if (frame.newest == 0)
    {
        return {0, 0};
    }
    return {frame.is_static ? 0 : samples_[frame.newest].stamp, samples_[frame.newest].parent};
}

} // namespace frames
} // namespace roscfe
