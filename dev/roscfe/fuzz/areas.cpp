#include "area.h"

namespace fuzz
{

Area *make_topics();
Area *make_reports();
Area *make_services();
Area *make_parameters();
Area *make_table();
Area *make_transforms();
Area *make_commands();

const Areas kAreas[] = {{"topics", make_topics},         {"reports", make_reports}, {"services", make_services},
                        {"parameters", make_parameters}, {"table", make_table},     {"transforms", make_transforms},
                        {"commands", make_commands},     {nullptr, nullptr}};

} // namespace fuzz
