// The bytes of a message, with the count of them in front, as they go over a ROS connection.
#ifndef ROSCFE_ROS_SERIALIZED_MESSAGE_H
#define ROSCFE_ROS_SERIALIZED_MESSAGE_H

#include <boost/shared_array.hpp>
#include <boost/shared_ptr.hpp>

#include <stdint.h>

#include <cstddef>
#include <typeinfo>

#include "ros/roscpp_serialization_macros.h"

namespace ros
{

class SerializedMessage
{
  public:
    boost::shared_array<uint8_t> buf;
    size_t                       num_bytes;
    uint8_t *                    message_start; // past the count

    boost::shared_ptr<void const> message;
    const std::type_info *        type_info;

    SerializedMessage() : num_bytes(0), message_start(nullptr), type_info(nullptr) {}
    SerializedMessage(boost::shared_array<uint8_t> bytes, size_t count)
        : buf(bytes), num_bytes(count), message_start(bytes ? bytes.get() : nullptr), type_info(nullptr)
    {
    }
};

} // namespace ros

#endif
