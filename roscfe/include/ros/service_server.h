// ros::ServiceServer, and the options of one.
#ifndef ROS_SERVICE_SERVER_H
#define ROS_SERVICE_SERVER_H

#include <string>

#include "ros/forwards.h"
#include "roscfe/service.h"

namespace ros
{

// What a callback may take in place of request and response.
template <class Req, class Res>
class ServiceEvent
{
  public:
    typedef Req RequestType;
    typedef Res ResponseType;
    ServiceEvent(Req &request, Res &response) : request_(request), response_(response) {}
    const Req & getRequest() const { return request_; }
    Res &       getResponse() const { return response_; }
    std::string getCallerName() const { return "unknown_caller"; }
    M_string &  getConnectionHeader() const
    {
        static M_string empty;
        return empty;
    }

  private:
    Req &request_;
    Res &response_;
};

struct AdvertiseServiceOptions
{
    template <class Req, class Res>
    void init(const std::string &_service, const boost::function<bool(Req &, Res &)> &_callback)
    {
        service  = _service;
        type     = roscfe::wire::Traits<Req>::service_type();
        service_md5 = roscfe::wire::Traits<Req>::service_md5();
        make     = [_callback](const std::string &name,
                           CallbackQueueInterface *queue) -> boost::shared_ptr<roscfe::Service> {
            return boost::make_shared<roscfe::TypedService<Req, Res>>(name, queue, _callback);
        };
    }

    template <class S>
    void init(const std::string &_service,
              const boost::function<bool(typename S::Request &, typename S::Response &)> &_callback)
    {
        init<typename S::Request, typename S::Response>(_service, _callback);
    }

    template <class S>
    static AdvertiseServiceOptions
    create(const std::string &service,
           const boost::function<bool(typename S::Request &, typename S::Response &)> &callback,
           const VoidConstPtr &tracked_object, CallbackQueueInterface *queue)
    {
        AdvertiseServiceOptions options;
        options.init<S>(service, callback);
        options.tracked_object = tracked_object;
        options.callback_queue = queue;
        return options;
    }

    std::string             service;
    const char *            type           = "*";
    const char *            service_md5    = "*";
    CallbackQueueInterface *callback_queue = nullptr;
    VoidConstPtr            tracked_object;
    boost::function<boost::shared_ptr<roscfe::Service>(const std::string &, CallbackQueueInterface *)> make;
};

class ServiceServer
{
  public:
    ServiceServer() = default;
    explicit ServiceServer(const boost::shared_ptr<roscfe::Service> &service);

    void        shutdown();
    std::string getService() const;

    explicit operator bool() const { return handle_ && handle_->service; }
    operator void *() const { return *this ? const_cast<void *>(static_cast<const void *>(handle_.get())) : nullptr; }
    bool operator<(const ServiceServer &other) const { return handle_ < other.handle_; }
    bool operator==(const ServiceServer &other) const { return handle_ == other.handle_; }
    bool operator!=(const ServiceServer &other) const { return handle_ != other.handle_; }

  private:
    struct Handle
    {
        explicit Handle(const boost::shared_ptr<roscfe::Service> &of) : service(of) {}
        ~Handle() { release(); }
        void                               release();
        boost::shared_ptr<roscfe::Service> service;
    };
    boost::shared_ptr<Handle> handle_;
};

} // namespace ros

#endif
