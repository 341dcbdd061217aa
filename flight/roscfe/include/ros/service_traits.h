// Type names and md5 sums of services.
#ifndef ROSCPP_SERVICE_TRAITS_H
#define ROSCPP_SERVICE_TRAITS_H

#include "roscfe/wire.h"

namespace ros
{
namespace service_traits
{

template <class S>
inline const char *md5sum()
{
    return roscfe::wire::Traits<S>::md5();
}
template <class S>
inline const char *md5sum(const S &)
{
    return md5sum<S>();
}
template <class S>
inline const char *datatype()
{
    return roscfe::wire::Traits<S>::type();
}
template <class S>
inline const char *datatype(const S &)
{
    return datatype<S>();
}

} // namespace service_traits
} // namespace ros

#endif
