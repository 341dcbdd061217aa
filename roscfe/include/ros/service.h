// ros::service: calls and questions without a client object.
#ifndef ROS_SERVICE_H
#define ROS_SERVICE_H

#include <string>

#include "ros/names.h"
#include "ros/node_handle.h"
#include "ros/service_client.h"

namespace ros
{
namespace service
{

template <class Req, class Res>
bool call(const std::string &name, const Req &request, Res &response)
{
    return ServiceClient(names::resolve(name), false, "*", "*").call(request, response);
}
template <class S>
bool call(const std::string &name, S &service)
{
    return ServiceClient(names::resolve(name), false, roscfe::wire::Traits<S>::type(), roscfe::wire::Traits<S>::md5())
        .call(service);
}

bool exists(const std::string &name, bool print_failure_reason);
bool waitForService(const std::string &name, std::int32_t timeout_ms);
bool waitForService(const std::string &name, Duration timeout = Duration(-1));

} // namespace service
} // namespace ros

#endif
