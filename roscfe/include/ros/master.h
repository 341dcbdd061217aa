// ros::master: there is no master on cFE; the bus is there whenever the node is.
#ifndef ROSCPP_MASTER_H
#define ROSCPP_MASTER_H

#include <string>
#include <vector>

#include "XmlRpcValue.h"
#include "ros/forwards.h"
#include "ros/time.h"

namespace ros
{
namespace master
{

inline bool               check() { return true; }
inline const std::string &getHost()
{
    static const std::string host = "localhost";
    return host;
}
inline std::uint32_t      getPort() { return 11311; }
inline const std::string &getURI()
{
    static const std::string uri = "http://localhost:11311";
    return uri;
}
inline void setRetryTimeout(WallDuration) {}

// False: nobody answers.
inline bool execute(const std::string &, const XmlRpc::XmlRpcValue &, XmlRpc::XmlRpcValue &, XmlRpc::XmlRpcValue &, bool)
{
    return false;
}

} // namespace master
} // namespace ros

#endif
