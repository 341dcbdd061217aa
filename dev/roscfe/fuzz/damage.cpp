#include "damage.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "cfe_stand_in.h"

namespace fuzz
{

Random g_random(1);

namespace
{

const std::uint32_t kCounts[] = {0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 0x10000, 0xFFFF, 256, 25, 7, 3, 1, 0};

constexpr std::size_t kMostSamples = 4096;
Sample                g_samples[kMostSamples];
std::size_t           g_sample_count = 0;

} // namespace

std::uint64_t Random::next()
{
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t mixed = state_;
    mixed               = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9ULL;
    mixed               = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBULL;
    return mixed ^ (mixed >> 31);
}

void Bytes::assign(const std::uint8_t *from, std::size_t count)
{
    size = 0;
    append(from, count);
}

void Bytes::append(const void *from, std::size_t count)
{
    const std::size_t room = std::min(count, kMostBytes - size);
    if (room > 0)
    {
        std::memcpy(at + size, from, room);
    }
    size += room;
}

void Bytes::put32(std::size_t where, std::uint32_t value)
{
    for (std::size_t byte = 0; byte < 4 && where + byte < size; ++byte)
    {
        at[where + byte] = static_cast<std::uint8_t>(value >> (8 * byte));
    }
}

void Bytes::remove(std::size_t where, std::size_t count)
{
    count = std::min(count, size - where);
    std::memmove(at + where, at + where + count, size - where - count);
    size -= count;
}

void Bytes::insert(std::size_t where, std::size_t count)
{
    count = std::min(count, kMostBytes - size);
    std::memmove(at + where + count, at + where, size - where);
    for (std::size_t i = 0; i < count; ++i)
    {
        at[where + i] = g_random.byte();
    }
    size += count;
}

void damage(Bytes &bytes)
{
    const std::size_t where = g_random.below(bytes.size + 1);
    switch (g_random.below(7))
    {
        case 0:
            bytes.size = where;
            break;
        case 1:
            bytes.insert(bytes.size, 1 + g_random.below(9));
            break;
        case 2:
        {
            const std::size_t count = sizeof kCounts / sizeof *kCounts;
            const std::size_t which = g_random.below(count + 2);
            const std::size_t rest  = bytes.size - where;
            bytes.put32(where, which < count ? kCounts[which] : static_cast<std::uint32_t>(rest - which + count - 3));
            break;
        }
        case 3:
            bytes.remove(where, 1 + g_random.below(8));
            break;
        case 4:
            bytes.insert(where, 1 + g_random.below(8));
            break;
        case 5:
            for (std::size_t flips = 1 + g_random.below(4); flips > 0 && bytes.size > 0; --flips)
            {
                bytes.at[g_random.below(bytes.size)] ^= static_cast<std::uint8_t>(1 << g_random.below(8));
            }
            break;
        default:
            for (std::size_t i = 0; i < bytes.size; ++i)
            {
                bytes.at[i] = g_random.byte();
            }
    }
}

void vary(Bytes &bytes)
{
    for (std::size_t faults = g_random.one_in(4) ? 0 : 1 + g_random.below(2) * g_random.below(3); faults > 0; --faults)
    {
        damage(bytes);
    }
}

// The file: MsgId (2 bytes), length (4 bytes), both little-endian, and the bytes, again and again.
void read_corpus(const char *path)
{
    std::FILE *file = std::fopen(path, "rb");
    if (file == nullptr)
    {
        std::fprintf(stderr, "the corpus %s cannot be read\n", path);
        std::_Exit(2);
    }
    std::uint8_t lead[6];
    while (g_sample_count < kMostSamples && std::fread(lead, 1, sizeof lead, file) == sizeof lead)
    {
        const std::size_t size = lead[2] | lead[3] << 8 | lead[4] << 16;
        auto *            made = static_cast<std::uint8_t *>(stand_in::outside_memory(size + 1));
        if (std::fread(made, 1, size, file) != size)
        {
            std::_Exit(2);
        }
        g_samples[g_sample_count++] = {static_cast<std::uint16_t>(lead[0] | lead[1] << 8), made, size};
    }
    std::fclose(file);
}

const Sample &any_sample()
{
    return g_samples[g_random.below(g_sample_count)];
}

bool has_sample_of(std::uint16_t msg_id)
{
    return std::any_of(g_samples, g_samples + g_sample_count, [&](const Sample &each) { return each.msg_id == msg_id; });
}

const Sample &sample_of(std::uint16_t msg_id)
{
    std::size_t at = g_random.below(g_sample_count);
    while (g_samples[at].msg_id != msg_id)
    {
        at = (at + 1) % g_sample_count;
    }
    return g_samples[at];
}

} // namespace fuzz
