// The bytes of a packet's header, and cFE's calls for them: a part of every stand-in for cFE.
#ifndef DEV_ROSCFE_CFE_MESSAGES_H
#define DEV_ROSCFE_CFE_MESSAGES_H

#include <cstdint>

namespace stand_in
{

// The stream id, the sequence and the length are words of two bytes, the high one first.
inline std::uint32_t word(const void *packet, int at)
{
    const std::uint8_t *bytes = static_cast<const std::uint8_t *>(packet) + at;
    return static_cast<std::uint32_t>(bytes[0] << 8 | bytes[1]);
}

inline void set_word(void *packet, int at, std::uint32_t value)
{
    std::uint8_t *bytes = static_cast<std::uint8_t *>(packet) + at;
    bytes[0]            = static_cast<std::uint8_t>(value >> 8);
    bytes[1]            = static_cast<std::uint8_t>(value);
}

} // namespace stand_in

#endif
