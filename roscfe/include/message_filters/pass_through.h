// message_filters::PassThrough: a filter into which messages are put by hand.
#ifndef ROSCFE_MESSAGE_FILTERS_PASS_THROUGH_H
#define ROSCFE_MESSAGE_FILTERS_PASS_THROUGH_H

#include "message_filters/simple_filter.h"

namespace message_filters
{

template <class M>
class PassThrough : public SimpleFilter<M>
{
  public:
    typedef boost::shared_ptr<M const> MConstPtr;
    typedef ros::MessageEvent<M const> EventType;

    PassThrough() = default;
    template <class F>
    explicit PassThrough(F &filter)
    {
        connectInput(filter);
    }
    ~PassThrough() { input_.disconnect(); }

    template <class F>
    void connectInput(F &filter)
    {
        input_.disconnect();
        input_ = filter.registerCallback(
            boost::function<void(const EventType &)>([this](const EventType &event) { this->add(event); }));
    }
    void add(const MConstPtr &message) { add(EventType(message)); }
    void add(const EventType &event) { this->signalMessage(event); }

  private:
    Connection input_;
};

} // namespace message_filters

#endif
