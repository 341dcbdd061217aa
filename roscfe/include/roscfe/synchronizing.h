// Messages of several streams that belong together, without their types.
#ifndef ROSCFE_SYNCHRONIZING_H
#define ROSCFE_SYNCHRONIZING_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>

#include "ros/time.h"

namespace roscfe
{

// A message of any type: its stamp, when it came, and itself.
struct StampedItem
{
    ros::Time                     stamp;
    ros::Time                     receipt;
    boost::shared_ptr<void const> message;
};
typedef std::vector<StampedItem> ItemSet; // one of each stream

class Synchronization
{
  public:
    virtual ~Synchronization() = default;
    virtual void add(std::size_t stream, const StampedItem &item) = 0;

    boost::function<void(const ItemSet &)> on_set;
    boost::function<void(const ItemSet &)> on_drop;
};

// Messages with the same stamp. Sets that are not complete are given up when a later one is, or when there are too many.
class ExactSynchronization final : public Synchronization
{
  public:
    ExactSynchronization(std::size_t streams, std::uint32_t queue_size) : streams_(streams), queue_size_(queue_size) {}
    void add(std::size_t stream, const StampedItem &item) override { add_now(stream, item); }

  private:
    void add_now(std::size_t stream, const StampedItem &item);
    void drop_oldest();

    std::size_t                  streams_;
    std::uint32_t                queue_size_;
    std::map<ros::Time, ItemSet> sets_;
    ros::Time                    last_signal_;
};

// The closest messages, as ROS's adaptive algorithm finds them
// (http://wiki.ros.org/message_filters/ApproximateTime): each message is used once, and sets do not cross.
class ApproximateSynchronization final : public Synchronization
{
  public:
    ApproximateSynchronization(std::size_t streams, std::uint32_t queue_size);
    void add(std::size_t stream, const StampedItem &item) override { add_now(stream, item); }

    double                     age_penalty = 0.1; // how much an earlier end of a set is worth
    ros::Duration              most_apart  = ros::DURATION_MAX;
    std::vector<ros::Duration> least_between; // messages of each stream

  private:
    static constexpr std::size_t kNoPivot = SIZE_MAX;

    struct Stream
    {
        std::deque<StampedItem> waiting;
        std::vector<StampedItem> past; // looked at since the candidate was found
        bool                    has_dropped = false;
    };

    void      add_now(std::size_t stream, const StampedItem &item);
    void      process();
    void      search_virtually();
    void      make_candidate();
    void      publish_candidate();
    void      delete_front(std::size_t stream);
    void      move_front_to_past(std::size_t stream);
    void      recover(std::size_t stream, std::size_t count);
    void      recover_all(const std::vector<std::size_t> *counts);
    bool      is_proved(ros::Time end) const;
    bool      is_no_better(ros::Time start, ros::Time end) const;
    ros::Time virtual_time(std::size_t stream) const;
    void      boundary(bool end, bool is_virtual, std::size_t &stream, ros::Time &time) const;

    std::uint32_t       queue_size_;
    std::vector<Stream> streams_;
    std::size_t         not_empty_ = 0;
    ItemSet             candidate_;
    ros::Time           candidate_start_;
    ros::Time           candidate_end_;
    ros::Time           pivot_time_;
    std::size_t         pivot_ = kNoPivot;
};

} // namespace roscfe

#endif
