// As much of cFE and OSAL as the interface library calls, for one node that flies alone, on whatever computer a compiler
// makes programs for. The Software Bus has one pipe, to which everything that the node subscribed to comes back. Time
// passes while the node waits, and not else; a wait without an end that nothing can end is the end of the program.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <new>
#include <vector>

extern "C" {
#include "cfe.h"
#include "cfe_msgids.h"
#include "cfe_sb_msg.h"
}

#include "../cfe_messages.h"
#include "cfe_stand_in.h"
#include "roscfe/node.h"

extern "C" void NODE_AppMain(void);

extern "C" __attribute__((weak)) void __gcov_dump(); // writes which lines were reached, where that is measured

#if !defined(ROSCFE_PROFILE_HOST)
extern "C" {
void *__real_malloc(std::size_t size);
void  __real_free(void *at);
}
#endif

namespace stand_in
{

void *outside_memory(std::size_t size)
{
#if defined(ROSCFE_PROFILE_HOST)
    return std::malloc(size);
#else
    return __real_malloc(size);
#endif
}

void outside_free(void *at)
{
#if defined(ROSCFE_PROFILE_HOST)
    std::free(at);
#else
    __real_free(at);
#endif
}

} // namespace stand_in

namespace
{

template <class T>
struct Outside
{
    typedef T value_type;

    Outside() = default;
    template <class U>
    Outside(const Outside<U> &)
    {
    }
    T *  allocate(std::size_t count) { return static_cast<T *>(stand_in::outside_memory(count * sizeof(T))); }
    void deallocate(T *at, std::size_t) { stand_in::outside_free(at); }
    template <class U>
    bool operator==(const Outside<U> &) const
    {
        return true;
    }
    template <class U>
    bool operator!=(const Outside<U> &) const
    {
        return false;
    }
};

template <class T>
using Vector = std::vector<T, Outside<T>>;
typedef Vector<std::uint8_t> Packet;

constexpr CFE_ResourceId_t kPipe = {stand_in::kPipe};
constexpr std::int64_t     kSecond = 1000000000, kMillisecond = 1000000;

// The state lives as long as the program, whose end destroys nothing.
struct State
{
    std::int64_t                            now = 100 * kSecond;
    Vector<std::uint32_t>                   subscriptions;
    std::deque<Packet, Outside<Packet>>     pipe;
    std::size_t                             depth   = 0;
    bool                                    reports = false;
    Packet                                  received; // until the next one is, and just as long as it
    Vector<std::uint8_t>                    table;
};

State &state()
{
    alignas(State) static unsigned char memory[sizeof(State)];
    static State *                      made = new (memory) State;
    return *made;
}

using stand_in::set_word;
using stand_in::word;

bool is_subscribed(std::uint32_t id)
{
    for (const std::uint32_t each : state().subscriptions)
    {
        if (each == id)
        {
            return true;
        }
    }
    return false;
}


template <class Report>
Packet packet_of(std::uint32_t id, const Report &report)
{
    Packet packet(sizeof report);
    std::memcpy(packet.data(), &report, sizeof report);
    CFE_MSG_Init(reinterpret_cast<CFE_MSG_Message_t *>(packet.data()), CFE_SB_ValueToMsgId(id), sizeof report);
    return packet;
}

void put(const Packet &packet)
{
    stand_in::put(packet.data(), packet.size());
}

// The list of subscriptions, in as many packets as it takes.
void report_all()
{
    Vector<std::uint32_t> all = state().subscriptions;
    for (std::size_t at = 0; stand_in::other_subscription != nullptr && stand_in::other_subscription(at) != 0; ++at)
    {
        all.push_back(stand_in::other_subscription(at));
    }
    CFE_SB_AllSubscriptionsTlm_t report{};
    for (const std::uint32_t each : all)
    {
        if (report.Payload.Entries == CFE_MISSION_SB_SUB_ENTRIES_PER_PKT || &each == all.data())
        {
            if (&each != all.data())
            {
                put(packet_of(CFE_SB_ALLSUBS_TLM_MID, report));
            }
            ++report.Payload.PktSegment;
            report.Payload.Entries = 0;
        }
        report.Payload.Entry[report.Payload.Entries++].MsgId = CFE_SB_ValueToMsgId(each);
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

// Whether a test wants a function to fail: the value of CFE_FAILS in the environment is its name, and behind a colon how
// many of its calls succeed first.
bool fails(const char *function)
{
    static int        calls  = 0;
    const char *      wanted = std::getenv("CFE_FAILS");
    const std::size_t size   = std::strlen(function);
    if (wanted == nullptr || std::strncmp(wanted, function, size) != 0 || (wanted[size] != '\0' && wanted[size] != ':'))
    {
        return false;
    }
    return calls++ >= (wanted[size] == ':' ? std::atoi(wanted + size + 1) : 0);
}

void print_event(const char *format, std::va_list values)
{
    char text[1024];
    std::vsnprintf(text, sizeof text, format, values);
    if (stand_in::event != nullptr)
    {
        stand_in::event(text);
    }
    else
    {
        std::fprintf(stderr, "%s\n", text);
    }
}

[[noreturn]] void end(int status)
{
    std::fflush(stdout);
    if (__gcov_dump != nullptr)
    {
        __gcov_dump();
    }
    std::_Exit(status);
}

} // namespace

namespace stand_in
{

bool put(const std::uint8_t *packet, std::size_t size)
{
    if (!is_subscribed(word(packet, 0)) || state().pipe.size() >= state().depth)
    {
        return false;
    }
    state().pipe.emplace_back(packet, packet + size);
    return true;
}

void advance(std::int64_t ns)
{
    state().now += ns;
}

} // namespace stand_in

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

// A program alone has one task.
CFE_Status_t CFE_ES_CreateChildTask(CFE_ES_TaskId_t *, const char *, CFE_ES_ChildTaskMainFuncPtr_t,
                                    CFE_ES_StackPointer_t, size_t, CFE_ES_TaskPriority_Atom_t, uint32)
{
    return CFE_ES_ERR_CHILD_TASK_CREATE;
}

void CFE_ES_ExitChildTask(void)
{
    end(3);
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
    print_event(format, values);
    va_end(values);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t *handle, const char *, size_t size, uint16, CFE_TBL_CallbackFuncPtr_t)
{
    *handle = CFE_TBL_Handle_t();
    state().table.assign(size, 0);
    return fails("CFE_TBL_Register") ? CFE_TBL_ERR_REGISTRY_FULL : CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t, CFE_TBL_SrcEnum_t, const void *from)
{
    std::memcpy(state().table.data(), from, state().table.size());
    return fails("CFE_TBL_Load") ? CFE_TBL_ERR_LOAD_IN_PROGRESS : CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t)
{
    const bool loaded = stand_in::load != nullptr &&
                        stand_in::load(reinterpret_cast<char *>(state().table.data()), state().table.size());
    return loaded ? CFE_TBL_INFO_UPDATED : CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Modified(CFE_TBL_Handle_t)
{
    return fails("CFE_TBL_Modified") ? CFE_TBL_ERR_NO_ACCESS : CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_GetAddress(void **address, CFE_TBL_Handle_t)
{
    *address = state().table.data();
    return fails("CFE_TBL_GetAddress") ? CFE_TBL_ERR_NO_ACCESS : CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t)
{
    return CFE_SUCCESS;
}

// -- Software Bus ------------------------------------------------------------------------------------------------------

CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t *pipe, uint16 depth, const char *)
{
    *pipe   = kPipe;
    state().depth = depth;
    return fails("CFE_SB_CreatePipe") ? CFE_SB_MAX_PIPES_MET : CFE_SUCCESS;
}

CFE_Status_t CFE_SB_GetPipeName(char *name, size_t size, CFE_SB_PipeId_t pipe)
{
    const auto id = static_cast<std::uint32_t>(CFE_RESOURCEID_TO_ULONG(pipe));
    if (id != stand_in::kPipe && stand_in::has_pipe != nullptr && !stand_in::has_pipe(id))
    {
        return CFE_SB_BAD_ARGUMENT;
    }
    std::snprintf(name, size, id == stand_in::kPipe ? "NODE_PIPE" : "P%08lX", static_cast<unsigned long>(id));
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_SubscribeEx(CFE_SB_MsgId_t id, CFE_SB_PipeId_t, CFE_SB_Qos_t, uint16)
{
    if (fails("CFE_SB_SubscribeEx"))
    {
        return CFE_SB_MAX_MSGS_MET;
    }
    if (!is_subscribed(id.Value))
    {
        state().subscriptions.push_back(id.Value);
        if (state().reports)
        {
            report_one(id.Value);
        }
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_Unsubscribe(CFE_SB_MsgId_t id, CFE_SB_PipeId_t)
{
    for (std::size_t at = 0; at < state().subscriptions.size(); ++at)
    {
        if (state().subscriptions[at] == id.Value)
        {
            state().subscriptions.erase(state().subscriptions.begin() + static_cast<std::ptrdiff_t>(at));
            break;
        }
    }
    return CFE_SUCCESS;
}

void CFE_SB_TimeStampMsg(CFE_MSG_Message_t *) {}

CFE_SB_Buffer_t *CFE_SB_AllocateMessageBuffer(size_t size)
{
    if (fails("CFE_SB_AllocateMessageBuffer"))
    {
        return nullptr;
    }
    // cFE's memory is not cleared either.
    return static_cast<CFE_SB_Buffer_t *>(std::memset(stand_in::outside_memory(size), 0xA5, size));
}

CFE_Status_t CFE_SB_ReleaseMessageBuffer(CFE_SB_Buffer_t *buffer)
{
    stand_in::outside_free(buffer);
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_TransmitBuffer(CFE_SB_Buffer_t *buffer, bool)
{
    if (fails("CFE_SB_TransmitBuffer"))
    {
        return CFE_SB_MSG_TOO_BIG;
    }
    static std::uint16_t counts[0x2000];
    const std::uint8_t * bytes = reinterpret_cast<const std::uint8_t *>(buffer);
    const unsigned       id    = word(bytes, 0);
    set_word(buffer, 2, (word(bytes, 2) & 0xC000) | (counts[id & 0x1FFF]++ & 0x3FFF));
    const Packet packet(bytes, bytes + word(bytes, 4) + 7);
    stand_in::outside_free(buffer);
    if (stand_in::sent != nullptr && stand_in::sent(packet.data(), packet.size()))
    {
        return CFE_SUCCESS;
    }
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
        state().reports = packet[6] == CFE_SB_ENABLE_SUB_REPORTING_CC;
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t **buffer, CFE_SB_PipeId_t, int32 wait_ms)
{
    if (state().pipe.empty() && stand_in::fill != nullptr)
    {
        stand_in::fill();
    }
    if (state().pipe.empty())
    {
        if (wait_ms == CFE_SB_POLL)
        {
            return CFE_SB_NO_MESSAGE;
        }
        if (wait_ms == CFE_SB_PEND_FOREVER)
        {
            end(0);
        }
        state().now += wait_ms * kMillisecond;
        return CFE_SB_TIME_OUT;
    }
    state().received.~Packet(); // what still points to it is wrong
    new (&state().received) Packet(std::move(state().pipe.front()));
    state().pipe.pop_front();
    *buffer = reinterpret_cast<CFE_SB_Buffer_t *>(state().received.data());
    return CFE_SUCCESS;
}

// -- OSAL --------------------------------------------------------------------------------------------------------------

int32 OS_GetLocalTime(OS_time_t *time)
{
    *time = OS_TimeFromTotalNanoseconds(state().now);
    return OS_SUCCESS;
}

int32 OS_TaskDelay(uint32 milliseconds)
{
    state().now += milliseconds * kMillisecond;
    return OS_SUCCESS;
}

void OS_printf(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    std::vprintf(format, values);
    va_end(values);
}

int32 OS_QueueGetIdByName(osal_id_t *id, const char *name)
{
    *id = 0x00020001;
    return stand_in::has_queue != nullptr && stand_in::has_queue(name, 0) ? OS_SUCCESS : OS_ERR_NAME_NOT_FOUND;
}

int32 OS_QueueGetInfo(osal_id_t id, OS_queue_prop_t *)
{
    return stand_in::has_queue != nullptr && stand_in::has_queue(nullptr, id) ? OS_SUCCESS : OS_ERR_INVALID_ID;
}

int32 OS_CondVarCreate(osal_id_t *id, const char *, uint32)
{
    *id = 0x000F0001;
    return fails("OS_CondVarCreate") ? OS_ERR_NO_FREE_IDS : OS_SUCCESS;
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

int32 OS_CondVarWait(osal_id_t)
{
    return OS_ERROR; // there is one task, which nobody could wake
}

int32 OS_CondVarBroadcast(osal_id_t)
{
    return OS_SUCCESS;
}

osal_id_t OS_TaskGetId(void)
{
    return 0x00010001;
}

int32 OS_TaskGetInfo(osal_id_t, OS_task_prop_t *)
{
    return OS_SUCCESS;
}

int32 OS_CondVarTimedWait(osal_id_t, const OS_time_t *until)
{
    const std::int64_t ns = OS_TimeGetTotalNanoseconds(*until);
    state().now                 = ns > state().now ? ns : state().now;
    return OS_ERROR_TIMEOUT;
}

} // extern "C"
