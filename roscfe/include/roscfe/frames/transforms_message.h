// tf2_msgs/TFMessage, the type of /tf and /tf_static, as it is sent and heard here: without a message in between.
#ifndef ROSCFE_FRAMES_TRANSFORMS_MESSAGE_H
#define ROSCFE_FRAMES_TRANSFORMS_MESSAGE_H

#include <boost/shared_ptr.hpp>

#include <geometry_msgs/TransformStamped.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "ros/exception.h"
#include "roscfe/frames/buffer.h"
#include "roscfe/subscription.h"
#include "roscfe/wire.h"

namespace roscfe
{
namespace frames
{

// Transforms that stand elsewhere, one behind the other. On the wire they are a tf2_msgs/TFMessage.
struct Transforms
{
    const geometry_msgs::TransformStamped *first;
    std::size_t                            count;
};

// Fill a buffer with what comes on a topic: at once, whatever the node is waiting for at the time. A listener of ROS
// has a thread of its own for that. The topic's name is resolved.
boost::shared_ptr<Subscription> hear(Buffer &buffer, const std::string &topic, bool is_static);

// Read the bytes of a tf2_msgs/TFMessage into a buffer. False: they are none; the transforms before are taken.
bool take(Buffer &buffer, const std::uint8_t *bytes, std::size_t size, bool is_static);

} // namespace frames

namespace wire
{

template <>
struct Fields<frames::Transforms>
{
    static constexpr std::size_t kLeast = 4;
    static constexpr bool        kFixed = false;

    template <class Stream, class Message>
    static void visit(Stream &stream, Message &message)
    {
        const std::uint32_t count = static_cast<std::uint32_t>(message.count);
        stream.raw(&count, 1);
        for (std::size_t at = 0; at < message.count; ++at)
        {
            stream.next(message.first[at]);
        }
    }
};

template <>
struct Traits<frames::Transforms>
{
    static constexpr bool has_header    = false;
    static constexpr bool is_fixed_size = false;

    static const char *md5() { return "94810edda583a504dfda3829e70d7eec"; }
    static const char *type() { return "tf2_msgs/TFMessage"; }
    static const char *definition();
};

} // namespace wire
} // namespace roscfe

#endif
