// ros::ServiceClient: a call waits for its answer, and takes the node's messages over meanwhile.
#ifndef ROS_SERVICE_CLIENT_H
#define ROS_SERVICE_CLIENT_H

#include <string>

#include "ros/forwards.h"
#include "ros/time.h"
#include "roscfe/service.h"

namespace ros
{

struct ServiceClientOptions
{
    template <class S>
    void init(const std::string &_service, bool _persistent, const M_string &_header)
    {
        service    = _service;
        md5sum     = roscfe::wire::Traits<S>::md5();
        type       = roscfe::wire::Traits<S>::type();
        persistent = _persistent;
        header     = _header;
        request_bytes  = roscfe::wire::most_bytes<typename S::Request>();
        response_bytes = roscfe::wire::most_bytes<typename S::Response>();
    }

    std::string service;
    std::string md5sum;
    std::string type;
    bool        persistent = false;
    M_string    header;
    std::size_t request_bytes  = 0; // at most; 0 when nobody knows
    std::size_t response_bytes = 0;
};

class ServiceClient
{
  public:
    ServiceClient() = default;
    ServiceClient(const std::string &name, bool persistent, const char *type, const char *md5,
                  std::size_t most_of_request = 0, std::size_t most_of_response = 0);

    template <class S>
    bool call(S &service)
    {
        return call(service.request, service.response);
    }
    template <class Req, class Res>
    bool call(const Req &request, Res &response)
    {
        if (!isValid())
        {
            return false;
        }
        const std::size_t size = roscfe::wire::length(request);
        std::uint8_t *    at   = client_->begin(size);
        if (at == nullptr)
        {
            return false;
        }
        roscfe::wire::write(request, at, size);
        return client_->call() && roscfe::wire::read(response, client_->answer_.data(), client_->answer_.size());
    }
    template <class Req, class Res>
    bool call(const Req &request, Res &response, const std::string &)
    {
        return call(request, response);
    }

    bool        isValid() const; // a persistent one is until its server has gone
    bool        isPersistent() const { return persistent_; }
    std::string getService() const { return client_ ? client_->name_ : std::string(); }
    bool        waitForExistence(Duration timeout = Duration(-1));
    bool        exists() const { return client_ && client_->exists(); }
    void        shutdown(); // ends the connection of a persistent one; any other has none

    explicit operator bool() const { return isValid(); }
    operator void *() const { return client_.get(); }
    bool operator<(const ServiceClient &other) const { return client_ < other.client_; }
    bool operator==(const ServiceClient &other) const { return client_ == other.client_; }
    bool operator!=(const ServiceClient &other) const { return client_ != other.client_; }

  private:
    boost::shared_ptr<roscfe::Client> client_;
    bool                              persistent_ = false;
};

} // namespace ros

#endif
