// roscpp's way to the bytes of messages, for nodes that serialize by themselves or have a Serializer of their own.
// The bytes are those of roscfe/wire.h.
#ifndef ROSCFE_ROS_SERIALIZATION_H
#define ROSCFE_ROS_SERIALIZATION_H

#include <boost/array.hpp>
#include <boost/shared_ptr.hpp>

#include <stdint.h>

#include <map>
#include <string>
#include <vector>

#include "ros/builtin_message_traits.h"
#include "ros/exception.h"
#include "ros/message_traits.h"
#include "ros/roscpp_serialization_macros.h"
#include "ros/serialized_message.h"
#include "ros/time.h"
#include "ros/types.h"
#include "roscfe/wire.h"

#define ROS_NEW_SERIALIZATION_API 1

// Three functions of a Serializer out of one, `allInOne(stream, message)`, that calls stream.next() for each field.
#define ROS_DECLARE_ALLINONE_SERIALIZER                      \
    template <typename Stream, typename T>                   \
    inline static void write(Stream &stream, const T &t)     \
    {                                                        \
        allInOne<Stream, const T &>(stream, t);              \
    }                                                        \
                                                             \
    template <typename Stream, typename T>                   \
    inline static void read(Stream &stream, T &t)            \
    {                                                        \
        allInOne<Stream, T &>(stream, t);                    \
    }                                                        \
                                                             \
    template <typename T>                                    \
    inline static uint32_t serializedLength(const T &t)      \
    {                                                        \
        ros::serialization::LStream stream;                  \
        allInOne<ros::serialization::LStream, const T &>(stream, t); \
        return stream.getLength();                           \
    }

namespace ros
{
namespace serialization
{

namespace mt = message_traits;

// How a type becomes bytes. This one is of generated messages and of what their fields are made of.
template <class T>
struct Serializer
{
    template <class Stream>
    static void write(Stream &stream, const T &value)
    {
        check();
        roscfe::wire::detail::item(stream, value);
    }

    template <class Stream>
    static void read(Stream &stream, T &value)
    {
        check();
        roscfe::wire::detail::item(stream, value);
    }

    static uint32_t serializedLength(const T &value)
    {
        check();
        return static_cast<uint32_t>(roscfe::wire::length(value));
    }

  private:
    static void check()
    {
        namespace wire = roscfe::wire;
        static_assert(std::is_arithmetic<T>::value || wire::detail::is_time<T> || wire::detail::IsText<T>::value ||
                          wire::detail::IsVector<T>::value || wire::detail::IsArray<T>::value ||
                          wire::HasFields<T>::value,
                      "neither a message nor a type of a field: specialise ros::serialization::Serializer for it");
    }
};

template <class T, class Stream>
void serialize(Stream &stream, const T &value)
{
    stream.next(value);
}

template <class T, class Stream>
void deserialize(Stream &stream, T &value)
{
    stream.next(value);
}

template <class T>
uint32_t serializationLength(const T &value)
{
    return static_cast<uint32_t>(roscfe::wire::length(value));
}

namespace stream_types
{

enum StreamType
{
    Input,
    Output,
    Length
};

} // namespace stream_types

typedef stream_types::StreamType StreamType;

// Reads; throws StreamOverrunException where the bytes end, or where a count cannot be true.
class IStream : public roscfe::wire::Reader
{
  public:
    static const StreamType stream_type = stream_types::Input;

    IStream(const uint8_t *data, uint32_t count) : Reader(data, count) {}

    template <class T>
    void next(T &value)
    {
        Reader::next(value);
        if (!good())
            throwStreamOverrun();
    }

    template <class T>
    IStream &operator>>(T &value)
    {
        next(value);
        return *this;
    }
};

// Writes; throws StreamOverrunException where the room ends.
class OStream : public roscfe::wire::Writer
{
  public:
    static const StreamType stream_type = stream_types::Output;

    OStream(uint8_t *data, uint32_t count) : Writer(data, count) {}

    template <class T>
    void next(const T &value)
    {
        Writer::next(value);
        if (!good())
            throwStreamOverrun();
    }

    template <class T>
    OStream &operator<<(const T &value)
    {
        next(value);
        return *this;
    }
};

// Counts.
class LStream : public roscfe::wire::Length
{
  public:
    static const StreamType stream_type = stream_types::Length;
};

// The bytes of a message with their count in front.
template <class M>
SerializedMessage serializeMessage(const M &message)
{
    const uint32_t    count = serializationLength(message);
    SerializedMessage made(boost::shared_array<uint8_t>(new uint8_t[count + 4]), count + 4);
    OStream           stream(made.buf.get(), count + 4);
    stream.next(count);
    made.message_start = stream.getData();
    stream.next(message);
    return made;
}

// A service's answer: whether it went well, then the response with its count, or a text that says why not.
template <class M>
SerializedMessage serializeServiceResponse(bool ok, const M &message)
{
    const uint32_t    count = serializationLength(message);
    const uint32_t    whole = count + (ok ? 5 : 1);
    SerializedMessage made;
    made.buf.reset(new uint8_t[whole]);
    made.num_bytes = whole; // roscpp leaves message_start null here
    OStream stream(made.buf.get(), whole);
    stream.next(ok);
    if (ok)
        stream.next(count);
    stream.next(message);
    return made;
}

template <class M>
void deserializeMessage(const SerializedMessage &bytes, M &message)
{
    IStream stream(bytes.message_start,
                   static_cast<uint32_t>(bytes.num_bytes - static_cast<size_t>(bytes.message_start - bytes.buf.get())));
    stream.next(message);
}

template <class M>
struct PreDeserializeParams
{
    boost::shared_ptr<M>                                  message;
    boost::shared_ptr<std::map<std::string, std::string>> connection_header;
};

template <class M>
struct PreDeserialize
{
    static void notify(const PreDeserializeParams<M> &) {}
};

} // namespace serialization
} // namespace ros

#endif
