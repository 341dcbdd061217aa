// Both sides of a service: requests are command packets, answers telemetry packets of the same number.
#ifndef ROSCFE_SERVICE_H
#define ROSCFE_SERVICE_H

#include <cstdint>
#include <string>
#include <vector>

#include "ros/callback_queue_interface.h"
#include "ros/forwards.h"
#include "roscfe/wire.h"

namespace roscfe
{

// A service that the node offers; requests wait in it for their callback.
class Service : public ros::CallbackInterface
{
  public:
    Service(const std::string &name, ros::CallbackQueueInterface *callbacks) : name_(name), callbacks_(callbacks) {}

    // Answer a request: the bytes of the response, and whether it succeeded.
    virtual bool serve(const std::uint8_t *request, std::size_t size) = 0;

    // The length of the response, and its bytes.
    virtual std::size_t answer_length() const                                     = 0;
    virtual void        write_answer(std::uint8_t *to, std::size_t size) const = 0;

    // Set memory aside: requests and responses have so many bytes at most; 0 is as many as they like.
    void set_aside(std::size_t most_of_request, std::size_t most_of_response);

    CallResult call() override { return call_now(); }
    CallResult call_now();
    std::size_t waiting() const { return count_; } // requests
    bool       receive(std::uint32_t number, const std::uint8_t *bytes, std::size_t size);

    static constexpr std::size_t kWaiting = 16; // requests

    const std::string            name_;
    ros::CallbackQueueInterface *callbacks_;
    std::uint16_t                answer_id_   = 0;
    bool                         alive_       = true;
    bool                         has_tracked_ = false;
    ros::VoidConstWPtr           tracked_;
    std::uint32_t                dropped_ = 0; // requests for which there was no room
    std::size_t                  most_    = 0; // bytes of a request; 0 is as many as it likes

  private:
    struct Request
    {
        std::uint32_t             number = 0;
        std::vector<std::uint8_t> bytes;
    };
    std::vector<Request> waiting_ = std::vector<Request>(kWaiting);
    std::size_t          head_    = 0;
    std::size_t          count_   = 0;
};

template <class Req, class Res>
class TypedService final : public Service
{
  public:
    typedef boost::function<bool(Req &, Res &)> Callback;

    TypedService(const std::string &name, ros::CallbackQueueInterface *callbacks, const Callback &callback)
        : Service(name, callbacks), callback_(callback)
    {
        set_aside(wire::most_bytes<Req>(), wire::most_bytes<Res>());
    }

    bool serve(const std::uint8_t *request, std::size_t size) override
    {
        response_ = Res();
        request_  = Req();
        return wire::read(request_, request, size) && callback_(request_, response_);
    }
    std::size_t answer_length() const override { return wire::length(response_); }
    void write_answer(std::uint8_t *to, std::size_t size) const override { wire::write(response_, to, size); }

  private:
    Callback callback_;
    Req      request_;
    Res      response_;
};

void offer(const boost::shared_ptr<Service> &service, const char *type, const char *md5);
void withdraw(const boost::shared_ptr<Service> &service);

// Calls of one service by one client. A persistent one is connected with the server that it finds at first, and with no
// other one, as in roscpp.
class Client
{
  public:
    Client(const std::string &name, const char *type, const char *md5, std::size_t most_of_request = 0,
           std::size_t most_of_response = 0, bool persistent = false);
    ~Client();
    Client(const Client &) = delete;
    Client &operator=(const Client &) = delete;

    // Send a request, whose bytes `write` makes, and wait for the answer; null when there is no service, or it failed.
    std::uint8_t *begin(std::size_t size);
    bool          call();

    bool exists() const;
    bool wait_for_existence(std::int64_t timeout_ns); // below 0 is for ever

    // Whether the server of a persistent client is still there.
    bool is_linked();
    void unlink() { is_linked_ = false; }
    void lose(std::uint16_t request_id_of_server, std::uint32_t server);

    const std::string         name_;
    const std::size_t         most_;   // bytes of an answer; 0 is as many as it likes
    std::vector<std::uint8_t> answer_; // of the last call

  private:
    std::uint16_t request_id() const;
    bool          may_be_answered() const;
    bool          waits_for_answer() const;

    const bool                is_master_; // a client of cfepy's ROS application
    std::uint16_t             answer_id_ = 0;
    std::size_t               size_      = 0;
    std::uint32_t             server_    = 0; // the pipe of the one server
    bool                      is_linked_ = false;
    std::vector<std::uint8_t> long_request_;
};

// Wait until a service is there; the time in nanoseconds, below 0 for ever.
bool wait_for_service(const std::string &name, std::int64_t timeout_ns);
bool service_exists(const std::string &name);

} // namespace roscfe

#endif
