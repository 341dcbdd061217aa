// Transforms from the bus: packets of /tf and /tf_static are read straight into a buffer.
#include "moments.h"
#include "roscfe/frames/transforms_message.h"
#include "ros/callback_queue.h"
#include "ros/console.h"
#include "ros/time.h"
#include "roscfe/ground.h"

namespace roscfe
{

const char *wire::Traits<frames::Transforms>::definition()
{
    return "geometry_msgs/TransformStamped[] transforms\n"
           "================================================================================\n"
           "MSG: geometry_msgs/TransformStamped\n"
           "Header header\n"
           "string child_frame_id\n"
           "Transform transform\n"
           "================================================================================\n"
           "MSG: std_msgs/Header\n"
           "uint32 seq\n"
           "time stamp\n"
           "string frame_id\n"
           "================================================================================\n"
           "MSG: geometry_msgs/Transform\n"
           "Vector3 translation\n"
           "Quaternion rotation\n"
           "================================================================================\n"
           "MSG: geometry_msgs/Vector3\n"
           "float64 x\n"
           "float64 y\n"
           "float64 z\n"
           "================================================================================\n"
           "MSG: geometry_msgs/Quaternion\n"
           "float64 x\n"
           "float64 y\n"
           "float64 z\n"
           "float64 w\n";
}

namespace frames
{

namespace
{

const char *const kAuthority = "unknown_publisher"; // a packet does not say who sent it

// A text that stays where it came.
bool read_text(wire::Reader &reader, std::string_view &text)
{
    std::uint32_t size = 0;
    reader.raw(&size, 1);
    if (!reader.good() || size > reader.getLength())
    {
        return false;
    }
    text = std::string_view(reinterpret_cast<const char *>(reader.advance(size)), size);
    return true;
}

class Ear final : public Subscription
{
  public:
    Ear(Buffer &buffer, const std::string &topic, bool is_static)
        : Subscription(topic, 1, ros::getGlobalCallbackQueue(), 0), buffer_(buffer), is_static_(is_static)
    {
    }

    bool receive(const std::uint8_t *bytes, std::size_t size) override
    {
        const ros::Time now = ros::Time::now();
        if (now < last_)
        {
            // Not as a ros::Duration, which has no room for more than 68 years.
            ROS_WARN("Detected jump back in time of %gs. Clearing TF buffer.",
                     seconds(static_cast<std::int64_t>(last_.toNSec()) - static_cast<std::int64_t>(now.toNSec())));
            buffer_.clear();
        }
        last_ = now;
        if (take(buffer_, bytes, size, is_static_))
        {
            ++g_counters.received;
        }
        else
        {
            ++bad_;
            ++g_counters.bad;
        }
        return false; // no callback is due
    }

    CallResult call() override { return Invalid; }

  private:
    Buffer &  buffer_;
    ros::Time last_;
    bool      is_static_;
};

} // namespace

boost::shared_ptr<Subscription> hear(Buffer &buffer, const std::string &topic, bool is_static)
{
    typedef wire::Traits<Transforms> Type;
    boost::shared_ptr<Subscription> ear = boost::make_shared<Ear>(buffer, topic, is_static);
    subscribe(ear, Type::type(), Type::md5(), Type::definition());
    return ear;
}

namespace
{

// Call a function with each transform of a packet; false when the packet is no whole message.
template <class F>
bool with_each(const std::uint8_t *bytes, std::size_t size, F function)
{
    wire::Reader  reader(bytes, size);
    std::uint32_t count = 0;
    reader.raw(&count, 1);
    for (; count > 0 && reader.good(); --count)
    {
        std::uint32_t    head[3] = {0, 0, 0}; // sequence number, seconds, nanoseconds
        double           numbers[7];
        std::string_view parent, child;
        reader.raw(head, 3);
        if (!read_text(reader, parent) || !read_text(reader, child))
        {
            return false;
        }
        reader.raw(numbers, 7);
        if (reader.good())
        {
            const Rigid rigid = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]};
            function(child, parent, nanoseconds(head[1], head[2]), rigid);
        }
    }
    return reader.good() && reader.at_end();
}

} // namespace

// Nothing of a packet is taken that is no whole message, as of any other type.
bool take(Buffer &buffer, const std::uint8_t *bytes, std::size_t size, bool is_static)
{
    if (!with_each(bytes, size, [](std::string_view, std::string_view, std::int64_t, const Rigid &) {}))
    {
        return false;
    }
    return with_each(bytes, size, [&](std::string_view child, std::string_view parent, std::int64_t stamp,
                                        const Rigid &rigid) {
        buffer.set(child, parent, stamp, rigid, kAuthority, is_static);
    });
}

} // namespace frames
} // namespace roscfe
