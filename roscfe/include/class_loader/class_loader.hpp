#ifndef ROSCFE_CLASS_LOADER_HPP
#define ROSCFE_CLASS_LOADER_HPP
#include "pluginlib/class_list_macros.h"
#endif
