// message_filters::sync_policies::ExactTime: messages with the same stamp.
#ifndef ROSCFE_MESSAGE_FILTERS_SYNC_POLICIES_EXACT_TIME_H
#define ROSCFE_MESSAGE_FILTERS_SYNC_POLICIES_EXACT_TIME_H

#include "message_filters/synchronizer.h"

namespace message_filters
{
namespace sync_policies
{

template <class... M>
class ExactTime
{
  public:
    typedef std::tuple<M...> Messages;

    explicit ExactTime(std::uint32_t queue_size) : synchronization_(sizeof...(M), queue_size) {}

    // Callbacks for sets that are given up: the messages of the streams that have one with the stamp.
    template <class... C>
    Connection registerDropCallback(C... callback)
    {
        return dropped_.add(callback...);
    }

  protected:
    void begin_synchronization(const boost::function<void(const roscfe::ItemSet &)> &on_set)
    {
        synchronization_.on_set  = on_set;
        synchronization_.on_drop = [this](const roscfe::ItemSet &set) { dropped_(set); };
    }
    roscfe::Synchronization &synchronization() { return synchronization_; }

  private:
    roscfe::ExactSynchronization synchronization_;
    SetSignal<Messages>          dropped_;
};

} // namespace sync_policies
} // namespace message_filters

#endif
