// operator new and delete of a node, in the profiles pool and strict: an arena, and lists of free blocks by size.
#include "roscfe/heap.h"

#include <new>

#include "roscfe/refuse.h"

#ifndef ROSCFE_ARENA_BYTES
#define ROSCFE_ARENA_BYTES 262144
#endif

namespace roscfe
{
namespace heap
{

namespace
{

bool          g_sealed = false;
std::uint32_t g_late   = 0;

} // namespace

void seal()
{
    g_sealed = true;
}

void unseal()
{
    g_sealed = false;
}

bool is_sealed()
{
    return g_sealed;
}

std::uint32_t late_allocations()
{
    return g_late;
}

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)

namespace
{

// A block is a power of two, with its class in front: taking and giving back take the same time, however much is used.
constexpr std::size_t kLead     = alignof(std::max_align_t);
constexpr int         kSmallest = 5; // 32 bytes
constexpr int         kClasses  = 27;

struct Free
{
    Free *next;
};

alignas(std::max_align_t) unsigned char g_arena[ROSCFE_ARENA_BYTES];
std::size_t g_used = 0;
Free *      g_free[kClasses];

int class_of(std::size_t size)
{
    int found = kSmallest;
    while ((static_cast<std::size_t>(1) << found) < size)
    {
        ++found;
    }
    return found;
}

} // namespace

void *take(std::size_t size)
{
    if (g_sealed)
    {
        ++g_late;
#if defined(ROSCFE_PROFILE_STRICT)
        g_sealed = false; // what is said of it may allocate
        refuse("memory was allocated after initialisation", "the profile is strict");
#endif
    }
    const int of = class_of(size + kLead);
    if (of >= kClasses)
    {
        refuse("the arena has no room", "a block is larger than any arena");
    }
    unsigned char *block = reinterpret_cast<unsigned char *>(g_free[of]);
    if (block != nullptr)
    {
        g_free[of] = g_free[of]->next;
    }
    else
    {
        const std::size_t bytes = static_cast<std::size_t>(1) << of;
        if (bytes > sizeof g_arena - g_used)
        {
            g_sealed = false;
            refuse("the node's arena is full", "build it with a larger ROSCFE_ARENA_BYTES");
        }
        block = g_arena + g_used;
        g_used += bytes;
    }
    *reinterpret_cast<int *>(block) = of;
    return block + kLead;
}

void give(void *at)
{
    if (at != nullptr)
    {
        unsigned char *block = static_cast<unsigned char *>(at) - kLead;
        const int      of    = *reinterpret_cast<int *>(block);
        Free *         freed = reinterpret_cast<Free *>(block);
        freed->next          = g_free[of];
        g_free[of]           = freed;
    }
}

std::size_t used()
{
    return g_used;
}

std::size_t capacity()
{
    return sizeof g_arena;
}

#else

std::size_t used()
{
    return 0;
}

std::size_t capacity()
{
    return 0;
}

#endif

} // namespace heap
} // namespace roscfe

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)

void *operator new(std::size_t size)
{
    return roscfe::heap::take(size);
}
void *operator new[](std::size_t size)
{
    return roscfe::heap::take(size);
}
void *operator new(std::size_t size, const std::nothrow_t &) noexcept
{
    return roscfe::heap::take(size);
}
void *operator new[](std::size_t size, const std::nothrow_t &) noexcept
{
    return roscfe::heap::take(size);
}
void operator delete(void *at) noexcept
{
    roscfe::heap::give(at);
}
void operator delete[](void *at) noexcept
{
    roscfe::heap::give(at);
}
void operator delete(void *at, std::size_t) noexcept
{
    roscfe::heap::give(at);
}
void operator delete[](void *at, std::size_t) noexcept
{
    roscfe::heap::give(at);
}

#endif
