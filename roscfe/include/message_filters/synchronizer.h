// message_filters::Synchronizer: callbacks that get messages of several filters at once.
#ifndef ROSCFE_MESSAGE_FILTERS_SYNCHRONIZER_H
#define ROSCFE_MESSAGE_FILTERS_SYNCHRONIZER_H

#include <list>
#include <string>
#include <tuple>
#include <utility>

#include "message_filters/connection.h"
#include "ros/message_traits.h"
#include "ros/parameter_adapter.h"
#include "roscfe/synchronizing.h"

namespace message_filters
{

class NullType
{
};

template <class Policy>
class Synchronizer : public Policy
{
  public:
    typedef typename Policy::Messages              Messages; // a std::tuple of the types
    static constexpr std::size_t                   kStreams = std::tuple_size<Messages>::value;
    template <std::size_t i>
    using Message = typename std::tuple_element<i, Messages>::type;

    explicit Synchronizer(std::uint32_t queue_size) : Policy(queue_size) { begin(); }
    explicit Synchronizer(const Policy &policy) : Policy(policy) { begin(); }
    template <class... F>
    explicit Synchronizer(const Policy &policy, F &... filters) : Policy(policy)
    {
        begin();
        connectInput(filters...);
    }
    Synchronizer(const Synchronizer &) = delete;
    Synchronizer &operator=(const Synchronizer &) = delete;
    ~Synchronizer() { disconnect(); }

    template <class... F>
    void connectInput(F &... filters)
    {
        disconnect();
        connect(std::index_sequence_for<F...>(), filters...);
    }

    // A callable that takes pointers to the messages, a function, or a method of an object.
    template <class C>
    Connection registerCallback(C callback)
    {
        return add_callback([callback](const roscfe::ItemSet &set) mutable {
            call(callback, set, std::make_index_sequence<kStreams>());
        });
    }
    template <class... P>
    Connection registerCallback(void (*callback)(P...))
    {
        return add_callback([callback](const roscfe::ItemSet &set) {
            call_with<P...>([callback](P... parameters) { callback(parameters...); }, set,
                            std::index_sequence_for<P...>());
        });
    }
    template <class T, class U, class... P>
    Connection registerCallback(void (T::*callback)(P...), U *object)
    {
        return add_callback([callback, object](const roscfe::ItemSet &set) {
            call_with<P...>([callback, object](P... parameters) { (object->*callback)(parameters...); }, set,
                            std::index_sequence_for<P...>());
        });
    }
    template <class T, class U, class... P>
    Connection registerCallback(void (T::*callback)(P...) const, U *object)
    {
        return add_callback([callback, object](const roscfe::ItemSet &set) {
            call_with<P...>([callback, object](P... parameters) { (object->*callback)(parameters...); }, set,
                            std::index_sequence_for<P...>());
        });
    }

    template <int i>
    void add(const boost::shared_ptr<Message<i> const> &message)
    {
        take<i>(ros::MessageEvent<Message<i> const>(message));
    }

    void               setName(const std::string &name) { name_ = name; }
    const std::string &getName() { return name_; }
    Policy *           getPolicy() { return this; }

  private:
    void begin()
    {
        this->synchronization().on_set = [this](const roscfe::ItemSet &set) {
            for (auto each = callbacks_.begin(); each != callbacks_.end();)
            {
                (*each++)(set);
            }
        };
    }

    template <std::size_t i>
    void take(const ros::MessageEvent<Message<i> const> &event)
    {
        typedef ros::message_traits::TimeStamp<Message<i>> Stamp;
        this->synchronization().add(i, {Stamp::value(*event.getConstMessage()), event.getReceiptTime(),
                                        event.getConstMessage()});
    }

    template <std::size_t... i, class... F>
    void connect(std::index_sequence<i...>, F &... filters)
    {
        (inputs_.push_back(filters.registerCallback(boost::function<void(const ros::MessageEvent<Message<i> const> &)>(
             [this](const ros::MessageEvent<Message<i> const> &event) { this->template take<i>(event); }))),
         ...);
    }
    void disconnect()
    {
        for (Connection &each : inputs_)
        {
            each.disconnect();
        }
        inputs_.clear();
    }

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
    Connection add_callback(F callback)
    {
        callbacks_.push_back(boost::function<void(const roscfe::ItemSet &)>(callback));
        const auto place = std::prev(callbacks_.end());
        return Connection([this, place]() { callbacks_.erase(place); });
    }

    std::list<boost::function<void(const roscfe::ItemSet &)>> callbacks_;
    std::list<Connection>                                     inputs_;
    std::string                                               name_;
};

} // namespace message_filters

#endif
