// A buffer of transforms that does what lines on the standard input say, and prints the answers.
// Compiled against the headers of cfepy or those of a real ROS. "-" stands for an empty name; times are nanoseconds.
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "tf2/buffer_core.h"
#include "tf2/exceptions.h"

static ros::Time moment(std::uint64_t ns)
{
    return ros::Time(ns / 1000000000u, ns % 1000000000u);
}

static std::string word(std::istream &from)
{
    std::string text;
    from >> text;
    return text == "-" ? "" : text;
}

static ros::Time when(std::istream &from)
{
    std::uint64_t ns = 0;
    from >> ns;
    return moment(ns);
}

static double number(std::istream &from)
{
    std::string text;
    from >> text;
    return std::strtod(text.c_str(), nullptr);
}

static void set(tf2::BufferCore &buffer, std::istream &from)
{
    geometry_msgs::TransformStamped message;
    message.child_frame_id   = word(from);
    message.header.frame_id  = word(from);
    message.header.stamp     = when(from);
    const bool        fixed  = word(from) == "static";
    const std::string author = word(from);
    auto &            t      = message.transform;
    for (double *each : {&t.translation.x, &t.translation.y, &t.translation.z, &t.rotation.x, &t.rotation.y,
                         &t.rotation.z, &t.rotation.w})
        *each = number(from);
    std::printf("%d\n", buffer.setTransform(message, author, fixed));
}

static void print(const geometry_msgs::TransformStamped &found)
{
    const auto &t = found.transform.translation;
    const auto &r = found.transform.rotation;
    std::printf("%llu %s %s %a %a %a %a %a %a %a\n", (unsigned long long)found.header.stamp.toNSec(),
                found.header.frame_id.c_str(), found.child_frame_id.c_str(), t.x, t.y, t.z, r.x, r.y, r.z, r.w);
}

static void answer(tf2::BufferCore &buffer, const std::string &what, std::istream &from)
{
    if (what == "look" || what == "can")
    {
        const std::string target = word(from), source = word(from);
        const ros::Time   time = when(from);
        std::string       text;
        if (what == "look")
            print(buffer.lookupTransform(target, source, time));
        else
            std::printf("%d ", buffer.canTransform(target, source, time, &text)), std::printf("%s\n", text.c_str());
    }
    else if (what == "lookfull" || what == "canfull" || what == "chain")
    {
        const std::string target = word(from);
        const ros::Time   target_time = when(from);
        const std::string source = word(from);
        const ros::Time   source_time = when(from);
        const std::string        fixed = word(from);
        std::string              text;
        std::vector<std::string> names;
        if (what == "lookfull")
            print(buffer.lookupTransform(target, target_time, source, source_time, fixed));
        else if (what == "canfull")
        {
            std::printf("%d ", buffer.canTransform(target, target_time, source, source_time, fixed, &text));
            std::printf("%s\n", text.c_str());
        }
        else
        {
            buffer._chainAsVector(target, target_time, source, source_time, fixed, names);
            for (const std::string &name : names)
                std::printf("%s ", name.c_str());
            std::printf("\n");
        }
    }
    else if (what == "common")
    {
        const auto  target = buffer._lookupFrameNumber(word(from)), source = buffer._lookupFrameNumber(word(from));
        ros::Time   time;
        std::string text;
        const int   error = buffer._getLatestCommonTime(target, source, time, &text);
        std::printf("%d %llu %s\n", error, (unsigned long long)time.toNSec(), text.c_str());
    }
    else if (what == "parent")
    {
        const std::string frame = word(from);
        std::string       parent;
        const bool        has = buffer._getParent(frame, when(from), parent);
        std::printf("%d %d %s\n", buffer._frameExists(frame), has, has ? parent.c_str() : "");
    }
    else if (what == "string")
        std::printf("%s\n", buffer.allFramesAsString().c_str());
    else if (what == "yaml")
        std::printf("%s\n", buffer.allFramesAsYAML(number(from)).c_str());
    else if (what == "dot")
        std::printf("%s\n", buffer._allFramesAsDot(number(from)).c_str());
    else if (what == "clear")
        buffer.clear();
    else if (what == "set")
        set(buffer, from);
}

template <class Error>
static void print(const char *name, const Error &error)
{
    std::printf("%s: %s\n", name, error.what());
}

int main(int, char **args)
{
    tf2::BufferCore buffer{ros::Duration(std::atof(args[1]))};
    for (std::string line; std::getline(std::cin, line);)
    {
        std::istringstream from(line);
        const std::string  what = word(from);
#if defined(__cpp_exceptions)
        try
        {
            answer(buffer, what, from);
        }
        catch (const tf2::LookupException &error)
        {
            print("LookupException", error);
        }
        catch (const tf2::ConnectivityException &error)
        {
            print("ConnectivityException", error);
        }
        catch (const tf2::ExtrapolationException &error)
        {
            print("ExtrapolationException", error);
        }
        catch (const tf2::InvalidArgumentException &error)
        {
            print("InvalidArgumentException", error);
        }
#else
        answer(buffer, what, from);
#endif
        std::fflush(stdout);
    }
}
