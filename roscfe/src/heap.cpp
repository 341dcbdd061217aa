// The heap of a node in the profiles pool and strict: an arena, and lists of free blocks by size. operator new and delete
// take from it, and so do C's functions (malloc and its kin), in whose place the linker puts those below (--wrap).
#include "roscfe/heap.h"

#include <cerrno>
#include <cstring>
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

// A block is a power of two: taking and giving back take the same time, however much is used. In front of what the node
// gets stand the class of the block and the distance from its beginning.
struct Lead
{
    std::uint32_t of;
    std::uint32_t distance;
};

constexpr std::size_t kAligned  = alignof(std::max_align_t) > sizeof(Lead) ? alignof(std::max_align_t) : sizeof(Lead);
constexpr std::size_t kArena    = ROSCFE_ARENA_BYTES;
constexpr std::size_t kSmallest = 5; // 32 bytes
constexpr std::size_t kClasses  = 48;

constexpr std::size_t kLargest  = 0x7FFFFFFF; // bytes of an arena

static_assert(kArena >= 64 && kArena <= kLargest, "an arena has at least 64 bytes, and less than 2 GiB");

struct Free
{
    Free *next;
};

alignas(kAligned) unsigned char g_arena[kArena];
std::size_t g_used = 0;
Free *      g_free[kClasses];

// The class of a block of so many bytes, which are no more than the arena has.
std::size_t class_of(std::size_t size)
{
    std::size_t found = kSmallest;
    while ((static_cast<std::size_t>(1) << found) < size)
    {
        ++found;
    }
    return found;
}

Lead *lead_of(void *at)
{
    return static_cast<Lead *>(static_cast<void *>(static_cast<unsigned char *>(at) - sizeof(Lead)));
}

bool is_in_arena(const void *at)
{
    const auto place = reinterpret_cast<std::uintptr_t>(at);
    const auto begin = reinterpret_cast<std::uintptr_t>(&g_arena[0]);
    return place >= begin && place - begin < kArena;
}

// The bytes that a node may use from a place on.
std::size_t room_at(void *at)
{
    const Lead *lead = lead_of(at);
    return (static_cast<std::size_t>(1) << lead->of) - lead->distance;
}

// A block with an address that is a multiple of `alignment`; null when there is no room for it.
void *take(std::size_t size, std::size_t alignment)
{
    alignment               = alignment > kAligned ? alignment : kAligned;
    const std::size_t spare = alignment > kAligned ? alignment : 0; // between the block's beginning and such an address
    if (size > kArena - kAligned || spare > kArena - kAligned - size)
    {
        return nullptr;
    }
    const std::size_t of    = class_of(kAligned + spare + size);
    const std::size_t bytes = static_cast<std::size_t>(1) << of;
    unsigned char *   block = reinterpret_cast<unsigned char *>(g_free[of]);
    if (block != nullptr)
    {
        g_free[of] = g_free[of]->next;
    }
    else if (bytes <= kArena - g_used)
    {
        block = g_arena + g_used;
        g_used += bytes;
    }
    else
    {
        return nullptr;
    }
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(block) + kAligned;
    const std::uintptr_t more  = -first & (alignment - 1);
    unsigned char *      at    = block + kAligned + more;
    *lead_of(at)               = {static_cast<std::uint32_t>(of), static_cast<std::uint32_t>(at - block)};
    return at;
}

void give(void *at)
{
    if (at != nullptr)
    {
        const Lead lead  = *lead_of(at);
        Free *     freed = reinterpret_cast<Free *>(static_cast<unsigned char *>(at) - lead.distance);
        freed->next      = g_free[lead.of];
        g_free[lead.of]  = freed;
    }
}

// The node takes memory: after its start that is counted, and in the profile strict it is the end.
void note()
{
    if (g_sealed)
    {
        ++g_late;
#if defined(ROSCFE_PROFILE_STRICT)
        g_sealed = false; // what is said of it may allocate
        refuse("memory was allocated after initialisation", "the profile is strict");
#endif
    }
}

// Whether somebody who can do without gets none, so that a node of the profile strict takes nothing after its start.
bool does_without()
{
#if defined(ROSCFE_PROFILE_STRICT)
    return g_sealed;
#else
    return false;
#endif
}

// What operator new gives: memory, or the end of the application.
void *need(std::size_t size, std::size_t alignment = kAligned)
{
    note();
    void *at = take(size, alignment);
    if (at == nullptr)
    {
        g_sealed = false;
        const bool is_too_large = size > kLargest || alignment > kLargest - size;
        refuse(is_too_large ? "the arena has no room" : "the node's arena is full",
               is_too_large ? "a block is larger than any arena" : "build it with a larger ROSCFE_ARENA_BYTES");
    }
    return at;
}

// What operator new gives that is called with std::nothrow: memory, or a null pointer.
void *offer(std::size_t size, std::size_t alignment = kAligned)
{
    if (does_without())
    {
        return nullptr;
    }
    note();
    return take(size, alignment);
}

// What C's functions give: memory, or a null pointer and ENOMEM.
void *c_block(std::size_t size, std::size_t alignment = kAligned)
{
    note();
    void *at = take(size, alignment);
    if (at == nullptr)
    {
        errno = ENOMEM;
    }
    return at;
}

bool is_power_of_two(std::size_t number)
{
    return number != 0 && (number & (number - 1)) == 0;
}

} // namespace

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

using roscfe::heap::c_block;
using roscfe::heap::give;
using roscfe::heap::need;
using roscfe::heap::offer;

void *operator new(std::size_t size)
{
    return need(size);
}
void *operator new[](std::size_t size)
{
    return need(size);
}
void *operator new(std::size_t size, const std::nothrow_t &) noexcept
{
    return offer(size);
}
void *operator new[](std::size_t size, const std::nothrow_t &) noexcept
{
    return offer(size);
}
void *operator new(std::size_t size, std::align_val_t alignment)
{
    return need(size, static_cast<std::size_t>(alignment));
}
void *operator new[](std::size_t size, std::align_val_t alignment)
{
    return need(size, static_cast<std::size_t>(alignment));
}
void *operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t &) noexcept
{
    return offer(size, static_cast<std::size_t>(alignment));
}
void *operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t &) noexcept
{
    return offer(size, static_cast<std::size_t>(alignment));
}
void operator delete(void *at) noexcept
{
    give(at);
}
void operator delete[](void *at) noexcept
{
    give(at);
}
void operator delete(void *at, std::size_t) noexcept
{
    give(at);
}
void operator delete[](void *at, std::size_t) noexcept
{
    give(at);
}
void operator delete(void *at, const std::nothrow_t &) noexcept
{
    give(at);
}
void operator delete[](void *at, const std::nothrow_t &) noexcept
{
    give(at);
}
void operator delete(void *at, std::align_val_t) noexcept
{
    give(at);
}
void operator delete[](void *at, std::align_val_t) noexcept
{
    give(at);
}
void operator delete(void *at, std::size_t, std::align_val_t) noexcept
{
    give(at);
}
void operator delete[](void *at, std::size_t, std::align_val_t) noexcept
{
    give(at);
}
void operator delete(void *at, std::align_val_t, const std::nothrow_t &) noexcept
{
    give(at);
}
void operator delete[](void *at, std::align_val_t, const std::nothrow_t &) noexcept
{
    give(at);
}

// -- functions of C, in whose place the linker puts these (--wrap) --------------------------------------------------

extern "C" {

void  __real_free(void *at);
void *__real_realloc(void *at, std::size_t size);

void *__wrap_malloc(std::size_t size)
{
    return c_block(size);
}

void *__wrap_calloc(std::size_t count, std::size_t size)
{
    if (size != 0 && count > static_cast<std::size_t>(-1) / size)
    {
        errno = ENOMEM;
        return nullptr;
    }
    void *at = c_block(count * size);
    return at != nullptr ? std::memset(at, 0, count * size) : nullptr;
}

// What functions of libc have allocated themselves, such as getline, is libc's.
void __wrap_free(void *at)
{
    if (roscfe::heap::is_in_arena(at))
    {
        give(at);
    }
    else if (at != nullptr)
    {
        __real_free(at);
    }
}

void *__wrap_realloc(void *at, std::size_t size)
{
    if (at != nullptr && !roscfe::heap::is_in_arena(at))
    {
        return __real_realloc(at, size);
    }
    if (at != nullptr && size == 0)
    {
        give(at);
        return nullptr;
    }
    if (at != nullptr && size <= roscfe::heap::room_at(at))
    {
        return at;
    }
    void *moved = c_block(size);
    if (at != nullptr && moved != nullptr)
    {
        std::memcpy(moved, at, roscfe::heap::room_at(at));
        give(at);
    }
    return moved;
}

void *__wrap_reallocarray(void *at, std::size_t count, std::size_t size)
{
    if (size != 0 && count > static_cast<std::size_t>(-1) / size)
    {
        errno = ENOMEM;
        return nullptr;
    }
    return __wrap_realloc(at, count * size);
}

int __wrap_posix_memalign(void **out, std::size_t alignment, std::size_t size)
{
    if (!roscfe::heap::is_power_of_two(alignment) || alignment % sizeof(void *) != 0)
    {
        return EINVAL;
    }
    void *at = c_block(size, alignment);
    if (at == nullptr)
    {
        return ENOMEM;
    }
    *out = at;
    return 0;
}

void *__wrap_aligned_alloc(std::size_t alignment, std::size_t size)
{
    if (!roscfe::heap::is_power_of_two(alignment))
    {
        errno = EINVAL;
        return nullptr;
    }
    return c_block(size, alignment);
}

void *__wrap_memalign(std::size_t alignment, std::size_t size)
{
    return __wrap_aligned_alloc(alignment, size);
}

char *__wrap_strndup(const char *text, std::size_t most)
{
    const void *      end  = std::memchr(text, '\0', most);
    const std::size_t size = end != nullptr ? static_cast<std::size_t>(static_cast<const char *>(end) - text) : most;
    char *            made = static_cast<char *>(c_block(size + 1));
    if (made != nullptr)
    {
        std::memcpy(made, text, size);
        made[size] = '\0';
    }
    return made;
}

char *__wrap_strdup(const char *text)
{
    return __wrap_strndup(text, std::strlen(text));
}

} // extern "C"

#endif
