// An area of the fuzz driver: packets of one kind, and what the node does with them.
#ifndef DEV_ROSCFE_FUZZ_AREA_H
#define DEV_ROSCFE_FUZZ_AREA_H

#include <cstddef>
#include <cstdint>

#include <ros/ros.h>

#include "damage.h"

namespace fuzz
{

struct Area
{
    virtual ~Area() = default;

    virtual void prepare() {}                      // before there is a NodeHandle
    virtual void begin(ros::NodeHandle &node) = 0; // before the first spin
    virtual void work() {}                         // before each later spin
    virtual void fill() = 0;                       // `give` packets, since the pipe is empty
    virtual void finish() {}                       // all have come: `give` what calls still wait for

    // A packet of the node; true when the area has taken it.
    virtual bool sent(const std::uint8_t *, std::size_t) { return false; }

    // Subscriptions of other applications; 0 behind the last one.
    virtual std::uint16_t other_subscription(std::size_t) { return 0; }

    virtual bool        load(char *, std::size_t) { return false; } // the table of parameters
    virtual std::size_t accepted() const = 0;                       // packets that were what they should be
};

struct Areas // by name
{
    const char *name;
    Area *(*make)();
};
extern const Areas kAreas[];

// A header for a packet, and its bytes; then it goes into the pipe, and is counted.
bool give(std::uint16_t msg_id, const std::uint8_t *bytes, std::size_t size, unsigned flags = 3);
bool give(Bytes &packet); // a whole one, whose length is corrected
void count(const std::uint8_t *bytes, std::size_t size); // one that does not come through the pipe

// A message as `wire` sends it: sometimes in several packets, of which one may be missing, double or in the wrong place.
// Each repeats a lead.
void give_in_pieces(std::uint16_t msg_id, const Bytes &bytes, const std::uint8_t *lead = nullptr, std::size_t lead_size = 0);

// Twenty samples, varied.
void give_samples();

extern std::size_t g_left;   // packets to come
extern bool        g_flying; // until then the area makes no packets with faults
extern std::size_t g_calls; // of the node's callbacks

constexpr std::uint16_t kCommandBit = 0x1000, kMaster = 0x08FC, kReportControl = 0x180E;
constexpr bool          kIsStrict =
#if defined(ROSCFE_PROFILE_STRICT)
    true;
#else
    false;
#endif

inline std::uint16_t msg_id_of(const std::uint8_t *packet)
{
    return static_cast<std::uint16_t>(packet[0] << 8 | packet[1]);
}

} // namespace fuzz

#endif
