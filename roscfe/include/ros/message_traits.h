// What is known of a type of message. Generated messages bring it along (roscfe::wire::Traits); a user specialises these
// templates for a type of his own, as in roscpp.
#ifndef ROSCFE_ROS_MESSAGE_TRAITS_H
#define ROSCFE_ROS_MESSAGE_TRAITS_H

#include <string>
#include <type_traits>

#include "ros/message_forward.h"
#include "ros/time.h"
#include "roscfe/wire.h"

namespace std_msgs
{
ROS_DECLARE_MESSAGE(Header)
}

#define ROS_IMPLEMENT_SIMPLE_TOPIC_TRAITS(msg, md5sum, datatype, definition) \
    namespace ros                                                            \
    {                                                                        \
    namespace message_traits                                                 \
    {                                                                        \
    template <>                                                              \
    struct MD5Sum<msg>                                                       \
    {                                                                        \
        static const char *value() { return md5sum; }                        \
        static const char *value(const msg &) { return value(); }            \
    };                                                                       \
    template <>                                                              \
    struct DataType<msg>                                                     \
    {                                                                        \
        static const char *value() { return datatype; }                      \
        static const char *value(const msg &) { return value(); }            \
    };                                                                       \
    template <>                                                              \
    struct Definition<msg>                                                   \
    {                                                                        \
        static const char *value() { return definition; }                    \
        static const char *value(const msg &) { return value(); }            \
    };                                                                       \
    }                                                                        \
    }

namespace ros
{
namespace message_traits
{

struct TrueType
{
    static const bool value = true;
    typedef TrueType  type;
};

struct FalseType
{
    static const bool value = false;
    typedef FalseType type;
};

namespace detail
{

template <bool value>
using Truth = typename std::conditional<value, TrueType, FalseType>::type;

template <class M>
using Plain = typename std::remove_const<typename std::remove_reference<M>::type>::type;

template <class M>
constexpr bool is_generated = roscfe::wire::HasFields<Plain<M>>::value;

template <class M>
constexpr bool has_header()
{
    if constexpr (is_generated<M>)
        return roscfe::wire::Traits<Plain<M>>::has_header;
    else
        return false;
}

} // namespace detail

// Whether an array of it may be copied as it lies in memory.
template <class M>
struct IsSimple : detail::Truth<detail::is_generated<M> && roscfe::wire::detail::is_image<detail::Plain<M>>()>
{
};

template <class M>
struct IsFixedSize : detail::Truth<roscfe::wire::detail::is_fixed<detail::Plain<M>>()>
{
};

template <class M>
struct HasHeader : detail::Truth<detail::has_header<M>()>
{
};

template <class M>
struct IsMessage : detail::Truth<detail::is_generated<M>>
{
};

template <class M>
struct MD5Sum
{
    static_assert(detail::is_generated<M>, "no message: specialise ros::message_traits::MD5Sum for it");
    static const char *value() { return roscfe::wire::Traits<detail::Plain<M>>::md5(); }
    static const char *value(const M &) { return value(); }
};

template <class M>
struct DataType
{
    static_assert(detail::is_generated<M>, "no message: specialise ros::message_traits::DataType for it");
    static const char *value() { return roscfe::wire::Traits<detail::Plain<M>>::type(); }
    static const char *value(const M &) { return value(); }
};

template <class M>
struct Definition
{
    static_assert(detail::is_generated<M>, "no message: specialise ros::message_traits::Definition for it");
    static const char *value() { return roscfe::wire::Traits<detail::Plain<M>>::definition(); }
    static const char *value(const M &) { return value(); }
};

// The header of a message; a null pointer for one that has none.
template <class M, class Enable = void>
struct Header
{
    static std_msgs::Header *      pointer(M &) { return nullptr; }
    static const std_msgs::Header *pointer(const M &) { return nullptr; }
};

template <class M>
struct Header<M, typename std::enable_if<HasHeader<M>::value>::type>
{
    static std_msgs::Header *      pointer(M &message) { return &message.header; }
    static const std_msgs::Header *pointer(const M &message) { return &message.header; }
};

// The frame in the header of a message.
template <class M, class Enable = void>
struct FrameId
{
    static std::string *      pointer(M &) { return nullptr; }
    static const std::string *pointer(const M &) { return nullptr; }
};

template <class M>
struct FrameId<M, typename std::enable_if<HasHeader<M>::value>::type>
{
    static auto *      pointer(M &message) { return &message.header.frame_id; } // strict profile: a FixedString
    static const auto *pointer(const M &message) { return &message.header.frame_id; }
    static std::string value(const M &message) { return message.header.frame_id; }
};

// The time in the header of a message.
template <class M, class Enable = void>
struct TimeStamp
{
    static ros::Time *      pointer(M &) { return nullptr; }
    static const ros::Time *pointer(const M &) { return nullptr; }
};

template <class M>
struct TimeStamp<M, typename std::enable_if<HasHeader<M>::value>::type>
{
    static ros::Time *      pointer(typename std::remove_const<M>::type &message) { return &message.header.stamp; }
    static const ros::Time *pointer(const M &message) { return &message.header.stamp; }
    static ros::Time        value(const M &message) { return message.header.stamp; }
};

template <class M>
const char *md5sum()
{
    return MD5Sum<detail::Plain<M>>::value();
}

template <class M>
const char *datatype()
{
    return DataType<detail::Plain<M>>::value();
}

template <class M>
const char *definition()
{
    return Definition<detail::Plain<M>>::value();
}

template <class M>
const char *md5sum(const M &message)
{
    return MD5Sum<detail::Plain<M>>::value(message);
}

template <class M>
const char *datatype(const M &message)
{
    return DataType<detail::Plain<M>>::value(message);
}

template <class M>
const char *definition(const M &message)
{
    return Definition<detail::Plain<M>>::value(message);
}

template <class M>
auto header(M &message)
{
    return Header<detail::Plain<M>>::pointer(message);
}

template <class M>
auto frameId(M &message)
{
    return FrameId<detail::Plain<M>>::pointer(message);
}

template <class M>
auto timeStamp(M &message)
{
    return TimeStamp<detail::Plain<M>>::pointer(message);
}

template <class M>
bool isSimple()
{
    return IsSimple<detail::Plain<M>>::value;
}

template <class M>
bool isFixedSize()
{
    return IsFixedSize<detail::Plain<M>>::value;
}

template <class M>
bool hasHeader()
{
    return HasHeader<detail::Plain<M>>::value;
}

} // namespace message_traits
} // namespace ros

namespace roscfe
{
namespace wire
{

// A type that is of any type by itself, such as a ShapeShifter, has a definition of each message only.
template <class M, class = void>
struct DefinitionOf
{
    static const char *value() { return ""; }
};
template <class M>
struct DefinitionOf<M, std::void_t<decltype(ros::message_traits::Definition<M>::value())>>
{
    static const char *value() { return ros::message_traits::Definition<M>::value(); }
};

template <class M>
struct Traits
{
    static constexpr bool has_header = ros::message_traits::HasHeader<M>::value;
    static constexpr bool is_fixed_size = ros::message_traits::IsFixedSize<M>::value;

    static const char *md5() { return ros::message_traits::MD5Sum<M>::value(); }
    static const char *type() { return ros::message_traits::DataType<M>::value(); }
    static const char *definition() { return DefinitionOf<M>::value(); }
};

} // namespace wire
} // namespace roscfe

#endif
