// diagnostic_updater::Updater: tasks that tell how a node is, on /diagnostics.
#ifndef ROSCFE_DIAGNOSTIC_UPDATER_DIAGNOSTIC_UPDATER_H
#define ROSCFE_DIAGNOSTIC_UPDATER_DIAGNOSTIC_UPDATER_H

#include <string>
#include <vector>

#include "diagnostic_msgs/DiagnosticArray.h"
#include "diagnostic_updater/DiagnosticStatusWrapper.h"

namespace diagnostic_updater
{

typedef boost::function<void(DiagnosticStatusWrapper &)>             TaskFunction;
typedef boost::function<void(diagnostic_msgs::DiagnosticStatus &)> UnwrappedTaskFunction;

class DiagnosticTask
{
  public:
    explicit DiagnosticTask(const std::string &name) : name_(name) {}
    virtual ~DiagnosticTask() = default;
    const std::string &getName() { return name_; }
    virtual void       run(DiagnosticStatusWrapper &status) = 0;

  private:
    const std::string name_;
};

template <class T>
class GenericFunctionDiagnosticTask : public DiagnosticTask
{
  public:
    GenericFunctionDiagnosticTask(const std::string &name, boost::function<void(T &)> function)
        : DiagnosticTask(name), function_(function)
    {
    }
    void run(DiagnosticStatusWrapper &status) override { function_(status); }

  private:
    boost::function<void(T &)> function_;
};
typedef GenericFunctionDiagnosticTask<diagnostic_msgs::DiagnosticStatus> UnwrappedFunctionDiagnosticTask;
typedef GenericFunctionDiagnosticTask<DiagnosticStatusWrapper>           FunctionDiagnosticTask;

// Several tasks with one status.
class CompositeDiagnosticTask : public DiagnosticTask
{
  public:
    explicit CompositeDiagnosticTask(const std::string &name) : DiagnosticTask(name) {}
    void addTask(DiagnosticTask *task) { tasks_.push_back(task); }
    void run(DiagnosticStatusWrapper &status) override
    {
        DiagnosticStatusWrapper combined;
        DiagnosticStatusWrapper original;
        original.summary(status);
        for (DiagnosticTask *each : tasks_)
        {
            status.summary(original);
            each->run(status);
            combined.mergeSummary(status);
        }
        status.summary(combined);
    }

  private:
    std::vector<DiagnosticTask *> tasks_;
};

class DiagnosticTaskVector
{
  public:
    virtual ~DiagnosticTaskVector() = default;

    void add(const std::string &name, TaskFunction function) { put(name, function); }
    void add(DiagnosticTask &task)
    {
        put(task.getName(), [&task](DiagnosticStatusWrapper &status) { task.run(status); });
    }
    template <class T>
    void add(const std::string name, T *object, void (T::*method)(DiagnosticStatusWrapper &))
    {
        put(name, [object, method](DiagnosticStatusWrapper &status) { (object->*method)(status); });
    }
    bool removeByName(const std::string &name)
    {
        for (auto each = tasks_.begin(); each != tasks_.end(); ++each)
        {
            if (each->name == name)
            {
                tasks_.erase(each);
                return true;
            }
        }
        return false;
    }

  protected:
    struct Task
    {
        std::string  name;
        TaskFunction run;
    };
    const std::vector<Task> &getTasks() { return tasks_; }
    virtual void             addedTaskCallback(const Task &) {}

  private:
    void put(const std::string &name, const TaskFunction &run)
    {
        tasks_.push_back({name, run});
        addedTaskCallback(tasks_.back());
    }

    std::vector<Task> tasks_;
};

class Updater : public DiagnosticTaskVector
{
  public:
    bool verbose_ = false;

    Updater(ros::NodeHandle node = ros::NodeHandle(), ros::NodeHandle private_node = ros::NodeHandle("~"),
            std::string node_name = ros::this_node::getName())
        : private_node_(private_node), name_(node_name.substr(node_name.empty() || node_name[0] != '/' ? 0 : 1))
    {
        publisher_ = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1);
        look_for_period();
        next_ = ros::Time::now() + ros::Duration(period_);
    }

    // Run the tasks when their period is over.
    void update()
    {
        const ros::Time now = ros::Time::now();
        if (now < next_)
        {
            look_for_period();
            return;
        }
        force_update();
    }
    void force_update()
    {
        look_for_period();
        next_ = ros::Time::now() + ros::Duration(period_);
        if (!publisher_)
        {
            return;
        }
        std::vector<diagnostic_msgs::DiagnosticStatus> all;
        bool                                           warned = false;
        for (const Task &each : getTasks())
        {
            DiagnosticStatusWrapper status;
            status.name        = each.name.c_str();
            status.level       = 2;
            status.message     = "No message was set";
            status.hardware_id = hardware_id_.c_str();
            each.run(status);
            all.push_back(status);
            warned = warned || status.level > 0;
            if (verbose_ && status.level > 0)
            {
                ROS_WARN("Non-zero diagnostic status. Name: '%s', status %i: '%s'", status.name.c_str(), status.level,
                         status.message.c_str());
            }
        }
        if (warned && !warned_ && hardware_id_.empty())
        {
            ROS_WARN("diagnostic_updater: No HW_ID was set. This is probably a bug. Please report it. For devices that "
                     "do not have a HW_ID, set this value to 'none'. This warning only occurs once all diagnostics are "
                     "OK so it is okay to wait until the device is open before calling setHardwareID.");
            warned_ = true;
        }
        publish(all);
    }
    double getPeriod() { return period_; }

    // One status for all tasks, at once.
    void broadcast(int level, const std::string text)
    {
        std::vector<diagnostic_msgs::DiagnosticStatus> all;
        for (const Task &each : getTasks())
        {
            DiagnosticStatusWrapper status;
            status.name = each.name.c_str();
            status.summary(static_cast<unsigned char>(level), text);
            all.push_back(status);
        }
        publish(all);
    }
    void setHardwareID(const std::string &id) { hardware_id_ = id; }
    void setHardwareIDf(const char *format, ...) __attribute__((format(printf, 2, 3)))
    {
        char    text[1000];
        va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        hardware_id_ = text;
    }

  private:
    void addedTaskCallback(const Task &task) override
    {
        DiagnosticStatusWrapper status;
        status.name = task.name.c_str();
        status.summary(0, "Node starting up");
        publish({status});
    }

    void look_for_period()
    {
        const double before = period_;
        private_node_.getParamCached("diagnostic_period", period_);
        next_ += ros::Duration(period_ - before);
    }

    void publish(std::vector<diagnostic_msgs::DiagnosticStatus> all)
    {
        diagnostic_msgs::DiagnosticArray message;
        message.header.stamp = ros::Time::now();
        for (diagnostic_msgs::DiagnosticStatus &each : all)
        {
            each.name = (name_ + ": " + each.name.c_str()).c_str();
            message.status.push_back(each);
        }
        publisher_.publish(message);
    }

    ros::NodeHandle private_node_;
    ros::Publisher  publisher_;
    ros::Time       next_{1, 0};
    double          period_ = 1.0;
    std::string     name_;
    std::string     hardware_id_;
    bool            warned_ = false;
};

} // namespace diagnostic_updater

#endif
