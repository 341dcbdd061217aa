// A callback's registration, which can be ended.
#ifndef ROSCFE_MESSAGE_FILTERS_CONNECTION_H
#define ROSCFE_MESSAGE_FILTERS_CONNECTION_H

#include <boost/function.hpp>

namespace message_filters
{

class Connection
{
  public:
    Connection() = default;
    explicit Connection(const boost::function<void()> &end) : end_(end) {}

    void disconnect()
    {
        if (end_)
        {
            end_();
            end_ = boost::function<void()>();
        }
    }

  private:
    boost::function<void()> end_;
};

} // namespace message_filters

#endif
