// The tree of frames with the transforms of some seconds (tf2::BufferCore, as plain numbers).
//
// All memory is taken when it is made: frames by name, and samples that the frames share. Nothing is thrown; what is
// wrong is a Failure, of which a text is made when somebody wants it. Times are nanoseconds; 0 is the latest.
#ifndef ROSCFE_FRAMES_BUFFER_H
#define ROSCFE_FRAMES_BUFFER_H

#include <cstdint>
#include <memory>
#include <string_view>

#include "roscfe/frames/text.h"

namespace roscfe
{
namespace frames
{

typedef std::uint32_t FrameId; // 0 is no frame

constexpr std::int64_t  kForever = INT64_MAX;
constexpr std::uint32_t kDeepest = 1000; // a way as long as this means a loop

// A translation, then a rotation as a quaternion.
struct Rigid
{
    double x = 0.0, y = 0.0, z = 0.0;
    double qx = 0.0, qy = 0.0, qz = 0.0, qw = 1.0;
};

// How much a buffer holds.
struct Capacity
{
    std::uint32_t frames;
    std::uint32_t samples; // of all frames together; when they are used up, the longest history loses its oldest
    std::uint32_t name;    // characters of a frame's name
};

// Why a transform is not to be had.
struct Failure
{
    enum Kind : std::uint8_t
    {
        none,
        empty_name,    // InvalidArgumentException
        slash,         // InvalidArgumentException
        unknown_frame, // LookupException
        loop,          // LookupException
        no_connection, // ConnectivityException
        extrapolation, // ExtrapolationException
        undefined      // a number that is no frame's
    };
    Kind             kind = none;
    const char *     role = "";     // what the name below was given as
    std::string_view name;          // of the frame that is unknown, or ill-formed
    FrameId          target = 0, source = 0;
    FrameId          frame = 0;     // the one that has no sample at the time
    std::int64_t     time  = 0;

    explicit operator bool() const { return kind != none; }
};

class Buffer
{
  public:
    // keep_ns: how old samples become, behind the newest of their frame.
    Buffer(const Capacity &capacity, std::int64_t keep_ns);
    ~Buffer();
    Buffer(const Buffer &) = delete;
    Buffer &operator=(const Buffer &) = delete;

    // Take in a transform from a frame to its parent; one that makes no sense is logged and left out.
    // `authority` is who says so. True when it was taken.
    bool set(std::string_view child, std::string_view parent, std::int64_t stamp, const Rigid &rigid,
             std::string_view authority, bool is_static);

    // Forget all samples that are not static; the frames stay known.
    void clear();

    // What takes coordinates in the source frame to the target frame, and the time that it holds for.
    Failure look_up(std::string_view target, std::string_view source, std::int64_t time, Rigid &found,
                    std::int64_t &when) const;

    // The same from one time to another, by way of a frame that does not move in between.
    Failure look_up(std::string_view target, std::int64_t target_time, std::string_view source,
                    std::int64_t source_time, std::string_view fixed, Rigid &found, std::int64_t &when) const;

    // Whether it is to be had; the text is why not, and may be null.
    bool can(std::string_view target, std::string_view source, std::int64_t time, Text *why_not) const;
    bool can(std::string_view target, std::int64_t target_time, std::string_view source, std::int64_t source_time,
             std::string_view fixed, Text *why_not) const;
    bool can(FrameId target, FrameId source, std::int64_t time, Text *why_not) const;

    // The latest time at which the way between two frames is covered; 0 for any time.
    Failure latest_common_time(FrameId target, FrameId source, std::int64_t &time) const;

    // The frames from the source by way of the fixed frame to the target, one after another to `add`.
    template <class Add>
    Failure chain(std::string_view target, std::int64_t target_time, std::string_view source, std::int64_t source_time,
                  std::string_view fixed, const Add &add) const;

    Failure validate(const char *role, std::string_view name, FrameId &id) const;
    void    describe(const Failure &failure, Text &text) const;

    // -- frames ----------------------------------------------------------------------------------------------------

    FrameId          find(std::string_view name) const; // 0 when it is unknown
    FrameId          find_or_add(std::string_view name);
    std::string_view name_of(FrameId id) const;
    std::uint32_t    frame_count() const { return frame_count_; }          // ids are 1 to this
    FrameId          parent_at(FrameId id, std::int64_t time) const;       // 0: it has none, or no sample then
    std::int64_t     keep_ns() const { return keep_ns_; }
    std::uint32_t    cut_short() const { return cut_short_; } // samples that went before their time, for lack of room

    void all_as_string(Text &text) const;
    void all_as_yaml(Text &text, double now) const; // a negative now leaves the age out
    void all_as_dot(Text &text, double now) const;  // 0 leaves the ages out

    // Called after each transform that was taken: one who waits for them, such as a message filter.
    struct Watcher
    {
        virtual ~Watcher() = default;
        virtual void transforms_changed() = 0;

      private:
        friend class Buffer;
        Watcher *next_ = nullptr;
    };
    void watch(Watcher &watcher);
    void watch_no_more(Watcher &watcher);

  private:
    typedef std::uint32_t SampleId; // 0 is none

    struct Sample
    {
        std::int64_t stamp;
        Rigid        rigid;
        FrameId      parent;
        SampleId     older, newer;
    };
    struct Frame
    {
        SampleId      newest = 0, oldest = 0;
        std::uint32_t count       = 0;
        std::uint32_t name_length = 0, authority_length = 0;
        bool          has_cache = false; // a parent was given once
        bool          is_static = false;
    };
    struct Step // of a way upwards: a frame's parent, and the time of its newest sample
    {
        std::int64_t stamp;
        FrameId      parent;
    };
    class Way;

    // -- samples (samples.cpp) -------------------------------------------------------------------------------------

    const char *insert(FrameId id, std::int64_t stamp, const Rigid &rigid, FrameId parent); // why not, or null
    void        drop_oldest(FrameId id);
    SampleId    new_sample(FrameId id);
    SampleId    not_after(const Frame &frame, std::int64_t stamp) const; // the newest one that is no newer
    bool        sample_at(FrameId id, std::int64_t time, Rigid &rigid, FrameId &parent) const;
    Step        newest(FrameId id) const;

    // -- ways through the tree (tree.cpp) --------------------------------------------------------------------------

    Failure walk(Way &way, std::int64_t time, FrameId target, FrameId source) const;
    Failure walk_chain(std::int64_t time, FrameId target, FrameId source, std::uint32_t &count) const;
    Failure look_up(FrameId target, FrameId source, std::int64_t time, Rigid &found, std::int64_t &when) const;
    Failure no_connection(FrameId target, FrameId source) const;
    bool    unknown(const char *const *roles, const std::string_view *names, FrameId *ids, int count,
                    Text *why_not) const;

    char *name_at(FrameId id) const { return &names_[static_cast<std::size_t>(id) * capacity_.name]; }
    char *authority_at(FrameId id) const { return &authorities_[static_cast<std::size_t>(id) * capacity_.name]; }

    const Capacity     capacity_;
    const std::int64_t keep_ns_;
    std::uint32_t      frame_count_ = 0;
    std::uint32_t      sample_count_ = 0; // that were in use at any time
    SampleId           free_ = 0;         // those that are free again
    std::uint32_t      cut_short_ = 0;
    Watcher *          watchers_ = nullptr;

    std::unique_ptr<Frame[]>   frames_; // by id, so that the first one is none
    std::unique_ptr<Sample[]>  samples_;
    std::unique_ptr<char[]>    names_;
    std::unique_ptr<char[]>    authorities_;
    std::unique_ptr<Step[]>    steps_; // of the way that is being looked for
    std::unique_ptr<FrameId[]> chain_;
};

template <class Add>
Failure Buffer::chain(std::string_view target, std::int64_t target_time, std::string_view source,
                      std::int64_t source_time, std::string_view fixed, const Add &add) const
{
    // As in tf2, an unknown name is no error by itself: the way that begins or ends there is looked for, and not found.
    const FrameId target_id = find(target), source_id = find(source), fixed_id = find(fixed);
    std::uint32_t count     = 0;
    Failure       failure   = walk_chain(source_time, fixed_id, source_id, count);
    // The fixed frame comes again as the first one of the second way, unless that way has no length.
    const std::uint32_t first = count - (target_id != fixed_id && count != 0 ? 1 : 0);
    for (std::uint32_t at = 0; !failure && at < first; ++at)
    {
        add(name_of(chain_[at]));
    }
    failure = failure ? failure : walk_chain(target_time, target_id, fixed_id, count);
    for (std::uint32_t at = 0; !failure && at < count; ++at)
    {
        add(name_of(chain_[at]));
    }
    return failure;
}

} // namespace frames
} // namespace roscfe

#endif
