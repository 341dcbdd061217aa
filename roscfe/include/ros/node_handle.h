// ros::NodeHandle: names in a namespace, and all that a node makes.
#ifndef ROS_NODE_HANDLE_H
#define ROS_NODE_HANDLE_H

#include <string>
#include <type_traits>

#include "ros/advertise_options.h"
#include "ros/callback_queue.h"
#include "ros/exceptions.h"
#include "ros/forwards.h"
#include "ros/init.h"
#include "ros/names.h"
#include "ros/param.h"
#include "ros/parameter_adapter.h"
#include "ros/publisher.h"
#include "ros/rate.h"
#include "ros/service_client.h"
#include "ros/service_server.h"
#include "ros/subscribe_options.h"
#include "ros/subscriber.h"
#include "ros/timer.h"
#include "roscfe/brought_along.h"
#include "roscfe/parts.h"

namespace ros
{

class NodeHandle
{
  public:
    NodeHandle(const std::string &ns = std::string(), const M_string &remappings = M_string());
    NodeHandle(const NodeHandle &other);
    NodeHandle(const NodeHandle &parent, const std::string &ns);
    NodeHandle(const NodeHandle &parent, const std::string &ns, const M_string &remappings);
    ~NodeHandle();
    NodeHandle &operator=(const NodeHandle &other);

    void                    setCallbackQueue(CallbackQueueInterface *queue) { queue_ = queue; }
    CallbackQueueInterface *getCallbackQueue() const { return queue_ != nullptr ? queue_ : getGlobalCallbackQueue(); }
    const std::string &     getNamespace() const { return namespace_; }
    const std::string &     getUnresolvedNamespace() const { return unresolved_namespace_; }
    std::string             resolveName(const std::string &name, bool remap = true) const;
    bool                    ok() const { return ros::ok(); }
    void                    shutdown() {}

    // -- topics -------------------------------------------------------------------------------------------------------

    template <class M>
    Publisher advertise(const std::string &topic, std::uint32_t queue_size, bool latch = false)
    {
        AdvertiseOptions options;
        options.init<M>(topic, queue_size);
        options.latch = latch;
        roscfe::parts::need_room<roscfe::wire::most_bytes<M>()>();
        if (latch)
        {
            roscfe::parts::need(roscfe::parts::latching);
        }
        return advertise_as(options);
    }
    template <class M>
    Publisher advertise(const std::string &topic, std::uint32_t queue_size, const SubscriberStatusCallback &connect_cb,
                        const SubscriberStatusCallback &disconnect_cb  = SubscriberStatusCallback(),
                        const VoidConstPtr &            tracked_object = VoidConstPtr(), bool latch = false)
    {
        AdvertiseOptions options;
        options.init<M>(topic, queue_size, connect_cb, disconnect_cb);
        options.tracked_object = tracked_object;
        options.latch          = latch;
        return advertise(options);
    }
    Publisher advertise(AdvertiseOptions &options)
    {
        roscfe::parts::need(roscfe::parts::latching);
        return advertise_as(options);
    }

    // A method of an object, of one behind a shared pointer, or a function; first with any parameter, then with a
    // pointer to the message named, for calls such as subscribe<std_msgs::String>(...).
    template <class P, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, void (T::*function)(P), T *object,
                         const TransportHints &hints = TransportHints())
    {
        return hear<P>(topic, queue_size, [function, object](P message) { (object->*function)(message); }, hints);
    }
    template <class P, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, void (T::*function)(P) const, T *object,
                         const TransportHints &hints = TransportHints())
    {
        return hear<P>(topic, queue_size, [function, object](P message) { (object->*function)(message); }, hints);
    }
    template <class M, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size,
                         void (T::*function)(const boost::shared_ptr<M const> &), T *object,
                         const TransportHints &hints = TransportHints())
    {
        typedef const boost::shared_ptr<M const> &P;
        return hear<P>(topic, queue_size, [function, object](P message) { (object->*function)(message); }, hints);
    }
    template <class M, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size,
                         void (T::*function)(const boost::shared_ptr<M const> &) const, T *object,
                         const TransportHints &hints = TransportHints())
    {
        typedef const boost::shared_ptr<M const> &P;
        return hear<P>(topic, queue_size, [function, object](P message) { (object->*function)(message); }, hints);
    }
    template <class P, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, void (T::*function)(P),
                         const boost::shared_ptr<T> &object, const TransportHints &hints = TransportHints())
    {
        T *raw = object.get();
        return hear<P>(topic, queue_size, [function, raw](P message) { (raw->*function)(message); }, hints, object);
    }
    template <class P, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, void (T::*function)(P) const,
                         const boost::shared_ptr<T> &object, const TransportHints &hints = TransportHints())
    {
        T *raw = object.get();
        return hear<P>(topic, queue_size, [function, raw](P message) { (raw->*function)(message); }, hints, object);
    }
    template <class M, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size,
                         void (T::*function)(const boost::shared_ptr<M const> &), const boost::shared_ptr<T> &object,
                         const TransportHints &hints = TransportHints())
    {
        typedef const boost::shared_ptr<M const> &P;
        T *raw = object.get();
        return hear<P>(topic, queue_size, [function, raw](P message) { (raw->*function)(message); }, hints, object);
    }
    template <class M, class T>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size,
                         void (T::*function)(const boost::shared_ptr<M const> &) const,
                         const boost::shared_ptr<T> &object, const TransportHints &hints = TransportHints())
    {
        typedef const boost::shared_ptr<M const> &P;
        T *raw = object.get();
        return hear<P>(topic, queue_size, [function, raw](P message) { (raw->*function)(message); }, hints, object);
    }
    template <class P>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, void (*function)(P),
                         const TransportHints &hints = TransportHints())
    {
        return hear<P>(topic, queue_size, function, hints);
    }
    // A lambda is no function, although it may become one: it is for the next overload.
    template <class M, class F,
              typename std::enable_if<std::is_same<F, void (*)(const boost::shared_ptr<M const> &)>::value, int>::type = 0>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, F function,
                         const TransportHints &hints = TransportHints())
    {
        return hear<const boost::shared_ptr<M const> &>(topic, queue_size, function, hints);
    }
    template <class M>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size,
                         const boost::function<void(const boost::shared_ptr<M const> &)> &callback,
                         const VoidConstPtr &  tracked_object = VoidConstPtr(),
                         const TransportHints &hints          = TransportHints())
    {
        return hear<const boost::shared_ptr<M const> &>(topic, queue_size, callback, hints, tracked_object);
    }
    template <class M, class P>
    ROSCFE_SUBSCRIBES Subscriber subscribe(const std::string &topic, std::uint32_t queue_size, const boost::function<void(P)> &callback,
                         const VoidConstPtr &  tracked_object = VoidConstPtr(),
                         const TransportHints &hints          = TransportHints())
    {
        return hear<P>(topic, queue_size, callback, hints, tracked_object);
    }
    Subscriber subscribe(SubscribeOptions &options);

    // -- services -----------------------------------------------------------------------------------------------------

    template <class T, class Req, class Res>
    ServiceServer advertiseService(const std::string &service, bool (T::*function)(Req &, Res &), T *object)
    {
        return serve<Req, Res>(
            service, [function, object](Req &request, Res &response) { return (object->*function)(request, response); });
    }
    template <class T, class Req, class Res>
    ServiceServer advertiseService(const std::string &service, bool (T::*function)(ServiceEvent<Req, Res> &), T *object)
    {
        return serve<Req, Res>(service, [function, object](Req &request, Res &response) {
            ServiceEvent<Req, Res> event(request, response);
            return (object->*function)(event);
        });
    }
    template <class T, class Req, class Res>
    ServiceServer advertiseService(const std::string &service, bool (T::*function)(Req &, Res &),
                                   const boost::shared_ptr<T> &object)
    {
        T *raw = object.get();
        return serve<Req, Res>(
            service, [function, raw](Req &request, Res &response) { return (raw->*function)(request, response); },
            object);
    }
    template <class Req, class Res>
    ServiceServer advertiseService(const std::string &service, bool (*function)(Req &, Res &))
    {
        return serve<Req, Res>(service, function);
    }
    template <class Req, class Res>
    ServiceServer advertiseService(const std::string &service, bool (*function)(ServiceEvent<Req, Res> &))
    {
        return serve<Req, Res>(service, [function](Req &request, Res &response) {
            ServiceEvent<Req, Res> event(request, response);
            return function(event);
        });
    }
    template <class Req, class Res>
    ServiceServer advertiseService(const std::string &service, const boost::function<bool(Req &, Res &)> &callback,
                                   const VoidConstPtr &tracked_object = VoidConstPtr())
    {
        return serve<Req, Res>(service, callback, tracked_object);
    }
    ServiceServer advertiseService(AdvertiseServiceOptions &options);

    template <class Req, class Res>
    ServiceClient serviceClient(const std::string &service, bool persistent = false, const M_string & = M_string())
    {
        return ServiceClient(resolveName(service), persistent, "*", "*", roscfe::wire::most_bytes<Req>(),
                             roscfe::wire::most_bytes<Res>());
    }
    template <class S>
    ServiceClient serviceClient(const std::string &service, bool persistent = false, const M_string & = M_string())
    {
        return ServiceClient(resolveName(service), persistent, roscfe::wire::Traits<S>::type(),
                             roscfe::wire::Traits<S>::md5(), roscfe::wire::most_bytes<typename S::Request>(),
                             roscfe::wire::most_bytes<typename S::Response>());
    }
    ServiceClient serviceClient(ServiceClientOptions &options);

    // -- timers -------------------------------------------------------------------------------------------------------

    template <class H, class T, class E>
    Timer createTimer(Duration period, void (H::*function)(E), T *object, bool oneshot = false,
                      bool autostart = true) const
    {
        return timer<Timer, TimerOptions>(
            period, [function, object](const TimerEvent &event) { (object->*function)(event); }, oneshot, autostart);
    }
    template <class H, class T, class E>
    Timer createTimer(Rate rate, void (H::*function)(E), T *object, bool oneshot = false, bool autostart = true) const
    {
        return createTimer(rate.expectedCycleTime(), function, object, oneshot, autostart);
    }
    template <class T, class E>
    Timer createTimer(Duration period, void (T::*function)(E), const boost::shared_ptr<T> &object,
                      bool oneshot = false, bool autostart = true) const
    {
        T *raw = object.get();
        return timer<Timer, TimerOptions>(
            period, [function, raw](const TimerEvent &event) { (raw->*function)(event); }, oneshot, autostart, object);
    }
    Timer createTimer(Duration period, const TimerCallback &callback, bool oneshot = false, bool autostart = true) const
    {
        return timer<Timer, TimerOptions>(period, callback, oneshot, autostart);
    }
    Timer createTimer(Rate rate, const TimerCallback &callback, bool oneshot = false, bool autostart = true) const
    {
        return timer<Timer, TimerOptions>(rate.expectedCycleTime(), callback, oneshot, autostart);
    }
    Timer createTimer(TimerOptions &options) const { return with_queue<Timer>(options); }

    template <class H, class T, class E>
    WallTimer createWallTimer(WallDuration period, void (H::*function)(E), T *object, bool oneshot = false,
                              bool autostart = true) const
    {
        return timer<WallTimer, WallTimerOptions>(
            period, [function, object](const WallTimerEvent &event) { (object->*function)(event); }, oneshot, autostart);
    }
    template <class T, class E>
    WallTimer createWallTimer(WallDuration period, void (T::*function)(E), const boost::shared_ptr<T> &object,
                              bool oneshot = false, bool autostart = true) const
    {
        T *raw = object.get();
        return timer<WallTimer, WallTimerOptions>(
            period, [function, raw](const WallTimerEvent &event) { (raw->*function)(event); }, oneshot, autostart,
            object);
    }
    WallTimer createWallTimer(WallDuration period, const WallTimerCallback &callback, bool oneshot = false,
                              bool autostart = true) const
    {
        return timer<WallTimer, WallTimerOptions>(period, callback, oneshot, autostart);
    }
    WallTimer createWallTimer(WallTimerOptions &options) const { return with_queue<WallTimer>(options); }

    template <class H, class T, class E>
    SteadyTimer createSteadyTimer(WallDuration period, void (H::*function)(E), T *object, bool oneshot = false,
                                  bool autostart = true) const
    {
        return timer<SteadyTimer, SteadyTimerOptions>(
            period, [function, object](const SteadyTimerEvent &event) { (object->*function)(event); }, oneshot,
            autostart);
    }
    SteadyTimer createSteadyTimer(WallDuration period, const SteadyTimerCallback &callback, bool oneshot = false,
                                  bool autostart = true) const
    {
        return timer<SteadyTimer, SteadyTimerOptions>(period, callback, oneshot, autostart);
    }
    SteadyTimer createSteadyTimer(SteadyTimerOptions &options) const { return with_queue<SteadyTimer>(options); }

    // -- parameters ---------------------------------------------------------------------------------------------------

    template <class T>
    bool getParam(roscfe::Name key, T &value) const
    {
        return param::get(full_key(key), value);
    }
    template <class T>
    bool getParamCached(roscfe::Name key, T &value) const
    {
        return param::getCached(full_key(key), value);
    }
    template <class T>
    bool param(roscfe::Name key, T &value, const T &otherwise) const
    {
        return param::param(full_key(key), value, otherwise);
    }
    template <class T>
    T param(roscfe::Name key, const T &otherwise) const
    {
        return param::param(full_key(key), otherwise);
    }
    template <class T>
    void setParam(const std::string &key, const T &value) const
    {
        param::set(resolveName(key), value);
    }
    void setParam(const std::string &key, const char *value) const { param::set(resolveName(key), value); }
    bool hasParam(roscfe::Name key) const { return param::has(full_key(key)); }
    bool deleteParam(const std::string &key) const { return param::del(resolveName(key)); }
    bool searchParam(const std::string &key, std::string &result) const
    {
        return param::search(namespace_, key, result);
    }
    bool getParamNames(std::vector<std::string> &keys) const { return param::getParamNames(keys); }

  private:
    Publisher advertise_as(AdvertiseOptions &options);

    template <class P, class F>
    Subscriber hear(const std::string &topic, std::uint32_t queue_size, F function, const TransportHints &hints,
                    const VoidConstPtr &tracked_object = VoidConstPtr())
    {
        SubscribeOptions options;
        options.initByFullCallbackType<P>(topic, queue_size, boost::function<void(P)>(function));
        options.tracked_object  = tracked_object;
        options.transport_hints = hints;
        return subscribe(options);
    }

    template <class Req, class Res, class F>
    ServiceServer serve(const std::string &service, F function, const VoidConstPtr &tracked_object = VoidConstPtr())
    {
        AdvertiseServiceOptions options;
        options.init<Req, Res>(service, boost::function<bool(Req &, Res &)>(function));
        options.tracked_object = tracked_object;
        return advertiseService(options);
    }

    template <class T, class O, class D, class F>
    T timer(D period, const F &function, bool oneshot, bool autostart,
            const VoidConstPtr &tracked_object = VoidConstPtr()) const
    {
        O options(period, function, getCallbackQueue(), oneshot, autostart);
        options.tracked_object = tracked_object;
        return T(options);
    }

    template <class T, class O>
    T with_queue(O &options) const
    {
        if (options.callback_queue == nullptr)
        {
            options.callback_queue = getCallbackQueue();
        }
        return T(options);
    }

    std::string resolved(const std::string &name, bool remap) const; // without a look at what is valid
    std::string remapped(const std::string &resolved) const;
    const std::string &full_key(roscfe::Name key) const; // as resolveName, in memory that is used again

    std::string             namespace_;
    std::string             unresolved_namespace_;
    CallbackQueueInterface *queue_ = nullptr;
    M_string                remappings_;
};

} // namespace ros

#endif
