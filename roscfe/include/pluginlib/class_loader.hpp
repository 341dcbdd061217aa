#ifndef ROSCFE_PLUGINLIB_CLASS_LOADER_HPP
#define ROSCFE_PLUGINLIB_CLASS_LOADER_HPP
#include "pluginlib/class_loader.h"
#endif
