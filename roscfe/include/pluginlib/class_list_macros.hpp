#ifndef ROSCFE_PLUGINLIB_CLASS_LIST_MACROS_HPP
#define ROSCFE_PLUGINLIB_CLASS_LIST_MACROS_HPP
#include "pluginlib/class_list_macros.h"
#endif
