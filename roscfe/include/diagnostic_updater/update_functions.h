// Tasks that many nodes have: how often something happens, and how old its stamps are.
#ifndef ROSCFE_DIAGNOSTIC_UPDATER_UPDATE_FUNCTIONS_H
#define ROSCFE_DIAGNOSTIC_UPDATER_UPDATE_FUNCTIONS_H

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "diagnostic_updater/diagnostic_updater.h"

namespace diagnostic_updater
{

struct FrequencyStatusParam
{
    FrequencyStatusParam(double *min_freq, double *max_freq, double tolerance = 0.1, int window_size = 5)
        : min_freq_(min_freq), max_freq_(max_freq), tolerance_(tolerance), window_size_(window_size)
    {
    }
    double *min_freq_;
    double *max_freq_;
    double  tolerance_;
    int     window_size_;
};

class FrequencyStatus : public DiagnosticTask
{
  public:
    FrequencyStatus(const FrequencyStatusParam &params, std::string name = "Frequency Status")
        : DiagnosticTask(name), params_(params), times_(static_cast<std::size_t>(params.window_size_)),
          sequences_(static_cast<std::size_t>(params.window_size_))
    {
        clear();
    }

    void clear()
    {
        count_ = 0;
        index_ = 0;
        std::fill(times_.begin(), times_.end(), ros::Time::now());
        std::fill(sequences_.begin(), sequences_.end(), 0);
    }
    void tick() { ++count_; }
    void run(DiagnosticStatusWrapper &status) override
    {
        const ros::Time now    = ros::Time::now();
        const int       events = count_ - sequences_[index_];
        const double    window = (now - times_[index_]).toSec();
        const double    rate   = events / window;
        sequences_[index_]     = count_;
        times_[index_]         = now;
        index_                 = (index_ + 1) % times_.size();
        if (events == 0)
        {
            status.summary(2, "No events recorded.");
        }
        else if (rate < *params_.min_freq_ * (1 - params_.tolerance_))
        {
            status.summary(1, "Frequency too low.");
        }
        else if (rate > *params_.max_freq_ * (1 + params_.tolerance_))
        {
            status.summary(1, "Frequency too high.");
        }
        else
        {
            status.summary(0, "Desired frequency met");
        }
        status.addf("Events in window", "%d", events);
        status.addf("Events since startup", "%d", count_);
        status.addf("Duration of window (s)", "%f", window);
        status.addf("Actual frequency (Hz)", "%f", rate);
        if (*params_.min_freq_ == *params_.max_freq_)
        {
            status.addf("Target frequency (Hz)", "%f", *params_.min_freq_);
        }
        if (*params_.min_freq_ > 0)
        {
            status.addf("Minimum acceptable frequency (Hz)", "%f", *params_.min_freq_ * (1 - params_.tolerance_));
        }
        if (*params_.max_freq_ < std::numeric_limits<double>::infinity())
        {
            status.addf("Maximum acceptable frequency (Hz)", "%f", *params_.max_freq_ * (1 + params_.tolerance_));
        }
    }

  private:
    const FrequencyStatusParam params_;
    int                        count_ = 0;
    std::vector<ros::Time>     times_;
    std::vector<int>           sequences_;
    std::size_t                index_ = 0;
};

struct TimeStampStatusParam
{
    TimeStampStatusParam(double min_acceptable = -1, double max_acceptable = 5)
        : max_acceptable_(max_acceptable), min_acceptable_(min_acceptable)
    {
    }
    double max_acceptable_;
    double min_acceptable_;
};

class TimeStampStatus : public DiagnosticTask
{
  public:
    TimeStampStatus(const TimeStampStatusParam &params = TimeStampStatusParam(), std::string name = "Timestamp Status")
        : DiagnosticTask(name), params_(params)
    {
    }

    void tick(double stamp)
    {
        if (stamp == 0)
        {
            zero_seen_ = true;
            return;
        }
        const double delta = ros::Time::now().toSec() - stamp;
        most_              = valid_ ? std::max(most_, delta) : delta;
        least_             = valid_ ? std::min(least_, delta) : delta;
        valid_             = true;
    }
    void tick(const ros::Time time) { tick(time.toSec()); }
    void run(DiagnosticStatusWrapper &status) override
    {
        status.summary(0, "Timestamps are reasonable.");
        if (!valid_)
        {
            status.summary(1, "No data since last update.");
        }
        else
        {
            if (least_ < params_.min_acceptable_)
            {
                status.summary(2, "Timestamps too far in future seen.");
                ++early_;
            }
            if (most_ > params_.max_acceptable_)
            {
                status.summary(2, "Timestamps too far in past seen.");
                ++late_;
            }
            if (zero_seen_)
            {
                status.summary(2, "Zero timestamp seen.");
                ++zero_;
            }
        }
        status.addf("Earliest timestamp delay:", "%f", least_);
        status.addf("Latest timestamp delay:", "%f", most_);
        status.addf("Earliest acceptable timestamp delay:", "%f", params_.min_acceptable_);
        status.addf("Latest acceptable timestamp delay:", "%f", params_.max_acceptable_);
        status.add("Late diagnostic update count:", late_);
        status.add("Early diagnostic update count:", early_);
        status.add("Zero seen diagnostic update count:", zero_);
        valid_     = false;
        least_     = 0;
        most_      = 0;
        zero_seen_ = false;
    }

  private:
    const TimeStampStatusParam params_;
    int                        early_     = 0;
    int                        late_      = 0;
    int                        zero_      = 0;
    bool                       zero_seen_ = false;
    double                     most_      = 0;
    double                     least_     = 0;
    bool                       valid_     = false;
};

class Heartbeat : public DiagnosticTask
{
  public:
    Heartbeat() : DiagnosticTask("Heartbeat") {}
    void run(DiagnosticStatusWrapper &status) override { status.summary(0, "Alive"); }
};

} // namespace diagnostic_updater

#endif
