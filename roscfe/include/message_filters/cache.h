// message_filters::Cache: the last messages, by their stamps.
#ifndef ROSCFE_MESSAGE_FILTERS_CACHE_H
#define ROSCFE_MESSAGE_FILTERS_CACHE_H

#include <deque>
#include <vector>

#include "message_filters/simple_filter.h"
#include "ros/message_traits.h"

namespace message_filters
{

template <class M>
class Cache : public SimpleFilter<M>
{
  public:
    typedef boost::shared_ptr<M const> MConstPtr;
    typedef ros::MessageEvent<M const> EventType;

    explicit Cache(unsigned size = 1) { setCacheSize(size); }
    template <class F>
    explicit Cache(F &filter, unsigned size = 1)
    {
        setCacheSize(size);
        connectInput(filter);
    }
    ~Cache() { input_.disconnect(); }

    template <class F>
    void connectInput(F &filter)
    {
        input_.disconnect();
        input_ = filter.registerCallback(
            boost::function<void(const EventType &)>([this](const EventType &event) { this->add(event); }));
    }
    void setCacheSize(unsigned size) { size_ = size == 0 ? 1 : size; }

    void add(const MConstPtr &message) { add(EventType(message)); }
    void add(const EventType &event)
    {
        while (cache_.size() >= size_)
        {
            cache_.pop_front();
        }
        // Mostly the newest one; else it goes where its stamp says.
        auto place = cache_.end();
        while (place != cache_.begin() && stamp(*std::prev(place)) > stamp(event))
        {
            --place;
        }
        cache_.insert(place, event);
        this->signalMessage(event);
    }

    std::vector<MConstPtr> getInterval(const ros::Time &start, const ros::Time &end) const
    {
        std::vector<MConstPtr> found;
        for (const EventType &each : cache_)
        {
            if (stamp(each) >= start && stamp(each) <= end)
            {
                found.push_back(each.getConstMessage());
            }
        }
        return found;
    }
    // As getInterval, with the message before it and the one behind it.
    std::vector<MConstPtr> getSurroundingInterval(const ros::Time &start, const ros::Time &end) const
    {
        std::vector<MConstPtr> found;
        for (std::size_t i = 0; i < cache_.size(); ++i)
        {
            const bool is_last_before = stamp(cache_[i]) < start && (i + 1 == cache_.size() || stamp(cache_[i + 1]) >= start);
            const bool is_first_after = stamp(cache_[i]) > end && (i == 0 || stamp(cache_[i - 1]) <= end);
            const bool is_in          = stamp(cache_[i]) >= start && stamp(cache_[i]) <= end;
            if (is_last_before || is_in || is_first_after)
            {
                found.push_back(cache_[i].getConstMessage());
            }
        }
        return found;
    }
    MConstPtr getElemBeforeTime(const ros::Time &time) const
    {
        MConstPtr found;
        for (const EventType &each : cache_)
        {
            if (stamp(each) < time)
            {
                found = each.getConstMessage();
            }
        }
        return found;
    }
    MConstPtr getElemAfterTime(const ros::Time &time) const
    {
        for (const EventType &each : cache_)
        {
            if (stamp(each) > time)
            {
                return each.getConstMessage();
            }
        }
        return MConstPtr();
    }
    ros::Time getLatestTime() const { return cache_.empty() ? ros::Time() : stamp(cache_.back()); }
    ros::Time getOldestTime() const { return cache_.empty() ? ros::Time() : stamp(cache_.front()); }

  private:
    static ros::Time stamp(const EventType &event)
    {
        return ros::message_traits::TimeStamp<M>::value(*event.getConstMessage());
    }

    std::size_t           size_ = 1;
    std::deque<EventType> cache_;
    Connection            input_;
};

} // namespace message_filters

#endif
