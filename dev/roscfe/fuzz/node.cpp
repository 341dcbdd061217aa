// The fuzz driver: a node that takes over packets of an area until all have come, in one process with the stand-in of cFE.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "area.h"
#include "cfe_stand_in.h"
#include "roscfe/ground.h"
#include "roscfe/heap.h"

extern "C" {
#include "cfe.h"
}

#if defined(__SANITIZE_ADDRESS__)
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
static std::size_t in_use() { return __sanitizer_get_current_allocated_bytes(); }
#else
static std::size_t in_use() { return 0; }
#endif

namespace fuzz
{

std::size_t g_left   = 0;
std::size_t g_calls  = 0;
bool        g_flying = false;

namespace
{

Area *         g_area    = nullptr;
std::size_t    g_events  = 0;
char           g_last[1024];
std::uint16_t  g_sequence = 0;
std::uint64_t  g_digest   = 14695981039346656037ULL; // of all packets
constexpr auto kRoom      = static_cast<std::size_t>(CFE_MISSION_SB_MAX_SB_MSG_SIZE);
std::uint8_t   g_packet[kRoom];

bool put(std::size_t size)
{
    g_packet[4] = static_cast<std::uint8_t>((size - 7) >> 8);
    g_packet[5] = static_cast<std::uint8_t>(size - 7);
    if (!stand_in::put(g_packet, size))
    {
        return false;
    }
    if (g_left == 0)
    {
        return true; // at the end a whole one for each call that waits
    }
    count(g_packet, size);
    return true;
}

std::size_t header_of(std::uint16_t msg_id)
{
    return (msg_id & kCommandBit) != 0 ? 8 : 16;
}

} // namespace

void count(const std::uint8_t *bytes, std::size_t size)
{
    for (std::size_t i = 0; i < size; i += 1 + size / 64)
    {
        g_digest = (g_digest ^ bytes[i]) * 1099511628211ULL;
    }
    g_left -= g_left > 0 ? 1 : 0;
}

bool give(std::uint16_t msg_id, const std::uint8_t *bytes, std::size_t size, unsigned flags)
{
    const std::size_t header = header_of(msg_id);
    size                     = size < kRoom - header ? size : kRoom - header;
    std::memset(g_packet, 0, header);
    g_packet[0] = static_cast<std::uint8_t>(msg_id >> 8);
    g_packet[1] = static_cast<std::uint8_t>(msg_id);
    g_packet[2] = static_cast<std::uint8_t>(flags << 6 | (g_sequence >> 8 & 0x3F));
    g_packet[3] = static_cast<std::uint8_t>(g_sequence);
    g_sequence  = static_cast<std::uint16_t>((g_sequence + 1) & 0x3FFF);
    if (size > 0)
    {
        std::memcpy(g_packet + header, bytes, size);
    }
    std::size_t whole = header + size;
    if (g_random.one_in(50)) // for a subscription of this pipe, or of another one
    {
        const std::uint8_t spare[] = {static_cast<std::uint8_t>(stand_in::kPipe >> 16),
                                      static_cast<std::uint8_t>(stand_in::kPipe >> 8),
                                      static_cast<std::uint8_t>(stand_in::kPipe),
                                      static_cast<std::uint8_t>(g_random.below(3) << 1 | 1)};
        for (std::size_t at = 12; at < 16 && at < whole; ++at)
        {
            g_packet[at] = g_random.one_in(10) ? g_random.byte() : spare[at - 12];
        }
    }
    if (g_random.one_in(200))
    {
        whole = 7 + g_random.below(header + 8); // ends in its header, or soon behind it
        whole = whole < header + size ? whole : header + size;
        whole = whole < 7 ? 7 : whole;
    }
    return put(whole);
}

bool give(Bytes &packet)
{
    packet.size = packet.size < 7 ? 7 : packet.size < kRoom ? packet.size : kRoom;
    std::memcpy(g_packet, packet.at, packet.size);
    return put(packet.size);
}

void give_in_pieces(std::uint16_t msg_id, const Bytes &bytes, const std::uint8_t *lead, std::size_t lead_size)
{
    static Bytes part;
    std::size_t  room = kRoom - header_of(msg_id) - lead_size;
    if (bytes.size <= room && !g_random.one_in(8))
    {
        part.assign(lead, lead_size);
        part.append(bytes.at, bytes.size);
        give(msg_id, part.at, part.size);
        return;
    }
    room = g_random.one_in(2) ? room : 1 + g_random.below(bytes.size + 1 < room ? bytes.size + 1 : room);
    if (bytes.size / room > 20)
    {
        room = bytes.size / 20;
    }
    for (std::size_t at = 0; at < bytes.size || at == 0; at += room)
    {
        const std::size_t size  = bytes.size - at < room ? bytes.size - at : room;
        unsigned          flags = at == 0 ? 1 : at + room >= bytes.size ? 2 : 0;
        flags                   = g_random.one_in(40) ? static_cast<unsigned>(g_random.below(4)) : flags;
        part.assign(lead, lead_size);
        part.append(bytes.at + at, size);
        const bool is_lost = g_random.one_in(60), is_double = g_random.one_in(60);
        for (int copies = is_lost ? 0 : is_double ? 2 : 1; copies > 0; --copies)
        {
            give(msg_id, part.at, part.size, flags);
        }
        g_sequence = static_cast<std::uint16_t>((g_sequence + (g_random.one_in(60) ? 1 : 0)) & 0x3FFF);
    }
}

void give_samples()
{
    static Bytes bytes;
    for (int i = 0; i < 20; ++i)
    {
        const Sample &sample = any_sample();
        bytes.assign(sample.bytes, sample.size);
        vary(bytes);
        give_in_pieces(sample.msg_id, bytes);
    }
}

} // namespace fuzz

namespace stand_in
{

void fill()
{
    advance(20000);
    if (fuzz::g_flying && fuzz::g_left > 0)
    {
        fuzz::g_area->fill();
    }
    else if (fuzz::g_flying)
    {
        fuzz::g_area->finish();
    }
}

bool sent(const std::uint8_t *packet, std::size_t size)
{
    return fuzz::g_area != nullptr && fuzz::g_area->sent(packet, size);
}

void event(const char *text)
{
    ++fuzz::g_events;
    std::snprintf(fuzz::g_last, sizeof fuzz::g_last, "%s", text);
    if (std::strstr(text, "NODE: ") == text || fuzz::g_events <= 20)
    {
        std::fprintf(stderr, "%s\n", text);
    }
}

std::uint32_t other_subscription(std::size_t at)
{
    return fuzz::g_area->other_subscription(at);
}

bool has_pipe(std::uint32_t pipe)
{
    return (pipe * 2654435761U >> 24 & 3) != 0 && !fuzz::g_random.one_in(100);
}

bool has_queue(const char *name, std::uint32_t)
{
    return name != nullptr ? fuzz::g_random.one_in(2) : !fuzz::g_random.one_in(20);
}

bool load(char *table, std::size_t size)
{
    return fuzz::g_area != nullptr && fuzz::g_flying && fuzz::g_area->load(table, size);
}

} // namespace stand_in

static const char *given(const char *name, const char *otherwise)
{
    const char *value = std::getenv(name);
    return value != nullptr ? value : otherwise;
}

int main(int argc, char **argv)
{
    using namespace fuzz;
    g_random                = Random(std::strtoull(given("FUZZ_SEED", "1"), nullptr, 10));
    const std::size_t count = std::strtoull(given("FUZZ_PACKETS", "1000"), nullptr, 10);
    read_corpus(given("FUZZ_CORPUS", ""));
    const char *wanted = given("FUZZ_AREA", "");
    for (const Areas *each = kAreas; each->name != nullptr; ++each)
    {
        if (std::strcmp(each->name, wanted) == 0)
        {
            g_area = each->make();
        }
    }
    if (g_area == nullptr)
    {
        std::fprintf(stderr, "no area %s\n", wanted);
        std::_Exit(2);
    }
    ros::init(argc, argv, "fuzzed");
    g_area->prepare();
    ros::NodeHandle node;
    g_left   = count;
    g_area->begin(node);
    ros::spinOnce();
    g_flying           = true;
    std::size_t before = 0, last = 0;
    for (std::size_t spins = 0, idle = 0; g_left > 0; ++spins)
    {
        g_area->work();
        ros::spinOnce();
        if (before == 0 && g_left < count / 2)
        {
            before = in_use();
        }
        idle = g_left == last ? idle + 1 : 0;
        last = g_left;
        if (idle > 100000)
        {
            std::fprintf(stderr, "no packet is taken any more\n");
            std::_Exit(2);
        }
    }
    ros::spinOnce();
    std::printf("packets %lu\naccepted %lu\nbad %lu\ndropped %lu\nsent %lu\nevents %lu\ncallbacks %lu\n",
                static_cast<unsigned long>(count), static_cast<unsigned long>(g_area->accepted()),
                static_cast<unsigned long>(roscfe::g_counters.bad), static_cast<unsigned long>(roscfe::g_counters.dropped),
                static_cast<unsigned long>(roscfe::g_counters.sent), static_cast<unsigned long>(g_events),
                static_cast<unsigned long>(g_calls));
    std::printf("arena %lu\nlate %lu\ngrowth %ld\ndigest %016llx\n", static_cast<unsigned long>(roscfe::heap::used()),
                static_cast<unsigned long>(roscfe::heap::late_allocations()),
                before != 0 ? static_cast<long>(in_use()) - static_cast<long>(before) : 0L,
                static_cast<unsigned long long>(g_digest));
    return 0;
}
