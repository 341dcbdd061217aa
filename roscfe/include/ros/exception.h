// The base of what ROS throws.
#ifndef ROSCFE_ROS_EXCEPTION_H
#define ROSCFE_ROS_EXCEPTION_H

#include <stdexcept>
#include <string>

namespace ros
{

class Exception : public std::runtime_error
{
  public:
    Exception(const std::string &what) : std::runtime_error(what) {}
};

} // namespace ros

#endif
