// As much of cFE and OSAL as the interface library calls, for one node that flies alone, on whatever computer a compiler
// makes programs for. The Software Bus has one pipe, to which everything that the node subscribed to comes back. Time
// passes while the node waits, and not else; a wait without an end that nothing can end is the end of the program.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

extern "C" {
#include "cfe.h"
#include "cfe_msgids.h"
#include "cfe_sb_msg.h"
}

#include "roscfe/node.h"

extern "C" void NODE_AppMain(void);

namespace
{

typedef std::vector<std::uint8_t> Packet;

constexpr CFE_ResourceId_t kPipe = {0x00030001};
constexpr std::int64_t     kSecond = 1000000000, kMillisecond = 1000000;

std::int64_t               g_now = 100 * kSecond;
std::vector<std::uint32_t> g_subscriptions;
std::deque<Packet>         g_pipe;
std::size_t                g_depth   = 0;
bool                       g_reports = false;
Packet                     g_received; // until the next one is
std::vector<std::uint8_t>  g_table;

// Bytes of a header: the stream id, the sequence, the length, all with the high byte first.
std::uint8_t *bytes_of(void *message)
{
    return static_cast<std::uint8_t *>(message);
}

unsigned word(const void *message, int at)
{
    const std::uint8_t *bytes = static_cast<const std::uint8_t *>(message) + at;
    return static_cast<unsigned>(bytes[0] << 8 | bytes[1]);
}

void set_word(void *message, int at, unsigned value)
{
    bytes_of(message)[at]     = static_cast<std::uint8_t>(value >> 8);
    bytes_of(message)[at + 1] = static_cast<std::uint8_t>(value);
}

bool is_subscribed(std::uint32_t id)
{
    for (const std::uint32_t each : g_subscriptions)
    {
        if (each == id)
        {
            return true;
        }
    }
    return false;
}

void put(const Packet &packet)
{
    if (is_subscribed(word(packet.data(), 0)) && g_pipe.size() < g_depth)
    {
        g_pipe.push_back(packet);
    }
}

template <class Report>
Packet packet_of(std::uint32_t id, const Report &report)
{
    Packet packet(sizeof report);
    std::memcpy(packet.data(), &report, sizeof report);
    CFE_MSG_Init(reinterpret_cast<CFE_MSG_Message_t *>(packet.data()), CFE_SB_ValueToMsgId(id), sizeof report);
    return packet;
}

void report_all()
{
    CFE_SB_AllSubscriptionsTlm_t report{};
    for (const std::uint32_t each : g_subscriptions)
    {
        auto &entry = report.Payload.Entry[report.Payload.Entries++];
        entry.MsgId = CFE_SB_ValueToMsgId(each);
    }
    put(packet_of(CFE_SB_ALLSUBS_TLM_MID, report));
}

void report_one(std::uint32_t id)
{
    CFE_SB_SingleSubscriptionTlm_t report{};
    report.Payload.SubType = CFE_SB_SUBSCRIPTION;
    report.Payload.MsgId   = CFE_SB_ValueToMsgId(id);
    report.Payload.Pipe    = kPipe;
    put(packet_of(CFE_SB_ONESUB_TLM_MID, report));
}

// Whether a test wants a function to fail: its name is the value of CFE_FAILS in the environment.
bool fails(const char *function)
{
    const char *wanted = std::getenv("CFE_FAILS");
    return wanted != nullptr && std::strcmp(wanted, function) == 0;
}

[[noreturn]] void end(int status)
{
    std::fflush(stdout);
    std::_Exit(status);
}

} // namespace

int main()
{
    NODE_AppMain();
    return 4; // it does not return
}

extern "C" {

// -- Executive Services, Event Services, Tables ------------------------------------------------------------------------

bool CFE_ES_RunLoop(uint32 *)
{
    return true;
}

CFE_Status_t CFE_ES_GetAppID(CFE_ES_AppId_t *id)
{
    *id = CFE_ES_AppId_t();
    return CFE_SUCCESS;
}

CFE_Status_t CFE_ES_RestartApp(CFE_ES_AppId_t)
{
    return CFE_SUCCESS;
}

void CFE_ES_ExitApp(uint32 status)
{
    end(status == CFE_ES_RunStatus_APP_EXIT ? 0 : 3);
}

void CFE_ES_PerfLogAdd(uint32, uint32) {}

CFE_Status_t CFE_ES_WriteToSysLog(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    std::vfprintf(stderr, format, values);
    va_end(values);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_EVS_Register(const void *, uint16, uint16)
{
    return fails("CFE_EVS_Register") ? CFE_EVS_APP_NOT_REGISTERED : CFE_SUCCESS;
}

CFE_Status_t CFE_EVS_SendEvent(uint16, CFE_EVS_EventType_Enum_t, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    std::vfprintf(stderr, format, values);
    va_end(values);
    std::fputc('\n', stderr);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t *handle, const char *, size_t size, uint16, CFE_TBL_CallbackFuncPtr_t)
{
    *handle = CFE_TBL_Handle_t();
    g_table.assign(size, 0);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t, CFE_TBL_SrcEnum_t, const void *from)
{
    std::memcpy(g_table.data(), from, g_table.size());
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t)
{
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Modified(CFE_TBL_Handle_t)
{
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_GetAddress(void **address, CFE_TBL_Handle_t)
{
    *address = g_table.data();
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t)
{
    return CFE_SUCCESS;
}

// -- messages ----------------------------------------------------------------------------------------------------------

CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t *message, CFE_SB_MsgId_t id, CFE_MSG_Size_t size)
{
    const std::size_t header = (id.Value & 0x1000) != 0 ? 8 : 12;
    std::memset(message, 0, size < header ? size : header);
    set_word(message, 0, id.Value);
    set_word(message, 2, 0xC000);
    set_word(message, 4, static_cast<unsigned>(size - 7));
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
    bytes_of(message)[6] = static_cast<std::uint8_t>(code);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetFcnCode(const CFE_MSG_Message_t *message, CFE_MSG_FcnCode_t *code)
{
    *code = static_cast<CFE_MSG_FcnCode_t>(word(message, 6) >> 8 & 0x7F);
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
    const unsigned bits = static_cast<unsigned>(flag - CFE_MSG_SegFlag_Continue);
    set_word(message, 2, (word(message, 2) & 0x3FFF) | bits << 14);
    return CFE_SUCCESS;
}

// -- Software Bus ------------------------------------------------------------------------------------------------------

CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t *pipe, uint16 depth, const char *)
{
    *pipe   = kPipe;
    g_depth = depth;
    return fails("CFE_SB_CreatePipe") ? CFE_SB_MAX_PIPES_MET : CFE_SUCCESS;
}

CFE_Status_t CFE_SB_GetPipeName(char *name, size_t size, CFE_SB_PipeId_t)
{
    std::snprintf(name, size, "NODE_PIPE");
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_SubscribeEx(CFE_SB_MsgId_t id, CFE_SB_PipeId_t, CFE_SB_Qos_t, uint16)
{
    if (fails("CFE_SB_SubscribeEx") && (id.Value & 0xFF00) == 0x0A00)
    {
        return CFE_SB_MAX_MSGS_MET;
    }
    if (!is_subscribed(id.Value))
    {
        g_subscriptions.push_back(id.Value);
        if (g_reports)
        {
            report_one(id.Value);
        }
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_Unsubscribe(CFE_SB_MsgId_t id, CFE_SB_PipeId_t)
{
    for (std::size_t at = 0; at < g_subscriptions.size(); ++at)
    {
        if (g_subscriptions[at] == id.Value)
        {
            g_subscriptions.erase(g_subscriptions.begin() + static_cast<std::ptrdiff_t>(at));
            break;
        }
    }
    return CFE_SUCCESS;
}

void CFE_SB_TimeStampMsg(CFE_MSG_Message_t *) {}

CFE_SB_Buffer_t *CFE_SB_AllocateMessageBuffer(size_t size)
{
    return static_cast<CFE_SB_Buffer_t *>(std::calloc(1, size));
}

CFE_Status_t CFE_SB_ReleaseMessageBuffer(CFE_SB_Buffer_t *buffer)
{
    std::free(buffer);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_TransmitBuffer(CFE_SB_Buffer_t *buffer, bool)
{
    static std::uint16_t counts[0x2000];
    const std::uint8_t * bytes = bytes_of(buffer);
    const unsigned       id    = word(bytes, 0);
    set_word(buffer, 2, (word(bytes, 2) & 0xC000) | (counts[id & 0x1FFF]++ & 0x3FFF));
    const Packet packet(bytes, bytes + word(bytes, 4) + 7);
    std::free(buffer);
    if (id != CFE_SB_SUB_RPT_CTRL_MID)
    {
        put(packet);
    }
    else if (packet[6] == CFE_SB_SEND_PREV_SUBS_CC)
    {
        report_all();
    }
    else
    {
        g_reports = packet[6] == CFE_SB_ENABLE_SUB_REPORTING_CC;
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t **buffer, CFE_SB_PipeId_t, int32 wait_ms)
{
    if (g_pipe.empty())
    {
        if (wait_ms == CFE_SB_POLL)
        {
            return CFE_SB_NO_MESSAGE;
        }
        if (wait_ms == CFE_SB_PEND_FOREVER)
        {
            end(0);
        }
        g_now += wait_ms * kMillisecond;
        return CFE_SB_TIME_OUT;
    }
    g_received = g_pipe.front();
    g_pipe.pop_front();
    *buffer = reinterpret_cast<CFE_SB_Buffer_t *>(g_received.data());
    return CFE_SUCCESS;
}

// -- OSAL --------------------------------------------------------------------------------------------------------------

int32 OS_GetLocalTime(OS_time_t *time)
{
    *time = OS_TimeFromTotalNanoseconds(g_now);
    return OS_SUCCESS;
}

int32 OS_TaskDelay(uint32 milliseconds)
{
    g_now += milliseconds * kMillisecond;
    return OS_SUCCESS;
}

void OS_printf(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    std::vprintf(format, values);
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
    *id = 0x000F0001;
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
    const std::int64_t ns = OS_TimeGetTotalNanoseconds(*until);
    g_now                 = ns > g_now ? ns : g_now;
    return OS_ERROR_TIMEOUT;
}

} // extern "C"
