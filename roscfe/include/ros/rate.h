// ros::Rate and ros::WallRate: the same pace as roscpp keeps, after a slow cycle too.
#ifndef ROS_RATE_H
#define ROS_RATE_H

#include "ros/time.h"

namespace ros
{

template <class T, class D>
class RateOf
{
  public:
    // A frequency of 0 has a cycle that no duration is: std::runtime_error.
    explicit RateOf(double frequency) : start_(T::now()), expected_(1.0 / frequency), actual_(0.0) {}
    explicit RateOf(const D &cycle) : start_(T::now()), expected_(cycle), actual_(0.0) {}

    // Wait for the end of the cycle; false when it was over already.
    bool sleep()
    {
        T       expected_end = start_ + expected_;
        const T actual_end   = T::now();
        if (actual_end < start_) // time went back
        {
            expected_end = actual_end + expected_;
        }
        const D rest = expected_end - actual_end;
        actual_      = actual_end - start_;
        start_       = expected_end;
        if (rest <= D(0.0))
        {
            if (actual_end > expected_end + expected_) // more than a whole cycle late: begin anew
            {
                start_ = actual_end;
            }
            return false;
        }
        return rest.sleep();
    }

    void reset() { start_ = T::now(); }
    D    cycleTime() const { return actual_; }
    D    expectedCycleTime() const { return expected_; }

  private:
    T start_;
    D expected_;
    D actual_;
};

class Rate : public RateOf<Time, Duration>
{
  public:
    Rate(double frequency) : RateOf<Time, Duration>(frequency) {}
    explicit Rate(const Duration &cycle) : RateOf<Time, Duration>(cycle) {}
};

class WallRate : public RateOf<WallTime, WallDuration>
{
  public:
    WallRate(double frequency) : RateOf<WallTime, WallDuration>(frequency) {}
    explicit WallRate(const Duration &cycle) : RateOf<WallTime, WallDuration>(WallDuration(cycle.sec, cycle.nsec)) {}
};

} // namespace ros

#endif
