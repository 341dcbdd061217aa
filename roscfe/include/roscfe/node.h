// What the convertor generates around a ROS node, and the entry of such a node as a cFE application.
#ifndef ROSCFE_NODE_H
#define ROSCFE_NODE_H

#include <cstdint>

namespace roscfe
{

// A topic and its MsgId. A raw topic carries whole cFE packets as std_msgs/UInt8MultiArray.
struct TopicId
{
    const char *  name; // resolved, such as "/chatter"
    std::uint16_t msg_id;
    bool          raw;
};

// A service and the MsgId of its answers; its requests have the command bit (0x1000) added.
struct ServiceId
{
    const char *  name;
    std::uint16_t answer_msg_id;
};

// A name and what takes its place, both resolved.
struct Remap
{
    const char *from;
    const char *to;
};

// A row of a table of parameters: a full name and a value as JSON. A name that begins with "+" goes on with the value
// (and the name) of the row above; an empty one is a free row. cfepy's tables ROS.Params have the same rows.
struct ParamRow
{
    char name[48];
    char value[80];
};

constexpr std::uint16_t kNoMarks = 0xFFFF;

// What is generated has it as `extern "C" const roscfe::NodeDescription roscfe_node`, which marks the shared object as a
// ROS node: cfepy starts its application ROS before it.
//
// One node of a launch file, or one executable of a package.
struct NodeDescription
{
    const char *      app;  // name of the cFE application, such as "TALKER"
    const char *      name; // of the node without its namespace; "" is what ros::init says
    const char *      ns;   // namespace, such as "/"
    const char *const *args; // of main, after the name of the program
    int               arg_count;
    const TopicId *   topics;
    int               topic_count;
    const ServiceId * services;
    int               service_count;
    const Remap *     remaps;
    int               remap_count;
    const ParamRow *  params; // the first contents of the table <APP>.Params, free rows included
    int               param_rows;
    std::uint16_t     longest_queue; // messages that a subscription keeps at most, whatever the node asks for
    std::uint16_t     pipe_depth;    // packets that wait in the node's pipe while it computes
    bool              params_are_given; // cfepy's parameter server has them before the node starts, as of a launch file
    std::uint16_t     housekeeping_msg_id; // commands have the command bit (0x1000) added; 0: the node has neither
    std::uint16_t     performance_id;      // marks its work in the performance log of ES, or kNoMarks
};

// Run a node: the application's entry point calls this, which does not return.
[[noreturn]] void run(const NodeDescription &node, int (*main_function)(int, char **));
[[noreturn]] void run(const NodeDescription &node, int (*main_function)());

} // namespace roscfe

#endif
