// PLUGINLIB_EXPORT_CLASS and its older forms.
#ifndef ROSCFE_PLUGINLIB_CLASS_LIST_MACROS_H
#define ROSCFE_PLUGINLIB_CLASS_LIST_MACROS_H

#include "roscfe/plugins.h"

#define PLUGINLIB_EXPORT_CLASS(Class, Base) ROSCFE_EXPORT_CLASS_(Class, Base, __COUNTER__)
#define PLUGINLIB_DECLARE_CLASS(package, name, Class, Base) ROSCFE_EXPORT_CLASS_(Class, Base, __COUNTER__)
#define PLUGINLIB_REGISTER_CLASS(name, Class, Base) ROSCFE_EXPORT_CLASS_(Class, Base, __COUNTER__)
#define CLASS_LOADER_REGISTER_CLASS(Class, Base) ROSCFE_EXPORT_CLASS_(Class, Base, __COUNTER__)

#endif
