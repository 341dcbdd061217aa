// "_param:=value": the value is a number or a truth value, if it is one, as in roscpp.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "core/core.h"
#include "ros/names.h"
#include "ros/param.h"
#include "roscfe/parts.h"

namespace roscfe
{

namespace parts
{
extern const char private_parameters = 0;
}

void set_private(const std::string &name, const char *value)
{
    namespace param         = ros::param;
    const std::string full  = ros::names::append(g_node.name, name);
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

} // namespace roscfe
