// Log lines: the console, /rosout, and events within what EVS takes.
#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <vector>

#include "roscfe/parts.h"

#include "internal.h"
#include "ros/advertise_options.h"
#include "ros/console.h"
#include "roscfe/format.h"

namespace roscfe
{
namespace logging
{

namespace
{

constexpr std::size_t  kLongest     = 1024; // characters of a line
constexpr int          kEventsAtOnce = 16;  // below what EVS squelches an application for, with room for the node's own
constexpr std::int64_t kEventEvery   = kSecond / 8;
constexpr int          kEventsFrom   = ros::console::levels::Warn;

int           g_level       = ros::console::levels::Info;
int           g_events_left = kEventsAtOnce;
std::int64_t  g_refilled_ns = 0;
std::uint32_t g_lost        = 0; // events that were not sent
std::uint32_t g_rosout_seq  = 0;

const char *const kNames[]  = {"DEBUG", " INFO", " WARN", "ERROR", "FATAL"};
const std::uint16_t kTypes[] = {CFE_EVS_EventType_DEBUG, CFE_EVS_EventType_INFORMATION, CFE_EVS_EventType_INFORMATION,
                                CFE_EVS_EventType_ERROR, CFE_EVS_EventType_CRITICAL};

// EVS stops listening to an application that says too much. So there are no more events than it takes, and what is
// left out is counted and said.
void send_event(int level, std::int64_t now, const char *text)
{
    if (g_refilled_ns == 0)
    {
        g_refilled_ns = now;
    }
    while (g_events_left < kEventsAtOnce && g_refilled_ns + kEventEvery <= now)
    {
        ++g_events_left;
        g_refilled_ns += kEventEvery;
    }
    if (g_events_left == kEventsAtOnce)
    {
        g_refilled_ns = now;
    }
    if (g_lost > 0 && g_events_left > 1)
    {
        CFE_EVS_SendEvent(kLogLostEid, CFE_EVS_EventType_ERROR, "%s: %lu log lines were no events",
                          g_node.name.c_str(), static_cast<unsigned long>(g_lost));
        g_lost = 0;
        --g_events_left;
    }
    if (g_events_left == 0)
    {
        ++g_lost;
        return;
    }
    --g_events_left;
    CFE_EVS_SendEvent(kLogEid, kTypes[level], "%s", text);
}

std::uint8_t *put_u32(std::uint8_t *at, std::uint32_t value)
{
    for (int byte = 0; byte < 4; ++byte)
    {
        *at++ = static_cast<std::uint8_t>(value >> (8 * byte));
    }
    return at;
}

std::uint8_t *put_text(std::uint8_t *at, const char *text)
{
    const std::size_t size = std::strlen(text);
    at                     = put_u32(at, static_cast<std::uint32_t>(size));
    std::memcpy(at, text, size);
    return at + size;
}

int print_text(char *to, std::size_t size, const char *form, std::va_list values)
{
    return format::print_by_libc != nullptr ? format::print_by_libc(to, size, form, values)
                                            : format::print(to, size, form, values);
}

__attribute__((format(printf, 3, 4))) int format_text(char *to, std::size_t size, const char *form, ...)
{
    std::va_list values;
    va_start(values, form);
    const int length = print_text(to, size, form, values);
    va_end(values);
    return length;
}

// OS_printf takes so many characters at once, and cuts the rest with the end of the line.
void show(int level, std::int64_t now, const char *text)
{
    static char line[kLongest + 160];
    char        simulated[40] = "";
    if (is_simulated() && ros_now_ns() != 0)
    {
        const std::int64_t time = ros_now_ns();
        format_text(simulated, sizeof simulated, ", %lld.%09lld", static_cast<long long>(time / kSecond),
                      static_cast<long long>(time % kSecond));
    }
    const int length = format_text(line, sizeof line, "[%s] [%s] [%lld.%09lld%s]: %s", g_node.name.c_str(), kNames[level],
                                     static_cast<long long>(now / kSecond), static_cast<long long>(now % kSecond), simulated,
                                     text);
    constexpr int kPiece = OS_BUFFER_SIZE - 2; // room for the end of the line, and of the text
    const int     size   = std::min(length, static_cast<int>(sizeof line) - 1);
    int           at     = 0;
    for (; size - at > kPiece; at += kPiece)
    {
        OS_printf("%.*s", kPiece, line + at);
    }
    OS_printf("%s\n", line + at);
}

// rosgraph_msgs/Log, without a list of topics.
void publish(int level, std::int64_t now, const char *file, int line, const char *function, const char *text)
{
    parts::need(parts::subscribers); // of /rosout
    if (!g_node.started || !g_node.knows_subscribers || pipes_on(kRosoutMsgId) == 0)
    {
        return;
    }
    const std::size_t size = 4 + 8 + 4 + 1 + 4 + g_node.name.size() + 4 + std::strlen(text) + 4 + std::strlen(file) + 4 +
                             std::strlen(function) + 4 + 4;
    CFE_SB_Buffer_t *buffer = begin_packet(kRosoutMsgId, kTelemetryHeader + size);
    if (buffer == nullptr)
    {
        return;
    }
    std::uint8_t *at = bytes_of(buffer) + kTelemetryHeader;
    at               = put_u32(at, g_rosout_seq++);
    at               = put_u32(at, static_cast<std::uint32_t>(now / kSecond));
    at               = put_u32(at, static_cast<std::uint32_t>(now % kSecond));
    at               = put_u32(at, 0); // frame_id
    *at++            = static_cast<std::uint8_t>(1 << level);
    at               = put_text(at, g_node.name.c_str());
    at               = put_text(at, text);
    at               = put_text(at, file);
    at               = put_text(at, function);
    at               = put_u32(at, static_cast<std::uint32_t>(line));
    put_u32(at, 0); // topics
    send_packet(buffer);
}

} // namespace

bool is_enabled(int level)
{
    return level >= g_level;
}

void set_level(int level)
{
    g_level = level;
}

void print(int level, const char *file, int line, const char *function, const char *format, ...)
{
    if (g_node.is_shut)
    {
        return; // ros::shutdown() ends rosconsole in roscpp
    }
    static char  text[kLongest];
    std::va_list arguments;
    va_start(arguments, format);
    const int length = print_text(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length >= static_cast<int>(sizeof text))
    {
        std::memcpy(text + sizeof text - 4, "...", 4);
    }
    const std::int64_t now = now_ns();
    show(level, now, text);
    publish(level, ros_now_ns(), file, line, function, text);
    if (level >= kEventsFrom)
    {
        send_event(level, now, text);
    }
}

bool is_due(double period, std::int64_t &last_ns, bool first)
{
    const std::int64_t now = ros_now_ns();
    if (last_ns < 0)
    {
        last_ns = now;
        return first;
    }
    if (now - last_ns < static_cast<std::int64_t>(period * 1e9))
    {
        return false;
    }
    last_ns = now;
    return true;
}

} // namespace logging

void log_other_type(const Publication &there, const ros::AdvertiseOptions &options)
{
    ROS_ERROR("Tried to advertise on topic [%s] with md5sum [%s] and datatype [%s], but the topic is already advertised as "
              "md5sum [%s] and datatype [%s]",
              there.topic_.c_str(), options.md5sum.c_str(), options.datatype.c_str(), there.md5_.c_str(),
              there.type_.c_str());
}

} // namespace roscfe

namespace ros
{
namespace console
{

bool set_logger_level(const std::string &, levels::Level level)
{
    roscfe::logging::set_level(level);
    return true;
}

bool get_loggers(std::map<std::string, levels::Level> &loggers)
{
    loggers.clear();
    for (int level = levels::Debug; level < levels::Count; ++level)
    {
        if (roscfe::logging::is_enabled(level))
        {
            loggers[ROSCONSOLE_DEFAULT_NAME] = static_cast<levels::Level>(level);
            break;
        }
    }
    return true;
}

} // namespace console
} // namespace ros
