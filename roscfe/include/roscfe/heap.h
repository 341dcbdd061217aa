// The node's own memory in the profiles pool and strict: operator new takes from an arena of a fixed size.
#ifndef ROSCFE_HEAP_H
#define ROSCFE_HEAP_H

#include <cstddef>
#include <cstdint>

namespace roscfe
{
namespace heap
{

// The node is initialised: it spins for the first time. From now on an allocation is counted, and in the strict profile
// it is an event and the end of the application.
void seal();

// The node ends: what is left to be done may allocate.
void unseal();

// Whether the node was initialised, and how many allocations there have been since.
bool          is_sealed();
std::uint32_t late_allocations();

// Bytes of the arena that were taken at some time; blocks that were given back are taken again before more is.
std::size_t used();
std::size_t capacity();

} // namespace heap
} // namespace roscfe

#endif
