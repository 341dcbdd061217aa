// Spinners. Threads of a node take turns on cFE, so callbacks of all of them run one after the other.
#ifndef ROS_SPINNER_H
#define ROS_SPINNER_H

#include <cstdint>

#include "ros/callback_queue.h"
#include "ros/forwards.h"
#include "roscfe/helpers.h"

namespace ros
{

class Spinner
{
  public:
    virtual ~Spinner() = default;
    virtual void spin(CallbackQueue *queue = nullptr) = 0;
};

class SingleThreadedSpinner : public Spinner
{
  public:
    void spin(CallbackQueue *queue = nullptr) override { spin_now(queue); }

  private:
    static void spin_now(CallbackQueue *queue);
};

class MultiThreadedSpinner : public SingleThreadedSpinner
{
  public:
    explicit MultiThreadedSpinner(std::uint32_t = 0) {}
};

// While it is started, callbacks run in a thread of their own, or, in nodes that have none, whenever the node waits: in
// Rate::sleep, Duration::sleep, waitForShutdown.
class AsyncSpinner
{
  public:
    explicit AsyncSpinner(std::uint32_t, CallbackQueue *queue = nullptr);
    ~AsyncSpinner() { stop(); }
    AsyncSpinner(const AsyncSpinner &) = delete;
    AsyncSpinner &operator=(const AsyncSpinner &) = delete;

    bool canStart() const { return true; }
    void start();
    void stop();

  private:
    CallbackQueue *queue_;
    roscfe::Helper *thread_ = nullptr;
    bool           started_ = false;
};

} // namespace ros

#endif
