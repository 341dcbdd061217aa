// Talks to the housekeeping application of the flight computer in its own packets, byte for byte.
//
// Publishes:  /cfe/hk/commands, /cfe/hk/send_hk, /cfe/hk/send_combined (std_msgs/UInt8MultiArray, whole command packets):
//             a no-op at the start, and once a second requests for HK's own housekeeping and for the combined packet
// Subscribes: /cfe/hk/combined_pkt1 (std_msgs/UInt8MultiArray, a whole telemetry packet)
#include <cstring>
#include <initializer_list>

#include <ros/ros.h>
#include <std_msgs/UInt8MultiArray.h>

static const size_t kHeader = 16;  // bytes of a telemetry packet's header
static int g_received = 0;

static uint32_t word(const std_msgs::UInt8MultiArray& packet, size_t at)
{
  return packet.data[at] | packet.data[at + 1] << 8 | packet.data[at + 2] << 16 |
         static_cast<uint32_t>(packet.data[at + 3]) << 24;
}

static void received(const std_msgs::UInt8MultiArray::ConstPtr& packet)
{
  ++g_received;
  if (packet->data.size() != kHeader + 12)
  {
    ROS_ERROR("the combined packet has %d bytes", static_cast<int>(packet->data.size()));
    return;
  }
  const uint32_t bits = word(*packet, kHeader + 8);
  float peak;
  std::memcpy(&peak, &bits, sizeof peak);
  ROS_INFO("packet %d of HK: HK has %d commands, arm at sample %u, peak current %.3f A", g_received,
           packet->data[kHeader], word(*packet, kHeader + 4), peak);
}

// A command packet: MsgId, sequence, length and function code, big-endian, with 0 for the checksum.
static std_msgs::UInt8MultiArray command(uint16_t msg_id, uint8_t function, std::initializer_list<uint8_t> payload)
{
  std_msgs::UInt8MultiArray packet;
  const uint8_t length = static_cast<uint8_t>(payload.size() + 1);
  packet.data = { static_cast<uint8_t>(msg_id >> 8), static_cast<uint8_t>(msg_id), 0xC0, 0, 0, length, function, 0 };
  packet.data.insert(packet.data.end(), payload);
  return packet;
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "hk_monitor");
  ros::NodeHandle nh;
  ros::Publisher commands = nh.advertise<std_msgs::UInt8MultiArray>("/cfe/hk/commands", 1);
  ros::Publisher send_hk = nh.advertise<std_msgs::UInt8MultiArray>("/cfe/hk/send_hk", 1);
  ros::Publisher send_combined = nh.advertise<std_msgs::UInt8MultiArray>("/cfe/hk/send_combined", 1);
  ros::Subscriber packets = nh.subscribe("/cfe/hk/combined_pkt1", 1, received);
  const std_msgs::UInt8MultiArray noop = command(0x189A, 0, {});
  const std_msgs::UInt8MultiArray housekeeping = command(0x189B, 0, {});
  const std_msgs::UInt8MultiArray combined = command(0x189C, 0, { 0x9C, 0x08, 0, 0 });
  ros::Duration(0.5).sleep();
  commands.publish(noop);
  ros::Rate rate(1);
  while (ros::ok())
  {
    send_hk.publish(housekeeping);
    send_combined.publish(combined);
    ros::spinOnce();
    rate.sleep();
  }
  return 0;
}
