// Log lines: on the console as ROS prints them, on /rosout when somebody listens, and from a level on as events.
#ifndef ROSCONSOLE_ROSCONSOLE_H
#define ROSCONSOLE_ROSCONSOLE_H

#include <cstdio>
#include <map>
#include <sstream>
#include <string>

#include "ros/time.h"
#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
#include "roscfe/log_stream.h"
#include "roscfe/standard_streams.h"
#define ROSCFE_STREAM_ ::roscfe::LogStream
#define ROSCFE_TEXT_OF_(stream) (stream).text()
#else
#include <iostream>
#define ROSCFE_STREAM_ std::ostringstream
#define ROSCFE_TEXT_OF_(stream) (stream).str().c_str()
#endif

#ifndef ROSCONSOLE_DEFAULT_NAME
#ifdef ROS_PACKAGE_NAME
#define ROSCONSOLE_DEFAULT_NAME "ros." ROS_PACKAGE_NAME
#else
#define ROSCONSOLE_DEFAULT_NAME "ros"
#endif
#endif
#define ROSCONSOLE_ROOT_LOGGER_NAME "ros"
#define ROSCONSOLE_NAME_PREFIX ROSCONSOLE_DEFAULT_NAME

#define ROSCONSOLE_SEVERITY_DEBUG 0
#define ROSCONSOLE_SEVERITY_INFO 1
#define ROSCONSOLE_SEVERITY_WARN 2
#define ROSCONSOLE_SEVERITY_ERROR 3
#define ROSCONSOLE_SEVERITY_FATAL 4
#define ROSCONSOLE_SEVERITY_NONE 5
#ifndef ROSCONSOLE_MIN_SEVERITY
#define ROSCONSOLE_MIN_SEVERITY ROSCONSOLE_SEVERITY_DEBUG
#endif

namespace ros
{
namespace console
{

namespace levels
{
enum Level
{
    Debug,
    Info,
    Warn,
    Error,
    Fatal,
    Count
};
}
typedef levels::Level Level;

class FilterBase
{
  public:
    virtual ~FilterBase() = default;
    virtual bool isEnabled() { return true; }
};

bool set_logger_level(const std::string &name, levels::Level level);
bool get_loggers(std::map<std::string, levels::Level> &loggers);
inline void notifyLoggerLevelsChanged() {}
inline void initialize() {}

} // namespace console
} // namespace ros

namespace roscfe
{
namespace logging
{

bool is_enabled(int level);

// A line of a log; longer ones are cut at kLongest characters, which the line says.
void print(int level, const char *file, int line, const char *function, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

// Whether a period, in seconds, has passed since the last time that it had; of the first time as `first` says.
bool is_due(double period, std::int64_t &last_ns, bool first);

} // namespace logging
} // namespace roscfe

#define ROSCFE_LOG_(condition, level, ...)                                                                             \
    do                                                                                                                 \
    {                                                                                                                  \
        if ((level) >= ROSCONSOLE_MIN_SEVERITY && ::roscfe::logging::is_enabled(level) && (condition))                 \
        {                                                                                                              \
            ::roscfe::logging::print(level, __FILE__, __LINE__, __FUNCTION__, __VA_ARGS__);                            \
        }                                                                                                              \
    } while (0)
#define ROSCFE_LOG_STREAM_(condition, level, args)                                                                     \
    do                                                                                                                 \
    {                                                                                                                  \
        if ((level) >= ROSCONSOLE_MIN_SEVERITY && ::roscfe::logging::is_enabled(level) && (condition))                 \
        {                                                                                                              \
            ROSCFE_STREAM_ roscfe_stream_;                                                                             \
            roscfe_stream_ << args;                                                                                    \
            ::roscfe::logging::print(level, __FILE__, __LINE__, __FUNCTION__, "%s", ROSCFE_TEXT_OF_(roscfe_stream_));  \
        }                                                                                                              \
    } while (0)

// Conditions that remember, each in the function that it stands in.
#define ROSCFE_ONCE_ ([]() { static bool done = false; const bool first = !done; done = true; return first; }())
#define ROSCFE_DUE_(period, first)                                                                                     \
    ([](double seconds) { static std::int64_t last = -1; return ::roscfe::logging::is_due(seconds, last, first); }(period))

// ROS_LOG and its kin take a level as ros::console::levels has it, and a name.
#define ROS_LOG(level, name, ...) ROSCFE_LOG_(true, level, __VA_ARGS__)
#define ROS_LOG_STREAM(level, name, args) ROSCFE_LOG_STREAM_(true, level, args)
#define ROS_LOG_COND(condition, level, name, ...) ROSCFE_LOG_(condition, level, __VA_ARGS__)
#define ROS_LOG_STREAM_COND(condition, level, name, args) ROSCFE_LOG_STREAM_(condition, level, args)
#define ROS_LOG_ONCE(level, name, ...) ROSCFE_LOG_(ROSCFE_ONCE_, level, __VA_ARGS__)
#define ROS_LOG_STREAM_ONCE(level, name, args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, level, args)
#define ROS_LOG_THROTTLE(period, level, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), level, __VA_ARGS__)
#define ROS_LOG_STREAM_THROTTLE(period, level, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), level, args)
#define ROS_LOG_DELAYED_THROTTLE(period, level, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), level, __VA_ARGS__)
#define ROS_LOG_STREAM_DELAYED_THROTTLE(period, level, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), level, args)
#define ROS_LOG_FILTER(filter, level, name, ...) ROSCFE_LOG_((filter)->isEnabled(), level, __VA_ARGS__)
#define ROS_LOG_STREAM_FILTER(filter, level, name, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), level, args)

#define ROS_DEBUG(...) ROSCFE_LOG_(true, 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM(args) ROSCFE_LOG_STREAM_(true, 0, args)
#define ROS_DEBUG_NAMED(name, ...) ROSCFE_LOG_(true, 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_NAMED(name, args) ROSCFE_LOG_STREAM_(true, 0, args)
#define ROS_DEBUG_COND(condition, ...) ROSCFE_LOG_(condition, 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_COND(condition, args) ROSCFE_LOG_STREAM_(condition, 0, args)
#define ROS_DEBUG_COND_NAMED(condition, name, ...) ROSCFE_LOG_(condition, 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_COND_NAMED(condition, name, args) ROSCFE_LOG_STREAM_(condition, 0, args)
#define ROS_DEBUG_ONCE(...) ROSCFE_LOG_(ROSCFE_ONCE_, 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_ONCE(args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 0, args)
#define ROS_DEBUG_ONCE_NAMED(name, ...) ROSCFE_LOG_(ROSCFE_ONCE_, 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_ONCE_NAMED(name, args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 0, args)
#define ROS_DEBUG_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 0, args)
#define ROS_DEBUG_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 0, args)
#define ROS_DEBUG_DELAYED_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_DELAYED_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 0, args)
#define ROS_DEBUG_DELAYED_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_DELAYED_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 0, args)
#define ROS_DEBUG_FILTER(filter, ...) ROSCFE_LOG_((filter)->isEnabled(), 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_FILTER(filter, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 0, args)
#define ROS_DEBUG_FILTER_NAMED(filter, name, ...) ROSCFE_LOG_((filter)->isEnabled(), 0, __VA_ARGS__)
#define ROS_DEBUG_STREAM_FILTER_NAMED(filter, name, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 0, args)

#define ROS_INFO(...) ROSCFE_LOG_(true, 1, __VA_ARGS__)
#define ROS_INFO_STREAM(args) ROSCFE_LOG_STREAM_(true, 1, args)
#define ROS_INFO_NAMED(name, ...) ROSCFE_LOG_(true, 1, __VA_ARGS__)
#define ROS_INFO_STREAM_NAMED(name, args) ROSCFE_LOG_STREAM_(true, 1, args)
#define ROS_INFO_COND(condition, ...) ROSCFE_LOG_(condition, 1, __VA_ARGS__)
#define ROS_INFO_STREAM_COND(condition, args) ROSCFE_LOG_STREAM_(condition, 1, args)
#define ROS_INFO_COND_NAMED(condition, name, ...) ROSCFE_LOG_(condition, 1, __VA_ARGS__)
#define ROS_INFO_STREAM_COND_NAMED(condition, name, args) ROSCFE_LOG_STREAM_(condition, 1, args)
#define ROS_INFO_ONCE(...) ROSCFE_LOG_(ROSCFE_ONCE_, 1, __VA_ARGS__)
#define ROS_INFO_STREAM_ONCE(args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 1, args)
#define ROS_INFO_ONCE_NAMED(name, ...) ROSCFE_LOG_(ROSCFE_ONCE_, 1, __VA_ARGS__)
#define ROS_INFO_STREAM_ONCE_NAMED(name, args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 1, args)
#define ROS_INFO_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 1, __VA_ARGS__)
#define ROS_INFO_STREAM_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 1, args)
#define ROS_INFO_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 1, __VA_ARGS__)
#define ROS_INFO_STREAM_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 1, args)
#define ROS_INFO_DELAYED_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 1, __VA_ARGS__)
#define ROS_INFO_STREAM_DELAYED_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 1, args)
#define ROS_INFO_DELAYED_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 1, __VA_ARGS__)
#define ROS_INFO_STREAM_DELAYED_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 1, args)
#define ROS_INFO_FILTER(filter, ...) ROSCFE_LOG_((filter)->isEnabled(), 1, __VA_ARGS__)
#define ROS_INFO_STREAM_FILTER(filter, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 1, args)
#define ROS_INFO_FILTER_NAMED(filter, name, ...) ROSCFE_LOG_((filter)->isEnabled(), 1, __VA_ARGS__)
#define ROS_INFO_STREAM_FILTER_NAMED(filter, name, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 1, args)

#define ROS_WARN(...) ROSCFE_LOG_(true, 2, __VA_ARGS__)
#define ROS_WARN_STREAM(args) ROSCFE_LOG_STREAM_(true, 2, args)
#define ROS_WARN_NAMED(name, ...) ROSCFE_LOG_(true, 2, __VA_ARGS__)
#define ROS_WARN_STREAM_NAMED(name, args) ROSCFE_LOG_STREAM_(true, 2, args)
#define ROS_WARN_COND(condition, ...) ROSCFE_LOG_(condition, 2, __VA_ARGS__)
#define ROS_WARN_STREAM_COND(condition, args) ROSCFE_LOG_STREAM_(condition, 2, args)
#define ROS_WARN_COND_NAMED(condition, name, ...) ROSCFE_LOG_(condition, 2, __VA_ARGS__)
#define ROS_WARN_STREAM_COND_NAMED(condition, name, args) ROSCFE_LOG_STREAM_(condition, 2, args)
#define ROS_WARN_ONCE(...) ROSCFE_LOG_(ROSCFE_ONCE_, 2, __VA_ARGS__)
#define ROS_WARN_STREAM_ONCE(args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 2, args)
#define ROS_WARN_ONCE_NAMED(name, ...) ROSCFE_LOG_(ROSCFE_ONCE_, 2, __VA_ARGS__)
#define ROS_WARN_STREAM_ONCE_NAMED(name, args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 2, args)
#define ROS_WARN_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 2, __VA_ARGS__)
#define ROS_WARN_STREAM_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 2, args)
#define ROS_WARN_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 2, __VA_ARGS__)
#define ROS_WARN_STREAM_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 2, args)
#define ROS_WARN_DELAYED_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 2, __VA_ARGS__)
#define ROS_WARN_STREAM_DELAYED_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 2, args)
#define ROS_WARN_DELAYED_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 2, __VA_ARGS__)
#define ROS_WARN_STREAM_DELAYED_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 2, args)
#define ROS_WARN_FILTER(filter, ...) ROSCFE_LOG_((filter)->isEnabled(), 2, __VA_ARGS__)
#define ROS_WARN_STREAM_FILTER(filter, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 2, args)
#define ROS_WARN_FILTER_NAMED(filter, name, ...) ROSCFE_LOG_((filter)->isEnabled(), 2, __VA_ARGS__)
#define ROS_WARN_STREAM_FILTER_NAMED(filter, name, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 2, args)

#define ROS_ERROR(...) ROSCFE_LOG_(true, 3, __VA_ARGS__)
#define ROS_ERROR_STREAM(args) ROSCFE_LOG_STREAM_(true, 3, args)
#define ROS_ERROR_NAMED(name, ...) ROSCFE_LOG_(true, 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_NAMED(name, args) ROSCFE_LOG_STREAM_(true, 3, args)
#define ROS_ERROR_COND(condition, ...) ROSCFE_LOG_(condition, 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_COND(condition, args) ROSCFE_LOG_STREAM_(condition, 3, args)
#define ROS_ERROR_COND_NAMED(condition, name, ...) ROSCFE_LOG_(condition, 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_COND_NAMED(condition, name, args) ROSCFE_LOG_STREAM_(condition, 3, args)
#define ROS_ERROR_ONCE(...) ROSCFE_LOG_(ROSCFE_ONCE_, 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_ONCE(args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 3, args)
#define ROS_ERROR_ONCE_NAMED(name, ...) ROSCFE_LOG_(ROSCFE_ONCE_, 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_ONCE_NAMED(name, args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 3, args)
#define ROS_ERROR_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 3, args)
#define ROS_ERROR_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 3, args)
#define ROS_ERROR_DELAYED_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_DELAYED_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 3, args)
#define ROS_ERROR_DELAYED_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_DELAYED_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 3, args)
#define ROS_ERROR_FILTER(filter, ...) ROSCFE_LOG_((filter)->isEnabled(), 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_FILTER(filter, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 3, args)
#define ROS_ERROR_FILTER_NAMED(filter, name, ...) ROSCFE_LOG_((filter)->isEnabled(), 3, __VA_ARGS__)
#define ROS_ERROR_STREAM_FILTER_NAMED(filter, name, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 3, args)

#define ROS_FATAL(...) ROSCFE_LOG_(true, 4, __VA_ARGS__)
#define ROS_FATAL_STREAM(args) ROSCFE_LOG_STREAM_(true, 4, args)
#define ROS_FATAL_NAMED(name, ...) ROSCFE_LOG_(true, 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_NAMED(name, args) ROSCFE_LOG_STREAM_(true, 4, args)
#define ROS_FATAL_COND(condition, ...) ROSCFE_LOG_(condition, 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_COND(condition, args) ROSCFE_LOG_STREAM_(condition, 4, args)
#define ROS_FATAL_COND_NAMED(condition, name, ...) ROSCFE_LOG_(condition, 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_COND_NAMED(condition, name, args) ROSCFE_LOG_STREAM_(condition, 4, args)
#define ROS_FATAL_ONCE(...) ROSCFE_LOG_(ROSCFE_ONCE_, 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_ONCE(args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 4, args)
#define ROS_FATAL_ONCE_NAMED(name, ...) ROSCFE_LOG_(ROSCFE_ONCE_, 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_ONCE_NAMED(name, args) ROSCFE_LOG_STREAM_(ROSCFE_ONCE_, 4, args)
#define ROS_FATAL_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 4, args)
#define ROS_FATAL_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, true), 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, true), 4, args)
#define ROS_FATAL_DELAYED_THROTTLE(period, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_DELAYED_THROTTLE(period, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 4, args)
#define ROS_FATAL_DELAYED_THROTTLE_NAMED(period, name, ...) ROSCFE_LOG_(ROSCFE_DUE_(period, false), 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_DELAYED_THROTTLE_NAMED(period, name, args) ROSCFE_LOG_STREAM_(ROSCFE_DUE_(period, false), 4, args)
#define ROS_FATAL_FILTER(filter, ...) ROSCFE_LOG_((filter)->isEnabled(), 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_FILTER(filter, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 4, args)
#define ROS_FATAL_FILTER_NAMED(filter, name, ...) ROSCFE_LOG_((filter)->isEnabled(), 4, __VA_ARGS__)
#define ROS_FATAL_STREAM_FILTER_NAMED(filter, name, args) ROSCFE_LOG_STREAM_((filter)->isEnabled(), 4, args)

#endif
