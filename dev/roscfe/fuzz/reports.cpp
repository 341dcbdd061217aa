// Reports of the Software Bus: who subscribes, and who has.
#include <std_msgs/Header.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

#include <cstddef>
#include <cstring>

#include "area.h"
#include "cfe_stand_in.h"

extern "C" {
#include "cfe.h"
#include "cfe_msgids.h"
#include "cfe_sb_msg.h"
}

namespace fuzz
{

namespace
{

class Reports final : public Area
{
  public:
    std::uint16_t other_subscription(std::size_t at) override { return at < 3 ? kOthers[at] : 0; }

    void begin(ros::NodeHandle &node) override
    {
        const ros::SubscriberStatusCallback told = [](const ros::SingleSubscriberPublisher &) { ++g_calls; };
        out_[0] = node.advertise<std_msgs::String>("string", 1, true);
        out_[1] = node.advertise<std_msgs::Header>("header", 1, told, told);
        out_[2] = node.advertise<std_msgs::String>("other_string", 1, told, told, ros::VoidConstPtr(), true);
        in_     = node.subscribe<std_msgs::String>("string", 1, [](const boost::shared_ptr<std_msgs::String const> &) {});
        again_  = node.subscribe<std_msgs::String>("string", 1, [](const boost::shared_ptr<std_msgs::String const> &) {});
        client_ = node.serviceClient<std_srvs::SetBool>("a", true);
        std_msgs::String message;
        message.data = "latched";
        out_[0].publish(message);
        out_[2].publish(message);
    }

    void work() override
    {
        static std_msgs::String text;
        static std_msgs::Header header;
        out_[0].publish(text);
        out_[1].publish(header);
        if (g_random.one_in(10))
        {
            g_calls += out_[g_random.below(3)].getNumSubscribers();
            client_.isValid();
            client_.exists();
        }
    }

    bool sent(const std::uint8_t *packet, std::size_t) override
    {
        const std::uint16_t id = msg_id_of(packet);
        if (g_flying && id == kReportControl && packet[6] == CFE_SB_SEND_PREV_SUBS_CC && !g_random.one_in(4))
        {
            return true; // the list comes with faults, or not at all
        }
        return id != kReportControl && id != CFE_SB_ONESUB_TLM_MID;
    }

    void fill() override
    {
        static Bytes packet;
        for (int i = 0; i < 20; ++i)
        {
            packet.size = 0;
            g_random.one_in(3) ? list(packet) : one(packet);
            if (g_random.one_in(2))
            {
                const std::uint8_t head[] = {packet.at[0], packet.at[1], packet.at[2]};
                vary(packet);
                std::memcpy(packet.at, head, g_random.one_in(8) ? 0 : sizeof head);
            }
            give(packet);
        }
    }

    std::size_t accepted() const override { return g_calls; }

  private:
    static constexpr std::uint16_t kOthers[] = {0x1B10, 0x0A01, 0x0900};

    template <class Report>
    void put(Bytes &packet, const Report &report, std::uint16_t msg_id, std::size_t size)
    {
        packet.assign(reinterpret_cast<const std::uint8_t *>(&report), size);
        packet.at[0] = static_cast<std::uint8_t>(msg_id >> 8);
        packet.at[1] = static_cast<std::uint8_t>(msg_id);
        packet.at[2] = 0xC0;
    }

    CFE_SB_MsgId_t any_msg_id()
    {
        static const std::uint32_t kIds[] = {0x0A01, 0x0A02, 0x0A0D, 0x1B10, 0x0900, 0x18FC, 0, 0xFFFF, 0x10000, 0xFFFFFFFF};
        const std::size_t          which  = g_random.below(14);
        return CFE_SB_ValueToMsgId(which < 10 ? kIds[which] : static_cast<std::uint32_t>(g_random.below(0x2000)));
    }

    CFE_SB_PipeId_t any_pipe()
    {
        static const std::uint32_t kPipes[] = {stand_in::kPipe, 0, 0xFF000000, 0xFF000001, 0xFFFFFFFF};
        const std::size_t          which    = g_random.below(10);
        return CFE_SB_PIPEID_C(CFE_ResourceId_FromInteger(
            which < 5 ? kPipes[which] : static_cast<std::uint32_t>(0x00030002 + g_random.below(200))));
    }

    void one(Bytes &packet)
    {
        CFE_SB_SingleSubscriptionTlm_t report;
        std::memset(&report, 0, sizeof report);
        report.Payload.SubType      = g_random.one_in(3) ? CFE_SB_UNSUBSCRIPTION : CFE_SB_SUBSCRIPTION;
        report.Payload.MsgId        = any_msg_id();
        report.Payload.Pipe         = any_pipe();
        report.Payload.Qos.Priority = g_random.one_in(5) ? g_random.byte() : 0;
        put(packet, report, CFE_SB_ONESUB_TLM_MID, sizeof report);
    }

    void list(Bytes &packet)
    {
        static CFE_SB_AllSubscriptionsTlm_t report;
        report.Payload.PktSegment = g_random.one_in(3) ? segment_ = 1 : g_random.one_in(20) ? g_random.byte() : ++segment_;
        report.Payload.Entries    = g_random.one_in(2) ? CFE_MISSION_SB_SUB_ENTRIES_PER_PKT
                                                       : static_cast<std::uint32_t>(g_random.below(CFE_MISSION_SB_SUB_ENTRIES_PER_PKT));
        for (std::uint32_t i = 0; i < report.Payload.Entries; ++i)
        {
            report.Payload.Entry[i].MsgId = any_msg_id();
        }
        report.Payload.Entries += g_random.one_in(30) ? g_random.byte() << 24 | g_random.byte() : 0;
        const std::size_t lead = offsetof(CFE_SB_AllSubscriptionsTlm_t, Payload.Entry);
        put(packet, report, CFE_SB_ALLSUBS_TLM_MID,
            g_random.one_in(10) ? lead + g_random.below(sizeof report - lead) : sizeof report);
    }

    ros::Publisher     out_[3];
    ros::Subscriber    in_, again_;
    ros::ServiceClient client_;
    std::uint32_t      segment_ = 1;
};

constexpr std::uint16_t Reports::kOthers[];

} // namespace

Area *make_reports()
{
    static Reports made;
    return &made;
}

} // namespace fuzz
