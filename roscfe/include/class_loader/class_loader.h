#ifndef ROSCFE_CLASS_LOADER_H
#define ROSCFE_CLASS_LOADER_H
#include "pluginlib/class_list_macros.h"
#endif
