// Names and md5 sums of services. Generated services and their messages bring them along (roscfe::wire::Traits).
#ifndef ROSCFE_ROS_SERVICE_TRAITS_H
#define ROSCFE_ROS_SERVICE_TRAITS_H

#include <type_traits>

#include "ros/message_traits.h"
#include "roscfe/wire.h"

namespace ros
{
namespace service_traits
{

namespace detail
{

using message_traits::detail::Plain;

// Of a service itself, or of its request or response.
template <class M>
constexpr bool is_message = roscfe::wire::HasFields<M>::value;

} // namespace detail

template <class M>
struct MD5Sum
{
    static const char *value()
    {
        if constexpr (detail::is_message<M>)
            return roscfe::wire::Traits<M>::service_md5();
        else
            return roscfe::wire::Traits<M>::md5();
    }
    static const char *value(const M &) { return value(); }
};

template <class M>
struct DataType
{
    static const char *value()
    {
        if constexpr (detail::is_message<M>)
            return roscfe::wire::Traits<M>::service_type();
        else
            return roscfe::wire::Traits<M>::type();
    }
    static const char *value(const M &) { return value(); }
};

template <class M>
const char *md5sum()
{
    return MD5Sum<detail::Plain<M>>::value();
}

template <class M>
const char *md5sum(const M &)
{
    return md5sum<M>();
}

template <class M>
const char *datatype()
{
    return DataType<detail::Plain<M>>::value();
}

template <class M>
const char *datatype(const M &)
{
    return datatype<M>();
}

} // namespace service_traits
} // namespace ros

#endif
