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

class Publication;

// What one call of advertise has asked for, which the copies of its publisher share: a message to be kept for subscribers
// that come later, and callbacks that are told of subscribers.
class Advertised : public ros::CallbackInterface, public boost::enable_shared_from_this<Advertised>
{
  public:
    Advertised(const boost::shared_ptr<Publication> &publication, const ros::AdvertiseOptions &options,
               ros::CallbackQueueInterface *callbacks);

    // A subscriber has come, or has gone: the callback for that is due.
    void tell(std::uint32_t pipe, bool came);
    // The topic is given up: no callback is called any more.
    void end();
    void keep(const std::uint8_t *bytes, std::size_t size);

    CallResult call() override;

    const boost::shared_ptr<Publication> publication_;
    const bool                           latch_;
    bool                                 has_latched_ = false;
    std::vector<std::uint8_t>            latched_; // the last message

  private:
    struct Peer
    {
        std::uint32_t pipe;
        bool          came;
    };

    ros::SubscriberStatusCallback connect_, disconnect_;
    ros::CallbackQueueInterface * callbacks_;
    ros::VoidConstWPtr            tracked_;
    bool                          has_tracked_;
    bool                          is_over_ = false;
    std::vector<Peer>             waiting_;
};

class Publication
{
  public:
    Publication(const std::string &topic, const char *type, const char *md5, bool has_header)
        : topic_(topic), type_(type), md5_(md5), has_header_(has_header)
    {
    }

    // Set memory aside for what is not written onto the bus itself: messages of so many bytes at most.
    void set_aside(bool latch, std::size_t most_bytes);

    // Whether a message would reach anybody, now or later.
    bool is_wanted(bool latch) const;

    // Whether a message is looked at though it reaches nobody, such as by a bag; on cfepy alone.
    bool is_watched() const;

    // Memory for a message of so many bytes, on the Software Bus where it fits in a packet; null when it is refused.
    std::uint8_t *begin(std::size_t size, bool latch);

    // Send what was written there; a publisher that latches keeps it.
    void send(Advertised &by);

    // Memory for a message that is not sent, and show what was written there to those who look on.
    std::uint8_t *begin_unsent(std::size_t size) const;
    void          show_unsent(std::uint8_t *at, std::size_t size) const;

    // How many pipes get the topic's messages.
    std::uint32_t subscribers() const;

    const std::string topic_;
    const std::string type_;
    const std::string md5_;
    const bool        has_header_; // its number in header.seq is written by the publisher
    std::uint16_t     msg_id_ = 0;
    bool              raw_    = false;
    std::uint32_t     seq_    = 0;
    std::vector<boost::shared_ptr<Advertised>> advertised_; // of publishers that are not shut down

  private:
    void write_number(std::uint8_t *at, std::size_t size) const;

    std::size_t size_   = 0;       // of the message under way
    void *      buffer_ = nullptr; // of the Software Bus, or null when the message is long
};

// The publication of a topic, made when it is the first of the node.
boost::shared_ptr<Publication> advertise(const std::string &topic, const char *type, const char *md5,
                                         const char *definition, bool has_header);

} // namespace roscfe

#endif
