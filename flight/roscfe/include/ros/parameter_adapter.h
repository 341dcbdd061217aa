// From the parameter of a callback to the message that it means, and from a received message to that parameter.
#ifndef ROS_PARAMETER_ADAPTER_H
#define ROS_PARAMETER_ADAPTER_H

#include <type_traits>

#include "ros/message_event.h"

namespace ros
{

// const M&, M&, M: the message itself.
template <class P>
struct ParameterAdapter
{
    typedef typename std::remove_cv<typename std::remove_reference<P>::type>::type Message;
    typedef MessageEvent<Message const>                                            Event;
    static const Message &getParameter(const Event &event) { return *event.getConstMessage(); }
};

// Pointers to it, and events, by value or by reference; a pointer to a message that may be changed gets it as it is.
namespace detail
{
template <class X>
struct PointerAdapter
{
    typedef typename std::remove_const<X>::type Message;
    typedef MessageEvent<Message const>         Event;
    static boost::shared_ptr<X> getParameter(const Event &event)
    {
        return boost::const_pointer_cast<X>(event.getConstMessage());
    }
};
template <class X>
struct EventAdapter
{
    typedef typename std::remove_const<X>::type Message;
    typedef MessageEvent<Message const>         Event;
    static MessageEvent<X> getParameter(const Event &event) { return MessageEvent<X>(event); }
};
} // namespace detail

template <class X>
struct ParameterAdapter<boost::shared_ptr<X>> : detail::PointerAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const boost::shared_ptr<X>> : detail::PointerAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const boost::shared_ptr<X> &> : detail::PointerAdapter<X>
{
};
template <class X>
struct ParameterAdapter<MessageEvent<X>> : detail::EventAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const MessageEvent<X>> : detail::EventAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const MessageEvent<X> &> : detail::EventAdapter<X>
{
};

} // namespace ros

#endif
