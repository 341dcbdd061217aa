// The life of a node: from the application's entry point to its end.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <unistd.h>

#include "internal.h"
#include "ros/init.h"
#include "ros/names.h"
#include "ros/rate.h"
#include "ros/time.h"
#include "roscfe/heap.h"
#include "roscfe/refuse.h"

namespace roscfe
{

Node g_node;

namespace
{

int (*g_main_with_arguments)(int, char **) = nullptr;
int (*g_main)()                            = nullptr;
constexpr int kMostArguments               = 64;
constexpr int kRefused                     = 134; // exit status of a program that aborts

// cfepy looks after its nodes as roslaunch does: one that ends by itself may be required, or is started again.
void tell_end(int status)
{
    static bool               is_told = false; // what ends the node on the way does not tell it again
    std::vector<std::uint8_t> answer;
    if (is_told || !g_node.has_master || g_node.asked_to_end)
    {
        return;
    }
    is_told         = true;
    const bool told = call_master(kEnded, g_node.description->app, std::to_string(status).c_str(), "", "", answer);
    if (!told || answer.size() < 5 || answer[0] == 0)
    {
        return;
    }
    CFE_ES_AppId_t app;
    const auto     delay_ms = static_cast<std::uint32_t>(answer[1]) | static_cast<std::uint32_t>(answer[2]) << 8 |
                          static_cast<std::uint32_t>(answer[3]) << 16 | static_cast<std::uint32_t>(answer[4]) << 24;
    OS_TaskDelay(delay_ms);
    std::uint32_t run = CFE_ES_RunStatus_APP_RUN;
    CFE_ES_RunLoop(&run); // ES restarts what it has seen running
    if (CFE_ES_GetAppID(&app) == CFE_SUCCESS)
    {
        CFE_ES_RestartApp(app); // takes place when the task has ended
    }
}

[[noreturn]] void end(int exit_status)
{
    heap::unseal();
    tell_end(exit_status);
    const std::uint32_t status = exit_status == 0 ? CFE_ES_RunStatus_APP_EXIT : CFE_ES_RunStatus_APP_ERROR;
    g_node.ended               = true;
    end_exact_waits();
    for (;;)
    {
        CFE_ES_ExitApp(status); // ends the task
    }
}

[[noreturn]] void run_main()
{
    static char *arguments[kMostArguments + 2];
    int          count = 0;
    arguments[count++] = const_cast<char *>(g_node.description->app);
    for (int i = 0; i < g_node.description->arg_count && i < kMostArguments; ++i)
    {
        arguments[count++] = const_cast<char *>(g_node.description->args[i]);
    }
    end(g_main != nullptr ? g_main() : g_main_with_arguments(count, arguments));
}

[[noreturn]] void run_node(const NodeDescription &node)
{
    g_node.description = &node;
    g_node.ns          = node.ns;
    CFE_EVS_Register(nullptr, 0, CFE_EVS_EventFilter_BINARY);
    run_main();
}

} // namespace

void run(const NodeDescription &node, int (*main_function)(int, char **))
{
    g_main_with_arguments = main_function;
    run_node(node);
}

void run(const NodeDescription &node, int (*main_function)())
{
    g_main = main_function;
    run_node(node);
}

void open()
{
    static bool is_open = false;
    if (!is_open)
    {
        is_open = true;
        open_bus();
        open_parameters();
    }
}

void own_name(char (&name)[OS_MAX_API_NAME], const char *end, const char *short_end)
{
    const char *app  = g_node.description->app;
    const bool  fits = std::strlen(app) + std::strlen(end) < sizeof name;
    std::snprintf(name, sizeof name, "%.17s%s", app, fits ? end : short_end);
}

void refuse(const char *what, const char *detail)
{
    const char *who = g_node.description != nullptr ? g_node.description->app : "roscfe";
    CFE_EVS_SendEvent(kRefusedEid, CFE_EVS_EventType_CRITICAL, "%s: %s: %s", who, what, detail);
    end(kRefused);
}

} // namespace roscfe

namespace ros
{

namespace
{

using roscfe::g_node;

void remap(const std::string &from, const std::string &to)
{
    g_node.remappings[names::resolve(g_node.ns, from, false)] = names::resolve(g_node.ns, to, false);
}

void initialize(const std::string &name, std::uint32_t options)
{
    if (g_node.initialized)
    {
        return;
    }
    std::string given = *g_node.description->name != '\0' ? g_node.description->name : name;
    // Where MsgIds are compiled in, those of private names go with the plain name.
    const bool has_ids = g_node.description->topic_count > 0 || g_node.description->service_count > 0;
    if ((options & init_options::AnonymousName) != 0 && *g_node.description->name == '\0' && !has_ids)
    {
        given += "_" + std::to_string(roscfe::now_ns());
    }
    if (given.find('/') != std::string::npos)
    {
        roscfe::refuse("a node's name has no slash", given.c_str());
    }
    g_node.initialized = true;
    g_node.name        = names::append(g_node.ns == "/" ? "" : g_node.ns, given);
    if (g_node.name[0] != '/')
    {
        g_node.name = "/" + g_node.name;
    }
    for (int i = 0; i < g_node.description->remap_count; ++i)
    {
        remap(g_node.description->remaps[i].from, g_node.description->remaps[i].to);
    }
}

// "from:=to", "_param:=value", and "__name:=name", which the convertor has read.
bool is_remapping(const char *argument)
{
    return std::strstr(argument, ":=") != nullptr;
}

// "_param:=value": the value is a number or a truth value, if it is one, as in roscpp.
void set_private(const std::string &name, const char *value)
{
    const std::string full  = names::append(g_node.name, name);
    char *            end   = nullptr;
    const bool        plain = *value != '\0' && *value != ' ';
    const long        whole = std::strtol(value, &end, 10);
    if (plain && *end == '\0' && whole >= INT32_MIN && whole <= INT32_MAX)
    {
        param::set(full, static_cast<int>(whole));
        return;
    }
    // As in roscpp no hexadecimal number, nor one that a double cannot hold, though strtod reads both.
    const double number  = std::strtod(value, &end);
    const bool   is_word = std::strpbrk(value, "nN") != nullptr; // inf or nan
    if (plain && *end == '\0' && std::strpbrk(value, "xX") == nullptr && (is_word || !std::isinf(number)))
    {
        param::set(full, number);
        return;
    }
    for (const char *word : {"true", "True", "TRUE", "false", "False", "FALSE"})
    {
        if (std::strcmp(value, word) == 0)
        {
            param::set(full, word[0] == 't' || word[0] == 'T');
            return;
        }
    }
    param::set(full, value);
}

} // namespace

void init(int &argc, char **argv, const std::string &name, std::uint32_t options)
{
    initialize(name, options);
    int kept = 0;
    for (int i = 0; i < argc; ++i)
    {
        const char *mark = i > 0 ? std::strstr(argv[i], ":=") : nullptr;
        if (mark == nullptr)
        {
            argv[kept++] = argv[i];
        }
        else if (argv[i][0] != '_')
        {
            remap(std::string(argv[i], static_cast<std::size_t>(mark - argv[i])), mark + 2);
        }
        else if (argv[i][1] != '_')
        {
            set_private(std::string(argv[i] + 1, static_cast<std::size_t>(mark - argv[i] - 1)), mark + 2);
        }
    }
    argc = kept;
    argv[argc] = nullptr;
}

void init(const M_string &remappings, const std::string &name, std::uint32_t options)
{
    initialize(name, options);
    for (const auto &each : remappings)
    {
        remap(each.first, each.second);
    }
}

void init(const VP_string &remappings, const std::string &name, std::uint32_t options)
{
    initialize(name, options);
    for (const auto &each : remappings)
    {
        remap(each.first, each.second);
    }
}

bool isInitialized()
{
    return g_node.initialized;
}

bool isStarted()
{
    return g_node.started && !g_node.shutting_down;
}

bool isShuttingDown()
{
    return g_node.shutting_down;
}

void start()
{
    if (g_node.started)
    {
        return;
    }
    if (!g_node.initialized)
    {
        roscfe::refuse("You must call ros::init() before creating the first NodeHandle", g_node.description->app);
    }
    g_node.started = true;
    roscfe::open();
    roscfe::open_clock();
    CFE_EVS_SendEvent(roscfe::kStartedEid, CFE_EVS_EventType_INFORMATION, "%s started", g_node.name.c_str());
}

void shutdown()
{
    g_node.shutting_down = true;
    g_node.is_shut       = true;
}

// In roscpp a thread shuts down then, a little later: until then the node is on the graph.
void requestShutdown()
{
    g_node.shutting_down = true;
}

bool ok()
{
    if (!g_node.shutting_down)
    {
        std::uint32_t status = CFE_ES_RunStatus_APP_RUN;
        if (!CFE_ES_RunLoop(&status))
        {
            g_node.asked_to_end = true;
            shutdown();
            roscfe::call_handler_of_end();
        }
    }
    return !g_node.shutting_down;
}

void waitForShutdown()
{
    while (ok())
    {
        WallDuration(0.5).sleep();
    }
}

void removeROSArgs(int argc, const char *const *argv, V_string &args)
{
    args.clear();
    for (int i = 0; i < argc; ++i)
    {
        if (!is_remapping(argv[i]))
        {
            args.push_back(argv[i]);
        }
    }
}

std::string getROSArg(int argc, const char *const *argv, const std::string &arg)
{
    const std::string lead = arg + ":=";
    for (int i = 0; i < argc; ++i)
    {
        if (std::strncmp(argv[i], lead.c_str(), lead.size()) == 0)
        {
            return argv[i] + lead.size();
        }
    }
    return std::string();
}

} // namespace ros

// -- functions of C that a node would block or end the processor with; the linker puts these in their place (--wrap) ---

extern "C" {

[[noreturn]] void __wrap_exit(int status)
{
    CFE_EVS_SendEvent(roscfe::kStartedEid, CFE_EVS_EventType_INFORMATION, "%s: exit(%d)", roscfe::g_node.name.c_str(),
                      status);
    roscfe::end(status);
}

[[noreturn]] void __wrap_abort()
{
    roscfe::refuse("abort", roscfe::g_node.name.c_str());
}

unsigned int __wrap_sleep(unsigned int seconds)
{
    roscfe::wait_until(roscfe::now_ns() + seconds * roscfe::kSecond);
    return 0;
}

int __wrap_usleep(useconds_t microseconds)
{
    roscfe::wait_until(roscfe::now_ns() + static_cast<std::int64_t>(microseconds) * 1000);
    return 0;
}

int __wrap_nanosleep(const struct timespec *request, struct timespec *rest)
{
    roscfe::wait_until(roscfe::now_ns() + request->tv_sec * roscfe::kSecond + request->tv_nsec);
    if (rest != nullptr)
    {
        *rest = timespec();
    }
    return 0;
}

} // extern "C"
