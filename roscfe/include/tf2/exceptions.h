// What goes wrong with transforms.
#ifndef TF2_EXCEPTIONS_H
#define TF2_EXCEPTIONS_H

#include <stdexcept>
#include <string>

namespace tf2
{

class TransformException : public std::runtime_error
{
  public:
    TransformException(const std::string &text) : std::runtime_error(text) {}
};

// Two frames are in different trees.
class ConnectivityException : public TransformException
{
  public:
    ConnectivityException(const std::string &text) : TransformException(text) {}
};

// A frame is unknown, or the tree has a loop.
class LookupException : public TransformException
{
  public:
    LookupException(const std::string &text) : TransformException(text) {}
};

// The time asked for is outside of what the buffer holds.
class ExtrapolationException : public TransformException
{
  public:
    ExtrapolationException(const std::string &text) : TransformException(text) {}
};

// A frame's name is empty or begins with a slash.
class InvalidArgumentException : public TransformException
{
  public:
    InvalidArgumentException(const std::string &text) : TransformException(text) {}
};

// A server of transforms did not answer in time.
class TimeoutException : public TransformException
{
  public:
    TimeoutException(const std::string &text) : TransformException(text) {}
};

} // namespace tf2

#endif
