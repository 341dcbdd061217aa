// A node's own types as messages, and its own use of streams. It compiles against roscpp's headers as well: own_types.txt
// is what it prints there.
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <geometry_msgs/PoseArray.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>
#include <std_msgs/String.h>

namespace demo
{

struct Point
{
    double x, y;
};

struct Track
{
    std_msgs::Header         header;
    std::string              name;
    std::vector<Point>       points;
    boost::array<int16_t, 3> axes;
    std::vector<std::string> tags;
    bool                     closed;
};

// Has its bytes without fields: a count, then the letters.
struct Blob
{
    char     bytes[8];
    uint32_t size;
};

} // namespace demo

namespace ros
{
namespace serialization
{

template <>
struct Serializer<demo::Point>
{
    template <typename Stream, typename T>
    inline static void allInOne(Stream &stream, T point)
    {
        stream.next(point.x);
        stream.next(point.y);
    }
    ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<demo::Track>
{
    template <typename Stream, typename T>
    inline static void allInOne(Stream &stream, T track)
    {
        stream.next(track.header);
        stream.next(track.name);
        stream.next(track.points);
        stream.next(track.axes);
        stream.next(track.tags);
        stream.next(track.closed);
    }
    ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<demo::Blob>
{
    template <typename Stream>
    inline static void write(Stream &stream, const demo::Blob &blob)
    {
        stream.next(blob.size);
        std::memcpy(stream.advance(blob.size), blob.bytes, blob.size);
    }
    template <typename Stream>
    inline static void read(Stream &stream, demo::Blob &blob)
    {
        stream.next(blob.size);
        std::memcpy(blob.bytes, stream.advance(blob.size), blob.size);
    }
    inline static uint32_t serializedLength(const demo::Blob &blob) { return 4 + blob.size; }
};

} // namespace serialization

namespace message_traits
{

template <>
struct IsMessage<demo::Track> : public TrueType
{
};
template <>
struct HasHeader<demo::Track> : public TrueType
{
};

} // namespace message_traits
} // namespace ros

ROS_IMPLEMENT_SIMPLE_TOPIC_TRAITS(demo::Track, "0123456789abcdef0123456789abcdef", "demo/Track", "Header header\n")

static void print(const char *what, const ros::SerializedMessage &message)
{
    const int start = message.message_start ? static_cast<int>(message.message_start - message.buf.get()) : -1;
    std::printf("%s %zu %d:", what, message.num_bytes, start);
    for (std::size_t index = 0; index < message.num_bytes; ++index)
        std::printf(" %02x", message.buf[static_cast<std::ptrdiff_t>(index)]);
    std::printf("\n");
}

template <class Function>
static void print_overrun(const char *what, Function function)
{
    try
    {
        function();
        std::printf("%s went well\n", what);
    }
    catch (const ros::serialization::StreamOverrunException &)
    {
        std::printf("%s: overrun\n", what);
    }
}

int main()
{
    namespace ser = ros::serialization;
    namespace mt  = ros::message_traits;

    demo::Track track{};
    track.header.seq      = 2;
    track.header.stamp    = ros::Time(3, 4);
    track.header.frame_id = "map";
    track.name            = "first";
    track.points          = {{1, 2}, {3, 4}};
    track.axes[1]         = -2;
    track.tags            = {"a", "", "bc"};
    track.closed          = true;
    std::printf("%u bytes\n", ser::serializationLength(track));
    const ros::SerializedMessage bytes = ser::serializeMessage(track);
    print("track", bytes);

    demo::Track again{};
    again.tags.resize(9);
    ser::deserializeMessage(bytes, again);
    std::printf("%s %s %zu %g %d %zu %d\n", again.header.frame_id.c_str(), again.name.c_str(), again.points.size(),
                again.points[1].y, again.axes[1], again.tags.size(), again.closed);
    std::printf("%s %s %s %d %d\n", mt::md5sum<demo::Track>(), mt::datatype(track), mt::definition<demo::Track>(),
                mt::hasHeader<demo::Track>(), mt::isFixedSize<demo::Track>());
    std::printf("%s %u\n", mt::frameId(track)->c_str(), mt::timeStamp(track)->sec);
    std::printf("%d\n", mt::frameId(again.name) == nullptr);

    demo::Blob blob = {"letters", 7};
    print("blob", ser::serializeMessage(blob));
    print("answer", ser::serializeServiceResponse(true, blob));
    print("refusal", ser::serializeServiceResponse(false, std::string("no")));

    std::vector<uint8_t> room(64);
    ser::OStream         out(room.data(), 64);
    out << static_cast<uint16_t>(513) << std::string("x") << std::vector<float>(2, 1.0f) << ros::Duration(-0.5);
    std::printf("%u left\n", out.getLength());
    ser::IStream         in(room.data(), 64);
    uint16_t             number = 0;
    std::string          text;
    std::vector<float>   floats;
    ros::Duration        span;
    in >> number >> text >> floats >> span;
    std::printf("%d %s %zu %g, %u left\n", number, text.c_str(), floats.size(), span.toSec(), in.getLength());
    ser::LStream count;
    count.next(text);
    count.advance(5);
    std::printf("%u counted\n", count.getLength());

    print_overrun("writing", [&] {
        ser::OStream small(room.data(), 3);
        small.next(text);
    });
    print_overrun("reading", [&] {
        ser::IStream small(room.data(), 3);
        uint32_t     wide = 0;
        small.next(wide);
    });
    print_overrun("reading a track", [&] {
        ser::IStream cut(bytes.message_start, 20);
        ser::deserialize(cut, again);
    });
    print_overrun("reading a blob", [&] {
        uint8_t      hostile[] = {5, 0, 0, 0, 'a'};
        ser::IStream cut(hostile, 5);
        ser::deserialize(cut, blob);
    });
    print_overrun("exactly", [&] {
        ser::OStream exact(room.data(), 5);
        ser::serialize(exact, text);
    });
}
