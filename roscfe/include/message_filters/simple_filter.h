// message_filters::SimpleFilter: what has one output, and the callbacks that it is for.
#ifndef ROSCFE_MESSAGE_FILTERS_SIMPLE_FILTER_H
#define ROSCFE_MESSAGE_FILTERS_SIMPLE_FILTER_H

#include <list>
#include <string>

#include "message_filters/connection.h"
#include "ros/parameter_adapter.h"

namespace message_filters
{

template <class M>
class SimpleFilter
{
  public:
    typedef boost::shared_ptr<M const>             MConstPtr;
    typedef boost::function<void(const MConstPtr &)> Callback;
    typedef ros::MessageEvent<M const>             EventType;
    typedef boost::function<void(const EventType &)> EventCallback;

    // A callable that takes a pointer to the message; functions and methods with any parameter.
    template <class C>
    Connection registerCallback(const C &callback)
    {
        const Callback call(callback);
        return add([call](const EventType &event) { call(event.getConstMessage()); });
    }
    template <class P>
    Connection registerCallback(const boost::function<void(P)> &callback)
    {
        return add([callback](const EventType &event) { callback(ros::ParameterAdapter<P>::getParameter(event)); });
    }
    template <class P>
    Connection registerCallback(void (*callback)(P))
    {
        return add([callback](const EventType &event) { callback(ros::ParameterAdapter<P>::getParameter(event)); });
    }
    template <class T, class P>
    Connection registerCallback(void (T::*callback)(P), T *object)
    {
        return add([callback, object](const EventType &event) {
            (object->*callback)(ros::ParameterAdapter<P>::getParameter(event));
        });
    }

    void               setName(const std::string &name) { name_ = name; }
    const std::string &getName() { return name_; }

  protected:
    void signalMessage(const MConstPtr &message) { signalMessage(EventType(message)); }
    void signalMessage(const EventType &event)
    {
        for (auto each = callbacks_.begin(); each != callbacks_.end();)
        {
            (each++)->call(event); // it may end its own registration
        }
    }

  private:
    struct Registered
    {
        EventCallback call;
    };

    template <class F>
    Connection add(F call)
    {
        callbacks_.push_back(Registered{EventCallback(call)});
        const auto place = std::prev(callbacks_.end());
        return Connection([this, place]() { callbacks_.erase(place); });
    }

    std::list<Registered> callbacks_;
    std::string           name_;
};

} // namespace message_filters

#endif
