// cFE's calls for the header of a packet.
#include "cfe_messages.h"

#include <cstring>

extern "C" {
#include "cfe.h"

using stand_in::set_word;
using stand_in::word;

CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t *message, CFE_SB_MsgId_t id, CFE_MSG_Size_t size)
{
    const std::uint32_t value  = CFE_SB_MsgIdToValue(id);
    const std::size_t   header = (value & 0x1000) != 0 ? 8 : 12;
    std::memset(message, 0, size < header ? size : header);
    set_word(message, 0, value);
    set_word(message, 2, 0xC000);
    set_word(message, 4, static_cast<std::uint32_t>(size - 7));
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetMsgId(const CFE_MSG_Message_t *message, CFE_SB_MsgId_t *id)
{
    *id = CFE_SB_ValueToMsgId(word(message, 0));
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetSize(const CFE_MSG_Message_t *message, CFE_MSG_Size_t *size)
{
    *size = word(message, 4) + 7;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_SetFcnCode(CFE_MSG_Message_t *message, CFE_MSG_FcnCode_t code)
{
    reinterpret_cast<std::uint8_t *>(message)[6] = static_cast<std::uint8_t>(code);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetFcnCode(const CFE_MSG_Message_t *message, CFE_MSG_FcnCode_t *code)
{
    *code = static_cast<CFE_MSG_FcnCode_t>(reinterpret_cast<const std::uint8_t *>(message)[6] & 0x7F);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetSegmentationFlag(const CFE_MSG_Message_t *message, CFE_MSG_SegmentationFlag_t *flag)
{
    static const CFE_MSG_SegmentationFlag_t kFlags[] = {CFE_MSG_SegFlag_Continue, CFE_MSG_SegFlag_First,
                                                        CFE_MSG_SegFlag_Last, CFE_MSG_SegFlag_Unsegmented};
    *flag = kFlags[word(message, 2) >> 14];
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_SetSegmentationFlag(CFE_MSG_Message_t *message, CFE_MSG_SegmentationFlag_t flag)
{
    const std::uint32_t bits = static_cast<std::uint32_t>(flag - CFE_MSG_SegFlag_Continue);
    set_word(message, 2, (word(message, 2) & 0x3FFF) | bits << 14);
    return CFE_SUCCESS;
}

} // extern "C"
