// The publishing side of a node on a topic, shared by all its publishers.
#ifndef ROSCFE_PUBLICATION_H
#define ROSCFE_PUBLICATION_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <boost/enable_shared_from_this.hpp>

#include "ros/callback_queue_interface.h"
#include "ros/forwards.h"

namespace ros
{
struct AdvertiseOptions;
}

namespace roscfe
{

class Subscription;
class Publication;

// What one call of advertise has asked for, which the copies of its publisher share. What more than plain messages is asked
// for (a message to be kept for subscribers that come later, callbacks that are told of subscribers) is in latching.cpp.
class Advertised
{
  public:
    explicit Advertised(const boost::shared_ptr<Publication> &publication, bool latch = false)
        : publication_(publication), latch_(latch)
    {
    }
    Advertised(const Advertised &) = delete;
    Advertised &operator=(const Advertised &) = delete;
    virtual ~Advertised() = default;

    // The topic has the publisher from now on.
    virtual void begin() {}
    // A subscriber has come, or has gone: the callback for that is due.
    virtual void tell(std::uint32_t, bool) {}
    // The topic is given up: no callback is called any more.
    virtual void end() {}
    virtual void keep(const std::uint8_t *, std::size_t) {}
    // Send what is kept to a pipe, or give it to the node's own subscription.
    virtual void repeat(std::uint32_t, std::uint8_t) {}
    virtual void give_kept(const boost::shared_ptr<Subscription> &) {}

    const boost::shared_ptr<Publication> publication_;
    const bool                           latch_;
};

class Publication
{
  public:
    Publication(const std::string &topic, const char *type, const char *md5, bool has_header)
        : topic_(topic), type_(type), md5_(md5), has_header_(has_header)
    {
    }

    // Whether a message would reach anybody, now or later.
    bool is_wanted(bool latch) const;

    // Memory for a message of so many bytes, on the Software Bus where it fits in a packet; null when it is refused.
    std::uint8_t *begin(std::size_t size, bool latch);

    // Send what was written there; a publisher that latches keeps it.
    void send(Advertised &by);

    const std::string topic_;
    const std::string type_;
    const std::string md5_;
    const bool        has_header_; // its number in header.seq is written by the publisher
    std::uint16_t     msg_id_ = 0;
    bool              raw_    = false;
    std::uint32_t     seq_    = 0;
    std::vector<boost::shared_ptr<Advertised>> advertised_; // of publishers that are not shut down

    void write_number(std::uint8_t *at, std::size_t size) const;

  private:
    std::size_t size_   = 0;       // of the message under way
    void *      buffer_ = nullptr; // of the Software Bus, or null when the message is long
};

// Whether messages are looked at though they reach nobody, such as by a bag; on cfepy alone. Then there is memory for a
// message that is not sent, which is shown to those who look on (watched.cpp).
__attribute__((weak, visibility("hidden"))) bool          is_watched(const Publication &publication);
__attribute__((weak, visibility("hidden"))) std::uint8_t *begin_unsent(std::size_t size);
__attribute__((weak, visibility("hidden"))) void          show_unsent(const Publication &publication, std::uint8_t *at, std::size_t size);

// The publication of a topic, made when it is the first of the node.
boost::shared_ptr<Publication> advertise(const std::string &topic, const char *type, const char *md5,
                                         const char *definition, bool has_header);

} // namespace roscfe

#endif
