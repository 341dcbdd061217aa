// Publishers whose rate and stamps are watched.
#ifndef ROSCFE_DIAGNOSTIC_UPDATER_PUBLISHER_H
#define ROSCFE_DIAGNOSTIC_UPDATER_PUBLISHER_H

#include <string>

#include "diagnostic_updater/update_functions.h"

namespace diagnostic_updater
{

class HeaderlessTopicDiagnostic : public CompositeDiagnosticTask
{
  public:
    HeaderlessTopicDiagnostic(std::string name, DiagnosticTaskVector &tasks, const FrequencyStatusParam &frequency)
        : CompositeDiagnosticTask(name + " topic status"), frequency_(frequency)
    {
        addTask(&frequency_);
        tasks.add(*this);
    }
    virtual void tick() { frequency_.tick(); }
    virtual void clear_window() { frequency_.clear(); }

  private:
    FrequencyStatus frequency_;
};

class TopicDiagnostic : public HeaderlessTopicDiagnostic
{
  public:
    TopicDiagnostic(std::string name, DiagnosticTaskVector &tasks, const FrequencyStatusParam &frequency,
                    const TimeStampStatusParam &stamp)
        : HeaderlessTopicDiagnostic(name, tasks, frequency), stamp_(stamp)
    {
        addTask(&stamp_);
    }
    void tick() override { ROS_FATAL("tick(void) has been called on a TopicDiagnostic. This is never correct. Use "
                                     "tick(ros::Time &) instead."); }
    virtual void tick(const ros::Time &stamp)
    {
        stamp_.tick(stamp);
        HeaderlessTopicDiagnostic::tick();
    }

  private:
    TimeStampStatus stamp_;
};

template <class M>
class DiagnosedPublisher : public TopicDiagnostic
{
  public:
    DiagnosedPublisher(const ros::Publisher &publisher, DiagnosticTaskVector &tasks,
                       const FrequencyStatusParam &frequency, const TimeStampStatusParam &stamp)
        : TopicDiagnostic(publisher.getTopic(), tasks, frequency, stamp), publisher_(publisher)
    {
    }
    virtual void publish(const boost::shared_ptr<M> &message) { publish(*message); }
    virtual void publish(const M &message)
    {
        tick(message.header.stamp);
        publisher_.publish(message);
    }
    ros::Publisher getPublisher() const { return publisher_; }
    void           setPublisher(ros::Publisher publisher) { publisher_ = publisher; }

  private:
    ros::Publisher publisher_;
};

} // namespace diagnostic_updater

#endif
