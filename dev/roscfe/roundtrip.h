// Reads frames of one type of message from the standard input, decodes each, and writes out what it encodes again.
//   in:  count (32 bits, little-endian), bytes
//   out: whether it was a message (8 bits), bytes allocated by reading it (32 bits), count (32 bits), bytes
#ifndef TESTS_ROSCFE_ROUNDTRIP_H
#define TESTS_ROSCFE_ROUNDTRIP_H

#include <cstdint>
#include <cstdio>
#include <vector>

#ifdef ROSCPP // roscpp's own headers
#include <ros/serialization.h>
#else
#include "roscfe/wire.h"
#endif

extern std::size_t g_allocated; // bytes, by operator new, since it was last set to 0

struct Codec
{
    const char *name;
    void (*run)();
};

inline bool take_number(std::uint32_t &number)
{
    std::uint8_t bytes[4];
    if (std::fread(bytes, 1, 4, stdin) != 4)
        return false;
    number = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
    return true;
}

inline void give_number(std::uint32_t number)
{
    for (int shift = 0; shift < 32; shift += 8)
        std::putchar(static_cast<int>(number >> shift & 255));
}

#ifdef ROSCPP
template <class Message>
bool read(Message &message, std::uint8_t *from, std::uint32_t size)
{
    try
    {
        ros::serialization::IStream stream(from, size);
        ros::serialization::deserialize(stream, message);
        return stream.getLength() == 0;
    }
    catch (const ros::serialization::StreamOverrunException &)
    {
        return false;
    }
}

template <class Message>
std::size_t length(const Message &message)
{
    return ros::serialization::serializationLength(message);
}

template <class Message>
bool write(const Message &message, std::uint8_t *to, std::size_t size)
{
    ros::serialization::OStream stream(to, static_cast<std::uint32_t>(size));
    ros::serialization::serialize(stream, message);
    return stream.getLength() == 0;
}
#else
using roscfe::wire::length;
using roscfe::wire::read;
using roscfe::wire::write;
#endif

template <class Message>
void run()
{
    Message       reused{}; // as a subscription reads into the slots that it has
    std::uint32_t count = 0;
    while (take_number(count))
    {
        // Exactly as long as the message, on the heap: a sanitizer sees each byte read behind its end.
        std::vector<std::uint8_t> frame(count);
        if (count > 0 && std::fread(frame.data(), 1, count, stdin) != count)
            return;
        g_allocated = 0;
        const bool        good = ::read(reused, frame.data(), count);
        const std::size_t allocated = g_allocated;

        std::vector<std::uint8_t> again(good ? ::length(reused) : 0);
        const bool written = good && ::write(reused, again.data(), again.size());
        std::putchar(good && written ? 1 : 0);
        give_number(static_cast<std::uint32_t>(allocated));
        give_number(static_cast<std::uint32_t>(again.size()));
        if (!again.empty())
            std::fwrite(again.data(), 1, again.size(), stdout);
    }
}

#endif
