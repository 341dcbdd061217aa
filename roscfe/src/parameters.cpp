// Parameters: rows of the application's table, which the ground loads and dumps like any other (CFE_TBL). Where cfepy's ROS
// application is, it has all parameters (parameter_server.cpp); the table is what they begin with, and what a load sets.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "internal.h"
#include "json.h"
#include "ros/param.h"
#include "ros/this_node.h"
#include "roscfe/parts.h"

namespace roscfe
{

namespace parts
{
extern const char parameters = 0;
}

using XmlRpc::XmlRpcValue;

namespace
{

std::size_t length_in(const char *text, std::size_t room)
{
    const void *end = std::memchr(text, '\0', room);
    return end != nullptr ? static_cast<std::size_t>(static_cast<const char *>(end) - text) : room;
}

enum class Relation
{
    apart,
    same,
    below
};

// The rows, from CFE_TBL_GetAddress to CFE_TBL_ReleaseAddress.
class Rows
{
  public:
    Rows()
    {
        void *             address = nullptr;
        const CFE_Status_t status  = g_node.has_table ? CFE_TBL_GetAddress(&address, g_node.table) : CFE_TBL_ERR_NEVER_LOADED;
        if (status == CFE_SUCCESS || status == CFE_TBL_INFO_UPDATED)
        {
            rows_ = static_cast<ParamRow *>(address);
        }
    }
    ~Rows()
    {
        if (g_node.has_table)
        {
            CFE_TBL_ReleaseAddress(g_node.table);
        }
    }
    Rows(const Rows &) = delete;
    Rows &operator=(const Rows &) = delete;

    int       count() const { return rows_ != nullptr ? g_node.description->param_rows : 0; }
    ParamRow &operator[](int index) { return rows_[index]; }

    // The end of the parameter that begins in a row: those that begin with "+" go on with it.
    int end_of(int first) const
    {
        int end = first + 1;
        while (end < count() && rows_[end].name[0] == '+')
        {
            ++end;
        }
        return end;
    }

    std::string name_of(int first, int end) const
    {
        std::string name = field(rows_[first].name, sizeof rows_[first].name);
        for (int i = first + 1; i < end; ++i)
        {
            name += field(rows_[i].name, sizeof rows_[i].name).substr(1);
        }
        return name;
    }

    // Whether a parameter has a name or is below it; a node may look often, and this takes no memory.
    Relation relation_of(int first, int end, const std::string &name) const
    {
        std::size_t at = 0;
        for (int i = first; i < end; ++i)
        {
            const char *      part = rows_[i].name;
            const std::size_t size = length_in(part, sizeof rows_[i].name);
            for (std::size_t of_part = i == first ? 0 : 1; of_part < size; ++of_part, ++at)
            {
                if (at == name.size()) // of "/" resolving leaves nothing
                {
                    return name.empty() || name == "/" || part[of_part] == '/' ? Relation::below : Relation::apart;
                }
                if (part[of_part] != name[at])
                {
                    return Relation::apart;
                }
            }
        }
        return at == name.size() ? Relation::same : Relation::apart;
    }

    void value_of(int first, int end, XmlRpcValue &value) const
    {
        if (end == first + 1) // as of all short ones: no memory is taken for the text
        {
            char text[sizeof(ParamRow::value) + 1];
            std::memcpy(text, rows_[first].value, sizeof(ParamRow::value));
            text[sizeof(ParamRow::value)] = '\0';
            from_json(text, value);
            return;
        }
        std::string text;
        for (int i = first; i < end; ++i)
        {
            text += field(rows_[i].value, sizeof rows_[i].value);
        }
        from_json(text.c_str(), value);
    }

  private:
    static std::string field(const char *at, std::size_t size) { return std::string(at, length_in(at, size)); }

    ParamRow *rows_ = nullptr;
};

bool is_below(const std::string &name, const std::string &ns)
{
    if (ns.empty())
    {
        return true; // "/", of which resolving leaves nothing
    }
    return name.size() > ns.size() && name.compare(0, ns.size(), ns) == 0 && (ns == "/" || name[ns.size()] == '/');
}

// Put a parameter into the tree of those that are below a namespace.
void put_below(XmlRpcValue &root, const std::string &path, const XmlRpcValue &value)
{
    XmlRpcValue *at    = &root;
    std::size_t  begin = 0;
    for (;;)
    {
        if (at->getType() != XmlRpcValue::TypeStruct)
        {
            at->clear();
        }
        const std::size_t slash = path.find('/', begin);
        at                      = &(*at)[path.substr(begin, slash - begin)];
        if (slash == std::string::npos)
        {
            break;
        }
        begin = slash + 1;
    }
    *at = value;
}

void erase(Rows &rows, const std::string &name)
{
    for (int i = 0; i < rows.count();)
    {
        const int end = rows.end_of(i);
        if (rows[i].name[0] != '\0' && rows.relation_of(i, end, name) != Relation::apart)
        {
            std::memset(static_cast<void *>(&rows[i]), 0, sizeof(ParamRow) * static_cast<std::size_t>(end - i));
        }
        i = end;
    }
}

// What has a parameter below it is a namespace from then on, and no value.
void erase_values_above(Rows &rows, const std::string &name)
{
    for (int i = 0; i < rows.count();)
    {
        const int end = rows.end_of(i);
        if (rows[i].name[0] != '\0' && is_below(name, rows.name_of(i, end)))
        {
            std::memset(static_cast<void *>(&rows[i]), 0, sizeof(ParamRow) * static_cast<std::size_t>(end - i));
        }
        i = end;
    }
}

// Rows that are free one after the other; -1 when there are not so many.
int free_rows(Rows &rows, int wanted)
{
    for (int i = 0; i + wanted <= rows.count(); ++i)
    {
        int found = 0;
        while (found < wanted && rows[i + found].name[0] == '\0')
        {
            ++found;
        }
        if (found == wanted)
        {
            return i;
        }
    }
    return -1;
}

bool put(Rows &rows, const std::string &name, const std::string &text)
{
    const std::size_t name_room  = sizeof(ParamRow::name) - 1;
    const std::size_t value_room = sizeof(ParamRow::value) - 1;
    const std::size_t of_value   = std::max<std::size_t>((text.size() + value_room - 1) / value_room, 1);
    std::size_t       of_name    = 1;
    if (name.size() > name_room)
    {
        of_name += (name.size() - name_room + name_room - 2) / (name_room - 1);
    }
    const int wanted = static_cast<int>(std::max(of_name, of_value));
    const int first  = free_rows(rows, wanted);
    if (first < 0)
    {
        return false;
    }
    std::size_t name_at = 0, value_at = 0;
    for (int i = 0; i < wanted; ++i)
    {
        ParamRow &  row  = rows[first + i];
        std::string part = i == 0 ? "" : "+";
        const std::string more = name.substr(std::min(name_at, name.size()), name_room - part.size());
        name_at += more.size();
        part += more;
        std::memcpy(row.name, part.c_str(), part.size() + 1);
        const std::string value = text.substr(std::min(value_at, text.size()), value_room);
        value_at += value.size();
        std::memcpy(row.value, value.c_str(), value.size() + 1);
    }
    return true;
}

std::string text_of(const XmlRpcValue &value)
{
    return value.toJson();
}

// The leaves of a tree, each a parameter of its own; an empty namespace is one.
bool put_all(Rows &rows, const std::string &name, const XmlRpcValue &value)
{
    if (value.getType() != XmlRpcValue::TypeStruct || value.size() == 0)
    {
        return put(rows, name, text_of(value));
    }
    bool good = true;
    for (const auto &each : value)
    {
        good = put_all(rows, ros::names::append(name, each.first), each.second) && good;
    }
    return good;
}

// -- the table ---------------------------------------------------------------------------------------------------------

bool get_row(const std::string &name, XmlRpcValue &value)
{
    Rows rows;
    bool found = false;
    for (int i = 0; i < rows.count();)
    {
        const int      end      = rows.end_of(i);
        const Relation relation = rows[i].name[0] != '\0' ? rows.relation_of(i, end, name) : Relation::apart;
        if (relation == Relation::same)
        {
            rows.value_of(i, end, value);
            return true;
        }
        if (relation == Relation::below)
        {
            XmlRpcValue leaf;
            rows.value_of(i, end, leaf);
            if (!found)
            {
                value = XmlRpcValue();
            }
            const std::size_t lead = name == "/" ? 1 : name.size() + 1;
            put_below(value, rows.name_of(i, end).substr(lead), leaf);
            found = true;
        }
        i = end;
    }
    return found;
}

bool has_row(const std::string &name)
{
    Rows rows;
    for (int i = 0; i < rows.count(); i = rows.end_of(i))
    {
        if (rows[i].name[0] != '\0' && rows.relation_of(i, rows.end_of(i), name) != Relation::apart)
        {
            return true;
        }
    }
    return false;
}

// Table Services are told, for a table that is to be kept in the Critical Data Store, and for dumps.
void tell_change()
{
    if (g_node.has_table && CFE_TBL_Modified(g_node.table) != CFE_SUCCESS)
    {
        CFE_EVS_SendEvent(kParameterEid, CFE_EVS_EventType_ERROR, "%s: CFE_TBL_Modified failed", g_node.name.c_str());
    }
}

void set_rows(const std::string &name, const XmlRpcValue &value)
{
    bool good = false;
    {
        Rows rows;
        erase(rows, name);
        erase_values_above(rows, name);
        good = put_all(rows, name, value);
    }
    tell_change();
    if (!good)
    {
        CFE_EVS_SendEvent(kParameterEid, CFE_EVS_EventType_ERROR, "%s: no row is free for the parameter %s",
                          g_node.name.c_str(), name.c_str());
    }
}

bool erase_rows(const std::string &name)
{
    XmlRpcValue value;
    if (!get_row(name, value))
    {
        return false;
    }
    {
        Rows rows;
        erase(rows, name);
    }
    tell_change();
    return true;
}

std::vector<std::string> row_names()
{
    std::vector<std::string> names;
    Rows                     rows;
    for (int i = 0; i < rows.count();)
    {
        const int end = rows.end_of(i);
        if (rows[i].name[0] != '\0')
        {
            names.push_back(rows.name_of(i, end));
        }
        i = end;
    }
    return names;
}

// What the ground has loaded counts from now on; whether the ROS application is to be asked.
bool take_over_load()
{
    if (!g_node.initialized)
    {
        return false;
    }
    open();
    const bool loaded = g_node.has_table && CFE_TBL_Manage(g_node.table) == CFE_TBL_INFO_UPDATED;
    if (loaded && g_node.has_master)
    {
        for (const std::string &name : row_names())
        {
            XmlRpcValue value;
            if (get_row(name, value))
            {
                server::set(name, value);
            }
        }
    }
    return g_node.has_master;
}

} // namespace

void open_parameters()
{
    reserve_keys();
    const NodeDescription &node = *g_node.description;
    if (node.param_rows == 0)
    {
        return;
    }
    const std::size_t size   = static_cast<std::size_t>(node.param_rows) * sizeof(ParamRow);
    CFE_Status_t      status = CFE_TBL_Register(&g_node.table, "Params", size, CFE_TBL_OPT_DEFAULT, nullptr);
    if (status == CFE_SUCCESS)
    {
        status = CFE_TBL_Load(g_node.table, CFE_TBL_SRC_ADDRESS, node.params);
    }
    g_node.has_table = status == CFE_SUCCESS;
    if (!g_node.has_table)
    {
        CFE_EVS_SendEvent(kParameterEid, CFE_EVS_EventType_ERROR, "%s: no table of parameters: 0x%08lX",
                          g_node.name.c_str(), as<unsigned long>(static_cast<std::uint32_t>(status)));
    }
    XmlRpcValue tree;
    if (g_node.has_master && !node.params_are_given && get_row("/", tree))
    {
        server::give(tree);
    }
}

bool get_param(const std::string &name, XmlRpcValue &value)
{
    return take_over_load() ? server::get(name, value) : get_row(name, value);
}

bool get_param_cached(const std::string &name, XmlRpcValue &value)
{
    return take_over_load() ? server::get_cached(name, value) : get_row(name, value);
}

void set_param(const std::string &name, const XmlRpcValue &value)
{
    if (take_over_load())
    {
        server::set(name, value);
    }
    else
    {
        set_rows(name, value);
    }
}

bool has_param(const std::string &name)
{
    return take_over_load() ? server::has(name) : has_row(name);
}

bool delete_param(const std::string &name)
{
    return take_over_load() ? server::erase(name) : erase_rows(name);
}

void param_names(std::vector<std::string> &names)
{
    if (take_over_load())
    {
        server::names(names);
    }
    else
    {
        names = row_names();
    }
}

// From a namespace upwards, the first that has the key's first part.
bool search_param(const std::string &ns, const std::string &key, std::string &result)
{
    if (take_over_load())
    {
        return server::search(ns, key, result);
    }
    const std::string first = key.substr(0, key.find('/'));
    std::string       at    = ns;
    for (;;)
    {
        XmlRpcValue value;
        if (get_row(ros::names::append(at, first), value))
        {
            result = ros::names::append(at, key);
            return true;
        }
        if (at == "/" || at.empty())
        {
            return false;
        }
        at = ros::names::parentNamespace(at);
    }
}

// -- types -------------------------------------------------------------------------------------------------------------

bool param_to(XmlRpcValue &value, std::string &to)
{
    if (value.getType() != XmlRpcValue::TypeString)
    {
        return false;
    }
    to = static_cast<const std::string &>(value);
    return true;
}

bool param_to(XmlRpcValue &value, double &to)
{
    if (value.getType() == XmlRpcValue::TypeInt)
    {
        to = static_cast<int>(value);
        return true;
    }
    if (value.getType() != XmlRpcValue::TypeDouble)
    {
        return false;
    }
    to = static_cast<double>(value);
    return true;
}

bool param_to(XmlRpcValue &value, float &to)
{
    double number = 0;
    if (!param_to(value, number))
    {
        return false;
    }
    to = static_cast<float>(number);
    return true;
}

bool param_to(XmlRpcValue &value, int &to)
{
    if (value.getType() == XmlRpcValue::TypeDouble)
    {
        const double number = static_cast<double>(value);
        to = static_cast<int>(std::fmod(number, 1.0) < 0.5 ? std::floor(number) : std::ceil(number));
        return true;
    }
    if (value.getType() != XmlRpcValue::TypeInt)
    {
        return false;
    }
    to = static_cast<int>(value);
    return true;
}

bool param_to(XmlRpcValue &value, bool &to)
{
    if (value.getType() != XmlRpcValue::TypeBoolean)
    {
        return false;
    }
    to = static_cast<bool>(value);
    return true;
}

bool param_to(XmlRpcValue &value, XmlRpcValue &to)
{
    to = value;
    return true;
}

namespace
{
bool number_of(XmlRpcValue &value, double &number)
{
    if (value.getType() == XmlRpcValue::TypeBoolean)
    {
        number = static_cast<bool>(value) ? 1 : 0;
        return true;
    }
    return param_to(value, number);
}
} // namespace

bool element_to(XmlRpcValue &value, std::string &to)
{
    return param_to(value, to);
}

bool element_to(XmlRpcValue &value, double &to)
{
    return number_of(value, to);
}

bool element_to(XmlRpcValue &value, float &to)
{
    double number = 0;
    const bool good = number_of(value, number);
    to              = static_cast<float>(number);
    return good;
}

bool element_to(XmlRpcValue &value, int &to)
{
    double number = 0;
    const bool good = number_of(value, number);
    to              = static_cast<int>(number);
    return good;
}

bool element_to(XmlRpcValue &value, bool &to)
{
    double number = 0;
    const bool good = number_of(value, number);
    to              = number != 0;
    return good;
}

} // namespace roscfe

namespace ros
{
namespace param
{

bool has(roscfe::Name key)
{
    return roscfe::has_param(roscfe::full_key(key));
}

bool del(const std::string &key)
{
    return roscfe::delete_param(names::resolve(key));
}

bool search(const std::string &key, std::string &result)
{
    return search(this_node::getName(), key, result);
}

bool search(const std::string &ns, const std::string &key, std::string &result)
{
    if (key.empty() || key[0] == '~')
    {
        return false;
    }
    if (key[0] == '/')
    {
        result = key;
        return roscfe::has_param(names::resolve(key));
    }
    return roscfe::search_param(names::resolve(ns), key, result);
}

bool getParamNames(std::vector<std::string> &keys)
{
    roscfe::param_names(keys);
    return true;
}

} // namespace param
} // namespace ros
