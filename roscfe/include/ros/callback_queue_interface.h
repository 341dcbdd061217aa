// What a queue of callbacks holds, and what a node handle needs of a queue.
#ifndef ROS_CALLBACK_QUEUE_INTERFACE_H
#define ROS_CALLBACK_QUEUE_INTERFACE_H

#include <cstdint>

#include <boost/shared_ptr.hpp>

namespace ros
{

class CallbackInterface
{
  public:
    enum CallResult
    {
        Success,
        TryAgain,
        Invalid
    };

    virtual ~CallbackInterface() = default;
    virtual CallResult call() = 0;
    virtual bool       ready() { return true; }
};
typedef boost::shared_ptr<CallbackInterface> CallbackInterfacePtr;

class CallbackQueueInterface
{
  public:
    virtual ~CallbackQueueInterface() = default;
    virtual void addCallback(const CallbackInterfacePtr &callback, std::uint64_t owner_id = 0) = 0;
    virtual void removeByID(std::uint64_t owner_id) = 0;

    // Of roscfe: as many more callbacks may wait, so that none is allocated for later.
    virtual void expect(std::size_t) {}
    virtual void expect_no_more(std::size_t) {} // since who was to add them has ended
};

} // namespace ros

#endif
