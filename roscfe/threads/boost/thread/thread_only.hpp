// A thread.
#ifndef BOOST_THREAD_THREAD_ONLY_HPP
#define BOOST_THREAD_THREAD_ONLY_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>

#include "boost/thread/interruption.hpp"
#include "boost/thread/thread_time.hpp"
#include "roscfe/thread_waits.h"

namespace boost
{
namespace this_thread
{

inline std::thread::id get_id()
{
    return std::this_thread::get_id();
}

inline void yield()
{
    roscfe::let_other_threads_run();
}

// Until a moment, or for a duration.
template <class Time>
void sleep(const Time &time)
{
    interruption_point();
    roscfe::wait_for_thread(roscfe::wait_end(roscfe_time::rest(time)), roscfe_thread::interruption());
    interruption_point();
}
template <class Duration>
void sleep_for(const Duration &duration)
{
    sleep(duration);
}
template <class Time>
void sleep_until(const Time &time)
{
    sleep(time);
}

} // namespace this_thread

class thread
{
  public:
    typedef std::thread::id                 id;
    typedef std::thread::native_handle_type native_handle_type;

    // All threads have one size of stack.
    class attributes
    {
      public:
        void        set_stack_size(std::size_t size) { size_ = size; }
        std::size_t get_stack_size() const { return size_; }

      private:
        std::size_t size_ = 0;
    };

    thread() noexcept = default;
    template <class F, class... Arguments,
              class = std::enable_if_t<!std::is_same<std::decay_t<F>, thread>::value &&
                                       !std::is_same<std::decay_t<F>, attributes>::value>>
    explicit thread(F &&function, Arguments &&... arguments) : data_(std::make_shared<roscfe_thread::Data>())
    {
        std::shared_ptr<roscfe_thread::Data> data = data_;
        thread_                                   = std::thread(
            [data](auto &&called, auto &&... with) {
                roscfe_thread::t_data = data.get();
                try
                {
                    std::invoke(std::forward<decltype(called)>(called), std::forward<decltype(with)>(with)...);
                }
                catch (const thread_interrupted &)
                {
                    // the end that was asked for
                }
                roscfe_thread::t_data = nullptr;
                data->is_done         = true;
                roscfe::thread_has_news();
            },
            std::forward<F>(function), std::forward<Arguments>(arguments)...);
    }
    template <class F, class... Arguments>
    thread(const attributes &, F &&function, Arguments &&... arguments)
        : thread(std::forward<F>(function), std::forward<Arguments>(arguments)...)
    {
    }
    ~thread() { detach(); }

    thread(thread &&other) noexcept { swap(other); }
    thread &operator=(thread &&other) noexcept
    {
        thread taken(std::move(other));
        swap(taken);
        return *this;
    }
    thread(const thread &) = delete;
    thread &operator=(const thread &) = delete;

    void swap(thread &other) noexcept
    {
        thread_.swap(other.thread_);
        data_.swap(other.data_);
    }

    id                   get_id() const { return thread_.get_id(); }
    native_handle_type   native_handle() { return thread_.native_handle(); }
    bool                 joinable() const { return thread_.joinable(); }
    static unsigned      hardware_concurrency() { return std::thread::hardware_concurrency(); }
    static unsigned      physical_concurrency() { return std::thread::hardware_concurrency(); }
    static void          yield() { this_thread::yield(); }
    template <class Time>
    static void sleep(const Time &until)
    {
        this_thread::sleep(until);
    }

    void join() { join_until(roscfe::kNoWaitEnd); }
    template <class Time>
    bool timed_join(const Time &time)
    {
        return join_until(roscfe::wait_end(roscfe_time::rest(time)));
    }
    template <class Duration>
    bool try_join_for(const Duration &duration)
    {
        return timed_join(duration);
    }
    template <class Time>
    bool try_join_until(const Time &time)
    {
        return timed_join(time);
    }
    void detach()
    {
        if (thread_.joinable())
        {
            thread_.detach();
        }
        data_.reset();
    }

    void interrupt()
    {
        if (data_ != nullptr)
        {
            data_->is_interrupted = true;
            roscfe::thread_has_news();
        }
    }
    bool interruption_requested() const { return data_ != nullptr && data_->is_interrupted; }

  private:
    bool join_until(std::int64_t until_ns)
    {
        if (!thread_.joinable())
        {
            return false; // Boost 2: nothing to wait for
        }
        this_thread::interruption_point();
        const std::shared_ptr<roscfe_thread::Data> data = data_;
        if (const bool *ends = roscfe_thread::interruption(); ends != nullptr || until_ns != roscfe::kNoWaitEnd)
        {
            while (!data->is_done && !this_thread::interruption_requested() &&
                   (until_ns == roscfe::kNoWaitEnd || roscfe::wait_end(0) < until_ns))
            {
                roscfe::wait_for_change(until_ns);
            }
            this_thread::interruption_point();
            if (!data->is_done)
            {
                return false;
            }
        }
        thread_.join();
        data_.reset();
        return true;
    }

    std::thread                          thread_;
    std::shared_ptr<roscfe_thread::Data> data_;
};

inline void swap(thread &one, thread &other) noexcept
{
    one.swap(other);
}

} // namespace boost

#endif
