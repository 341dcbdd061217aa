// A point that threads pass together.
#ifndef BOOST_THREAD_BARRIER_HPP
#define BOOST_THREAD_BARRIER_HPP

#include "boost/thread/condition_variable.hpp"
#include "boost/thread/mutex.hpp"

namespace boost
{

class barrier
{
  public:
    explicit barrier(unsigned int count) : count_(count), missing_(count) {}
    barrier(const barrier &) = delete;
    barrier &operator=(const barrier &) = delete;

    // True in the thread that came last.
    bool wait()
    {
        unique_lock<mutex> lock(mutex_);
        const unsigned     round = round_;
        if (--missing_ == 0)
        {
            missing_ = count_;
            ++round_;
            passed_.notify_all();
            return true;
        }
        while (round == round_)
        {
            passed_.wait(lock);
        }
        return false;
    }
    void count_down_and_wait() { wait(); }

  private:
    mutex              mutex_;
    condition_variable passed_;
    unsigned           count_;
    unsigned           missing_;
    unsigned           round_ = 0;
};

} // namespace boost

#endif
