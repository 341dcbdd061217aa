// From the parameter of a callback to the message that it means, and from a received message to that parameter.
#ifndef ROS_PARAMETER_ADAPTER_H
#define ROS_PARAMETER_ADAPTER_H

#include <type_traits>

#include "ros/message_event.h"

// Pointers to it, and events, by value or by reference; a pointer to a message that may be changed gets it as it is.
namespace roscfe
{

template <class X>
struct PointerAdapter
{
    typedef typename std::remove_const<X>::type Message;
    typedef ros::MessageEvent<Message const>         Event;
    static boost::shared_ptr<X> getParameter(const Event &event)
    {
        return boost::const_pointer_cast<X>(event.getConstMessage());
    }
};

template <class X>
struct EventAdapter
{
    typedef typename std::remove_const<X>::type Message;
    typedef ros::MessageEvent<Message const>         Event;
    static ros::MessageEvent<X> getParameter(const Event &event) { return ros::MessageEvent<X>(event); }
};
} // namespace roscfe

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

template <class X>
struct ParameterAdapter<boost::shared_ptr<X>> : roscfe::PointerAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const boost::shared_ptr<X>> : roscfe::PointerAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const boost::shared_ptr<X> &> : roscfe::PointerAdapter<X>
{
};
template <class X>
struct ParameterAdapter<MessageEvent<X>> : roscfe::EventAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const MessageEvent<X>> : roscfe::EventAdapter<X>
{
};
template <class X>
struct ParameterAdapter<const MessageEvent<X> &> : roscfe::EventAdapter<X>
{
};

} // namespace ros

#endif
