// message_filters::TimeSynchronizer: a synchronizer of messages with the same stamp.
#ifndef ROSCFE_MESSAGE_FILTERS_TIME_SYNCHRONIZER_H
#define ROSCFE_MESSAGE_FILTERS_TIME_SYNCHRONIZER_H

#include "message_filters/sync_policies/exact_time.h"

namespace message_filters
{

template <class... M>
class TimeSynchronizer : public Synchronizer<sync_policies::ExactTime<M...>>
{
    typedef sync_policies::ExactTime<M...> Policy;
    typedef Synchronizer<Policy>           Base;

  public:
    explicit TimeSynchronizer(std::uint32_t queue_size) : Base(Policy(queue_size)) {}

    // The filters, and behind them the length of the queue.
    template <class F0, class... Rest>
    TimeSynchronizer(F0 &first, Rest &&... rest)
        : TimeSynchronizer(std::make_index_sequence<sizeof...(M)>(), std::forward_as_tuple(first, rest...))
    {
    }

  private:
    template <std::size_t... i, class T>
    TimeSynchronizer(std::index_sequence<i...>, T &&arguments)
        : Base(Policy(static_cast<std::uint32_t>(std::get<sizeof...(M)>(arguments))), std::get<i>(arguments)...)
    {
    }
};

} // namespace message_filters

#endif
