// The life of a node: from the application's entry point to its end.
#include <cstring>

#include "core.h"
#include "ros/init.h"
#include "ros/names.h"
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
    if (CFE_EVS_Register(nullptr, 0, CFE_EVS_EventFilter_BINARY) != CFE_SUCCESS)
    {
        CFE_ES_WriteToSysLog("%s: CFE_EVS_Register failed\n", node.app); // no event can say so
        CFE_ES_ExitApp(CFE_ES_RunStatus_APP_ERROR);
    }
    if (g_node.description != nullptr) // in an image without loadable objects its variables are as its first life left them
    {
        refuse("the node has run already", "it starts again with its processor only");
    }
    g_node.description = &node;
    g_node.ns          = node.ns;
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
        if (open_parameters != nullptr)
        {
            open_parameters();
        }
    }
}

void end(int exit_status)
{
    heap::unseal();
    if (tell_end != nullptr)
    {
        tell_end(exit_status);
    }
    const std::uint32_t status = exit_status == 0 ? CFE_ES_RunStatus_APP_EXIT : CFE_ES_RunStatus_APP_ERROR;
    g_node.ended               = true;
    if (end_exact_waits != nullptr)
    {
        end_exact_waits();
    }
    for (;;)
    {
        CFE_ES_ExitApp(status); // ends the task
    }
}

void own_name(char (&name)[OS_MAX_API_NAME], const char *end, const char *short_end)
{
    constexpr std::size_t kOfApp = 17;
    const char *          app    = g_node.description->app;
    const std::size_t     length = std::strlen(app);
    const char *          last   = length + std::strlen(end) < sizeof name ? end : short_end;
    std::size_t           size   = length < kOfApp ? length : kOfApp;
    std::memcpy(name, app, size);
    for (; *last != '\0' && size + 1 < sizeof name; ++last)
    {
        name[size++] = *last;
    }
    name[size] = '\0';
}

void refuse(const char *what, const char *detail)
{
    const char *who = g_node.description != nullptr ? g_node.description->app : "roscfe";
    CFE_EVS_SendEvent(kRefusedEid, CFE_EVS_EventType_CRITICAL, "%s: %s: %s", who, what, detail);
    end(kRefused);
}

void remap(const std::string &from, const std::string &to)
{
    g_node.remappings[ros::names::resolve(g_node.ns, from, false)] = ros::names::resolve(g_node.ns, to, false);
}

void initialize(const std::string &name, std::uint32_t options)
{
    if (g_node.initialized)
    {
        return;
    }
    const NodeDescription &node  = *g_node.description;
    std::string            given = *node.name != '\0' ? node.name : name;
    // Where MsgIds are compiled in, those of private names go with the plain name.
    const bool has_ids = node.topic_count > 0 || node.service_count > 0;
    if ((options & ros::init_options::AnonymousName) != 0 && *node.name == '\0' && !has_ids)
    {
        given += "_" + std::to_string(now_ns());
    }
    if (given.find('/') != std::string::npos)
    {
        refuse("a node's name has no slash", given.c_str());
    }
    g_node.initialized = true;
    g_node.name        = ros::names::append(g_node.ns == "/" ? "" : g_node.ns, given);
    if (g_node.name[0] != '/')
    {
        g_node.name = "/" + g_node.name;
    }
    for (int i = 0; i < node.remap_count; ++i)
    {
        remap(node.remaps[i].from, node.remaps[i].to);
    }
}

} // namespace roscfe

namespace ros
{

using roscfe::g_node;

// "from:=to", "_param:=value", and "__name:=name", which the convertor has read.
void init(int &argc, char **argv, const std::string &name, std::uint32_t options)
{
    roscfe::initialize(name, options);
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
            roscfe::remap(std::string(argv[i], static_cast<std::size_t>(mark - argv[i])), mark + 2);
        }
        else if (argv[i][1] != '_' && roscfe::set_private != nullptr)
        {
            roscfe::set_private(std::string(argv[i] + 1, static_cast<std::size_t>(mark - argv[i] - 1)), mark + 2);
        }
    }
    argc       = kept;
    argv[argc] = nullptr;
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
    if (roscfe::open_clock != nullptr)
    {
        roscfe::open_clock();
    }
    CFE_EVS_SendEvent(roscfe::kStartedEid, CFE_EVS_EventType_INFORMATION, "%s started", g_node.name.c_str());
}

void shutdown()
{
    g_node.shutting_down = true;
    g_node.is_shut       = true;
}

bool ok()
{
    if (!g_node.shutting_down)
    {
        std::uint32_t status = CFE_ES_RunStatus_APP_RUN;
        if (!CFE_ES_RunLoop(&status))
        {
            g_node.asked_to_end  = true;
            g_node.shutting_down = true;
            if (roscfe::call_handler_of_end != nullptr)
            {
                roscfe::call_handler_of_end(); // in place of roscpp's, so its log is shown
            }
            shutdown();
        }
    }
    return !g_node.shutting_down;
}

} // namespace ros

// -- functions of C that a node would end the processor with; the linker puts these in their place (--wrap) ------------

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

} // extern "C"
