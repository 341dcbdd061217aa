// ros::Publisher: CFE_SB_TransmitBuffer of a message that is serialized into memory of the Software Bus.
#ifndef ROS_PUBLISHER_H
#define ROS_PUBLISHER_H

#include "ros/forwards.h"
#include "roscfe/publication.h"
#include "roscfe/wire.h"

namespace ros
{

class Publisher
{
  public:
    Publisher() = default;
    explicit Publisher(const boost::shared_ptr<roscfe::Advertised> &advertised);

    template <class M>
    void publish(const boost::shared_ptr<M> &message) const
    {
        publish(*message);
    }

    template <class M>
    void publish(const M &message) const
    {
        if (!handle_ || !handle_->advertised)
        {
            return; // roscpp asserts in a debug build only
        }
        roscfe::Advertised & advertised  = *handle_->advertised;
        roscfe::Publication &publication = *advertised.publication_;
        const bool           is_wanted   = publication.is_wanted(advertised.latch_);
        if (!is_wanted && (roscfe::is_watched == nullptr || !roscfe::is_watched(publication)))
        {
            ++publication.seq_;
            return;
        }
        const std::size_t size = roscfe::wire::length(message);
        std::uint8_t *    at = is_wanted ? publication.begin(size, advertised.latch_) : roscfe::begin_unsent(size);
        if (at == nullptr)
        {
            return;
        }
        roscfe::wire::write(message, at, size);
        if (is_wanted)
        {
            publication.send(advertised);
        }
        else
        {
            publication.write_number(at, size);
            roscfe::show_unsent(publication, at, size);
            ++publication.seq_;
        }
    }

    void          shutdown();
    std::string   getTopic() const;
    std::uint32_t getNumSubscribers() const;
    bool          isLatched() const;

    explicit operator bool() const { return handle_ && handle_->advertised; }
    operator void *() const { return *this ? const_cast<void *>(static_cast<const void *>(handle_.get())) : nullptr; }
    bool operator<(const Publisher &other) const { return handle_ < other.handle_; }
    bool operator==(const Publisher &other) const { return handle_ == other.handle_; }
    bool operator!=(const Publisher &other) const { return handle_ != other.handle_; }

  private:
    // What copies of one publisher share; the topic is given up with the last of them.
    struct Handle
    {
        explicit Handle(const boost::shared_ptr<roscfe::Advertised> &of);
        ~Handle() { release(); }
        void                                  release();
        boost::shared_ptr<roscfe::Advertised> advertised;
        const std::string                     topic; // which stays when a copy is shut down
    };
    boost::shared_ptr<Handle> handle_;
};

} // namespace ros

#endif
