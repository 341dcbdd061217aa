// topic_tools::ShapeShifter: a message of any type, whose bytes are kept as they are.
#ifndef TOPIC_TOOLS_SHAPE_SHIFTER_H
#define TOPIC_TOOLS_SHAPE_SHIFTER_H

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "ros/exception.h"
#include "ros/ros.h"
#include "roscfe/refuse.h"

namespace topic_tools
{

class ShapeShifterException : public ros::Exception
{
  public:
    ShapeShifterException(const std::string &what) : ros::Exception(what) {}
};

class ShapeShifter
{
  public:
    typedef boost::shared_ptr<ShapeShifter>       Ptr;
    typedef boost::shared_ptr<ShapeShifter const> ConstPtr;

    inline static bool uses_old_API_ = false;

    virtual ~ShapeShifter() = default;

    const std::string &getDataType() const { return datatype_; }
    const std::string &getMD5Sum() const { return md5_; }
    const std::string &getMessageDefinition() const { return definition_; }

    // Take the type of messages that come from now on.
    void morph(const std::string &md5sum, const std::string &datatype, const std::string &definition,
               const std::string &latching)
    {
        md5_        = md5sum;
        datatype_   = datatype;
        definition_ = definition;
        latching_   = latching;
        is_typed_   = md5_ != "*";
    }

    // A publisher of messages of this type.
    ros::Publisher
    advertise(ros::NodeHandle &nh, const std::string &topic, std::uint32_t queue_size, bool latch = false,
              const ros::SubscriberStatusCallback &connect_cb = ros::SubscriberStatusCallback()) const
    {
        ros::AdvertiseOptions options(topic, queue_size, getMD5Sum(), getDataType(), getMessageDefinition(), connect_cb);
        options.latch = latch;
        return nh.advertise(options);
    }

    // The message as one of type M; it must be of that type.
    template <class M>
    boost::shared_ptr<M> instantiate() const
    {
        if (!is_typed_)
        {
            ROSCFE_THROW(ShapeShifterException("Tried to instantiate message from an untyped shapeshifter."));
        }
        if (ros::message_traits::datatype<M>() != getDataType())
        {
            ROSCFE_THROW(ShapeShifterException("Tried to instantiate message without matching datatype."));
        }
        if (ros::message_traits::md5sum<M>() != getMD5Sum())
        {
            ROSCFE_THROW(ShapeShifterException("Tried to instantiate message without matching md5sum."));
        }
        boost::shared_ptr<M>        message = boost::make_shared<M>();
        ros::serialization::IStream stream(bytes_.data(), size());
        ros::serialization::deserialize(stream, *message);
        return message;
    }

    template <class Stream>
    void write(Stream &stream) const
    {
        if (!bytes_.empty())
        {
            std::memcpy(stream.advance(size()), bytes_.data(), bytes_.size());
        }
    }

    template <class Stream>
    void read(Stream &stream)
    {
        const auto size = static_cast<std::uint32_t>(stream.getLength());
        bytes_.assign(stream.getData(), stream.getData() + size);
        stream.advance(size);
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }

  private:
    std::string               md5_, datatype_, definition_, latching_;
    bool                      is_typed_ = false;
    std::vector<std::uint8_t> bytes_;
};

typedef boost::shared_ptr<ShapeShifter>       ShapeShifterPtr;
typedef boost::shared_ptr<ShapeShifter const> ShapeShifterConstPtr;

} // namespace topic_tools

namespace ros
{

namespace message_traits
{

template <>
struct IsMessage<topic_tools::ShapeShifter> : TrueType
{
};
template <>
struct IsMessage<const topic_tools::ShapeShifter> : TrueType
{
};

// By itself it is of any type, a message of it of one.
template <>
struct MD5Sum<topic_tools::ShapeShifter>
{
    static const char *value(const topic_tools::ShapeShifter &message) { return message.getMD5Sum().c_str(); }
    static const char *value() { return "*"; }
};
template <>
struct DataType<topic_tools::ShapeShifter>
{
    static const char *value(const topic_tools::ShapeShifter &message) { return message.getDataType().c_str(); }
    static const char *value() { return "*"; }
};
template <>
struct Definition<topic_tools::ShapeShifter>
{
    static const char *value(const topic_tools::ShapeShifter &message) { return message.getMessageDefinition().c_str(); }
};

} // namespace message_traits

namespace serialization
{

template <>
struct Serializer<topic_tools::ShapeShifter>
{
    template <class Stream>
    static void write(Stream &stream, const topic_tools::ShapeShifter &message)
    {
        message.write(stream);
    }
    template <class Stream>
    static void read(Stream &stream, topic_tools::ShapeShifter &message)
    {
        message.read(stream);
    }
    static std::uint32_t serializedLength(const topic_tools::ShapeShifter &message) { return message.size(); }
};

template <>
struct PreDeserialize<topic_tools::ShapeShifter>
{
    static void notify(const PreDeserializeParams<topic_tools::ShapeShifter> &params)
    {
        auto &header = *params.connection_header;
        params.message->morph(header["md5sum"], header["type"], header["message_definition"], header["latching"]);
    }
};

} // namespace serialization

} // namespace ros

#endif
