// ros::package: packages lie in the file system of ROS, of which a flight computer has none.
#ifndef ROSCFE_ROS_PACKAGE_H
#define ROSCFE_ROS_PACKAGE_H

#include <string>

namespace ros
{
namespace package
{

// Where the files of packages are on the flight computer: a folder of /cf by the package's name.
inline std::string getPath(const std::string &package)
{
    return "/cf/" + package;
}

} // namespace package
} // namespace ros

#endif
