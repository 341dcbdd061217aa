// Where messages go that are not sent, since the topic has no subscriber, while a bag or another watch looks on. cfepy has
// these functions in such runs alone; elsewhere they are not there.
#include "core/core.h"

extern "C" {
__attribute__((weak, visibility("default"))) void *cfepy_unsent_room(std::size_t size);
__attribute__((weak, visibility("default"))) void  cfepy_unsent(std::uint16_t msg_id, void *at, std::size_t size);
}

namespace roscfe
{

bool is_watched(const Publication &publication)
{
    return cfepy_unsent_room != nullptr && publication.msg_id_ != 0;
}

std::uint8_t *begin_unsent(std::size_t size)
{
    return static_cast<std::uint8_t *>(cfepy_unsent_room(size));
}

void show_unsent(const Publication &publication, std::uint8_t *at, std::size_t size)
{
    cfepy_unsent(publication.msg_id_, at, size);
}

} // namespace roscfe
