// Sets of messages that belong together.
#include "roscfe/synchronizing.h"

#include <algorithm>

namespace roscfe
{

// -- the same stamp ----------------------------------------------------------------------------------------------------

void ExactSynchronization::drop_oldest()
{
    if (on_drop)
    {
        on_drop(sets_.begin()->second);
    }
    sets_.erase(sets_.begin());
}

void ExactSynchronization::add_now(std::size_t stream, const StampedItem &item)
{
    ItemSet &set = sets_[item.stamp];
    set.resize(streams_);
    set[stream] = item;
    if (std::all_of(set.begin(), set.end(), [](const StampedItem &each) { return each.message != nullptr; }))
    {
        const ItemSet whole = set;
        if (on_set)
        {
            on_set(whole);
        }
        last_signal_ = item.stamp;
        sets_.erase(item.stamp);
        while (!sets_.empty() && sets_.begin()->first <= last_signal_)
        {
            drop_oldest();
        }
    }
    while (queue_size_ > 0 && sets_.size() > queue_size_)
    {
        drop_oldest();
    }
}

// -- the closest stamps ------------------------------------------------------------------------------------------------

ApproximateSynchronization::ApproximateSynchronization(std::size_t streams, std::uint32_t queue_size)
    : least_between(streams), queue_size_(queue_size), streams_(streams)
{
}

void ApproximateSynchronization::add_now(std::size_t stream, const StampedItem &item)
{
    Stream &own = streams_[stream];
    own.waiting.push_back(item);
    if (own.waiting.size() == 1)
    {
        ++not_empty_;
        if (not_empty_ == streams_.size())
        {
            process();
        }
    }
    if (own.waiting.size() + own.past.size() <= queue_size_)
    {
        return;
    }
    // More than the queue holds: the oldest one goes, and a candidate with it.
    recover_all(nullptr);
    delete_front(stream);
    own.has_dropped = true;
    if (pivot_ != kNoPivot)
    {
        candidate_.clear();
        pivot_ = kNoPivot;
        process();
    }
}

void ApproximateSynchronization::process()
{
    while (not_empty_ == streams_.size())
    {
        std::size_t first = 0, last = 0;
        ros::Time   start, end;
        boundary(true, false, last, end);
        boundary(false, false, first, start);
        for (std::size_t i = 0; i < streams_.size(); ++i)
        {
            // None that was dropped could have been better than those that are there.
            streams_[i].has_dropped = streams_[i].has_dropped && i == last;
        }
        if (pivot_ == kNoPivot)
        {
            if (end - start > most_apart || streams_[last].has_dropped)
            {
                delete_front(first);
                continue;
            }
            make_candidate();
            candidate_start_ = start;
            candidate_end_   = end;
            pivot_           = last;
            pivot_time_      = end;
            move_front_to_past(first);
        }
        else
        {
            if (!is_no_better(start, end))
            {
                make_candidate();
                candidate_start_ = start;
                candidate_end_   = end;
            }
            move_front_to_past(first);
        }
        if (first == pivot_ || is_proved(end))
        {
            publish_candidate();
        }
        else if (not_empty_ < streams_.size())
        {
            search_virtually();
        }
    }
}

// Messages that may come, as early as they can, may still prove that nothing better than the candidate will.
void ApproximateSynchronization::search_virtually()
{
    std::vector<std::size_t> moves(streams_.size());
    for (;;)
    {
        std::size_t first = 0, last = 0;
        ros::Time   start, end;
        boundary(true, true, last, end);
        boundary(false, true, first, start);
        if (is_proved(end))
        {
            publish_candidate();
            return;
        }
        if (!is_no_better(start, end))
        {
            recover_all(&moves);
            return;
        }
        move_front_to_past(first);
        ++moves[first];
    }
}

bool ApproximateSynchronization::is_proved(ros::Time end) const
{
    return (end - candidate_end_) * (1 + age_penalty) >= pivot_time_ - candidate_start_;
}

bool ApproximateSynchronization::is_no_better(ros::Time start, ros::Time end) const
{
    return (end - candidate_end_) * (1 + age_penalty) >= start - candidate_start_;
}

void ApproximateSynchronization::make_candidate()
{
    candidate_.clear();
    for (Stream &each : streams_)
    {
        candidate_.push_back(each.waiting.front());
        each.past.clear();
    }
}

void ApproximateSynchronization::publish_candidate()
{
    const ItemSet set = candidate_;
    candidate_.clear();
    pivot_ = kNoPivot;
    recover_all(nullptr);
    for (std::size_t i = 0; i < streams_.size(); ++i)
    {
        delete_front(i);
    }
    if (on_set)
    {
        on_set(set);
    }
}

void ApproximateSynchronization::delete_front(std::size_t stream)
{
    streams_[stream].waiting.pop_front();
    not_empty_ -= streams_[stream].waiting.empty() ? 1U : 0U;
}

void ApproximateSynchronization::move_front_to_past(std::size_t stream)
{
    streams_[stream].past.push_back(streams_[stream].waiting.front());
    delete_front(stream);
}

void ApproximateSynchronization::recover(std::size_t stream, std::size_t count)
{
    Stream &own = streams_[stream];
    for (; count > 0 && !own.past.empty(); --count)
    {
        own.waiting.push_front(own.past.back());
        own.past.pop_back();
    }
}

void ApproximateSynchronization::recover_all(const std::vector<std::size_t> *counts)
{
    not_empty_ = 0;
    for (std::size_t i = 0; i < streams_.size(); ++i)
    {
        recover(i, counts != nullptr ? (*counts)[i] : streams_[i].past.size());
        not_empty_ += streams_[i].waiting.empty() ? 0U : 1U;
    }
}

ros::Time ApproximateSynchronization::virtual_time(std::size_t stream) const
{
    const Stream &own = streams_[stream];
    if (!own.waiting.empty())
    {
        return own.waiting.front().stamp;
    }
    return std::max(own.past.back().stamp + least_between[stream], pivot_time_);
}

void ApproximateSynchronization::boundary(bool end, bool is_virtual, std::size_t &stream, ros::Time &time) const
{
    for (std::size_t i = 0; i < streams_.size(); ++i)
    {
        const ros::Time at = is_virtual ? virtual_time(i) : streams_[i].waiting.front().stamp;
        if (i == 0 || (at < time) != end) // of equal ones the first for the start, the last for the end
        {
            time   = at;
            stream = i;
        }
    }
}

} // namespace roscfe
