/* CFE_MSG and the functions of CFE_SB that only look at a message: bytes of CCSDS headers, most significant first.
 *
 * They answer as cfepy.msg does, for memory of an application. All arguments are in registers.
 */
#include "engine.h"

#include <string.h>

#define BAD_ARGUMENT 0xCA000003u               /* CFE_MSG_BAD_ARGUMENT, CFE_SB_BAD_ARGUMENT */
#define WRONG_TYPE 0xCA00000Du                 /* CFE_MSG_WRONG_MSG_TYPE */

enum { PRIMARY = 6, COMMAND = 8, TELEMETRY = 16, LEAST = 7, MOST = 0xFFFF + 7 };
enum { IS_COMMAND = 0x10, HAS_SECONDARY = 0x08, KIND = 0xF8, COMMAND_KIND = 0x18, TELEMETRY_KIND = 0x08 };

static uint32_t word_at(const unsigned char *message, int at) { return message[at] << 8 | message[at + 1]; }

static void put_word(unsigned char *message, int at, uint32_t value)
{
    message[at] = value >> 8;
    message[at + 1] = value;
}

static size_t size_of(const unsigned char *message) { return word_at(message, 4) + LEAST; }

static size_t header_of(const unsigned char *message)
{
    return !(message[0] & HAS_SECONDARY) ? PRIMARY : message[0] & IS_COMMAND ? COMMAND : TELEMETRY;
}

static bool is_valid_id(const Coroutine *call, uint64_t id)
{
    return (uint32_t)id > 0 && (uint32_t)id <= call->table->highest_msg_id;
}

/* A getter of a bit field: a word of the header, shifted and masked, into an output of one, two, four or eight bytes. */
#define GET(name, type, value)                       \
    NATIVE(name)                                     \
    {                                                \
        const unsigned char *message = POINTER(0);   \
        type *output = (type *)POINTER(1);           \
        if (message == NULL || output == NULL)       \
            return BAD_ARGUMENT;                     \
        *output = (value);                           \
        return 0;                                    \
    }

/* A setter: `good` says which values there are. */
#define SET(name, type, good, change)                \
    NATIVE(name)                                     \
    {                                                \
        unsigned char *message = POINTER(0);         \
        type value = (type)WORD(1);                  \
        if (message == NULL || !(good))              \
            return BAD_ARGUMENT;                     \
        change;                                      \
        return 0;                                    \
    }

#define FIELD(at, mask, bits) put_word(message, at, (word_at(message, at) & ~(mask)) | (bits))

GET(get_size, uint64_t, size_of(message))
SET(set_size, uint64_t, value >= LEAST && value <= MOST, put_word(message, 4, value - LEAST))
GET(get_type, uint32_t, message[0] & IS_COMMAND ? 1 : 2)
SET(set_type, uint32_t, value == 1 || value == 2, FIELD(0, 0x1000u, value == 1 ? 0x1000u : 0))
GET(get_version, uint16_t, message[0] >> 5)
SET(set_version, uint16_t, value <= 7, FIELD(0, 0xE000u, (uint32_t)value << 13))
GET(get_has_secondary, uint8_t, message[0] >> 3 & 1)
SET(set_has_secondary, uint8_t, true, FIELD(0, 0x0800u, value ? 0x0800u : 0))
GET(get_ap_id, uint16_t, word_at(message, 0) & 0x7FF)
SET(set_ap_id, uint16_t, value <= 0x7FF, FIELD(0, 0x07FFu, (uint32_t)value))
GET(get_segmentation, uint32_t, (message[2] >> 6) + 1)
SET(set_segmentation, uint32_t, value >= 1 && value <= 4, FIELD(2, 0xC000u, (value - 1) << 14))
GET(get_sequence, uint16_t, word_at(message, 2) & 0x3FFF)
SET(set_sequence, uint16_t, value <= 0x3FFF, FIELD(2, 0x3FFFu, (uint32_t)value))
GET(get_msg_id, uint32_t, word_at(message, 0))
SET(set_msg_id, uint32_t, is_valid_id(call, value), put_word(message, 0, value))

NATIVE(next_sequence)
{
    uint16_t count = WORD(0);
    return count < 0x3FFF ? count + 1 : 0;
}

NATIVE(type_of_id)
{
    uint32_t *type = (uint32_t *)POINTER(1);
    if (type == NULL || !is_valid_id(call, WORD(0)))
        return BAD_ARGUMENT;
    *type = WORD(0) & 0x1000 ? 1 : 2;
    return 0;
}

NATIVE(init)
{
    unsigned char *message = POINTER(0);
    uint64_t size = WORD(2);
    if (message == NULL)
        return BAD_ARGUMENT;
    memset(message, 0, size);
    put_word(message, 0, (message[0] & IS_COMMAND) << 8 | HAS_SECONDARY << 8); /* stays where the id cannot be */
    message[2] |= 0xC0;                                                       /* not segmented */
    if (!is_valid_id(call, WORD(1)))
        return BAD_ARGUMENT;
    put_word(message, 0, WORD(1));
    if (size < LEAST || size > MOST)
        return BAD_ARGUMENT;
    put_word(message, 4, size - LEAST);
    return 0;
}


/* ---- secondary headers -------------------------------------------------------------------------------------------- */

NATIVE(get_function_code)
{
    const unsigned char *message = POINTER(0);
    uint16_t *code = (uint16_t *)POINTER(1);
    if (message == NULL || code == NULL)
        return BAD_ARGUMENT;
    *code = 0;
    if ((message[0] & KIND) != COMMAND_KIND)
        return WRONG_TYPE;
    *code = message[6] & 0x7F;
    return 0;
}

NATIVE(set_function_code)
{
    unsigned char *message = POINTER(0);
    uint16_t code = WORD(1);
    if (message == NULL || code > 0x7F)
        return BAD_ARGUMENT;
    if ((message[0] & KIND) != COMMAND_KIND)
        return WRONG_TYPE;
    message[6] = code;
    return 0;
}

static uint8_t checksum(const unsigned char *message)
{
    uint8_t sum = 0xFF;
    for (size_t i = 0, size = size_of(message); i < size; i++)
        sum ^= message[i];
    return sum;
}

NATIVE(generate_checksum)
{
    unsigned char *message = POINTER(0);
    if (message == NULL)
        return BAD_ARGUMENT;
    if ((message[0] & KIND) != COMMAND_KIND)
        return WRONG_TYPE;
    message[7] = 0;
    message[7] = checksum(message);
    return 0;
}

NATIVE(validate_checksum)
{
    const unsigned char *message = POINTER(0);
    uint8_t *is_valid = POINTER(1);
    if (message == NULL || is_valid == NULL)
        return BAD_ARGUMENT;
    if ((message[0] & KIND) != COMMAND_KIND)
        return WRONG_TYPE;
    *is_valid = checksum(message) == 0;
    return 0;
}

NATIVE(get_time)
{
    const unsigned char *message = POINTER(0);
    uint32_t *time = (uint32_t *)POINTER(1);
    if (message == NULL || time == NULL)
        return BAD_ARGUMENT;
    time[0] = time[1] = 0;
    if ((message[0] & KIND) != TELEMETRY_KIND)
        return WRONG_TYPE;
    time[0] = word_at(message, 6) << 16 | word_at(message, 8);
    time[1] = word_at(message, 10) << 16;
    return 0;
}

NATIVE(set_time)
{
    unsigned char *message = POINTER(0);
    if (message == NULL)
        return BAD_ARGUMENT;
    if ((message[0] & KIND) != TELEMETRY_KIND)
        return WRONG_TYPE;
    uint32_t seconds = WORD(1);
    put_word(message, 6, seconds >> 16);
    put_word(message, 8, seconds);
    put_word(message, 10, WORD(1) >> 48);
    return 0;
}

/* ---- CFE_SB ------------------------------------------------------------------------------------------------------- */

NATIVE(user_data)
{
    unsigned char *message = POINTER(0);
    call->wants_python = message == NULL;
    return message == NULL ? 0 : (uint64_t)(message + header_of(message));
}

NATIVE(user_data_length)
{
    const unsigned char *message = POINTER(0);
    return message == NULL ? 0 : size_of(message) - header_of(message);
}

NATIVE(set_user_data_length)
{
    unsigned char *message = POINTER(0);
    uint64_t size = message == NULL ? 0 : header_of(message) + WORD(1);
    if (message == NULL || size > call->table->largest_message)
        call->wants_python = true;
    else if (size >= LEAST)
        put_word(message, 4, size - LEAST);
    return 0;
}

NATIVE(valid_msg_id) { return is_valid_id(call, WORD(0)); }

NATIVE(string_get)
{
    char *to = (char *)POINTER(0);
    const char *from = (const char *)POINTER(1), *instead = (const char *)POINTER(2);
    uint64_t room = WORD(3), most = WORD(4);
    if (room == 0 || to == NULL)
        return BAD_ARGUMENT;
    if (instead != NULL && (most == 0 || from[0] == 0)) {
        from = instead;
        most = room;
    }
    size_t count = 0;
    for (; count < most && count < room - 1 && from[count] != 0; count++)
        to[count] = from[count];
    to[count] = 0;
    return count;
}

NATIVE(string_set)
{
    char *to = (char *)POINTER(0);
    const char *from = (const char *)POINTER(1);
    uint64_t room = WORD(2), most = WORD(3);
    if (from == NULL || to == NULL)
        return BAD_ARGUMENT;
    size_t count = 0;
    for (; count < most && count < room && from[count] != 0; count++)
        to[count] = from[count];
    memset(to + count, 0, room - count);
    return count;
}


HIDDEN const NativeRow natives_of_msg[] = {
    {"CFE_MSG_Init", init},
    {"CFE_MSG_GetSize", get_size},
    {"CFE_MSG_SetSize", set_size},
    {"CFE_MSG_GetType", get_type},
    {"CFE_MSG_SetType", set_type},
    {"CFE_MSG_GetHeaderVersion", get_version},
    {"CFE_MSG_SetHeaderVersion", set_version},
    {"CFE_MSG_GetHasSecondaryHeader", get_has_secondary},
    {"CFE_MSG_SetHasSecondaryHeader", set_has_secondary},
    {"CFE_MSG_GetApId", get_ap_id},
    {"CFE_MSG_SetApId", set_ap_id},
    {"CFE_MSG_GetSegmentationFlag", get_segmentation},
    {"CFE_MSG_SetSegmentationFlag", set_segmentation},
    {"CFE_MSG_GetSequenceCount", get_sequence},
    {"CFE_MSG_SetSequenceCount", set_sequence},
    {"CFE_MSG_GetNextSequenceCount", next_sequence},
    {"CFE_MSG_GetMsgId", get_msg_id},
    {"CFE_MSG_SetMsgId", set_msg_id},
    {"CFE_MSG_GetTypeFromMsgId", type_of_id},
    {"CFE_MSG_GetFcnCode", get_function_code},
    {"CFE_MSG_SetFcnCode", set_function_code},
    {"CFE_MSG_GenerateChecksum", generate_checksum},
    {"CFE_MSG_ValidateChecksum", validate_checksum},
    {"CFE_MSG_GetMsgTime", get_time},
    {"CFE_MSG_SetMsgTime", set_time},
    {"CFE_SB_GetUserData", user_data},
    {"CFE_SB_GetUserDataLength", user_data_length},
    {"CFE_SB_SetUserDataLength", set_user_data_length},
    {"CFE_SB_IsValidMsgId", valid_msg_id},
    {"CFE_SB_MessageStringGet", string_get},
    {"CFE_SB_MessageStringSet", string_set},
    {NULL},
};
