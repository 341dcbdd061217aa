// message_filters::sync_policies::ApproximateTime: the messages whose stamps are closest.
#ifndef ROSCFE_MESSAGE_FILTERS_SYNC_POLICIES_APPROXIMATE_TIME_H
#define ROSCFE_MESSAGE_FILTERS_SYNC_POLICIES_APPROXIMATE_TIME_H

#include "message_filters/synchronizer.h"

namespace message_filters
{
namespace sync_policies
{

template <class... M>
class ApproximateTime
{
  public:
    typedef std::tuple<M...> Messages;

    explicit ApproximateTime(std::uint32_t queue_size) : synchronization_(sizeof...(M), queue_size) {}

    void setAgePenalty(double age_penalty) { synchronization_.age_penalty = age_penalty; }
    void setMaxIntervalDuration(ros::Duration most) { synchronization_.most_apart = most; }
    void setInterMessageLowerBound(int stream, ros::Duration least)
    {
        synchronization_.least_between[static_cast<std::size_t>(stream)] = least;
    }
    void setInterMessageLowerBound(ros::Duration least)
    {
        synchronization_.least_between.assign(sizeof...(M), least);
    }

  protected:
    void begin_synchronization(const boost::function<void(const roscfe::ItemSet &)> &on_set)
    {
        synchronization_.on_set = on_set;
    }
    roscfe::Synchronization &synchronization() { return synchronization_; }

  private:
    roscfe::ApproximateSynchronization synchronization_;
};

} // namespace sync_policies
} // namespace message_filters

#endif
