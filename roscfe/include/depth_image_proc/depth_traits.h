// What the pixels of a depth image say: millimeters in 16 bits, or meters as floats (http://wiki.ros.org/depth_image_proc,
// REP 118).
#ifndef ROSCFE_DEPTH_IMAGE_PROC_DEPTH_TRAITS_H
#define ROSCFE_DEPTH_IMAGE_PROC_DEPTH_TRAITS_H

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace depth_image_proc
{

template <typename T>
struct DepthTraits
{
};

template <>
struct DepthTraits<std::uint16_t>
{
    static inline bool          valid(std::uint16_t depth) { return depth != 0; }
    static inline float         toMeters(std::uint16_t depth) { return depth * 0.001f; }
    static inline std::uint16_t fromMeters(float depth) { return static_cast<std::uint16_t>(depth * 1000.0f + 0.5f); }
    template <class Buffer>
    static inline void initializeBuffer(Buffer &) // of bytes, which are 0 already: not valid
    {
    }
};

template <>
struct DepthTraits<float>
{
    static inline bool  valid(float depth) { return std::isfinite(depth); }
    static inline float toMeters(float depth) { return depth; }
    static inline float fromMeters(float depth) { return depth; }
    template <class Buffer>
    static inline void initializeBuffer(Buffer &buffer) // of bytes
    {
        const float none = std::numeric_limits<float>::quiet_NaN();
        for (std::size_t at = 0; at + sizeof none <= buffer.size(); at += sizeof none)
        {
            std::memcpy(&buffer[at], &none, sizeof none);
        }
    }
};

} // namespace depth_image_proc

#endif
