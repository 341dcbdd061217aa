// Assertions: one that fails is an event and the end of the application.
#ifndef ROSCONSOLE_ROSASSERT_H
#define ROSCONSOLE_ROSASSERT_H

#include "ros/console.h"
#include "roscfe/refuse.h"

#define ROS_BREAK() ::roscfe::refuse("ROS_BREAK", __FILE__)
#ifdef NDEBUG
#define ROS_ASSERT(condition) static_cast<void>(0)
#define ROS_ASSERT_MSG(condition, ...) static_cast<void>(0)
#define ROS_ASSERT_CMD(condition, command) static_cast<void>(0)
#else
#define ROS_ASSERT(condition)                                                                                          \
    do                                                                                                                 \
    {                                                                                                                  \
        if (!(condition))                                                                                              \
        {                                                                                                              \
            ::roscfe::refuse("ASSERTION FAILED: " #condition, __FILE__);                                               \
        }                                                                                                              \
    } while (0)
#define ROS_ASSERT_MSG(condition, ...)                                                                                 \
    do                                                                                                                 \
    {                                                                                                                  \
        if (!(condition))                                                                                              \
        {                                                                                                              \
            ROS_FATAL(__VA_ARGS__);                                                                                    \
            ::roscfe::refuse("ASSERTION FAILED: " #condition, __FILE__);                                               \
        }                                                                                                              \
    } while (0)
#define ROS_ASSERT_CMD(condition, command)                                                                             \
    do                                                                                                                 \
    {                                                                                                                  \
        if (!(condition))                                                                                              \
        {                                                                                                              \
            command;                                                                                                   \
        }                                                                                                              \
    } while (0)
#endif
#define ROS_ISSUE_BREAK() ROS_BREAK()

#endif
