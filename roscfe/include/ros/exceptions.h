// What roscpp throws.
#ifndef ROSCPP_EXCEPTIONS_H
#define ROSCPP_EXCEPTIONS_H

#include "ros/exception.h"

namespace ros
{

class InvalidNodeNameException : public Exception
{
  public:
    InvalidNodeNameException(const std::string &name, const std::string &reason)
        : Exception("Invalid node name [" + name + "]: " + reason)
    {
    }
};
class InvalidNameException : public Exception
{
    using Exception::Exception;
};
class ConflictingSubscriptionException : public Exception
{
    using Exception::Exception;
};
class InvalidParameterException : public Exception
{
    using Exception::Exception;
};
class InvalidPortException : public Exception
{
    using Exception::Exception;
};

} // namespace ros

#endif
