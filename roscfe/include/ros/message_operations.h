// How a message is printed: `os << message`, as roscpp has it.
#ifndef ROSCFE_ROS_MESSAGE_OPERATIONS_H
#define ROSCFE_ROS_MESSAGE_OPERATIONS_H

#include <cstddef>
#include <ostream>
#include <string>
#include <type_traits>

#include "roscfe/wire.h"

namespace ros
{
namespace message_operations
{

template <class M>
struct Printer;

namespace detail
{

// Prints the fields of a message, each in a line that begins with its name.
template <class Stream>
class Fields
{
  public:
    Fields(Stream &stream, const std::string &indent) : stream_(stream), indent_(indent) {}

    template <class T>
    void field(const char *name, const T &value)
    {
        if constexpr (roscfe::wire::detail::IsVector<T>::value || roscfe::wire::detail::IsArray<T>::value)
            items(name, value);
        else
        {
            stream_ << indent_ << name << ": ";
            if constexpr (roscfe::wire::HasFields<T>::value)
                stream_ << "\n";
            Printer<T>::stream(stream_, indent_ + "  ", value);
        }
    }

  private:
    Stream &           stream_;
    const std::string &indent_;

    template <class T>
    void items(const char *name, const T &values)
    {
        typedef typename T::value_type Value;
        stream_ << indent_ << name << "[]\n";
        for (std::size_t index = 0; index < values.size(); ++index)
        {
            stream_ << indent_ << "  " << name << "[" << index << "]: ";
            if constexpr (roscfe::wire::HasFields<Value>::value)
                stream_ << "\n" << indent_; // as gencpp does, which indents the first line twice
            Printer<Value>::stream(stream_, indent_ + (roscfe::wire::HasFields<Value>::value ? "    " : "  "),
                                   values[index]);
        }
    }
};

} // namespace detail

template <class M>
struct Printer
{
    template <class Stream>
    static void stream(Stream &stream, const std::string &indent, const M &value)
    {
        if constexpr (roscfe::wire::HasFields<M>::value)
        {
            detail::Fields<Stream> fields(stream, indent);
            roscfe::wire::Fields<M>::print(fields, value);
        }
        else if constexpr (std::is_integral<M>::value && sizeof(M) == 1)
            stream << +value << "\n"; // a number, not a letter
        else
            stream << value << "\n";
    }
};

} // namespace message_operations
} // namespace ros

#endif
