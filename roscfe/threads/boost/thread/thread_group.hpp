// Threads that are waited for together.
#ifndef BOOST_THREAD_THREAD_GROUP_HPP
#define BOOST_THREAD_THREAD_GROUP_HPP

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "boost/thread/thread_only.hpp"

namespace boost
{

class thread_group
{
  public:
    thread_group() = default;
    thread_group(const thread_group &) = delete;
    thread_group &operator=(const thread_group &) = delete;

    template <class F>
    thread *create_thread(F function)
    {
        threads_.push_back(std::make_unique<thread>(function));
        return threads_.back().get();
    }
    void add_thread(thread *added) { threads_.emplace_back(added); }
    void remove_thread(thread *removed)
    {
        const auto at = std::find_if(threads_.begin(), threads_.end(), [=](const auto &each) { return each.get() == removed; });
        if (at != threads_.end())
        {
            at->release();
            threads_.erase(at);
        }
    }

    bool is_thread_in(const thread *asked) const
    {
        return std::any_of(threads_.begin(), threads_.end(), [=](const auto &each) { return each->get_id() == asked->get_id(); });
    }
    bool is_this_thread_in() const
    {
        const auto id = this_thread::get_id();
        return std::any_of(threads_.begin(), threads_.end(), [=](const auto &each) { return each->get_id() == id; });
    }

    void join_all()
    {
        for (const auto &each : threads_)
        {
            if (each->joinable())
            {
                each->join();
            }
        }
    }
    void interrupt_all()
    {
        for (const auto &each : threads_)
        {
            each->interrupt();
        }
    }
    std::size_t size() const { return threads_.size(); }

  private:
    std::vector<std::unique_ptr<thread>> threads_;
};

} // namespace boost

#endif
