// What is known of the types of fields.
#ifndef ROSCFE_ROS_BUILTIN_MESSAGE_TRAITS_H
#define ROSCFE_ROS_BUILTIN_MESSAGE_TRAITS_H

#include <stdint.h>

#include "ros/message_traits.h"

#define ROSLIB_CREATE_SIMPLE_TRAITS(Type)     \
    template <>                               \
    struct IsSimple<Type> : public TrueType   \
    {                                         \
    };                                        \
    template <>                               \
    struct IsFixedSize<Type> : public TrueType \
    {                                         \
    };

namespace ros
{
namespace message_traits
{

ROSLIB_CREATE_SIMPLE_TRAITS(uint8_t)
ROSLIB_CREATE_SIMPLE_TRAITS(int8_t)
ROSLIB_CREATE_SIMPLE_TRAITS(uint16_t)
ROSLIB_CREATE_SIMPLE_TRAITS(int16_t)
ROSLIB_CREATE_SIMPLE_TRAITS(uint32_t)
ROSLIB_CREATE_SIMPLE_TRAITS(int32_t)
ROSLIB_CREATE_SIMPLE_TRAITS(uint64_t)
ROSLIB_CREATE_SIMPLE_TRAITS(int64_t)
ROSLIB_CREATE_SIMPLE_TRAITS(float)
ROSLIB_CREATE_SIMPLE_TRAITS(double)
ROSLIB_CREATE_SIMPLE_TRAITS(Time)
ROSLIB_CREATE_SIMPLE_TRAITS(Duration)

} // namespace message_traits
} // namespace ros

#endif
