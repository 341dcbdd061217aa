// Messages as bytes, as they are on a ROS connection and in packets of the software bus: little-endian on any host,
// nothing between the fields, a count of 32 bits before a text or an array without a fixed length
// (http://wiki.ros.org/roscpp/Overview/MessagesSerializationAndAdaptingTypes).
//
// One visitor for each type of message, which is generated beside it, counts the bytes, writes and reads them.
#ifndef ROSCFE_WIRE_H
#define ROSCFE_WIRE_H

#include <boost/array.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string>
#include <type_traits>
#include <vector>

#include "ros/duration.h"
#include "ros/exception.h"
#include "ros/time.h"
#include "roscfe/fixed.h"
#include "roscfe/refuse.h"

namespace ros
{
namespace serialization
{

// A user specialises this for a type of his own (ros/serialization.h).
template <class T>
struct Serializer;

class StreamOverrunException : public ros::Exception
{
  public:
    StreamOverrunException(const std::string &what) : Exception(what) {}
};

[[noreturn]] inline void throwStreamOverrun()
{
    ROSCFE_THROW(StreamOverrunException("Buffer Overrun"));
}

} // namespace serialization
} // namespace ros

namespace roscfe
{
namespace wire
{

// The visitor of a message, generated beside it. It is no member of the message, which may have a field of any name.
//   static constexpr std::size_t kLeast: bytes of an empty message;  static constexpr bool kFixed: it has no others
//   template <class Stream, class Message> static void visit(Stream &, Message &): stream.next(field), for each field
template <class Message>
struct Fields;

// What else is known of a message: md5(), type(), definition(), has_header, is_fixed_size; of a service's request and
// response also service_md5() and service_type(), which are md5() and type() of the service. Generated beside each; of a
// user's type it says what he says in ros::message_traits.
template <class Message>
struct Traits;

template <class T, class = void>
struct HasFields : std::false_type
{
};
template <class T>
struct HasFields<T, std::void_t<decltype(sizeof(Fields<T>))>> : std::true_type
{
};

constexpr std::size_t kMostEmpty = 65536; // items without any bytes that a message may have: memory bounds them alone

constexpr bool kSwapped = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__; // bytes in memory are not in the order of the wire

namespace detail
{

template <class T>
struct IsText : roscfe::detail::IsFixedString<T>
{
};
template <class Traits, class Allocator>
struct IsText<std::basic_string<char, Traits, Allocator>> : std::true_type
{
};

template <class T>
struct IsVector : std::false_type
{
};
template <class T, class Allocator>
struct IsVector<std::vector<T, Allocator>> : std::true_type
{
};
template <class T, std::size_t N>
struct IsVector<FixedVector<T, N>> : std::true_type
{
};

template <class T>
struct IsArray : std::false_type
{
};
template <class T, std::size_t N>
struct IsArray<boost::array<T, N>> : std::true_type
{
};

template <class T>
constexpr bool is_number = std::is_arithmetic<T>::value && !std::is_same<T, bool>::value;

template <class T>
constexpr bool is_time = std::is_same<T, ros::Time>::value || std::is_same<T, ros::Duration>::value;

// The fewest bytes that a value of a type takes; 0 if it may have none, or if only a user's Serializer knows.
template <class T>
constexpr std::size_t least()
{
    if constexpr (std::is_arithmetic<T>::value)
        return sizeof(T);
    else if constexpr (is_time<T>)
        return 8;
    else if constexpr (IsText<T>::value || IsVector<T>::value)
        return 4;
    else if constexpr (IsArray<T>::value)
        return T::static_size * least<typename T::value_type>();
    else if constexpr (HasFields<T>::value)
        return Fields<T>::kLeast;
    else
        return 0;
}

// Whether all values of a type take the same number of bytes.
template <class T>
constexpr bool is_fixed()
{
    if constexpr (std::is_arithmetic<T>::value || is_time<T>)
        return true;
    else if constexpr (IsArray<T>::value)
        return is_fixed<typename T::value_type>();
    else if constexpr (HasFields<T>::value)
        return Fields<T>::kFixed;
    else
        return false;
}

// Whether a value's memory is what is on the wire: numbers, and messages of them that the compiler left no gaps in.
template <class T>
constexpr bool is_image()
{
    if constexpr (is_number<T>)
        return true; // a stream puts its bytes in order
    else
        return !kSwapped && is_fixed<T>() && sizeof(T) == least<T>() && std::is_trivially_copyable<T>::value;
}

// Turn the bytes of each item round.
inline void swap_items(std::uint8_t *bytes, std::size_t count, std::size_t size)
{
    for (; count > 0; --count, bytes += size)
        for (std::size_t low = 0, high = size - 1; low < high; ++low, --high)
        {
            const std::uint8_t byte = bytes[low];
            bytes[low] = bytes[high];
            bytes[high] = byte;
        }
}

template <class Stream, class T>
void item(Stream &stream, T &value);

} // namespace detail

// Counts the bytes that a message takes.
class Length
{
  public:
    template <class T>
    void next(const T &value)
    {
        detail::item(*this, value);
    }

    // Room for bytes that a user's Serializer writes by itself.
    std::uint32_t advance(std::uint32_t count)
    {
        const std::size_t before = bytes_;
        bytes_ += count;
        return static_cast<std::uint32_t>(before);
    }

    std::uint32_t getLength() const { return static_cast<std::uint32_t>(bytes_); }
    std::size_t   bytes() const { return bytes_; }

    void add(std::size_t count) { bytes_ += count; }
    template <class T>
    void raw(const T *, std::size_t count)
    {
        bytes_ += count * sizeof(T);
    }
    template <class T>
    bool count(const T &)
    {
        bytes_ += 4;
        return true;
    }
    bool good() const { return true; }

  private:
    std::size_t bytes_ = 0;
};

// Writes a message. Where the room ends it stops, and is not good() any more.
class Writer
{
  public:
    Writer(std::uint8_t *to, std::size_t size) : at_(to), end_(to + size), good_(true) {}

    template <class T>
    void next(const T &value)
    {
        detail::item(*this, value);
    }

    // Room for bytes that a user's Serializer writes by itself; there must be enough (StreamOverrunException).
    std::uint8_t *advance(std::uint32_t count)
    {
        if (!has(count))
            ros::serialization::throwStreamOverrun();
        std::uint8_t *place = at_;
        at_ += count;
        return place;
    }

    std::uint8_t *getData() { return at_; }
    std::uint32_t getLength() const { return static_cast<std::uint32_t>(end_ - at_); }

    template <class T>
    void raw(const T *items, std::size_t count)
    {
        const std::size_t bytes = count * sizeof(T);
        if (!has(bytes) || bytes == 0)
            return;
        std::memcpy(at_, static_cast<const void *>(items), bytes);
        if (kSwapped && sizeof(T) > 1)
            detail::swap_items(at_, count, sizeof(T));
        at_ += bytes;
    }
    template <class T>
    bool count(const T &items)
    {
        const std::uint32_t number = static_cast<std::uint32_t>(items.size());
        raw(&number, 1);
        return good_;
    }
    bool good() const { return good_; }

  private:
    std::uint8_t *at_;
    std::uint8_t *end_;
    bool          good_;

    bool has(std::size_t bytes)
    {
        good_ = good_ && static_cast<std::size_t>(end_ - at_) >= bytes;
        return good_;
    }
};

// Reads a message. Where the bytes end, or a count cannot be true, it stops, and is not good() any more. Nothing is
// allocated for a count before it is known that the bytes can fill it.
class Reader
{
  public:
    Reader(const std::uint8_t *from, std::size_t size) : at_(from), end_(from + size), empty_(kMostEmpty), good_(true) {}

    template <class T>
    void next(T &value)
    {
        detail::item(*this, value);
    }

    // Bytes that a user's Serializer reads by itself; there must be enough (StreamOverrunException).
    std::uint8_t *advance(std::uint32_t count)
    {
        if (!has(count))
            ros::serialization::throwStreamOverrun();
        const std::uint8_t *place = at_;
        at_ += count;
        return const_cast<std::uint8_t *>(place); // roscpp's streams have one type of pointer for all
    }

    std::uint8_t *getData() { return const_cast<std::uint8_t *>(at_); }
    std::uint32_t getLength() const { return static_cast<std::uint32_t>(end_ - at_); }

    template <class T>
    void raw(T *items, std::size_t count)
    {
        const std::size_t bytes = count * sizeof(T);
        if (!has(bytes) || bytes == 0)
            return;
        std::memcpy(static_cast<void *>(items), at_, bytes);
        if (kSwapped && sizeof(T) > 1)
            detail::swap_items(reinterpret_cast<std::uint8_t *>(items), count, sizeof(T));
        at_ += bytes;
    }
    template <class T>
    bool count(T &items)
    {
        std::uint32_t number = 0;
        raw(&number, 1);
        good_ = good_ && fillable<typename T::value_type>(number) && fits(items, number);
        if (good_)
            resize(items, number);
        return good_;
    }
    bool good() const { return good_; }
    bool at_end() const { return at_ == end_; }

  private:
    const std::uint8_t *at_;
    const std::uint8_t *end_;
    std::size_t         empty_; // items without bytes that there may still be
    bool                good_;

    bool has(std::size_t bytes)
    {
        good_ = good_ && static_cast<std::size_t>(end_ - at_) >= bytes;
        return good_;
    }

    template <class T>
    bool fillable(std::size_t number)
    {
        constexpr std::size_t each = detail::least<T>();
        if constexpr (each > 0)
            return number <= static_cast<std::size_t>(end_ - at_) / each;
        if (number > empty_)
            return false;
        empty_ -= number;
        return true;
    }

    template <class T>
    static bool fits(const T &, std::size_t)
    {
        return true;
    }
    template <class T, std::size_t N>
    static bool fits(const FixedVector<T, N> &, std::size_t number)
    {
        return number <= N;
    }
    template <std::size_t N>
    static bool fits(const FixedString<N> &, std::size_t number)
    {
        return number <= N;
    }

    template <class T>
    static void resize(T &items, std::size_t number)
    {
        items.resize(number);
    }
    template <class T, std::size_t N>
    static void resize(FixedVector<T, N> &items, std::size_t number)
    {
        items.resize_fitting(number);
    }
    template <std::size_t N>
    static void resize(FixedString<N> &text, std::size_t number)
    {
        text.resize_fitting(number);
    }
};

namespace detail
{

// The memory of values that is what is on the wire.
template <class Stream, class T>
void image(Stream &stream, T *values, std::size_t count)
{
    typedef typename std::conditional<std::is_const<T>::value, const std::uint8_t, std::uint8_t>::type Byte;
    stream.raw(reinterpret_cast<Byte *>(values), count * sizeof(T));
}

// The items of a vector or an array: in one piece where their memory is what is on the wire.
template <class Stream, class T>
void items(Stream &stream, T &values)
{
    typedef typename std::remove_const<T>::type::value_type Value;
    if constexpr (is_number<Value>)
        stream.raw(values.data(), values.size());
    else if constexpr (is_image<Value>())
        image(stream, values.data(), values.size());
    else if constexpr (std::is_same<Stream, Length>::value && is_fixed<Value>())
        stream.add(values.size() * least<Value>());
    else
        for (auto &value : values)
        {
            item(stream, value);
            if (!stream.good())
                return;
        }
}

// One value of any type that a message can have.
template <class Stream, class T>
void item(Stream &stream, T &value)
{
    typedef typename std::remove_const<T>::type Value;
    if constexpr (std::is_same<Value, bool>::value)
    {
        std::uint8_t byte = 0;
        if constexpr (std::is_const<T>::value)
            byte = value;
        stream.raw(&byte, 1);
        if constexpr (!std::is_const<T>::value)
            value = byte != 0;
    }
    else if constexpr (is_number<Value>)
        stream.raw(&value, 1);
    else if constexpr (std::is_same<Stream, Length>::value && is_fixed<Value>())
        stream.add(least<Value>());
    else if constexpr (is_image<Value>())
        image(stream, &value, 1);
    else if constexpr (is_time<Value>)
    {
        stream.raw(&value.sec, 1);
        stream.raw(&value.nsec, 1);
    }
    else if constexpr (IsText<Value>::value)
    {
        if (stream.count(value) && !value.empty())
            stream.raw(&value[0], value.size());
    }
    else if constexpr (IsVector<Value>::value)
    {
        if (stream.count(value))
            items(stream, value);
    }
    else if constexpr (IsArray<Value>::value)
        items(stream, value);
    else if constexpr (HasFields<Value>::value)
        Fields<Value>::visit(stream, value);
    else if constexpr (std::is_same<Stream, Length>::value)
        stream.add(ros::serialization::Serializer<Value>::serializedLength(value));
    else if constexpr (std::is_const<T>::value)
        ros::serialization::Serializer<Value>::write(stream, value);
    else
        ros::serialization::Serializer<Value>::read(stream, value);
}

} // namespace detail

// How many bytes a message takes.
template <class Message>
std::size_t length(const Message &message)
{
    Length stream;
    detail::item(stream, message);
    return stream.bytes();
}

// Write a message to a place of exactly the size that length() says. False: it is another size.
template <class Message>
bool write(const Message &message, std::uint8_t *to, std::size_t size)
{
    Writer stream(to, size);
    detail::item(stream, message);
    return stream.good() && stream.getLength() == 0;
}

// How many bytes a message takes at most; 0 is as many as it likes. In the profile strict texts and arrays have room for a
// fixed number, which takes no less memory than bytes, so that what nodes send and get is set aside when they start.
template <class Message>
constexpr std::size_t most_bytes()
{
#if defined(ROSCFE_PROFILE_STRICT)
    return HasFields<Message>::value ? sizeof(Message) : 0;
#else
    return 0;
#endif
}

// Read a message that takes all of the bytes. False: there are too few or too many of them, or a count cannot be true,
// or a text or an array is longer than the strict profile has room for. The message is of no use then.
template <class Message>
bool read(Message &message, const std::uint8_t *from, std::size_t size)
{
    Reader stream(from, size);
#if defined(__cpp_exceptions)
    if constexpr (!HasFields<Message>::value)
    {
        try // a user's Serializer, which reads by itself
        {
            detail::item(stream, message);
        }
        catch (const std::exception &) // also of a count that cannot be true; roscpp catches them all
        {
            return false;
        }
        return stream.good() && (stream.at_end() || stream.getData() == from); // it may have copied them as they are
    }
#endif
    detail::item(stream, message);
    return stream.good() && stream.at_end();
}

} // namespace wire
} // namespace roscfe

#endif
