// What the callbacks of advertise get: a publisher for the one subscriber that came.
#ifndef ROS_SINGLE_SUBSCRIBER_PUBLISHER_H
#define ROS_SINGLE_SUBSCRIBER_PUBLISHER_H

#include <cstdint>
#include <string>
#include <vector>

#include "ros/forwards.h"
#include "roscfe/publication.h"
#include "roscfe/wire.h"

namespace roscfe
{
// Send a message of a topic to one pipe alone.
void send_to(Publication &publication, std::uint32_t pipe, const std::uint8_t *bytes, std::size_t size,
             std::uint8_t number = 0);
} // namespace roscfe

namespace ros
{

class SingleSubscriberPublisher
{
  public:
    SingleSubscriberPublisher(roscfe::Publication &publication, std::uint32_t pipe, const char *pipe_name)
        : publication_(publication), pipe_(pipe), pipe_name_(pipe_name)
    {
    }

    template <class M>
    void publish(const boost::shared_ptr<M> &message) const
    {
        publish(*message);
    }
    template <class M>
    void publish(const M &message) const
    {
        std::vector<std::uint8_t> bytes(roscfe::wire::length(message));
        roscfe::wire::write(message, bytes.data(), bytes.size());
        roscfe::send_to(publication_, pipe_, bytes.data(), bytes.size());
    }

    std::string getTopic() const { return publication_.topic_; }

    // The name of the subscriber's pipe: packets and pipes do not know nodes.
    std::string getSubscriberName() const { return pipe_name_; }

  private:
    roscfe::Publication &publication_;
    std::uint32_t        pipe_;
    const char *         pipe_name_;
};

} // namespace ros

#endif
