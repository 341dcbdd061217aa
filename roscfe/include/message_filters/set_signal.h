// Callbacks that get one message of each of several streams.
#ifndef ROSCFE_MESSAGE_FILTERS_SET_SIGNAL_H
#define ROSCFE_MESSAGE_FILTERS_SET_SIGNAL_H

#include <iterator>
#include <list>
#include <tuple>
#include <utility>

#include "message_filters/connection.h"
#include "ros/parameter_adapter.h"
#include "roscfe/synchronizing.h"

namespace message_filters
{

template <class Messages> // a std::tuple of the types
class SetSignal
{
    static constexpr std::size_t kStreams = std::tuple_size<Messages>::value;
    template <std::size_t i>
    using Message = typename std::tuple_element<i, Messages>::type;

  public:
    // A callable that takes pointers to the messages, a function, or a method of an object. A message that a set lacks
    // is a null pointer.
    template <class C>
    Connection add(C callback)
    {
        return keep([callback](const roscfe::ItemSet &set) mutable {
            call(callback, set, std::make_index_sequence<kStreams>());
        });
    }
    template <class... P>
    Connection add(void (*callback)(P...))
    {
        return keep([callback](const roscfe::ItemSet &set) {
            call_with<P...>([callback](P... parameters) { callback(parameters...); }, set,
                            std::index_sequence_for<P...>());
        });
    }
    template <class T, class U, class... P>
    Connection add(void (T::*callback)(P...), U *object)
    {
        return keep([callback, object](const roscfe::ItemSet &set) {
            call_with<P...>([callback, object](P... parameters) { (object->*callback)(parameters...); }, set,
                            std::index_sequence_for<P...>());
        });
    }
    template <class T, class U, class... P>
    Connection add(void (T::*callback)(P...) const, U *object)
    {
        return keep([callback, object](const roscfe::ItemSet &set) {
            call_with<P...>([callback, object](P... parameters) { (object->*callback)(parameters...); }, set,
                            std::index_sequence_for<P...>());
        });
    }

    // A callback may end its own registration.
    void operator()(const roscfe::ItemSet &set) const
    {
        for (auto each = callbacks_.begin(); each != callbacks_.end();)
        {
            (*each++)(set);
        }
    }

  private:
    typedef boost::function<void(const roscfe::ItemSet &)> Callback;

    template <std::size_t i>
    static boost::shared_ptr<Message<i> const> message_of(const roscfe::ItemSet &set)
    {
        return boost::static_pointer_cast<Message<i> const>(set[i].message);
    }
    template <class C, std::size_t... i>
    static void call(C &callback, const roscfe::ItemSet &set, std::index_sequence<i...>)
    {
        callback(message_of<i>(set)...);
    }
    template <class... P, class C, std::size_t... i>
    static void call_with(C callback, const roscfe::ItemSet &set, std::index_sequence<i...>)
    {
        callback(ros::ParameterAdapter<P>::getParameter(
            ros::MessageEvent<Message<i> const>(message_of<i>(set), set[i].receipt))...);
    }

    template <class F>
    Connection keep(F callback)
    {
        callbacks_.push_back(Callback(callback));
        const auto place = std::prev(callbacks_.end());
        return Connection([this, place]() { callbacks_.erase(place); });
    }

    std::list<Callback> callbacks_;
};

} // namespace message_filters

#endif
