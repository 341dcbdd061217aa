// message_filters::Synchronizer: callbacks that get messages of several filters at once.
#ifndef ROSCFE_MESSAGE_FILTERS_SYNCHRONIZER_H
#define ROSCFE_MESSAGE_FILTERS_SYNCHRONIZER_H

#include <list>
#include <string>
#include <tuple>
#include <utility>

#include "message_filters/set_signal.h"
#include "ros/message_traits.h"

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

    template <class... C>
    Connection registerCallback(C... callback)
    {
        return signal_.add(callback...);
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
        this->begin_synchronization([this](const roscfe::ItemSet &set) { signal_(set); });
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

    SetSignal<Messages>   signal_;
    std::list<Connection> inputs_;
    std::string           name_;
};

} // namespace message_filters

#endif
