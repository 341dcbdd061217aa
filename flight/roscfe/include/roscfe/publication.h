// The publishing side of a node on a topic, shared by all its publishers.
#ifndef ROSCFE_PUBLICATION_H
#define ROSCFE_PUBLICATION_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/forwards.h"

namespace roscfe
{

class Publication
{
  public:
    Publication(const std::string &topic, const char *type, const char *md5, bool has_header)
        : topic_(topic), type_(type), md5_(md5), has_header_(has_header)
    {
    }

    // Set memory aside for what is not written onto the bus itself: messages of so many bytes at most.
    void set_aside(std::size_t most_bytes);

    // Whether a message would reach anybody, now or later.
    bool is_wanted() const;

    // Memory for a message of so many bytes, on the Software Bus where it fits in a packet; null when it is refused.
    std::uint8_t *begin(std::size_t size);

    // Send what was written there.
    void send();

    // How many pipes get the topic's messages.
    std::uint32_t subscribers() const;

    const std::string topic_;
    const std::string type_;
    const std::string md5_;
    const bool        has_header_; // its number in header.seq is written by the publisher
    std::uint16_t     msg_id_ = 0;
    bool              raw_    = false;
    bool              latch_  = false;
    std::uint32_t     users_  = 0; // publishers that are not shut down
    std::uint32_t     seq_    = 0;
    std::vector<std::uint8_t>                   latched_; // the last message, for those who come later
    std::vector<ros::SubscriberStatusCallback> on_connect_;
    std::vector<ros::SubscriberStatusCallback> on_disconnect_;

  private:
    std::size_t size_    = 0;       // of the message under way
    void *      buffer_  = nullptr; // of the Software Bus, or null when the message is long
};

// The publication of a topic, made when it is the first of the node.
boost::shared_ptr<Publication> advertise(const std::string &topic, const char *type, const char *md5,
                                         const char *definition, bool has_header);

} // namespace roscfe

#endif
