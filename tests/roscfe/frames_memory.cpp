// A buffer of transforms in a node that may not allocate: after its construction there is not one `new`.
// Prints what it counted; also what a full buffer forgets, and what bytes from the bus that are no message do to it.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "roscfe/frames/transforms_message.h"
#include "tf2/buffer_core.h"
#include "tf2_geometry_msgs/tf2_geometry_msgs.h"

static unsigned long g_news = 0;

void *operator new(std::size_t size)
{
    ++g_news;
    return std::malloc(size);
}
void operator delete(void *at) noexcept
{
    std::free(at);
}
void operator delete(void *at, std::size_t) noexcept
{
    std::free(at);
}

static const char *const kNames[] = {"a_rather_long_name_of_a_frame_1", "a_rather_long_name_of_a_frame_2", "base",
                                     "a_rather_long_name_of_a_frame_3"};

static geometry_msgs::TransformStamped sample(int at, unsigned step)
{
    geometry_msgs::TransformStamped made;
    made.header.frame_id         = at == 0 ? "map" : kNames[at - 1];
    made.child_frame_id          = kNames[at];
    made.header.stamp            = ros::Time(100 + step / 100, step % 100 * 10000000);
    made.transform.translation.x = step;
    made.transform.rotation.w    = 1.0;
    return made;
}

// Everything that a node does with transforms, for many seconds. The bytes are of a tf2_msgs/TFMessage.
static double fly(tf2::BufferCore &buffer, unsigned char *bytes, std::size_t size)
{
    double sum = 0;
    for (unsigned step = 0; step < 5000; ++step)
    {
        geometry_msgs::TransformStamped all[4];
        for (int at = 0; at < 4; ++at)
        {
            all[at] = sample(at, step);
        }
        const roscfe::frames::Transforms message = {all, 4};
        const std::size_t                length  = roscfe::wire::length(message);
        if (length > size || !roscfe::wire::write(message, bytes, length) ||
            !roscfe::frames::take(buffer.frames(), bytes, length, false))
        {
            std::printf("not taken\n");
        }
        buffer.setTransform(all[0], "again"); // a repetition is refused, and logged
        const ros::Time middle = ros::Time(100 + step / 100, step % 100 * 10000000 / 2 + 1);
        sum += buffer.lookupTransform("map", kNames[3], ros::Time()).transform.translation.x;
        sum += buffer.canTransform("map", kNames[3], middle) + buffer.canTransform(kNames[3], "nowhere", middle);
        geometry_msgs::PoseStamped pose;
        pose.header.frame_id    = kNames[2];
        pose.pose.orientation.w = 1.0;
        tf2::doTransform(pose, pose, buffer.lookupTransform("map", ros::Time(), kNames[2], ros::Time(), "base"));
        sum += pose.pose.position.x;
    }
    return sum;
}

// Bytes that end early, or have one that is wrong.
static void harm(const unsigned char *good, std::size_t size)
{
    roscfe::frames::Buffer buffer({8, 32, 64}, 10000000000);
    unsigned long          refused = 0;
    for (std::size_t length = 0; length < size; ++length)
    {
        std::vector<unsigned char> part(good, good + length);
        refused += !roscfe::frames::take(buffer, part.data(), part.size(), false);
    }
    std::printf("cut: %lu of %lu refused\n", refused, static_cast<unsigned long>(size));
    for (std::size_t at = 0; at < size; ++at)
    {
        for (unsigned bit = 0; bit < 8; ++bit)
        {
            std::vector<unsigned char> wrong(good, good + size);
            wrong[at] = static_cast<unsigned char>(wrong[at] ^ 1u << bit);
            roscfe::frames::take(buffer, wrong.data(), wrong.size(), false);
        }
    }
    std::printf("frames: %lu\n", static_cast<unsigned long>(buffer.frame_count()));
}

int main()
{
    std::vector<unsigned char> bytes(2000);
    tf2::BufferCore            buffer;
    const unsigned long        before = g_news;
    const double               sum    = fly(buffer, bytes.data(), bytes.size());
    std::printf("news: %lu, sum %g\n", g_news - before, sum);
    std::printf("forgotten early: %lu\n", static_cast<unsigned long>(buffer.frames().cut_short()));
    std::printf("oldest: %d %d\n", buffer.canTransform("map", kNames[0], ros::Time(147, 0)),
                buffer.canTransform("map", kNames[0], ros::Time(145, 0)));

    const geometry_msgs::TransformStamped one     = sample(1, 7);
    const roscfe::frames::Transforms      message = {&one, 1};
    const std::size_t                     length  = roscfe::wire::length(message);
    roscfe::wire::write(message, bytes.data(), length);
    harm(bytes.data(), length);
}
