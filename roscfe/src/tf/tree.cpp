// The tree of frames, and the way through it from one frame to another (the walks of tf2::BufferCore).
#include <algorithm>
#include <cstring>

#include "roscfe/frames/buffer.h"
#include "ros/console.h"
#include "tf2/LinearMath/Transform.h"

namespace roscfe
{
namespace frames
{

namespace
{

typedef tf2::Vector3    Vector;
typedef tf2::Quaternion Quaternion;

tf2::Transform transform_of(const Rigid &rigid)
{
    return tf2::Transform(Quaternion(rigid.qx, rigid.qy, rigid.qz, rigid.qw), Vector(rigid.x, rigid.y, rigid.z));
}

Rigid rigid_of(const Vector &v, const Quaternion &q)
{
    return {v.x(), v.y(), v.z(), q.x(), q.y(), q.z(), q.w()};
}

// A chain of transforms, put together from its lower end on. The operations are tf2's.
struct Half
{
    Vector     translation;
    Quaternion rotation;

    void add(const Rigid &rigid)
    {
        const Quaternion turn(rigid.qx, rigid.qy, rigid.qz, rigid.qw);
        translation = tf2::quatRotate(turn, translation) + Vector(rigid.x, rigid.y, rigid.z);
        rotation    = turn * rotation;
    }
};

} // namespace

// What is put together on the way: the transforms from the source upwards, and from the target upwards.
class Buffer::Way
{
  public:
    Half         up, down;
    std::int64_t time = 0;
    Rigid        result;

    void nothing(std::int64_t at) { time = at; }
    void only_up(std::int64_t at)
    {
        time   = at;
        result = rigid_of(up.translation, up.rotation);
    }
    void only_down(std::int64_t at)
    {
        time                  = at;
        const Quaternion back = down.rotation.inverse();
        result                = rigid_of(tf2::quatRotate(back, -down.translation), back);
    }
    void both(std::int64_t at)
    {
        time                  = at;
        const Quaternion back = down.rotation.inverse();
        const Vector     from = tf2::quatRotate(back, -down.translation);
        result                = rigid_of(tf2::quatRotate(back, up.translation) + from, back * up.rotation);
    }
};

Buffer::Buffer(const Capacity &capacity, std::int64_t keep_ns)
    : capacity_{std::max<std::uint32_t>(capacity.frames, 2),
                std::max<std::uint32_t>(capacity.samples, std::max<std::uint32_t>(capacity.frames, 2) + 1),
                std::max<std::uint32_t>(capacity.name, 16)},
      keep_ns_(keep_ns),
      frames_(new Frame[capacity_.frames + 1]),
      samples_(new Sample[capacity_.samples + 1]),
      names_(new char[static_cast<std::size_t>(capacity_.frames + 1) * capacity_.name]),
      authorities_(new char[static_cast<std::size_t>(capacity_.frames + 1) * capacity_.name]),
      steps_(new Step[capacity_.frames + 1]),
      chain_(new FrameId[2 * (static_cast<std::size_t>(capacity_.frames) + 2)])
{
}

Buffer::~Buffer() = default;

// -- frames ------------------------------------------------------------------------------------------------------------

FrameId Buffer::find(std::string_view name) const
{
    for (FrameId id = 1; id <= frame_count_; ++id)
    {
        if (frames_[id].name_length == name.size() && std::memcmp(name_at(id), name.data(), name.size()) == 0)
        {
            return id;
        }
    }
    return 0;
}

FrameId Buffer::find_or_add(std::string_view name)
{
    const FrameId known = find(name);
    if (known != 0 || frame_count_ == capacity_.frames || name.size() > capacity_.name)
    {
        return known;
    }
    const FrameId id        = ++frame_count_;
    frames_[id].name_length = static_cast<std::uint32_t>(name.size());
    std::memcpy(name_at(id), name.data(), name.size());
    return id;
}

std::string_view Buffer::name_of(FrameId id) const
{
    if (id == 0 || id > frame_count_)
    {
        return "NO_PARENT";
    }
    return std::string_view(name_at(id), frames_[id].name_length);
}

FrameId Buffer::parent_at(FrameId id, std::int64_t time) const
{
    Rigid   rigid;
    FrameId parent = 0;
    return id != 0 && id <= frame_count_ && sample_at(id, time, rigid, parent) ? parent : 0;
}

Failure Buffer::validate(const char *role, std::string_view name, FrameId &id) const
{
    Failure failure;
    failure.role = role;
    failure.name = name;
    id           = 0;
    if (name.empty())
    {
        failure.kind = Failure::empty_name;
    }
    else if (name[0] == '/')
    {
        failure.kind = Failure::slash;
    }
    else if ((id = find(name)) == 0)
    {
        failure.kind = Failure::unknown_frame;
    }
    return failure;
}

// -- ways --------------------------------------------------------------------------------------------------------------

Failure Buffer::no_connection(FrameId target, FrameId source) const
{
    Failure failure;
    failure.kind   = Failure::no_connection;
    failure.target = target;
    failure.source = source;
    return failure;
}

Failure Buffer::walk(Way &way, std::int64_t time, FrameId target, FrameId source) const
{
    Failure failure = no_connection(target, source);
    if (source == target)
    {
        way.nothing(time);
        return Failure();
    }
    if (time == 0)
    {
        const Failure none_in_common = latest_common_time(target, source, time);
        if (none_in_common)
        {
            return none_in_common;
        }
    }
    failure.time                = time;
    const std::uint32_t deepest = std::min(frame_count_, kDeepest);
    FrameId             frame = source, top = source, lost = 0, parent = 0;
    Rigid               rigid;
    for (std::uint32_t depth = 0; frames_[frame].has_cache; frame = parent)
    {
        if (!sample_at(frame, time, rigid, parent))
        {
            lost = frame; // there may be a way all the same
            break;
        }
        if (frame == target)
        {
            way.only_up(time);
            return Failure();
        }
        way.up.add(rigid);
        if (++depth > deepest)
        {
            failure.kind = Failure::loop;
            return failure;
        }
    }
    top   = frame;
    frame = target;
    for (std::uint32_t depth = 0; frame != top && frames_[frame].has_cache; frame = parent)
    {
        if (!sample_at(frame, time, rigid, parent))
        {
            failure.kind  = Failure::extrapolation;
            failure.frame = frame;
            return failure;
        }
        if (frame == source)
        {
            way.only_down(time);
            return Failure();
        }
        way.down.add(rigid);
        if (++depth > deepest)
        {
            failure.kind = Failure::loop;
            return failure;
        }
    }
    if (frame == top)
    {
        way.both(time);
        return Failure();
    }
    if (lost != 0)
    {
        failure.kind  = Failure::extrapolation;
        failure.frame = lost;
    }
    return failure;
}

Failure Buffer::latest_common_time(FrameId target, FrameId source, std::int64_t &time) const
{
    Failure failure = no_connection(target, source);
    if (source == 0 || target == 0)
    {
        failure.kind = Failure::undefined;
        return failure;
    }
    if (source == target)
    {
        time = newest(source).stamp;
        return Failure();
    }
    const auto earlier = [](std::int64_t a, std::int64_t b) { return b != 0 && b < a ? b : a; };
    const auto of      = [](std::int64_t found) { return found == kForever ? 0 : found; };

    const std::uint32_t deepest = std::min(frame_count_, kDeepest);
    std::uint32_t       steps   = 0;
    std::int64_t        common  = kForever;
    for (FrameId frame = source;;)
    {
        const Step latest = newest(frame);
        if (latest.parent == 0)
        {
            break;
        }
        common          = earlier(common, latest.stamp);
        steps_[steps++] = latest;
        frame           = latest.parent;
        if (frame == target)
        {
            time = of(common);
            return Failure();
        }
        if (steps > deepest)
        {
            failure.kind = Failure::loop;
            return failure;
        }
    }
    common = kForever;
    for (FrameId frame = target, depth = 0;;)
    {
        const Step latest = newest(frame);
        if (latest.parent == 0)
        {
            return failure;
        }
        common          = earlier(common, latest.stamp);
        const auto end  = steps_.get() + steps;
        const auto meet = std::find_if(steps_.get(), end, [&](const Step &s) { return s.parent == latest.parent; });
        if (meet != end)
        {
            for (const Step *each = steps_.get(); each <= meet; ++each)
            {
                common = earlier(common, each->stamp);
            }
            time = of(common);
            return Failure();
        }
        frame = latest.parent;
        if (frame == source)
        {
            time = of(common);
            return Failure();
        }
        if (++depth > deepest)
        {
            failure.kind = Failure::loop;
            return failure;
        }
    }
}

Failure Buffer::walk_chain(std::int64_t time, FrameId target, FrameId source, std::uint32_t &count) const
{
    Way           way;
    const Failure failure = walk(way, time, target, source);
    count = 0;
    if (failure || target == source)
    {
        return failure;
    }
    // From the source up to where the target's way comes in, and down again: ids of both ways, then what they share.
    FrameId *const up = chain_.get(), *const down = up + capacity_.frames + 2;
    const auto     climb = [&](FrameId from, FrameId to, FrameId *ids) {
        std::uint32_t length = 0;
        ids[length++]        = from;
        while (from != to && length <= capacity_.frames && (from = parent_at(from, way.time)) != 0)
        {
            ids[length++] = from;
        }
        return length;
    };
    const std::uint32_t up_length = climb(source, target, up), down_length = climb(target, source, down);
    for (std::uint32_t turn = 0; turn < down_length; ++turn)
    {
        FrameId *const met = std::find(up, up + up_length, down[turn]);
        if (met != up + up_length)
        {
            // tf2 does not cut off what follows a meeting directly above the source.
            count = met == up + 1 ? up_length : static_cast<std::uint32_t>(met - up) + 1;
            std::reverse_copy(down, down + turn, up + count);
            count += turn;
            break;
        }
    }
    return failure;
}

// -- what is asked for -------------------------------------------------------------------------------------------------

Failure Buffer::look_up(FrameId target, FrameId source, std::int64_t time, Rigid &found, std::int64_t &when) const
{
    Way           way;
    const Failure failure = walk(way, time, target, source);
    found                 = way.result;
    when                  = way.time;
    return failure;
}

Failure Buffer::look_up(std::string_view target, std::string_view source, std::int64_t time, Rigid &found,
                        std::int64_t &when) const
{
    FrameId target_id = 0, source_id = 0;
    if (target == source) // whatever it is called
    {
        found = Rigid();
        when  = time != 0 || (target_id = find(target)) == 0 ? time : newest(target_id).stamp;
        return Failure();
    }
    const Failure bad_target = validate("lookupTransform argument target_frame", target, target_id);
    if (bad_target)
    {
        return bad_target;
    }
    const Failure bad_source = validate("lookupTransform argument source_frame", source, source_id);
    return bad_source ? bad_source : look_up(target_id, source_id, time, found, when);
}

Failure Buffer::look_up(std::string_view target, std::int64_t target_time, std::string_view source,
                        std::int64_t source_time, std::string_view fixed, Rigid &found, std::int64_t &when) const
{
    FrameId id      = 0;
    Failure failure = validate("lookupTransform argument target_frame", target, id);
    failure         = failure ? failure : validate("lookupTransform argument source_frame", source, id);
    failure         = failure ? failure : validate("lookupTransform argument fixed_frame", fixed, id);
    Rigid first, second;
    failure = failure ? failure : look_up(fixed, source, source_time, first, when);
    failure = failure ? failure : look_up(target, fixed, target_time, second, when);
    if (!failure)
    {
        const tf2::Transform both = transform_of(second) * transform_of(first);
        found                     = rigid_of(both.getOrigin(), both.getRotation());
    }
    return failure;
}

bool Buffer::unknown(const char *const *roles, const std::string_view *names, FrameId *ids, int count,
                     Text *why_not) const
{
    for (int at = 0; at < count; ++at)
    {
        const Failure failure = validate(roles[at], names[at], ids[at]);
        if (failure.kind == Failure::empty_name || failure.kind == Failure::slash)
        {
            char line[512];
            Text text(line, sizeof line);
            describe(failure, text);
            ROS_WARN("%s", line);
            return true;
        }
    }
    bool any = false;
    for (int at = 0; at < count; ++at)
    {
        if (ids[at] == 0)
        {
            if (why_not != nullptr)
            {
                // The third one is the fixed frame; there tf2 leaves out a space.
                *why_not << (any ? " " : "") << (at < 2 ? "canTransform: " : "")
                         << std::string_view(roles[at]).substr(std::strlen("canTransform argument "))
                         << (at < 2 ? " " : ": ") << names[at] << (at < 2 ? " does not exist." : "does not exist.");
            }
            any = true;
        }
    }
    return any;
}

bool Buffer::can(FrameId target, FrameId source, std::int64_t time, Text *why_not) const
{
    Way           way;
    const Failure failure = walk(way, time, target, source);
    if (failure && why_not != nullptr)
    {
        describe(failure, *why_not);
    }
    return !failure;
}

namespace
{
const char *const kRoles[] = {"canTransform argument target_frame", "canTransform argument source_frame",
                              "canTransform argument fixed_frame"};
}

bool Buffer::can(std::string_view target, std::string_view source, std::int64_t time, Text *why_not) const
{
    const std::string_view names[] = {target, source};
    FrameId                ids[2];
    return target == source || (!unknown(kRoles, names, ids, 2, why_not) && can(ids[0], ids[1], time, why_not));
}

bool Buffer::can(std::string_view target, std::int64_t target_time, std::string_view source, std::int64_t source_time,
                 std::string_view fixed, Text *why_not) const
{
    const std::string_view names[] = {target, source, fixed};
    FrameId                ids[3];
    return !unknown(kRoles, names, ids, 3, why_not) && can(ids[0], ids[2], target_time, why_not) &&
           can(ids[2], ids[1], source_time, why_not);
}

// -- those who wait ----------------------------------------------------------------------------------------------------

void Buffer::watch(Watcher &watcher)
{
    watcher.next_ = watchers_;
    watchers_     = &watcher;
}

void Buffer::watch_no_more(Watcher &watcher)
{
    for (Watcher **each = &watchers_; *each != nullptr; each = &(*each)->next_)
    {
        if (*each == &watcher)
        {
            *each = watcher.next_;
            return;
        }
    }
}

} // namespace frames
} // namespace roscfe
