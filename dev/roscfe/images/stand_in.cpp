// cFE's and OSAL's calls of the stand-in.
#include "stand_in.h"

#include <cstdarg>
#include <cstring>

extern "C" {
#include "cfe.h"
#include "cfe_msgids.h"
#include "cfe_sb_msg.h"
}

#include "../cfe_messages.h"
#include "roscfe/format.h"
#include "tasks.h"

namespace stand_in
{

namespace
{

constexpr std::size_t kBufferBytes = 512;
constexpr int         kBuffers     = 48;
constexpr int         kMostTopics  = 16; // subscriptions of a pipe
constexpr int         kDepth       = 8;
constexpr std::int64_t kMillisecond = 1000000;

struct Buffer
{
    alignas(8) std::uint8_t bytes[kBufferBytes];
    int users; // pipes that hold it, and whoever writes it
};

struct Pipe
{
    char          name[OS_MAX_API_NAME];
    bool          is_open;
    int           topic_count, count, head;
    std::uint32_t topics[kMostTopics];
    Buffer *      waiting[kDepth];
    Buffer *      held; // by the task that has received it
};

Buffer        g_buffers[kBuffers];
Pipe          g_pipes[kMostTasks];
bool          g_reports  = false;
std::uint32_t g_sent     = 0;
std::uint32_t g_received = 0;
std::uint32_t g_lost     = 0;

CFE_SB_PipeId_t id_of(int pipe)
{
    return CFE_SB_PIPEID_C(CFE_ResourceId_FromInteger(0x00030001U + static_cast<std::uint32_t>(pipe)));
}

int index_of(CFE_SB_PipeId_t id)
{
    const std::uint32_t index = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(id)) - 0x00030001U;
    return index < kMostTasks && g_pipes[index].is_open ? static_cast<int>(index) : -1;
}

bool hears(const Pipe &pipe, std::uint32_t topic)
{
    for (int i = 0; i < pipe.topic_count; ++i)
    {
        if (pipe.topics[i] == topic)
        {
            return true;
        }
    }
    return false;
}

void put(Buffer &buffer)
{
    for (Pipe &pipe : g_pipes)
    {
        if (!pipe.is_open || !hears(pipe, word(buffer.bytes, 0)))
        {
            continue;
        }
        if (pipe.count == kDepth)
        {
            ++g_lost;
            continue;
        }
        pipe.waiting[(pipe.head + pipe.count++) % kDepth] = &buffer;
        ++buffer.users;
        wake(&pipe);
    }
    --buffer.users;
}

Buffer *free_buffer(std::size_t size)
{
    for (Buffer &each : g_buffers)
    {
        if (each.users == 0 && size <= sizeof each.bytes)
        {
            std::memset(each.bytes, 0, sizeof each.bytes);
            each.users = 1;
            return &each;
        }
    }
    return nullptr;
}

template <class Report>
Report *report(std::uint32_t id, Buffer *&buffer)
{
    static_assert(sizeof(Report) <= kBufferBytes, "a report has room in a buffer");
    buffer = free_buffer(sizeof(Report));
    if (buffer == nullptr)
    {
        return nullptr;
    }
    auto *made = reinterpret_cast<Report *>(buffer->bytes);
    CFE_MSG_Init(reinterpret_cast<CFE_MSG_Message_t *>(buffer->bytes), CFE_SB_ValueToMsgId(id), sizeof(Report));
    return made;
}

void report_one(std::uint32_t topic, int pipe)
{
    Buffer *buffer = nullptr;
    auto *  made   = report<CFE_SB_SingleSubscriptionTlm_t>(CFE_SB_ONESUB_TLM_MID, buffer);
    if (made != nullptr)
    {
        made->Payload.SubType = CFE_SB_SUBSCRIPTION;
        made->Payload.MsgId   = CFE_SB_ValueToMsgId(topic);
        made->Payload.Pipe    = id_of(pipe);
        put(*buffer);
    }
}

void report_all()
{
    Buffer *buffer = nullptr;
    auto *  made   = report<CFE_SB_AllSubscriptionsTlm_t>(CFE_SB_ALLSUBS_TLM_MID, buffer);
    if (made == nullptr)
    {
        return;
    }
    made->Payload.PktSegment = 1;
    for (int i = 0; i < kMostTasks; ++i)
    {
        for (int topic = 0; topic < g_pipes[i].topic_count && made->Payload.Entries < CFE_MISSION_SB_SUB_ENTRIES_PER_PKT; ++topic)
        {
            made->Payload.Entry[made->Payload.Entries++].MsgId = CFE_SB_ValueToMsgId(g_pipes[i].topics[topic]);
        }
    }
    put(*buffer);
}

void print(const char *form, std::va_list values)
{
    static char text[256];
    roscfe::format::print(text, sizeof text, form, values);
    write(text);
}

void say(const char *form, ...)
{
    std::va_list values;
    va_start(values, form);
    print(form, values);
    va_end(values);
}

} // namespace

void fly()
{
    begin_tasks();
    while (run_next())
    {
    }
    say("%lu packets sent, %lu received, %lu lost\n", static_cast<unsigned long>(g_sent), static_cast<unsigned long>(g_received),
        static_cast<unsigned long>(g_lost));
    for (int i = 0; i < kAppCount; ++i)
    {
        say("%s: %lu bytes of its stack\n", kApps[i].name, static_cast<unsigned long>(stack_used(i)));
    }
    stop(0);
}

} // namespace stand_in

using namespace stand_in;

extern "C" {

// -- Executive Services and Event Services -----------------------------------------------------------------------------

bool CFE_ES_RunLoop(uint32 *)
{
    return now() < kFlight;
}

void CFE_ES_ExitApp(uint32 status)
{
    say("%s ends with %lu\n", kApps[current_task()].name, static_cast<unsigned long>(status));
    end_task();
}

CFE_Status_t CFE_ES_WriteToSysLog(const char *, ...)
{
    return CFE_SUCCESS;
}

CFE_Status_t CFE_EVS_Register(const void *, uint16, uint16)
{
    return CFE_SUCCESS;
}

CFE_Status_t CFE_EVS_SendEvent(uint16 id, CFE_EVS_EventType_Enum_t, const char *form, ...)
{
    std::va_list values;
    va_start(values, form);
    say("%s %u: ", kApps[current_task()].name, static_cast<unsigned>(id));
    print(form, values);
    write("\n");
    va_end(values);
    return CFE_SUCCESS;
}

// -- Software Bus ------------------------------------------------------------------------------------------------------

CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t *id, uint16, const char *name)
{
    const int index = current_task();
    std::strncpy(g_pipes[index].name, name, sizeof g_pipes[index].name - 1);
    g_pipes[index].is_open = true;
    *id                    = id_of(index);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_GetPipeName(char *name, size_t size, CFE_SB_PipeId_t id)
{
    const int index = index_of(id);
    if (index < 0)
    {
        return CFE_SB_BAD_ARGUMENT;
    }
    std::strncpy(name, g_pipes[index].name, size - 1);
    name[size - 1] = '\0';
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_SubscribeEx(CFE_SB_MsgId_t id, CFE_SB_PipeId_t of, CFE_SB_Qos_t, uint16)
{
    const int index = index_of(of);
    if (index < 0 || g_pipes[index].topic_count == kMostTopics)
    {
        return CFE_SB_BAD_ARGUMENT;
    }
    Pipe &pipe = g_pipes[index];
    if (!hears(pipe, CFE_SB_MsgIdToValue(id)))
    {
        pipe.topics[pipe.topic_count++] = CFE_SB_MsgIdToValue(id);
        if (g_reports)
        {
            report_one(CFE_SB_MsgIdToValue(id), index);
        }
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_Unsubscribe(CFE_SB_MsgId_t id, CFE_SB_PipeId_t of)
{
    const int index = index_of(of);
    for (int i = 0; index >= 0 && i < g_pipes[index].topic_count; ++i)
    {
        if (g_pipes[index].topics[i] == CFE_SB_MsgIdToValue(id))
        {
            g_pipes[index].topics[i] = g_pipes[index].topics[--g_pipes[index].topic_count];
            return CFE_SUCCESS;
        }
    }
    return CFE_SB_BAD_ARGUMENT;
}

CFE_SB_Buffer_t *CFE_SB_AllocateMessageBuffer(size_t size)
{
    Buffer *buffer = free_buffer(size);
    return buffer != nullptr ? reinterpret_cast<CFE_SB_Buffer_t *>(buffer->bytes) : nullptr;
}

CFE_Status_t CFE_SB_ReleaseMessageBuffer(CFE_SB_Buffer_t *buffer)
{
    --reinterpret_cast<Buffer *>(buffer)->users;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_TransmitBuffer(CFE_SB_Buffer_t *given, bool)
{
    Buffer &            buffer = *reinterpret_cast<Buffer *>(given);
    const std::uint32_t id     = word(buffer.bytes, 0);
    const std::uint8_t  code   = buffer.bytes[6];
    if (id != CFE_SB_SUB_RPT_CTRL_MID)
    {
        ++g_sent;
        put(buffer);
        return CFE_SUCCESS;
    }
    --buffer.users;
    if (code == CFE_SB_SEND_PREV_SUBS_CC)
    {
        report_all();
    }
    else
    {
        g_reports = code == CFE_SB_ENABLE_SUB_REPORTING_CC;
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t **given, CFE_SB_PipeId_t id, int32 wait_ms)
{
    Pipe &pipe = g_pipes[index_of(id)];
    if (pipe.held != nullptr)
    {
        --pipe.held->users;
        pipe.held = nullptr;
    }
    if (pipe.count == 0 && wait_ms == CFE_SB_POLL)
    {
        return CFE_SB_NO_MESSAGE;
    }
    if (pipe.count == 0)
    {
        wait(wait_ms == CFE_SB_PEND_FOREVER ? kNever : now() + wait_ms * kMillisecond, &pipe);
    }
    if (pipe.count == 0)
    {
        return CFE_SB_TIME_OUT;
    }
    pipe.held = pipe.waiting[pipe.head];
    pipe.head = (pipe.head + 1) % kDepth;
    --pipe.count;
    ++g_received;
    *given = reinterpret_cast<CFE_SB_Buffer_t *>(pipe.held->bytes);
    return CFE_SUCCESS;
}

// -- OSAL --------------------------------------------------------------------------------------------------------------

int32 OS_GetLocalTime(OS_time_t *time)
{
    *time = OS_TimeFromTotalNanoseconds(now());
    return OS_SUCCESS;
}

int32 OS_TaskDelay(uint32 milliseconds)
{
    wait(now() + milliseconds * kMillisecond);
    return OS_SUCCESS;
}

void OS_printf(const char *form, ...)
{
    std::va_list values;
    va_start(values, form);
    print(form, values);
    va_end(values);
}

int32 OS_QueueGetIdByName(osal_id_t *, const char *)
{
    return OS_ERR_NAME_NOT_FOUND;
}

int32 OS_QueueGetInfo(osal_id_t, OS_queue_prop_t *)
{
    return OS_ERR_INVALID_ID;
}

int32 OS_CondVarCreate(osal_id_t *id, const char *, uint32)
{
    *id = OS_ObjectIdFromInteger(0x000F0001U + static_cast<std::uint32_t>(current_task()));
    return OS_SUCCESS;
}

int32 OS_CondVarGetIdByName(osal_id_t *, const char *)
{
    return OS_ERR_NAME_NOT_FOUND;
}

int32 OS_CondVarDelete(osal_id_t)
{
    return OS_SUCCESS;
}

int32 OS_CondVarLock(osal_id_t)
{
    return OS_SUCCESS;
}

int32 OS_CondVarUnlock(osal_id_t)
{
    return OS_SUCCESS;
}

int32 OS_CondVarTimedWait(osal_id_t, const OS_time_t *until)
{
    wait(OS_TimeGetTotalNanoseconds(*until));
    return OS_ERROR_TIMEOUT;
}

} // extern "C"
