// Commands of the ground.
#include "area.h"

namespace fuzz
{

namespace
{

class Commands final : public Area
{
  public:
    void begin(ros::NodeHandle &) override {}

    bool sent(const std::uint8_t *packet, std::size_t) override
    {
        accepted_ += msg_id_of(packet) == 0x0C00 ? 1 : 0; // housekeeping
        return msg_id_of(packet) != kReportControl;
    }

    void fill() override
    {
        static Bytes packet;
        for (int i = 0; i < 40; ++i)
        {
            const std::uint8_t command[] = {0x1C, 0, 0xC0, 0, 0, 0, static_cast<std::uint8_t>(g_random.below(5)), 0};
            packet.assign(command, g_random.one_in(5) ? 7 : sizeof command);
            packet.insert(packet.size, g_random.one_in(4) ? g_random.below(40) : 0);
            packet.at[6] = g_random.one_in(10) ? g_random.byte() : packet.at[6];
            give(packet);
        }
    }

    std::size_t accepted() const override { return accepted_; }

  private:
    std::size_t accepted_ = 0;
};

} // namespace

Area *make_commands()
{
    static Commands made;
    return &made;
}

} // namespace fuzz
