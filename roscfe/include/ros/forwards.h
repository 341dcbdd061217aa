// Names that several headers of roscpp share.
#ifndef ROS_FORWARDS_H
#define ROS_FORWARDS_H

#include <cstdint>
#include <list>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <boost/bind.hpp>
#include <boost/enable_shared_from_this.hpp>
#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <boost/scoped_ptr.hpp>
#include <boost/weak_ptr.hpp>

#include "ros/time.h"

namespace ros
{

typedef boost::shared_ptr<void>                       VoidPtr;
typedef boost::weak_ptr<void>                         VoidWPtr;
typedef boost::shared_ptr<void const>                 VoidConstPtr;
typedef boost::weak_ptr<void const>                   VoidConstWPtr;
typedef std::vector<std::string>                      V_string;
typedef std::set<std::string>                         S_string;
typedef std::map<std::string, std::string>            M_string;
typedef std::pair<std::string, std::string>           StringPair;
typedef std::vector<std::pair<std::string, std::string>> VP_string;
typedef boost::shared_ptr<M_string>                   M_stringPtr;

class NodeHandle;
class Publisher;
class Subscriber;
class Timer;
class WallTimer;
class SteadyTimer;
class ServiceServer;
class ServiceClient;
class CallbackInterface;
class CallbackQueue;
class CallbackQueueInterface;
class TransportHints;
class SingleSubscriberPublisher;
typedef boost::shared_ptr<NodeHandle> NodeHandlePtr;

template <class T, class D>
struct TimerEventOf;
typedef TimerEventOf<Time, Duration>           TimerEvent;
typedef TimerEventOf<WallTime, WallDuration>   WallTimerEvent;
typedef TimerEventOf<SteadyTime, WallDuration> SteadyTimerEvent;

typedef std::vector<Publisher>     V_Publisher;
typedef std::vector<Subscriber>    V_Subscriber;
typedef std::vector<ServiceServer> V_ServiceServer;

typedef boost::function<void(const SingleSubscriberPublisher &)> SubscriberStatusCallback;

} // namespace ros

#endif
